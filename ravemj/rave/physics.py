"""Physics engines."""

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arrays import checked_number, checked_numbers, checked_vector
from ravemj.core.transforms import ZERO, Floats, Vec3
from ravemj.engine.simulation import BodyState
from ravemj.errors import ArgumentError
from ravemj.rave.enums import InterfaceType, PhysicsEngineOptions
from ravemj.rave.interface import Interface, asked_for

if TYPE_CHECKING:
    from ravemj.engine.physics import Loads, Physics
    from ravemj.rave.environment import Environment
    from ravemj.rave.joint import Joint
    from ravemj.rave.kinbody import KinBody
    from ravemj.rave.link import Link


_WITHOUT_DYNAMICS = "genericphysicsengine"
_WITH_DYNAMICS = ("ode", "bullet", "mujoco")
_LONGEST = 86400
"""Longest accepted time step [s]: a day, which MuJoCo simulates in minutes. A longer step is surely a mistake."""


class PhysicsEngine(Interface):
    """Physics engine: gravity and the dynamics of bodies; ``env.GetPhysicsEngine()`` returns it.

    With OpenRAVE's ``GenericPhysicsEngine``, which every environment has from the start, bodies stay in place, and
    forces have no effect. The other engines of ``RaveCreatePhysicsEngine`` simulate with MuJoCo: masses, joints,
    contacts and forces. Bodies without a static link then fall. Those with one stay in place, and gravity and contacts
    move their joints. Poses and velocities can be set at any time. An ``IdealController`` still places its robot
    exactly.

    Example:
        >>> env.SetPhysicsEngine(RaveCreatePhysicsEngine(env, "ode"))
        True
        >>> env.GetPhysicsEngine().SetGravity([0, 0, -9.81])
        >>> env.StepSimulation(0.1)
    """

    _interface_type = InterfaceType.physicsengine
    _internal = ("attach", "detach", "dynamics", "loads")
    dynamics: "Physics | None" = None
    """Simulated dynamics; None for an engine without simulation."""

    def __init__(self, env: "Environment", xmlid: str, gravity: Vec3 = ZERO) -> None:
        super().__init__(env, xmlid)
        self._gravity = gravity
        self._is_attached = False
        if xmlid.lower() in _WITH_DYNAMICS:
            from ravemj.engine.physics import Physics  # noqa: PLC0415 - slow to import

            self.dynamics = Physics(env.simulation)

    def Clone(self, ref: "PhysicsEngine", cloningoptions: int = 0) -> None:
        """Copy gravity, the description and the user data of another engine.

        Args:
            ref: The other engine.
            cloningoptions: Not used.
        """
        super().Clone(ref, cloningoptions)
        self.SetGravity(ref.GetGravity())

    def SetGravity(self, gravity: ArrayLike) -> None:
        """Set the gravitational acceleration.

        It belongs to the engine: another engine has its own.

        Args:
            gravity: The acceleration in world axes [m/s^2], shape (3,).

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
        """Return the gravitational acceleration in world axes [m/s^2], shape (3,)."""
        return np.array(self._env.simulation.gravity if self._is_attached else self._gravity)

    def SetPhysicsOptions(self, physicsoptions: int) -> bool:
        """Set whether links of one body collide with one another, and return whether the engine has options.

        ``physicsoptions`` is ``PhysicsEngineOptions.SelfCollisions``, or 0 for no such collisions.
        """
        if self.dynamics is None:
            return False
        with self._env.simulation.lock:
            self.dynamics.self_collisions = bool(physicsoptions & PhysicsEngineOptions.SelfCollisions)
        return True

    def GetPhysicsOptions(self) -> PhysicsEngineOptions:
        """Return the options, which select the collisions that the simulation handles."""
        return PhysicsEngineOptions(int(self.dynamics is not None and self.dynamics.self_collisions))

    def SimulateStep(self, timestep: float) -> None:
        """Advance the bodies by ``timestep`` [s]; ``StepSimulation`` calls this."""
        if self.dynamics is None:
            return
        checked = checked_number(timestep, "SimulateStep: timestep", 0, " s")
        if checked > _LONGEST:
            raise ArgumentError(f"SimulateStep: timestep is {checked:g} s, and should be {_LONGEST} s at most")
        with self._env.simulation.lock:
            self.dynamics.step(checked)

    def InitEnvironment(self) -> bool:
        """Return True; the engine needs no preparation."""
        return True

    def DestroyEnvironment(self) -> None:
        """Do nothing. OpenRAVE's engines free their memory here."""

    def InitKinBody(self, body: "KinBody") -> bool:
        """Return True: ``body`` needs no preparation."""
        del body
        return True

    def GetLinkVelocity(self, link: "Link") -> tuple[Floats, Floats]:
        """Return the velocity of the origin of ``link`` [m/s] and the angular velocity [rad/s] in the world.

        Both have shape (3,).
        """
        velocity = link.GetVelocity()
        return velocity[:3], velocity[3:]

    def SetLinkVelocity(self, link: "Link", linearvel: ArrayLike, angularvel: ArrayLike) -> bool:
        """Set the velocity of one link; see ``link.SetVelocity``.

        Args:
            link: The link.
            linearvel: The velocity of the link's origin in world axes [m/s], shape (3,).
            angularvel: The angular velocity in world axes [rad/s], shape (3,).

        Returns:
            True.
        """
        link.SetVelocity(linearvel, angularvel)
        return True

    def GetLinkVelocities(self, body: "KinBody") -> Floats:
        """Return the velocities of all links of ``body``, shape (links, 6); see ``body.GetLinkVelocities``."""
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
            world axes; zero without physics, and before the first step.
        """
        if self.dynamics is None:
            return np.zeros(3), np.zeros(3)
        state, child = joint.GetParent().simulation_state, joint.GetHierarchyChildLink()
        with self._env.simulation.lock:
            return self.dynamics.joint_wrench(state, child.GetIndex(), joint.GetAnchor())

    def GetLinkForceTorque(self, link: "Link") -> tuple[Floats, Floats]:
        """Return the force and torque of joints and contacts on a link, without gravity and forces of users.

        Returns:
            The force [N], and the torque about the link's centre of mass [N m], each of shape (3,), in world axes;
            zero without physics, and before the first step.
        """
        if self.dynamics is None:
            return np.zeros(3), np.zeros(3)
        with self._env.simulation.lock:
            return self.dynamics.link_wrench(link.GetParent().simulation_state, link.GetIndex())

    def SetBodyForce(self, link: "Link", force: ArrayLike, position: ArrayLike, add: bool) -> bool:
        """Apply a force to a link during the next step, as ``link.SetForce`` does.

        Args:
            link: The link.
            force: The force in world axes [N], shape (3,).
            position: The point of application in the world [m], shape (3,).
            add: Whether to add to the forces that were set for that step; False replaces them.

        Returns:
            Whether the engine simulates dynamics.
        """
        checked = checked_vector(force, 3, "force"), checked_vector(position, 3, "position")
        with self._env.simulation.lock:
            loads = self.loads(link.GetParent().simulation_state)
            if loads is not None:
                loads.push(link.GetIndex(), *checked, add=add)
        return loads is not None

    def SetBodyTorque(self, link: "Link", torque: ArrayLike, add: bool) -> bool:
        """Apply a torque to a link during the next step, as ``link.SetTorque`` does.

        Args:
            link: The link.
            torque: The torque in world axes [N m], shape (3,).
            add: Whether to add to the torques that were set for that step; False replaces them.

        Returns:
            Whether the engine simulates dynamics.
        """
        checked = checked_vector(torque, 3, "torque")
        with self._env.simulation.lock:
            loads = self.loads(link.GetParent().simulation_state)
            if loads is not None:
                loads.turn(link.GetIndex(), checked, add=add)
        return loads is not None

    def AddJointTorque(self, joint: "Joint", torques: ArrayLike) -> bool:
        """Add torques to a joint during the next step, as ``joint.AddTorque`` does.

        Args:
            joint: The joint.
            torques: A torque for each axis [N m; N for sliders], shape (axes,).

        Returns:
            Whether the engine simulates dynamics.

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
        """Register the engine with the environment."""
        self._is_attached = True
        self._env.simulation.set_gravity(self._gravity)
        self._env.simulation.physics = self.dynamics

    def detach(self) -> None:
        """Unregister the engine from the environment."""
        self._gravity = self._env.simulation.gravity
        self._is_attached = False

    def loads(self, state: BodyState) -> "Loads | None":
        """Return the mutable loads on a body for the next step; None without simulated dynamics."""
        return None if self.dynamics is None else self.dynamics.loads(state)

    def __repr__(self) -> str:
        if self._is_attached:
            return f"{self._env!r}.GetPhysicsEngine()"
        return f"RaveCreatePhysicsEngine({self._env!r}, {self._xmlid!r})"


def RaveCreatePhysicsEngine(env: "Environment", name: str) -> PhysicsEngine | None:
    """Make a physics engine; ``env.SetPhysicsEngine`` activates it.

    Args:
        env: The environment.
        name: ``ode``, ``bullet`` or ``mujoco``, which all simulate with MuJoCo; or ``GenericPhysicsEngine``, with which
            bodies stay in place. Letter case does not matter.

    Returns:
        The engine, without gravity; None for an unknown name.

    Example:
        >>> engine = RaveCreatePhysicsEngine(env, "ode")
        >>> engine.SetGravity([0, 0, -9.81])
        >>> env.SetPhysicsEngine(engine)
        True
    """
    word = asked_for(env, name, "RaveCreatePhysicsEngine")[0]
    return PhysicsEngine(env, word) if word.lower() in {_WITHOUT_DYNAMICS, *_WITH_DYNAMICS} else None
