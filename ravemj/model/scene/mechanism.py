"""Links and the joints between them."""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

from ravemj.core.transforms import Pose, Rows, Vec3, Wxyz
from ravemj.errors import Source
from ravemj.model.scene.record import Record
from ravemj.model.scene.shapes import Geometry

if TYPE_CHECKING:
    from ravemj.model.expressions import Expression

JointKind = Literal["hinge", "slider", "hinge2", "spherical", "rp", "pr", "pp"]

AXES: dict[JointKind, str] = {
    "hinge": "R",
    "slider": "P",
    "hinge2": "RR",
    "spherical": "RRR",
    "rp": "PR",
    "pr": "RP",
    "pp": "PP",
}
"""Axes of each joint kind (R revolute, P prismatic), the axis nearer to the parent first, in ``rp`` and ``pr`` last."""

OWN_SHAPES = "self"
"""Name of the group of a link's own shapes, stored while another group replaces them."""

UNLIMITED = 10000.0
"""The limit [rad] that OpenRAVE reports for a circular joint."""


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Inertial(Record):
    """Mass properties of a link.

    Attributes:
        mass: Mass [kg].
        com: Centre of mass in the link frame [m].
        inertia: Inertia tensor about the centre of mass, in axes parallel to the link's [kg m^2].
        axes: Orientation of principal axes chosen by a script, in the link frame; None means any that fit the tensor.
        undefined: Whether OpenRAVE's result is undefined (test random-xml-132: a total mass over shapes without
            volume). API getters then return NaN; computations use the finite values stored here.
    """

    mass: float
    com: Vec3
    inertia: Rows
    axes: Wxyz | None = None
    undefined: bool = False


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Parameters(Record):
    """Named values attached by scripts to a link or joint."""

    floats: tuple[tuple[str, tuple[float, ...]], ...] = ()
    integers: tuple[tuple[str, tuple[int, ...]], ...] = ()
    texts: tuple[tuple[str, str], ...] = ()


NO_PARAMETERS = Parameters()


@dataclass(frozen=True, slots=True, eq=False, repr=False, kw_only=True)
class Link(Record):
    """Rigid part of a body.

    Attributes:
        name: Its name.
        T_world_link: Its pose after loading.
        inertial: Its mass properties, as in the file.
        geometries: Its shapes, in document order.
        static: True for ``type="static"``.
        enabled: Whether it takes part in collision checks.
        groups: Alternative sets of shapes by name.
        parameters: Named values attached by scripts.
        self_collision_ignored: Whether self-collision checks ignore it.
        source: The element that it comes from.
    """

    name: str
    T_world_link: Pose
    inertial: Inertial
    geometries: tuple[Geometry, ...]
    static: bool
    enabled: bool
    groups: tuple[tuple[str, tuple[Geometry, ...]], ...] = ()
    parameters: Parameters = NO_PARAMETERS
    self_collision_ignored: bool = False
    source: Source


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Axis(Record):
    """Degree of freedom of a joint.

    Attributes:
        direction: Unit vector in the frame of the joint's parent link.
        reference: The value at which the joint has the pose ``Joint.T_parent_child``.
        value: The value after loading.
        lower: Lower limit [rad or m].
        upper: Upper limit [rad or m].
        circular: Whether it rotates without limits; the limits are then ±``UNLIMITED``.
        weight: Weight in distances between configurations.
        resolution: Step of planners [rad or m].
        max_velocity: Velocity limit [rad/s or m/s].
        max_acceleration: Acceleration limit [rad/s^2 or m/s^2].
        max_jerk: Jerk limit [rad/s^3 or m/s^3].
        max_torque: Torque or force limit [N m or N]; with a motor, its limit at rest. 0 if unknown.
        joint_torque: Limit of the joint itself if its motor has a different one; None means ``max_torque``.
        speed_torques: Speeds [rad/s or m/s] with the motor's torque limits; empty means ``max_torque`` at any speed.
        max_inertia: Limit of the moved inertia [kg m^2 or kg]; 0 if unknown.
        hard_max_velocity: Velocity that planners never exceed [rad/s or m/s]; 0 if unknown.
        hard_max_acceleration: Acceleration that planners never exceed.
        hard_max_jerk: Jerk that planners never exceed.
        armature: Inertia of a motor behind its gear [kg m^2].
        coulomb_friction: Friction of a motor at any speed [N m].
        viscous_friction: Friction of a motor per speed [N m s/rad].
        wrap_offset: Centre [rad] of the full turn to which scripts wrap the value.
    """

    direction: Vec3
    reference: float = 0.0
    value: float = 0.0
    lower: float = 0.0
    upper: float = 0.0
    circular: bool = False
    weight: float = 1.0
    resolution: float = 0.02
    max_velocity: float = 10.0
    max_acceleration: float = 50.0
    max_jerk: float = 50000.0
    max_torque: float = 0.0
    joint_torque: float | None = None
    speed_torques: tuple[tuple[float, float], ...] = ()
    max_inertia: float = 0.0
    hard_max_velocity: float = 0.0
    hard_max_acceleration: float = 0.0
    hard_max_jerk: float = 0.0
    armature: float = 0.0
    coulomb_friction: float = 0.0
    viscous_friction: float = 0.0
    wrap_offset: float = 0.0

    @property
    def own_torque(self) -> float:
        """Torque or force limit without regard to a motor [N m or N]; 0 if unknown."""
        return self.max_torque if self.joint_torque is None else self.joint_torque


RARE_NUMBERS = (
    "max_inertia",
    "hard_max_velocity",
    "hard_max_acceleration",
    "max_jerk",
    "hard_max_jerk",
    "wrap_offset",
)
"""Fields of axes that few files have and COLLADA lacks; ravemj writes them to COLLADA as attributes of its own."""


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Mimic(Record):
    """Equations of a mimic joint.

    Attributes:
        position: The equation as written, with the names of joints.
        velocity: The partial derivatives as written.
        acceleration: The second derivatives as written.
        expression: The equation over ``joint0``, ``joint1``, … (active joints, then passive ones); None if mimic joints
            depend on each other in a cycle, so that none moves.
        dofs: Indices of the DOFs that it depends on, directly or through other mimic joints.
    """

    position: str
    velocity: str
    acceleration: str
    expression: "Expression | None"
    dofs: tuple[int, ...]


@dataclass(frozen=True, slots=True, eq=False, repr=False, kw_only=True)
class Joint(Record):
    """Joint between two links; a positive value moves the child right-handed about or along the axis.

    Attributes:
        name: Its name.
        kind: ``hinge``, ``slider``, ``spherical`` (a rotation vector in the parent's axes), or two axes, of which the
            first carries the second: ``hinge2``, or with prismatic axes ``rp``, ``pr`` and ``pp``; see ``AXES``.
        parent: Index of the link nearer to link 0.
        child: Index of the link farther from link 0.
        T_parent_child: Pose of the child in the parent at ``Axis.reference``.
        anchor: A point on the axis, in the parent's frame.
        axes: Its degrees of freedom.
        places_child: False for a joint that closes a loop: another joint places its child.
        keeps_moving: True if a script set equal limits: as in OpenRAVE, only limits from files make welds.
        mimic: Its mimic equations, or None.
        parameters: Named values attached by scripts.
        source: The element that it comes from.
    """

    name: str
    kind: JointKind
    parent: int
    child: int
    T_parent_child: Pose
    anchor: Vec3
    axes: tuple[Axis, ...]
    places_child: bool
    keeps_moving: bool = False
    mimic: Mimic | None = None
    parameters: Parameters = NO_PARAMETERS
    source: Source

    def slides(self, axis: int = 0) -> bool:
        """Return whether an axis is prismatic, else revolute."""
        return AXES[self.kind][axis] == "P"

    @property
    def equation(self) -> "Expression | None":
        """Mimic equation, whose value is the first within the joint's limits if there are several.

        None for welds and joints that are not mimic joints.
        """
        if self.mimic is None or self.mimic.expression is None or self.static:
            return None
        if self.axes[0].circular:
            return self.mimic.expression
        return self.mimic.expression.within(self.axes[0].lower, self.axes[0].upper)

    @property
    def is_ball(self) -> bool:
        """Whether it is a spherical joint with three free values; spherical mimic joints turn about the parent's x."""
        return self.kind == "spherical" and self.equation is None

    @property
    def static(self) -> bool:
        """True for a weld: a joint without range when its body was made."""
        return not (self.has_room or self.keeps_moving)

    @property
    def has_room(self) -> bool:
        """True if an axis is circular or its lower limit is below the upper one."""
        return any(axis.lower < axis.upper or axis.circular for axis in self.axes)
