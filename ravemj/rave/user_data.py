"""What users attach to objects of an environment, and to the environment itself."""

from typing import Any


class Annotations:
    """What users attach to an object: a description and data of their own, under names."""

    def __init__(self) -> None:
        self.description = ""
        self.data: dict[str, Any] = {}

    def attach(self, key: Any, data: Any) -> None:  # noqa: ANN401 - any object of the user's
        """Keep data under a name, or with ``...`` as data the first argument under the name ''."""
        name, attached = ("", key) if data is ... else (key, data)
        self.data[str(name)] = attached
