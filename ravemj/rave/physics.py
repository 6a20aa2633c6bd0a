"""Physics engines."""

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arrays import checked_numbers, checked_vector
from ravemj.core.transforms import ZERO, Floats, Vec3
from ravemj.engine.simulation import BodyState
from ravemj.errors import ArgumentError
from ravemj.rave.enums import InterfaceType, PhysicsEngineOptions
from ravemj.rave.interface import Interface, checked_environment
from ravemj.rave.user_data import Annotations

if TYPE_CHECKING:
    from ravemj.engine.physics import Loads, Physics
    from ravemj.rave.environment import Environment
    from ravemj.rave.joint import Joint
    from ravemj.rave.kinbody import KinBody
    from ravemj.rave.link import Link


class PhysicsEngine(Interface):
    """A physics engine: it holds gravity and advances bodies in time; ``env.GetPhysicsEngine()`` returns it.

    This is OpenRAVE's ``GenericPhysicsEngine``, which every environment has from the start: bodies stay where they are
    put, and forces do nothing. ``RaveCreatePhysicsEngine`` makes others.
    """

    _interface_type = InterfaceType.physicsengine
    _internal = ("attach", "detach", "dynamics", "is_simulated", "loads")
    is_simulated = False
    """Whether bodies fall and collide."""
    dynamics: "Physics | None" = None
    """What moves the bodies, where they fall and collide."""

    def __init__(self, env: "Environment", xml_id: str, gravity: Vec3 = ZERO) -> None:
        self._env = env
        self.annotations = Annotations()
        self._xml_id = xml_id
        self._gravity = gravity
        self._is_attached = False

    def GetXMLId(self) -> str:
        """Return the name of the kind of engine, as it was spelt when it was made."""
        return self._xml_id

    def Clone(self, ref: "PhysicsEngine", cloningoptions: int = 0) -> None:
        """Take over gravity, the description and the data of users from another engine.

        Args:
            ref: The other engine.
            cloningoptions: Not used.
        """
        super().Clone(ref, cloningoptions)
        self.SetGravity(ref.GetGravity())

    def SetGravity(self, gravity: ArrayLike) -> None:
        """Set the acceleration of free fall in the world [m/s^2], shape (3,).

        It belongs to the engine: a new one has its own.

        Args:
            gravity: The acceleration in the world [m/s^2], shape (3,).

        Raises:
            IndexError: there are fewer than three numbers, as in OpenRAVE.

        Example:
            >>> env.GetPhysicsEngine().SetGravity([0, 0, -9.81])
        """
        given = checked_numbers(gravity, "SetGravity: gravity")
        if given.size < 3:
            raise IndexError(f"SetGravity: gravity has shape {given.shape}, and should have shape (3,)")
        x, y, z = checked_vector(given, 3, "SetGravity: gravity").tolist()
        self._gravity = (x, y, z)
        if self._is_attached:
            self._env.simulation.set_gravity(self._gravity)

    def GetGravity(self) -> Floats:
        """Return the acceleration of free fall in the world [m/s^2], shape (3,)."""
        return np.array(self._env.simulation.gravity if self._is_attached else self._gravity)

    def SetPhysicsOptions(self, physicsoptions: int) -> bool:
        """Set which collisions count, ``PhysicsEngineOptions``; return whether the engine has options.

        Args:
            physicsoptions: ``PhysicsEngineOptions`` combined with ``|``.
        """
        del physicsoptions
        return False

    def GetPhysicsOptions(self) -> PhysicsEngineOptions:
        """Return which collisions count."""
        return PhysicsEngineOptions(0)

    def SimulateStep(self, timestep: float) -> None:
        """Let the bodies move for a step of time [s]; ``StepSimulation`` calls this.

        Args:
            timestep: How long [s].
        """

    def InitEnvironment(self) -> bool:
        """Return True; nothing needs to be prepared."""
        return True

    def DestroyEnvironment(self) -> None:
        """Do nothing; OpenRAVE's engines free memory here."""

    def InitKinBody(self, body: "KinBody") -> bool:
        """Return True; nothing needs to be prepared.

        Args:
            body: The body.
        """
        del body
        return True

    def GetLinkVelocity(self, link: "Link") -> tuple[Floats, Floats]:
        """Return the velocity of a link, in world axes.

        Args:
            link: The link.

        Returns:
            That of its origin [m/s], and the angular one [rad/s], each of shape (3,).
        """
        velocity = link.GetVelocity()
        return velocity[:3], velocity[3:]

    def SetLinkVelocity(self, link: "Link", linearvel: ArrayLike, angularvel: ArrayLike) -> bool:
        """Set the velocity of one link; see ``link.SetVelocity``.

        Args:
            link: The link.
            linearvel: Velocity of its origin in the world [m/s], shape (3,).
            angularvel: Angular velocity in the world [rad/s], shape (3,).

        Returns:
            True.
        """
        link.SetVelocity(linearvel, angularvel)
        return True

    def GetLinkVelocities(self, body: "KinBody") -> Floats:
        """Return the velocities of all links of a body, shape (links, 6); see ``body.GetLinkVelocities``.

        Args:
            body: The body.
        """
        return body.GetLinkVelocities()

    def SetLinkVelocities(self, body: "KinBody", velocities: ArrayLike) -> bool:
        """Set the velocities of all links of a body; see ``body.SetLinkVelocities``.

        Args:
            body: The body.
            velocities: Shape (links, 6).

        Returns:
            True.
        """
        body.SetLinkVelocities(velocities)
        return True

    def GetJointForceTorque(self, joint: "Joint") -> tuple[Floats, Floats]:
        """Return the force and torque that a joint transmits to its child link.

        Returns:
            The force on the child link [N], and the torque about the joint's anchor [N m], each of shape (3,), in
            world axes; zero without physics.
        """
        del joint
        return np.zeros(3), np.zeros(3)

    def GetLinkForceTorque(self, link: "Link") -> tuple[Floats, Floats]:
        """Return the force and torque of joints and contacts on a link, without gravity and forces of users.

        Returns:
            The force [N], and the torque about the link's centre of mass [N m], each of shape (3,), in world axes;
            zero without physics.
        """
        del link
        return np.zeros(3), np.zeros(3)

    def SetBodyForce(self, link: "Link", force: ArrayLike, position: ArrayLike, add: bool) -> bool:
        """Let a force act on a link during the next step; ``link.SetForce`` is the same.

        Args:
            link: The link.
            force: In the world [N], shape (3,).
            position: Where it acts, in the world [m], shape (3,).
            add: Whether forces that were set for that step stay.

        Returns:
            Whether the engine moves bodies.
        """
        checked = checked_vector(force, 3, "force"), checked_vector(position, 3, "position")
        with self._env.simulation.lock:
            loads = self.loads(link.GetParent().simulation_state)
            if loads is not None:
                loads.push(link.GetIndex(), *checked, add=add)
        return loads is not None

    def SetBodyTorque(self, link: "Link", torque: ArrayLike, add: bool) -> bool:
        """Let a torque act on a link during the next step; ``link.SetTorque`` is the same.

        Args:
            link: The link.
            torque: In world axes [N m], shape (3,).
            add: Whether torques that were set for that step stay.

        Returns:
            Whether the engine moves bodies.
        """
        checked = checked_vector(torque, 3, "torque")
        with self._env.simulation.lock:
            loads = self.loads(link.GetParent().simulation_state)
            if loads is not None:
                loads.turn(link.GetIndex(), checked, add=add)
        return loads is not None

    def AddJointTorque(self, joint: "Joint", torques: ArrayLike) -> bool:
        """Let torques act on a joint during the next step, with those before; ``joint.AddTorque`` is the same.

        Args:
            joint: The joint.
            torques: For each of its axes [N m, for sliders N].

        Returns:
            Whether the engine moves bodies.

        Raises:
            ArgumentError: the joint is passive, or the number of torques is wrong.
        """
        checked = checked_vector(torques, joint.GetDOF(), "torques")
        first = joint.GetDOFIndex()
        if first < 0:
            raise ArgumentError(f"joint '{joint.GetName()}' is passive, and takes no torques")
        with self._env.simulation.lock:
            loads = self.loads(joint.GetParent().simulation_state)
            if loads is not None:
                loads.torques[first : first + len(checked)] += checked
        return loads is not None

    def attach(self) -> None:
        """Start to be the environment's engine."""
        self._is_attached = True
        self._env.simulation.set_gravity(self._gravity)
        self._env.simulation.physics = self.dynamics

    def detach(self) -> None:
        """Stop being the environment's engine."""
        self._gravity = self._env.simulation.gravity
        self._is_attached = False

    def loads(self, state: BodyState) -> "Loads | None":
        """Return the loads on a body in the next step, to be changed; None without simulated dynamics."""
        del state
        return None

    def __repr__(self) -> str:
        if self._is_attached:
            return f"{self._env!r}.GetPhysicsEngine()"
        return f"RaveCreatePhysicsEngine({self._env!r}, {self._xml_id!r})"


class SimulatedEngine(PhysicsEngine):
    """Simulates the dynamics of bodies with MuJoCo: masses, joints, contacts and forces.

    Bodies without a static link fall; those with one stay, and their joints swing. Poses and velocities can be set at
    any time. Robots with an ``IdealController`` go where it puts them.

    Example:
        >>> env.SetPhysicsEngine(RaveCreatePhysicsEngine(env, "ode"))
        True
        >>> env.GetPhysicsEngine().SetGravity([0, 0, -9.81])
        >>> env.StepSimulation(0.1)
    """

    is_simulated = True

    def __init__(self, env: "Environment", xml_id: str) -> None:
        super().__init__(env, xml_id)
        from ravemj.engine.physics import Physics  # noqa: PLC0415 - slow to import

        self.dynamics = self._physics = Physics(env.simulation)

    def SetPhysicsOptions(self, physicsoptions: int) -> bool:
        """Set which collisions count.

        Args:
            physicsoptions: ``PhysicsEngineOptions.SelfCollisions``, or 0: links of one body do not collide.

        Returns:
            True.
        """
        with self._env.simulation.lock:
            self._physics.set_self_collisions(bool(physicsoptions & PhysicsEngineOptions.SelfCollisions))
        return True

    def GetPhysicsOptions(self) -> PhysicsEngineOptions:
        """Return which collisions count."""
        return PhysicsEngineOptions(int(self._physics.self_collisions))

    def SimulateStep(self, timestep: float) -> None:
        """Let the bodies move for a step of time [s]; ``StepSimulation`` calls this."""
        with self._env.simulation.lock:
            self._physics.step(timestep)

    def GetJointForceTorque(self, joint: "Joint") -> tuple[Floats, Floats]:
        """Return the force and torque that a joint transmits to its child link.

        Returns:
            The force on the child link [N], and the torque about the joint's anchor [N m], each of shape (3,), in
            world axes; zero before the first step.
        """
        state, child = joint.GetParent().simulation_state, joint.GetHierarchyChildLink()
        with self._env.simulation.lock:
            return self._physics.joint_wrench(state, child.GetIndex(), joint.GetAnchor())

    def GetLinkForceTorque(self, link: "Link") -> tuple[Floats, Floats]:
        """Return the force and torque of joints and contacts on a link, without gravity and forces of users.

        Returns:
            The force [N], and the torque about the link's centre of mass [N m], each of shape (3,), in world axes;
            zero before the first step.
        """
        with self._env.simulation.lock:
            return self._physics.link_wrench(link.GetParent().simulation_state, link.GetIndex())

    def loads(self, state: BodyState) -> "Loads":
        """Return the loads on a body in the next step, to be changed."""
        return self._physics.loads(state)


_KINDS: dict[str, type[PhysicsEngine]] = {
    "genericphysicsengine": PhysicsEngine,
    "ode": SimulatedEngine,
    "bullet": SimulatedEngine,
    "mujoco": SimulatedEngine,
}


def RaveCreatePhysicsEngine(env: "Environment", name: str) -> PhysicsEngine | None:
    """Make a physics engine; ``env.SetPhysicsEngine`` switches it on.

    Args:
        env: The environment that it is for.
        name: ``ode``, ``bullet`` or ``mujoco``, all of which are MuJoCo; or ``GenericPhysicsEngine``, with which
            bodies stay where they are put. Upper and lower case are the same.

    Returns:
        The engine, without gravity; None where the name is not known.

    Example:
        >>> engine = RaveCreatePhysicsEngine(env, "ode")
        >>> engine.SetGravity([0, 0, -9.81])
        >>> env.SetPhysicsEngine(engine)
        True
    """
    checked_environment(env, "RaveCreatePhysicsEngine")
    kind = _KINDS.get(name.lower())
    return None if kind is None else kind(env, name)
