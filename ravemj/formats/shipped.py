"""The models that come with ravemj, by name."""

from pathlib import Path

from ravemj.errors import ArgumentError
from ravemj.formats.robot_packages import INSTALL, is_robot_name, robot_file, robot_names

SHIPPED_MODELS = {
    "pendulum": "env.xml",
    "panda": "panda.xml",
    "puma560": "puma560.xml",
    "scara": "scara.dae",
    "biped": "biped.robot.xml",
    "workshop": "workshop.env.xml",
    "desk_arm": "desk_arm/urdf/desk_arm.urdf",
    "mug": "mug.kinbody.xml",
    "box": "box.kinbody.xml",
}
"""The file of each name."""

_PACKAGE = Path(__file__).resolve().parent.parent


def model_path(name: str, *, download: bool = False) -> str:
    """Return the path of a model that comes with ravemj, or of a robot of an installed package.

    Args:
        name: ``pendulum`` (the tutorial's), ``panda``, ``puma560``, ``scara``, ``biped``, ``workshop``, ``desk_arm``
            (a URDF with its SRDF), or an object to grasp: ``mug`` or ``box``. With the extra ``robots`` also the robots
            of ``robot_descriptions`` and ``mujoco-menagerie``, for instance ``ur5e_mj_description``.
        download: Whether such a robot may be fetched; otherwise it has to be in the cache of its package.

    Raises:
        ArgumentError: there is no such model, or it is not on this machine and may not be fetched.
        RavemjError: it cannot be fetched.

    Example:
        >>> env = ravemj.load(ravemj.model_path("puma560"))
    """
    if is_robot_name(name):
        return str(robot_file(name, download=download).path)
    if name not in SHIPPED_MODELS:
        message = f"name: is {name!r}, and should be one of {', '.join(SHIPPED_MODELS)}, or the name of a robot"
        raise ArgumentError(f"{message}; {INSTALL}" if not robot_names() else message)
    installed = _PACKAGE / "models"  # the wheel holds them there; a clone has them beside the package
    return str((installed if installed.is_dir() else _PACKAGE.parent / "models") / SHIPPED_MODELS[name])
