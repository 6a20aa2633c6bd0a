"""Structure of a body: links, joints, DOF limits, mass, its source, and rebuilding it."""

# The fields of infos have the names that OpenRAVE gives them.
# pyright: reportPrivateUsage=false

import itertools
import os
from collections.abc import Iterable, Sequence
from types import EllipsisType
from typing import TYPE_CHECKING, Any, Literal, cast, overload

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.api_object import ApiObject
from ravemj.core.arguments import checked_index, checked_kind
from ravemj.core.arrays import checked_indices, checked_numbers, checked_transform, checked_vector
from ravemj.core.transforms import Floats, Pose
from ravemj.engine.simulation import BodyState, Simulation
from ravemj.errors import ArgumentError, ErrorCode, RavemjError
from ravemj.model import chains, hashes, scene
from ravemj.model.chains import adjacent_pairs
from ravemj.model.joints import value_differences
from ravemj.model.limits import with_fields
from ravemj.model.mimic import Equations
from ravemj.model.shape_bodies import FROM_SCRIPT, body_of_geometries, box_geometries, shape_geometry, sphere_geometries
from ravemj.rave.enums import UpdateFromInfoResult
from ravemj.rave.infos import ExtractInfoOptions, GeometryInfo, GrabbedInfo, JointInfo, KinBodyInfo, LinkInfo, body_of
from ravemj.rave.infos.link import geometries_of
from ravemj.rave.joint import Joint
from ravemj.rave.link import Link
from ravemj.rave.trimesh import TriMesh, checked_mesh

if TYPE_CHECKING:
    from ravemj.rave.kinbody import KinBody


class BodyPart(ApiObject):
    """Structure of a body: links, joints, DOF limits, mass and hashes, and methods that replace it.

    It is the root base class of bodies, and declares their shared state. OpenRAVE's ids, revisions and reference files
    belong to model databases, which ravemj does not have: they are empty unless scripts set them.
    """

    _often_called = ("GetDOFLimits",)

    _internal = (
        "extracted",
        "simulation_state",
    )

    _state: BodyState
    _simulation: Simulation

    _known: tuple[tuple[scene.Joint, ...], dict[str, Floats]] | None = None
    """Cached arrays of axis fields by name, and the tuple of joints for which they were computed.

    Every change of joints creates a new tuple, so the cache is valid if the scene still has this tuple.
    """

    @property
    def simulation_state(self) -> BodyState:
        """The body in the simulation: its scene description and its kinematics."""
        return self._state

    def _checked_link(self, index: int) -> int:
        return checked_index(index, len(self._state.scene.links), "linkindex")

    def GetDOF(self) -> int:
        """Return the number of degrees of freedom: the axes of all joints that are not passive.

        Example:
            >>> robot.GetDOF()
            2
        """
        return self._state.dof

    def GetDOFLimits(self, indices: "ArrayLike | EllipsisType | None" = ...) -> tuple[Floats, Floats]:
        """Return the joint limits.

        Args:
            indices: The DOF indices, in the order of the result; by default all.

        Returns:
            Lower and upper limits [rad or m], each of shape (dof,); ±10000 for circular joints.

        Raises:
            IndexError: there is no such DOF.

        Example:
            >>> lower, upper = robot.GetDOFLimits()
            >>> middle = (lower + upper) / 2
        """
        return self._of_axes("lower", indices), self._of_axes("upper", indices)

    def SetDOFLimits(self, lower: ArrayLike, upper: ArrayLike, indices: "ArrayLike | None" = None) -> None:
        """Set joint limits. The body does not move, even if a joint is outside now; ``SetDOFValues`` applies limits.

        Args:
            lower: Lower limits [rad or m], one for each DOF or for each index.
            upper: Upper limits [rad or m], likewise.
            indices: The DOF indices of the limits; None for all.

        Raises:
            openrave_exception: the number of limits is wrong. The limits do not change.
            IndexError: there is no such DOF.
        """
        self._set_axes("SetDOFLimits", {"lower": lower, "upper": upper}, indices)

    def GetDOFVelocityLimits(self, indices: "ArrayLike | EllipsisType | None" = ...) -> Floats:
        """Return the velocity limits [rad/s or m/s], shape (dof,), or those of the DOFs ``indices``."""
        return self._of_axes("max_velocity", indices)

    GetDOFMaxVel = GetDOFVelocityLimits

    def SetDOFVelocityLimits(self, limits: ArrayLike) -> None:
        """Set the velocity limits [rad/s or m/s], shape (dof,)."""
        self._set_axes("SetDOFVelocityLimits", {"max_velocity": limits})

    def GetDOFAccelerationLimits(self, indices: "ArrayLike | EllipsisType | None" = ...) -> Floats:
        """Return the acceleration limits [rad/s^2 or m/s^2], shape (dof,), or those of the DOFs ``indices``."""
        return self._of_axes("max_acceleration", indices)

    GetDOFMaxAccel = GetDOFAccelerationLimits

    def SetDOFAccelerationLimits(self, limits: ArrayLike) -> None:
        """Set the acceleration limits [rad/s^2 or m/s^2], shape (dof,)."""
        self._set_axes("SetDOFAccelerationLimits", {"max_acceleration": limits})

    def GetDOFJerkLimits(self, indices: "ArrayLike | EllipsisType | None" = ...) -> Floats:
        """Return the jerk limits [rad/s^3 or m/s^3], shape (dof,), or those of the DOFs ``indices``."""
        return self._of_axes("max_jerk", indices)

    def SetDOFJerkLimits(self, limits: ArrayLike) -> None:
        """Set the jerk limits [rad/s^3 or m/s^3], shape (dof,)."""
        self._set_axes("SetDOFJerkLimits", {"max_jerk": limits})

    def GetDOFHardVelocityLimits(self, indices: "ArrayLike | EllipsisType | None" = ...) -> Floats:
        """Return the velocities that planners never exceed, shape (dof,), or those of ``indices``; 0 for none."""
        return self._of_axes("hard_max_velocity", indices)

    def SetDOFHardVelocityLimits(self, limits: ArrayLike) -> None:
        """Set ``limits``, velocities that planners never exceed [rad/s or m/s], shape (dof,); 0 for none."""
        self._set_axes("SetDOFHardVelocityLimits", {"hard_max_velocity": limits})

    def GetDOFHardAccelerationLimits(self, indices: "ArrayLike | EllipsisType | None" = ...) -> Floats:
        """Return the accelerations that planners never exceed, shape (dof,), or those of ``indices``; 0 for none."""
        return self._of_axes("hard_max_acceleration", indices)

    def SetDOFHardAccelerationLimits(self, limits: ArrayLike) -> None:
        """Set ``limits``, accelerations that planners never exceed [rad/s^2 or m/s^2], shape (dof,); 0 for none."""
        self._set_axes("SetDOFHardAccelerationLimits", {"hard_max_acceleration": limits})

    def GetDOFHardJerkLimits(self, indices: "ArrayLike | EllipsisType | None" = ...) -> Floats:
        """Return the jerks that planners never exceed, shape (dof,), or those of ``indices``; 0 for none."""
        return self._of_axes("hard_max_jerk", indices)

    def SetDOFHardJerkLimits(self, limits: ArrayLike) -> None:
        """Set ``limits``, jerks that planners never exceed [rad/s^3 or m/s^3], shape (dof,); 0 for none."""
        self._set_axes("SetDOFHardJerkLimits", {"hard_max_jerk": limits})

    def GetDOFDynamicAccelerationJerkLimits(
        self, dofPositions: ArrayLike, dofVelocities: ArrayLike
    ) -> tuple[Floats, Floats]:
        """Return limits that depend on the configuration. ravemj has none.

        Args:
            dofPositions: Joint values [rad or m], shape (dof,).
            dofVelocities: Joint velocities [rad/s or m/s], shape (dof,).

        Returns:
            Two empty arrays: the limits of ``GetDOFAccelerationLimits`` and ``GetDOFJerkLimits`` apply everywhere.
        """
        for values, name in ((dofPositions, "dofPositions"), (dofVelocities, "dofVelocities")):
            checked_vector(values, self.GetDOF(), f"GetDOFDynamicAccelerationJerkLimits: {name}")
        return np.zeros(0), np.zeros(0)

    def GetDOFTorqueLimits(self, indices: "ArrayLike | EllipsisType | None" = ...) -> Floats:
        """Return the torque limits [N m or N], shape (dof,), or those of the DOFs ``indices``; 0 if unknown.

        Limits of motors are ignored; see ``GetDOFMaxTorque``.
        """
        return self._of_axes("own_torque", indices)

    def GetDOFMaxTorque(self, indices: "ArrayLike | EllipsisType | None" = ...) -> Floats:
        """Return the torque limits [N m or N], shape (dof,), or those of the DOFs ``indices``; 0 if unknown.

        The limit of a motor is its torque limit at the present speed.
        """
        limits = [joint.GetMaxTorque() for joint in self.GetJoints() for _ in range(joint.GetDOF())]
        return np.array(limits)[checked_indices(indices, self.GetDOF())]

    def SetDOFTorqueLimits(self, limits: ArrayLike) -> None:
        """Set the torque limits [N m, for sliders N], shape (dof,). The limits of motors do not change."""
        axes = self._state.scene.dof_axes
        motors = [dof for dof, axis in enumerate(axes) if axis.speed_torques or axis.joint_torque is not None]
        kept = self._of_axes("max_torque", motors)
        self._set_axes("SetDOFTorqueLimits", {"max_torque": limits})
        if motors:
            given = self._of_axes("max_torque", motors)
            self._set_axes("SetDOFTorqueLimits", {"max_torque": kept, "joint_torque": given}, motors)

    def GetDOFWeights(self, indices: "ArrayLike | EllipsisType | None" = ...) -> Floats:
        """Return the weights in distances between configurations, shape (dof,), or those of the DOFs ``indices``."""
        return self._of_axes("weight", indices)

    def SetDOFWeights(self, weights: ArrayLike) -> None:
        """Set the weights in distances between configurations.

        Args:
            weights: Weights, all positive, shape (dof,).

        Raises:
            openrave_exception: the number of weights is wrong (``Failed``), or one is not positive
                (``InvalidArguments``). The weights stay as they were.
        """
        self._set_axes("SetDOFWeights", {"weight": weights}, positive=True)

    def GetDOFResolutions(self, indices: "ArrayLike | EllipsisType | None" = ...) -> Floats:
        """Return the planners' steps [rad or m], shape (dof,), or those of the DOFs ``indices``."""
        return self._of_axes("resolution", indices)

    def SetDOFResolutions(self, resolutions: ArrayLike) -> None:
        """Set ``resolutions``, the steps in which planners test for collisions [rad or m], positive, shape (dof,)."""
        self._set_axes("SetDOFResolutions", {"resolution": resolutions}, positive=True)

    def _of_axes(self, field: str, indices: "ArrayLike | EllipsisType | None") -> Floats:
        scene = self._state.scene
        if self._known is None or self._known[0] is not scene.joints:
            self._known = (scene.joints, {})
        fields = self._known[1]
        values = fields.get(field)
        if values is None:
            fields[field] = values = np.array([getattr(axis, field) for axis in scene.dof_axes], dtype=np.float64)
        return values.copy() if indices is ... else values[checked_indices(indices, len(values))]

    def _set_axes(
        self, caller: str, fields: dict[str, ArrayLike], indices: "ArrayLike | None" = None, *, positive: bool = False
    ) -> None:
        """Set fields of the axes of DOFs, by default of all. On an error, none is changed."""
        dof = self.GetDOF()
        chosen = checked_indices(... if indices is None else indices, dof)
        given: dict[str, list[float]] = {}
        for name, values in fields.items():
            numbers = checked_numbers(values, f"{caller}: values")
            if numbers.ndim != 1 or (len(numbers) != len(chosen) and numbers.size + len(chosen) > 0):
                wanted = f"{dof} numbers, one for each DOF" if indices is None else f"{len(chosen)}, as many as indices"
                message = f"{caller}: values have shape {numbers.shape}, and should be {wanted}"
                raise ArgumentError(message, ErrorCode.Failed if indices is None else ErrorCode.Assert)
            if np.isnan(numbers).any():
                raise ArgumentError(f"{caller}: values are {numbers.tolist()}, and should be numbers")
            if positive and not (numbers > 0).all():
                raise ArgumentError(f"{caller}: values are {numbers.tolist()}, and should be positive")
            given[name] = numbers.tolist()
        with self._simulation.lock:
            self._state.edit_axes(with_fields(self._state.scene.dof_axes, chosen.tolist(), given))

    def SubtractDOFValues(
        self, values0: ArrayLike, values1: ArrayLike, indices: "ArrayLike | EllipsisType | None" = ...
    ) -> Floats:
        """Return the difference of joint values.

        Args:
            values0: Joint values [rad or m], one for each DOF or for each index.
            values1: The joint values to subtract, likewise.
            indices: The DOF indices of the values; by default all.

        Returns:
            ``values0 - values1``. For circular joints the difference is in [-pi, pi], except for joints on a static
            link, as in OpenRAVE.
        """
        chosen = checked_indices(indices, self.GetDOF())
        minuend, subtrahend = (checked_numbers(values, "SubtractDOFValues") for values in (values0, values1))
        if not len(minuend) == len(subtrahend) == len(chosen):
            message = (
                f"SubtractDOFValues: {len(minuend)} and {len(subtrahend)} values, and should be {len(chosen)} each"
            )
            raise ArgumentError(message, ErrorCode.Assert)
        return value_differences(self._state.scene, chosen.tolist(), minuend, subtrahend)

    _links: tuple[Link, ...] = ()
    _joints: tuple[Joint, ...] = ()
    _places: tuple[object, dict[str, int]] = (None, {})

    _uri: str | None = None
    """File or ``uri`` given to ``InitFrom…``; None if the body was read from its scene's source file."""

    _id = ""

    @property
    def _body(self) -> "KinBody":
        return cast("KinBody", self)

    def GetName(self) -> str:
        """Return the body's name, unique in its environment.

        Example:
            >>> [body.GetName() for body in env.GetBodies()]
            ['Pendulum']
        """
        return self._state.scene.name

    def GetLinks(self, indices: Sequence[int] | None = None) -> list[Link]:
        """Return the links in the order of the file; the first one is the root.

        Args:
            indices: The link indices; by default all.

        Example:
            >>> [link.GetName() for link in robot.GetLinks()]
            ['Base', 'Arm0', 'Arm1']
        """
        links = self._all_links()
        if indices is None:
            return list(links)
        return [links[index] for index in checked_indices(indices, len(links), "indices").tolist()]

    def _all_links(self) -> tuple[Link, ...]:
        """Return the links. They are created once, since they only store an index."""
        count = len(self._state.scene.links)
        if len(self._links) != count:
            self._links = tuple(Link(self._body, self._state, index) for index in range(count))
        return self._links

    def GetLink(self, name: str) -> Link | None:
        """Return the link called ``name``, or None.

        Example:
            >>> T_world_link = robot.GetLink("Arm1").GetTransform()
            >>> robot.GetLink("no such link") is None
            True
        """
        scenes = self._state.scene.links
        if self._places[0] is not scenes:  # the first of several that have a name, hence backwards
            self._places = (scenes, {scenes[index].name: index for index in reversed(range(len(scenes)))})
        index = self._places[1].get(name)
        return None if index is None else self._all_links()[index]

    def GetJoints(self, indices: Sequence[int] | None = None) -> list[Joint]:
        """Return the joints that have DOFs, in DOF order, or those of ``indices``."""
        joints = self._all_joints()[: len(self._state.scene.joints)]
        if indices is None:
            return list(joints)
        return [joints[index] for index in checked_indices(indices, len(joints), "indices").tolist()]

    def _all_joints(self) -> tuple[Joint, ...]:
        """Return the active joints, then the passive ones; created once, like the links."""
        body = self._state.scene
        count = len(body.joints) + len(body.passive_joints)
        if len(self._joints) != count:
            self._joints = tuple(Joint(self._body, self._state, index) for index in range(count))
        return self._joints

    def set_following(self, index: int, equations: Equations) -> None:
        """Make a joint a mimic joint, or an ordinary one; see ``Joint.SetMimicEquations``.

        Args:
            index: The index of the joint among the active joints followed by the passive ones.
            equations: The mimic equations.
        """
        from ravemj.model.following import with_equations  # noqa: PLC0415 - slow to import, and rarely wanted

        scene, order = with_equations(self._state.scene, index, equations)
        joints = self._all_joints()
        self._state.remake(scene)
        self._joints = tuple(joints[before] for before in order)
        for place, joint in enumerate(self._joints):
            joint.renumber(place)

    def GetPassiveJoints(self) -> list[Joint]:
        """Return the joints that have no DOF."""
        return list(self._all_joints()[len(self._state.scene.joints) :])

    def GetJoint(self, name: str) -> Joint | None:
        """Return the joint called ``name``, passive or not, or None.

        Example:
            >>> robot.GetJoint("Joint1").GetDOFIndex()
            1
            >>> robot.GetJoint("no such joint") is None
            True
        """
        return next((joint for joint in self._all_joints() if joint.GetName() == name), None)

    def GetJointFromDOFIndex(self, dofindex: int) -> Joint:
        """Return the joint that the DOF ``dofindex`` belongs to.

        Raises:
            IndexError: there is no such DOF.
        """
        dofs = checked_indices(dofindex, self.GetDOF(), "dofindex").tolist()
        if len(dofs) != 1:
            raise ArgumentError(f"GetJointFromDOFIndex: dofindex: are {dofs}, and should be one number")
        joints = self._state.scene.joints
        behind = itertools.accumulate(len(joint.axes) for joint in joints)  # the DOF after each joint
        return self._all_joints()[next(index for index, end in enumerate(behind) if dofs[0] < end)]

    def GetAdjacentLinks(self) -> set[tuple[int, int]]:
        """Return the pairs of links, by index, that self-collision checks ignore."""
        return set(adjacent_pairs(self._state.scene))

    def GetJointIndex(self, name: str) -> int:
        """Return the index in ``GetJoints()`` of the joint called ``name``, or -1."""
        return next((joint.GetJointIndex() for joint in self.GetJoints() if joint.GetName() == name), -1)

    def IsDOFRevolute(self, dofindex: int) -> bool:
        """Return whether the DOF ``dofindex`` is an angle."""
        return self.GetJointFromDOFIndex(dofindex).IsRevolute()

    def IsDOFPrismatic(self, dofindex: int) -> bool:
        """Return whether the DOF ``dofindex`` is a length."""
        return self.GetJointFromDOFIndex(dofindex).IsPrismatic()

    def IsDOFInChain(self, linkindex1: int, linkindex2: int, dofindex: int) -> bool:
        """Return whether a DOF moves two links relative to each other.

        Args:
            linkindex1: Index of a link.
            linkindex2: Index of the other link.
            dofindex: Index of the DOF.

        Raises:
            IndexError: the body has no such link.
        """
        checked_indices([linkindex1, linkindex2], len(self._state.scene.links), "link indices")  # random api-91001-74
        first, second = self.DoesDOFAffectLink(dofindex, linkindex1), self.DoesDOFAffectLink(dofindex, linkindex2)
        return first != second

    def DoesAffect(self, jointindex: int, linkindex: int) -> int:
        """Return 1 if a joint moves a link, directly or through mimic joints, else 0.

        Args:
            jointindex: Index of the joint, not of a DOF.
            linkindex: Index of the link.

        Raises:
            ArgumentError: there is no such joint or link.
        """
        joints = self.GetJoints()
        checked_index(jointindex, len(joints), "jointindex")
        return self.DoesDOFAffectLink(joints[jointindex].GetDOFIndex(), linkindex)

    def DoesDOFAffectLink(self, dofindex: int, linkindex: int) -> int:
        """Return 1 if a DOF moves a link, directly or through mimic joints, else 0.

        Args:
            dofindex: Index of the DOF.
            linkindex: Index of the link.

        Raises:
            ArgumentError: there is no such DOF or link.
        """
        checked_index(dofindex, self.GetDOF(), "dofindex")
        self._checked_link(linkindex)
        return int(dofindex in chains.dofs_moving(self._state.scene, linkindex))

    @overload
    def GetChain(self, linkindex1: int, linkindex2: int, returnjoints: Literal[True] = True) -> list[Joint]: ...
    @overload
    def GetChain(self, linkindex1: int, linkindex2: int, returnjoints: Literal[False]) -> list[Link]: ...
    def GetChain(self, linkindex1: int, linkindex2: int, returnjoints: bool = True) -> list[Joint] | list[Link]:
        """Return the chain of joints, or of links, from one link to another.

        Args:
            linkindex1: Index of the link to start from.
            linkindex2: Index of the link to reach.
            returnjoints: Whether to return the joints of the chain, including passive ones; otherwise its links,
                including both ends.

        Returns:
            Joints or links in order. The list is empty if no joints connect the links, or if they are the same.

        Raises:
            ArgumentError: there is no such link.

        Example:
            >>> [joint.GetName() for joint in robot.GetChain(0, 2)]
        """
        self._checked_link(linkindex1)
        self._checked_link(linkindex2)
        links, joints = chains.chain(self._state.scene, linkindex1, linkindex2)
        if not returnjoints:
            return self.GetLinks(links)
        every = self._all_joints()
        return [every[index] for index in joints]

    def GetDependencyOrderedJoints(self) -> list[Joint]:
        """Return the active joints, each one after the joints that move it."""
        return self.GetJoints(chains.dependency_order(self._state.scene))

    def GetClosedLoops(self) -> list[list[tuple[Link, Joint]]]:
        """Return the closed loops of links: each is a list of links with the joint that leads to the next link."""
        links, joints = self._all_links(), self._all_joints()
        return [
            [(links[link], joints[joint]) for link, joint in loop] for loop in chains.closed_loops(self._state.scene)
        ]

    def GetRigidlyAttachedLinks(self, linkindex: int) -> list[Link]:
        """Return the link of index ``linkindex``, then all links that no joint moves relative to it."""
        self._checked_link(linkindex)
        return self.GetLinks(chains.rigidly_attached(self._state.scene, linkindex))

    def GetKinematicsGeometryHash(self) -> str:
        """Return a hash of the body's links, geometries, masses and joints, 32 hexadecimal digits.

        Pose, joint values, limits, colours and names do not matter.
        """
        return self._state.made_once(hashes.of_body, self._state.scene)

    GetStructureHash = GetKinematicsGeometryHash

    def GetMass(self) -> float:
        """Return the mass of all links [kg]."""
        return sum(link.GetMass() for link in self.GetLinks())

    def IsVisible(self) -> bool:
        """Return whether any geometry of the body is drawn."""
        return any(link.IsVisible() for link in self.GetLinks())

    def SetVisible(self, visible: bool) -> bool:
        """Draw all geometries of the body, or none. Collision checks do not depend on it.

        Args:
            visible: Whether to draw them.

        Returns:
            Whether the visibility of any geometry has changed.
        """
        with self._simulation.lock:
            return any([link.SetVisible(visible) for link in self.GetLinks()])

    def GetURI(self) -> str:
        """Return the file that the body was read from, as ``file:/path``; empty for a body made in code.

        For a COLLADA file with several bodies, ``#`` and the body's id follow the path; ``ReadRobotURI`` and
        ``ReadKinBodyURI`` then read that body alone.

        After ``InitFromBoxes`` and similar methods, it is their argument ``uri``.
        """
        if self._uri is not None:
            return self._uri
        file = self._state.scene.source.file
        archive, inside, _ = file.partition(_ARCHIVE + "/")  # documents in archives are sources of their own
        if file in _NO_FILES:
            return ""
        element = self._state.scene.element
        return f"file:{os.path.abspath(archive + _ARCHIVE if inside else file)}{'#' if element else ''}{element}"

    GetXMLFilename = GetURI

    def GetReferenceURI(self) -> str:
        """Return an empty string.

        In OpenRAVE this is the file that the body refers to in JSON; ravemj does not read such references.
        """
        return ""

    def GetAssociatedFileEntries(self) -> None:
        """Return None. In OpenRAVE these are the files of a database that the body comes from."""

    def GetId(self) -> str:
        """Return the id that ``SetId`` set; empty in a new body."""
        return self._id

    def SetId(self, id: str) -> None:  # OpenRAVE's name of the argument
        """Set the text ``id``, for scripts that use ids. The environment identifies bodies by name."""
        self._id = str(id)

    def GetRevisionId(self) -> int:
        """Return 0. In OpenRAVE this is the revision of the body in a database."""
        return 0

    def GetLastModifiedAtUS(self) -> int:
        """Return 0. In OpenRAVE this is the time of the last change in a database."""
        return 0

    def GetManageData(self) -> None:
        """Return None, since there are no sensor systems."""

    def serialize(self, options: int) -> str:
        """Return a string that determines links, geometries and joints of the body; ``options`` has no effect.

        ``GetKinematicsGeometryHash`` is its hash. OpenRAVE's string differs.
        """
        del options
        return hashes.text_of_body(self._state.scene)

    def InitFromBoxes(self, boxes: ArrayLike, draw: bool = True, uri: str = "") -> bool:
        """Replace the body by a single static link of boxes.

        Args:
            boxes: One row for each box: centre x y z and half extents x y z [m], shape (n, 6). For rotated boxes:
                centre, the unit vectors along the x, y and z axes of the box, and half extents, shape (n, 15).
            draw: Whether the boxes are drawn. They collide either way.
            uri: The result of later calls of ``GetURI``.

        Returns:
            True.

        Raises:
            openrave_exception: the body is in an environment, or the rows have another length.
            TypeError: the argument is not a two-dimensional array.

        Example:
            >>> body = ravemj.RaveCreateKinBody(env, "")
            >>> body.InitFromBoxes([[0, 0, 0.1, 0.5, 0.5, 0.1]])
            True
            >>> body.SetName("table")
            >>> env.Add(body)
        """
        return self._become(box_geometries(_rows(boxes, (6, 15), "InitFromBoxes: boxes"), visible=bool(draw)), uri)

    def InitFromSpheres(self, spherex: ArrayLike, draw: bool = True, uri: str = "") -> bool:
        """Replace the body by a single static link of spheres.

        Args:
            spherex: One row for each sphere: centre x y z and radius [m], shape (n, 4); the spelling is OpenRAVE's.
            draw: Whether the spheres are drawn. They collide either way.
            uri: The result of later calls of ``GetURI``.

        Returns:
            True.

        Raises:
            openrave_exception: the body is in an environment, or the rows have another length.
            TypeError: the argument is not a two-dimensional array.
        """
        return self._become(
            sphere_geometries(_rows(spherex, (4,), "InitFromSpheres: spherex"), visible=bool(draw)), uri
        )

    def InitFromTrimesh(self, trimesh: TriMesh, draw: bool = True, uri: str = "") -> bool:
        """Replace the body by a single static link with the triangles of a mesh.

        Args:
            trimesh: The triangles.
            draw: Whether the triangles are drawn. They collide either way.
            uri: The result of later calls of ``GetURI``.

        Returns:
            True.

        Raises:
            openrave_exception: the body is in an environment, or a triangle has a vertex index out of range.
        """
        mesh = checked_mesh(trimesh, "InitFromTrimesh: trimesh")
        return self._become([shape_geometry(scene.TriMesh(mesh), Pose(), visible=bool(draw))], uri)

    def InitFromGeometries(self, geometries: Sequence[GeometryInfo], uri: str = "") -> bool:
        """Replace the body by a single static link of geometries.

        Args:
            geometries: The descriptions of the geometries.
            uri: The result of later calls of ``GetURI``.

        Returns:
            True.

        Raises:
            openrave_exception: the body is in an environment, or a description is invalid. The body stays as it is.
        """
        return self._become(geometries_of(geometries), uri)

    def Init(self, linkinfos: Sequence[LinkInfo], jointinfos: Sequence[JointInfo], uri: str = "") -> bool:
        """Replace the body by links and joints.

        Args:
            linkinfos: The descriptions of the links; the first one is the root.
            jointinfos: The descriptions of the joints; joints with DOFs stand in DOF order.
            uri: The result of later calls of ``GetURI``.

        Returns:
            True.

        Raises:
            openrave_exception: the body is in an environment, or the descriptions are invalid. The body stays as it is.
        """
        return self.InitFromKinBodyInfo(KinBodyInfo(_vLinkInfos=linkinfos, _vJointInfos=jointinfos, _uri=uri))

    def InitFromLinks(self, linkinfos: Sequence[LinkInfo], uri: str = "") -> bool:
        """Replace the body by links without joints.

        Args:
            linkinfos: The descriptions of the links.
            uri: The result of later calls of ``GetURI``.

        Returns:
            True.
        """
        return self.Init(linkinfos, [], uri)

    def InitFromLinkInfos(self, linkInfos: Sequence[LinkInfo], uri: str = "") -> bool:
        """Replace the body by links without joints; another name of ``InitFromLinks``.

        Args:
            linkInfos: The descriptions of the links.
            uri: The result of later calls of ``GetURI``.

        Returns:
            True.
        """
        return self.InitFromLinks(linkInfos, uri)

    def InitFromKinBodyInfo(self, info: KinBodyInfo) -> bool:
        """Rebuild the body, including its name, from a description.

        Args:
            info: The description, for instance a result of ``ExtractInfo``.

        Returns:
            True.

        Raises:
            openrave_exception: the body is in an environment, or the description is invalid. The body stays as it is.

        Example:
            >>> copy = ravemj.RaveCreateKinBody(env, "")
            >>> copy.InitFromKinBodyInfo(body.ExtractInfo())
            True
        """
        checked_kind(info, KinBodyInfo, "InitFromKinBodyInfo: info")
        T_world_link0 = info.transform()
        self._rebuild(body_of(info, self._state.scene))
        self._uri, self._id = info._uri, info._id or ""
        if T_world_link0 is not None:
            self._state.set_transform(T_world_link0)
        return True

    def UpdateFromKinBodyInfo(self, info: KinBodyInfo) -> UpdateFromInfoResult:
        """Set the body's pose and joint values to those of a description, inside or outside of an environment.

        Args:
            info: The description, for instance a result of ``ExtractInfo`` of a body of the same structure.

        Returns:
            ``NoChange`` or ``Success``. If links, joints or the name differ, the body does not change, and the result
            is ``RequireReinitialize``: remove the body from the environment, and call ``InitFromKinBodyInfo``.
        """
        with self._simulation.lock:
            before = self.ExtractInfo()
            if not info.same_structure(before):
                return UpdateFromInfoResult.RequireReinitialize
            values, T_world_link0 = info.values_by_axis(), checked_transform(info._transform, "KinBodyInfo._transform")
            present = before.values_by_axis()
            if values == present and np.array_equal(T_world_link0, before._transform):
                return UpdateFromInfoResult.NoChange
            self._state.set_transform(T_world_link0)
            if present:
                self._state.set_values(np.array([values.get(place, value) for place, value in present.items()]))
            return UpdateFromInfoResult.Success

    def SetZeroConfiguration(self) -> None:
        """Make the current configuration the zero configuration: all joint values become 0, and no link moves.

        Limits keep their numbers, so they refer to other poses than before, as in OpenRAVE.
        """
        with self._simulation.lock:
            self._state.rezero()

    def ExtractInfo(self, options: int = ExtractInfoOptions.Everything) -> KinBodyInfo:
        """Return the description of the body in its current state.

        Args:
            options: What to include, ``ExtractInfoOptions``.

        Returns:
            A ``KinBodyInfo``; for a robot a ``RobotBaseInfo``.
        """
        return KinBodyInfo(**self.extracted(options))

    def extracted(self, options: int) -> dict[str, Any]:
        """Return the fields of the description that ``ExtractInfo`` makes, by name.

        Args:
            options: What to include, ``ExtractInfoOptions``.
        """
        with self._simulation.lock:
            joints = [joint.GetInfo() for joint in self.GetJoints()]
            skip = options & ExtractInfoOptions.SkipDOFValues
            return {
                "_name": self.GetName(),
                "_vLinkInfos": [link.GetInfo() for link in self.GetLinks()],
                "_vJointInfos": [*joints, *(joint.GetInfo() for joint in self.GetPassiveJoints())],
                "_transform": self._state.link_transform(0) if self._state.scene.links else np.eye(4),
                "_dofValues": [] if skip else [value for joint in joints for value in joint.named_values()],
                "_isRobot": self._state.scene.is_robot,
                "_vGrabbedInfos": [GrabbedInfo.of(self._state.scene, grab) for grab in self._state.grabs],
            }

    def _become(self, geometries: Iterable[scene.Geometry], uri: str) -> bool:
        self._uri = str(uri)
        return self._rebuild(body_of_geometries(self._state.scene, geometries))

    def _rebuild(self, body: scene.KinBody) -> bool:
        with self._simulation.lock:
            if self._state.index:
                raise RavemjError(f"'{self.GetName()}' is in an environment; remove it first", ErrorCode.Failed)
            self._state.rebuild(body)
        return True


_ARCHIVE = ".zae"
"""Suffix of archives with COLLADA documents."""

_NO_FILES = frozenset({FROM_SCRIPT.file, "data"})
"""Source names of bodies that were not read from a file; readers of text use the name ``data``."""


def _rows(numbers: ArrayLike, widths: tuple[int, ...], name: str) -> Floats:
    """Return numbers as rows of one of the given widths; raise an error if a shape or number is invalid."""
    rows = checked_numbers(numbers, name)
    wanted = " or ".join(f"(n, {width})" for width in widths)
    if rows.ndim != 2:
        raise TypeError(f"{name}: has shape {rows.shape}, and should have {wanted}")
    if rows.shape[1] not in widths or not np.isfinite(rows).all():
        message = f"{name}: has shape {rows.shape}, and should be finite and have shape {wanted}"
        raise RavemjError(message, ErrorCode.Failed)
    return rows
