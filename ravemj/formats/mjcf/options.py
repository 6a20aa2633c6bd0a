"""Options of the translation to MJCF."""

from typing import NamedTuple

from ravemj.formats.mjcf.actuators import Actuators
from ravemj.model.gains import Gains


class Options(NamedTuple):
    """Options of a translation.

    Attributes:
        free_bases: Whether bodies without a static link can fall, as in OpenRAVE's physics engines; else every root is
            fixed to the world.
        actuators: The kind of actuator for each DOF, or None.
        decomposed: Whether meshes collide as several convex parts (with CoACD) in place of one hull.
        excludes: Whether to exclude pairs of links that OpenRAVE never tests.
        mechanism_only: Whether to write only links and joints, without shapes and dynamics, with a free joint for
            every root.
        free_robots: Whether robots can fall even if they have a static link.
        gains: For each body the gains of its actuators; a body without actuators may have None.
        merge_fixed: Whether a link fixed to its parent is merged into it, as shapes and a site.
        hull_vertices: Maximum number of vertices of a collision hull; 0 means no limit.
        self_collision: Whether links of one robot collide.
        sensors: Whether to write sensors of joints and of the base, and the model's own.
        timestep: Time step [s], or None for MuJoCo's.
        folder: Folder of the model, for a readable document: comments name files relative to it, and rounding noise
            is removed from vectors. None keeps all digits.
    """

    free_bases: bool = False
    actuators: Actuators | None = None
    decomposed: bool = False
    excludes: bool = True
    mechanism_only: bool = False
    free_robots: bool = False
    gains: tuple[Gains | None, ...] = ()
    merge_fixed: bool = False
    hull_vertices: int = 0
    self_collision: bool = True
    sensors: bool = False
    timestep: float | None = None
    folder: str | None = None
