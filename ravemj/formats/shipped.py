"""The models that come with ravemj, by name."""

from pathlib import Path

from ravemj.errors import ArgumentError

SHIPPED_MODELS = {
    "pendulum": "env.xml",
    "panda": "panda.xml",
    "puma560": "puma560.xml",
    "scara": "scara.dae",
    "workshop": "workshop.env.xml",
}
"""The file of each name."""

_PACKAGE = Path(__file__).resolve().parent.parent


def model_path(name: str) -> str:
    """Return the path of a model that comes with ravemj.

    Args:
        name: ``pendulum`` (the tutorial's), ``panda``, ``puma560``, ``scara`` or ``workshop``.

    Raises:
        ArgumentError: there is no such model.

    Example:
        >>> env = ravemj.load(ravemj.model_path("puma560"))
    """
    if name not in SHIPPED_MODELS:
        raise ArgumentError(f"name: is {name!r}, and should be one of {', '.join(SHIPPED_MODELS)}")
    installed = _PACKAGE / "models"  # the wheel holds them there; a clone has them beside the package
    return str((installed if installed.is_dir() else _PACKAGE.parent / "models") / SHIPPED_MODELS[name])
