"""The models that come with ravemj, by name."""

from pathlib import Path

from ravemj.errors import ArgumentError

SHIPPED_MODELS = {
    "pendulum": "env.xml",
    "panda": "panda.xml",
    "puma560": "puma560.xml",
    "scara": "scara.dae",
    "workshop": "workshop.env.xml",
    "desk_arm": "desk_arm/urdf/desk_arm.urdf",
}
"""The file of each name."""

_PACKAGE = Path(__file__).resolve().parent.parent


def model_path(name: str) -> str:
    """Return the path of a model that comes with ravemj.

    Args:
        name: ``pendulum`` (the tutorial's), ``panda``, ``puma560``, ``scara``, ``workshop`` or ``desk_arm``
            (a URDF with its SRDF).

    Raises:
        ArgumentError: there is no such model.

    Example:
        >>> env = ravemj.load(ravemj.model_path("puma560"))
    """
    if name not in SHIPPED_MODELS:
        raise ArgumentError(f"name: is {name!r}, and should be one of {', '.join(SHIPPED_MODELS)}")
    installed = _PACKAGE / "models"  # the wheel holds them there; a clone has them beside the package
    return str((installed if installed.is_dir() else _PACKAGE.parent / "models") / SHIPPED_MODELS[name])
