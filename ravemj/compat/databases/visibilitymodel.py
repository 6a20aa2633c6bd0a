"""From where a camera on an arm sees a body."""

from ravemj.compat.databases.model import DatabaseGenerator


class VisibilityModel(DatabaseGenerator):
    """From where a camera on an arm sees a body."""

    capability = "visual feedback"
