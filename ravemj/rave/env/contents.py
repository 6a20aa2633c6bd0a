"""Bodies, sensors and modules of an environment, and collisions between them."""

from collections.abc import Callable, Collection, Iterable, Sequence
from typing import TYPE_CHECKING, Any
from weakref import WeakValueDictionary

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ravemj.core.arguments import also_named, checked_kind
from ravemj.core.arrays import checked_numbers
from ravemj.core.handles import Handle, registered
from ravemj.core.transforms import Floats
from ravemj.engine.simulation import BodyState
from ravemj.errors import ArgumentError, ErrorCode, RavemjError
from ravemj.model import scene
from ravemj.model.bounds import links_triangles
from ravemj.rave.collision import CollisionChecker, NoCollisionChecker
from ravemj.rave.enums import InterfaceAddMode, SelectionOptions, TriangulateOptions
from ravemj.rave.interface import EnvironmentPart, Interface, Module
from ravemj.rave.kinbody import KinBody
from ravemj.rave.report import CollisionReport
from ravemj.rave.robot import Robot
from ravemj.rave.sensors import Sensor
from ravemj.rave.trimesh import TriMesh, trimesh_of

if TYPE_CHECKING:
    from ravemj.gui.viewers import Viewer


_SELECTIONS: dict[SelectionOptions, Callable[[scene.KinBody, Collection[str]], bool]] = {
    SelectionOptions.NoRobots: lambda body, names: not body.is_robot,
    SelectionOptions.Robots: lambda body, names: body.is_robot,
    SelectionOptions.Everything: lambda body, names: True,
    SelectionOptions.Body: lambda body, names: body.name in names,
    SelectionOptions.AllExceptBody: lambda body, names: body.name not in names,
}


def selects(options: int, names: Collection[str], body: scene.KinBody) -> bool:
    """Return whether ``SelectionOptions`` select a body; ``names`` are those for ``Body`` and ``AllExceptBody``."""
    return _SELECTIONS[SelectionOptions(options)](body, names)


BodyCallback = Callable[[KinBody, int], object]
"""Callback with a body, and 1 if it was added or 0 if it was removed."""

CollisionCallback = Callable[[CollisionReport, bool], int]
"""Callback with a one-collision report, and whether physics found it; returns a ``CollisionAction``."""


class Contents(EnvironmentPart):
    """Bodies, sensors and modules of an environment; collision checks of bodies, links and rays."""

    _often_called = ("CheckCollision",)

    _internal = (
        "collision_callbacks",
        "wrap",
    )

    def __init__(self) -> None:
        super().__init__()
        # The environment keeps the API objects of its bodies, so that active DOFs and user data survive. The objects
        # of other bodies are deleted with the script's last reference.
        self._objects: WeakValueDictionary[BodyState, KinBody] = WeakValueDictionary()
        self._kept_objects: dict[BodyState, KinBody] = {}
        self._body_callbacks: list[BodyCallback] = []
        self._modules: list[Module] = []
        self._sensors: list[Sensor] = []  # sensors without a robot
        self.collision_callbacks: list[CollisionCallback] = []
        self._checker: CollisionChecker | None = None

    def wrap(self, state: BodyState) -> KinBody:
        """Return the API object of a body; repeated calls return the same object."""
        with self._simulation.lock:
            wrapped = self._kept_objects.get(state) or self._objects.get(state)
            if wrapped is None:
                wrapped = (Robot if state.scene.is_robot else KinBody)(self._environment, state)
                self._objects[state] = wrapped
            if state.index:
                self._kept_objects[state] = wrapped
            return wrapped

    def _remove_all(self) -> None:
        for body in self._kept_objects.values():
            if isinstance(body, Robot):
                body.devices.forget()
        for sensor in self._sensors:
            sensor.hide()
        self._sensors.clear()
        gone = [self.wrap(state) for state in self._simulation.bodies]
        self._simulation.clear()
        self._kept_objects.clear()
        for body in gone:
            body.disconnect()
            self._tell_of_body(body, 0)

    def _tell_of_body(self, body: KinBody, action: int) -> None:
        """Call the callbacks of ``RegisterBodyCallback``; ``action`` is 1 if the body was added, 0 if removed."""
        for callback in tuple(self._body_callbacks):
            callback(body, action)

    @also_named(anonymous="addMode")
    def Add(self, interface: Interface, addMode: Any = None, cmdargs: str = "") -> None:  # noqa: ANN401 - OpenRAVE's
        """Add a body, a robot, a sensor or a module to the environment.

        Args:
            interface: The object, made for this environment. A body keeps its pose.
            addMode: Treatment of a taken name: None, False or ``InterfaceAddMode.StrictNameChecking`` raise an error,
                True or ``AllowRenaming`` rename the object. OpenRAVE 0.9 calls the argument ``anonymous``.
            cmdargs: The arguments of a module, the name of a robot first.

        Raises:
            openrave_exception: the name is taken (``BodyNameConflict``) or empty, or the object is of another kind or
                of another environment.

        Example:
            >>> box = ravemj.RaveCreateKinBody(env, "")
            >>> box.InitFromBoxes([[0, 0, 0, 0.1, 0.2, 0.3]])
            True
            >>> box.SetName("box")
            >>> env.Add(box)
        """
        if isinstance(interface, Module):
            self.AddModule(interface, cmdargs)
        elif isinstance(interface, Sensor):
            self.AddSensor(interface, _renames(addMode))
        elif not isinstance(interface, KinBody):
            self._add_other(interface)
        else:
            self.AddKinBody(interface, addMode)

    def _add_other(self, interface: object) -> None:
        """Do nothing for a viewer of this environment, which is attached already; raise an error for other objects."""
        if any(interface is viewer for viewer in self._viewers):
            return
        kind = "None" if interface is None else type(interface).__name__
        cause = f"; the last Read… gave None: {self._unread}" if interface is None and self._unread else ""
        raise ArgumentError(f"Add: takes a body, a robot, a sensor or a module, not {kind}{cause}")

    @also_named(anonymous="addMode", robot="body")
    def AddKinBody(self, body: KinBody, addMode: Any = None) -> None:  # noqa: ANN401 - a number or an enumeration
        """Add a body to the environment; see ``Add``.

        Args:
            body: The body.
            addMode: As for ``Add``.
        """
        self._check_alive()
        self._check_ours(body, "Add")
        state, renames = body.simulation_state, _renames(addMode)
        with self._simulation.lock:
            if self._simulation.holds(state):
                return
            if renames:  # also an empty name: pymanoid adds such bodies, though OpenRAVE 0.149 refuses them
                self._simulation.rename(state, self._simulation.free_name(state.scene.name))
            elif not body.GetName():
                raise RavemjError("Add: the body has no name; give it one with SetName", ErrorCode.Failed)
            body.connect()
            try:
                self._simulation.insert(state)
            except RavemjError:
                body.disconnect()
                raise
            self._kept_objects[state] = body
        self._tell_of_body(body, 1)
        for viewer in self._viewers:
            viewer.apply_loaded()

    AddRobot = AddKinBody

    def AddViewer(self, sensor: "Viewer", anonymous: bool = False) -> None:  # the argument's name is OpenRAVE's
        """Do nothing for a viewer of this environment, which is attached from the start; see ``RaveCreateViewer``.

        Args:
            sensor: The viewer.
            anonymous: Not used.
        """
        del anonymous
        self._add_other(sensor)

    def AddSensor(self, sensor: object, anonymous: bool = False) -> None:
        """Add a sensor without a robot. Simulation steps then advance it.

        Args:
            sensor: A sensor that ``RaveCreateSensor`` has made for this environment, with a name.
            anonymous: Whether the sensor gets another name if its name is taken.

        Raises:
            openrave_exception: the name is taken (``SensorNameConflict``) or empty, or a robot carries the sensor.

        Example:
            >>> laser = ravemj.RaveCreateSensor(env, "BaseLaser2D")
            >>> laser.SetName("door")
            >>> env.AddSensor(laser)
        """
        self._check_alive()
        added = checked_kind(sensor, Sensor, "AddSensor: sensor")
        if added.GetEnv() is not self._environment or added.attached is not None:
            raise ArgumentError(f"AddSensor: {added!r} was made for another environment, or a robot carries it")
        if added in self._sensors:
            return
        name, number = added.GetName(), 0
        if not name:
            raise RavemjError("AddSensor: the sensor has no name; give it one with SetName", ErrorCode.Failed)
        if not anonymous and self.GetSensor(name) is not None:
            raise RavemjError(f"AddSensor: there already is a sensor '{name}'", ErrorCode.SensorNameConflict)
        while self.GetSensor(added.GetName()) is not None:
            added.SetName(f"{name}{number}")
            number += 1
        with self._simulation.lock:
            self._sensors.append(added)

    @also_named(obj="interface", body="interface", prob="interface")
    def Remove(self, interface: object) -> bool:
        """Remove a body, a robot, a module, a sensor or a viewer from the environment.

        A removed body can be used outside of the environment and added again. All grabs by it and of it are released.

        Args:
            interface: The object.

        Returns:
            Whether it was in the environment.

        Raises:
            openrave_exception: it has another type (``InvalidArguments``), is None (``Failed``), or a body of another
                environment.

        Example:
            >>> env.Remove(env.GetKinBody("Pendulum"))
            True
            >>> env.GetBodies()
            []
        """
        if not isinstance(interface, KinBody):
            return self._remove_other(interface)
        state = interface.simulation_state
        if state.simulation is not self._simulation:
            raise ArgumentError(
                f"Remove: '{interface.GetName()}' was made for {interface.GetEnv()!r}, not for {self!r}"
            )
        self._kept_objects.pop(state, None)
        if isinstance(interface, Robot):
            interface.devices.forget()
        was_there = self._simulation.remove(state)
        if was_there:
            interface.disconnect()
            self._tell_of_body(interface, 0)
        return was_there

    RemoveKinBody = RemoveProblem = Remove

    def RemoveKinBodyByName(self, name: str) -> bool:
        """Remove the body called ``name``, and return whether it existed; see ``Remove``."""
        body = self.GetKinBody(name)
        return body is not None and self.Remove(body)

    def _remove_other(self, interface: object) -> bool:
        """Remove a module, a sensor or a viewer, and return whether it was in the environment."""
        if not isinstance(interface, Interface) and not hasattr(interface, "GetCameraTransform"):  # a viewer
            kind = "None" if interface is None else f"something of type {type(interface).__name__}"
            code = ErrorCode.Failed if interface is None else ErrorCode.InvalidArguments
            raise ArgumentError(f"Remove: takes a body, a sensor, a module or a viewer, not {kind}", code)
        if isinstance(interface, Module) and interface in self._modules:
            self._modules.remove(interface)
            interface.end()
            return True
        if isinstance(interface, Sensor) and interface in self._sensors:
            with self._simulation.lock:
                self._sensors.remove(interface)
                interface.hide()
            return True
        for viewer in self._viewers:
            if viewer is interface:
                self._viewers.remove(viewer)
                viewer.close()
                return True
        return False

    def _check_ours(self, body: KinBody, caller: str) -> None:
        checked_kind(body, KinBody, f"{caller}: body")
        if body.simulation_state.simulation is not self._simulation:
            raise ArgumentError(f"{caller}: '{body.GetName()}' was made for {body.GetEnv()!r}, not for {self!r}")

    def GetBodies(self, checkname: str | None = None) -> list[KinBody]:
        """Return all bodies, including robots.

        Args:
            checkname: A name; the result then has only the body of this name.

        Returns:
            The bodies in the order in which they were added; a new body takes the index of a removed one.

        Example:
            >>> robots = [body for body in env.GetBodies() if body.IsRobot()]
        """
        bodies = [self.wrap(state) for state in self._simulation.bodies]
        return bodies if checkname is None else [body for body in bodies if body.GetName() == checkname]

    def GetNumBodies(self) -> int:
        """Return the number of bodies, including robots."""
        return len(self._simulation.bodies)

    def GetRobots(self, checkname: str | None = None) -> list[Robot]:
        """Return the robots, in the order of ``GetBodies``.

        Args:
            checkname: A name; the result then has only the robot of this name.

        Example:
            >>> robot = env.GetRobots()[0]
        """
        return [body for body in self.GetBodies(checkname) if isinstance(body, Robot)]

    def GetKinBody(self, name: str) -> KinBody | None:
        """Return the body or robot called ``name``, or None.

        Example:
            >>> body = env.GetKinBody("Pendulum")
            >>> env.GetKinBody("no such body") is None
            True
        """
        state = self._simulation.body(name)
        return None if state is None else self.wrap(state)

    def GetRobot(self, name: str) -> Robot | None:
        """Return the robot called ``name``, or None.

        Example:
            >>> robot = env.GetRobot("Pendulum")
        """
        body = self.GetKinBody(name)
        return body if isinstance(body, Robot) else None

    def GetSensors(self) -> list[Sensor]:
        """Return the sensors of all robots, then the sensors without a robot; see ``robot.GetAttachedSensors``."""
        attached_sensors = (
            attached.GetSensor() for robot in self.GetRobots() for attached in robot.GetAttachedSensors()
        )
        return [*(sensor for sensor in attached_sensors if sensor is not None), *self._sensors]

    def GetSensor(self, name: str) -> Sensor | None:
        """Return the sensor called ``name``, or None. The name of a robot's sensor is ``robot:sensor``."""
        return next((sensor for sensor in self.GetSensors() if sensor.GetName() == name), None)

    def GetBodyFromEnvironmentBodyIndex(self, bodyIndex: int) -> KinBody | None:
        """Return the body with ``body.GetEnvironmentBodyIndex() == bodyIndex``, from 1 on, or None."""
        state = self._simulation.body_at(bodyIndex)
        return None if state is None else self.wrap(state)

    GetBodyFromEnvironmentId = GetBodyFromEnvironmentBodyIndex

    def GetBodiesFromEnvironmentBodyIndices(self, bodyIndex: Iterable[int]) -> list[KinBody | None]:
        """Return the bodies with the indices ``bodyIndex``, with None for an index that no body has."""
        return [self.GetBodyFromEnvironmentBodyIndex(int(index)) for index in bodyIndex]

    def GetMaxEnvironmentBodyIndex(self) -> int:
        """Return the largest index of a body; 0 without bodies."""
        return max((body.index for body in self._simulation.bodies), default=0)

    def AddModule(self, module: Module | None, args: str = "") -> int:
        """Add a module and start it.

        Args:
            module: A module from ``RaveCreateModule``.
            args: The arguments that the module starts with, the name of a robot first.

        Returns:
            0.

        Raises:
            openrave_exception: the argument is not a module, or was made for another environment.

        Example:
            >>> module = RaveCreateModule(env, "BaseManipulation")
            >>> env.AddModule(module, robot.GetName())
            0
        """
        if module is None:
            raise ArgumentError("AddModule: module is None; RaveCreateModule returns that for an unknown name")
        checked_kind(module, Module, "AddModule: module", "what RaveCreateModule returned")
        self._check_alive()
        if module.GetEnv() is not self:
            raise ArgumentError(f"AddModule: module was made for {module.GetEnv()!r}, not for {self!r}")
        if module not in self._modules:
            self._modules.append(module)
        module.start(args)
        return 0

    LoadProblem = AddModule

    def GetModules(self) -> list[Module]:
        """Return the added modules."""
        return list(self._modules)

    GetLoadedProblems = GetModules

    def RegisterBodyCallback(self, callback: BodyCallback) -> Handle:
        """Register a callback for added and removed bodies.

        Args:
            callback: A function of the body, and of 1 if it was added or 0 if it was removed.

        Returns:
            A handle; deleting or closing it removes the callback.
        """
        return registered(self._body_callbacks, callback, "RegisterBodyCallback: callback")

    TriangulateOptions = TriangulateOptions
    SelectionOptions = TriangulateOptions
    NoRobots = TriangulateOptions.NoRobots
    Robots = TriangulateOptions.Robots
    Everything = TriangulateOptions.Everything
    Body = TriangulateOptions.Body
    AllExceptBody = TriangulateOptions.AllExceptBody

    def GetCollisionChecker(self) -> CollisionChecker:
        """Return the collision checker that ``CheckCollision`` uses; never None."""
        if self._checker is None:
            self._checker = CollisionChecker(self._environment)
        return self._checker

    def SetCollisionChecker(self, collisionchecker: CollisionChecker | None) -> bool:
        """Set the collision checker that ``CheckCollision`` uses.

        Args:
            collisionchecker: A checker of this environment; with None, nothing collides from now on.

        Returns:
            True.
        """
        self._check_alive()
        checker = NoCollisionChecker(self._environment) if collisionchecker is None else collisionchecker
        checked_kind(checker, CollisionChecker, "SetCollisionChecker: collisionchecker")
        if checker.GetEnv() is not self._environment:
            raise ArgumentError("SetCollisionChecker: collisionchecker was made for another environment")
        self._checker = checker
        return True

    def CheckCollision(self, *arguments: object, report: CollisionReport | None = None, **named: object) -> bool:
        """Return whether bodies, links or rays collide.

        The arguments have OpenRAVE's forms, and ``report`` may also be the last of them:

        - ``(body)``, ``(link)``: test a body or a link against all other bodies.
        - ``(body, body2)``, ``(link, body)``, ``(link, link2)``: test the two against each other; two links may belong
          to the same body.
        - ``(body, bodyexcluded, linkexcluded)``, or with a link first: test against all bodies and links except those
          of two lists.
        - ``(ray)``, ``(ray, body)``: test a ray against all bodies, or against one. The length of its direction is its
          range.

        A body is tested together with the bodies that it holds, but not against them. Disabled links never collide.
        ``body.CheckSelfCollision`` tests a body against itself.

        Args:
            arguments: One of these forms; by name they are ``body``, ``link``, ``body1``, ``body2``, ``link1``,
                ``link2``, ``ray``, ``bodyexcluded``, ``linkexcluded``.
            report: Receives the collisions, in the detail of ``GetCollisionChecker().SetCollisionOptions``.
            named: The same arguments by name.

        Raises:
            openrave_exception: an argument is None (``Assert``) or has a wrong type (``InvalidArguments``), or one of
                two bodies is not in the environment.

        Example:
            >>> env.CheckCollision(robot)
            False
            >>> report = ravemj.CollisionReport()
            >>> env.CheckCollision(ravemj.Ray([0, 0, 5], [0, 0, -10]), report)
            True
            >>> report.contacts[0].pos
            array([0.  , 0.  , 0.03])
        """
        self._check_alive()
        checker = self._checker or self.GetCollisionChecker()
        if report is None and not named:  # which takes less time, since planners ask this most
            return checker.CheckCollision(*arguments)
        return checker.CheckCollision(*arguments, report=report, **named)

    def CheckCollisionRays(
        self, rays: ArrayLike, body: KinBody | None = None, front_facing_only: bool = False
    ) -> tuple[NDArray[np.bool_], Floats]:
        """Return the first hits of many rays.

        Args:
            rays: One row for each ray: its start, and its direction, whose length is the range [m], shape (n, 6).
            body: The body that the rays are tested against; by default all bodies.
            front_facing_only: Whether to ignore hits from behind, on the inside of a surface.

        Returns:
            Whether each ray hits, shape (n,); and the point and the outward normal of each hit in the world, shape
            (n, 6), zeros for rays without a hit.

        Example:
            >>> hits, points = env.CheckCollisionRays([[0, 0, 5, 0, 0, -10], [1, 0, 5, 0, 0, -10]])
        """
        rows = checked_numbers(rays, "CheckCollisionRays: rays")
        if rows.ndim == 1 and rows.size in {0, 6}:
            rows = rows.reshape(-1, 6)
        if rows.ndim != 2 or rows.shape[1] != 6:
            raise ArgumentError(f"CheckCollisionRays: rays have shape {rows.shape}, and should have shape (n, 6)")
        if not np.isfinite(rows).all():
            row = int(np.flatnonzero(~np.isfinite(rows).all(axis=1))[0])
            raise ArgumentError(f"CheckCollisionRays: ray {row} is {rows[row].tolist()}, and should be finite numbers")
        checker = self.GetCollisionChecker()
        with self._simulation.lock:
            world = checker.world()
            targets = checker.ray_targets(world, ... if body is None else body)
            return world.rays.first_hits(rows, targets, front_facing_only=front_facing_only)

    @also_named(fncallback="callback")
    def RegisterCollisionCallback(self, callback: CollisionCallback) -> Handle:
        """Register a callback that decides whether each collision counts.

        Args:
            callback: A function of a report with one pair, and of False. It returns a ``CollisionAction``; collisions
                that it ignores do not count.

        Returns:
            A handle; deleting or closing it removes the callback.
        """
        return registered(self.collision_callbacks, callback, "RegisterCollisionCallback: callback")

    def HasRegisteredCollisionCallbacks(self) -> bool:
        """Return whether callbacks of ``RegisterCollisionCallback`` are registered."""
        return bool(self.collision_callbacks)

    def Triangulate(self, body: KinBody) -> TriMesh:
        """Return all geometries of ``body``, without those of grabbed bodies, as triangles in the world."""
        checked_kind(body, KinBody, "Triangulate: body")
        with self._simulation.lock:
            return _triangles([body.simulation_state])

    def TriangulateScene(self, options: int = TriangulateOptions.Everything, name: str = "") -> TriMesh:
        """Return the geometries of several bodies as triangles, in the world and at their current poses.

        Args:
            options: The choice of bodies, a ``TriangulateOptions``.
            name: The name of the body, for ``Body`` and ``AllExceptBody``.
        """
        with self._simulation.lock:
            return _triangles([body for body in self._simulation.bodies if selects(options, [name], body.scene)])


def _renames(mode: Any) -> bool:  # noqa: ANN401 - a number or an enumeration
    """Return whether the argument ``addMode`` of ``Add`` allows renaming a body with a taken name."""
    if mode is None or isinstance(mode, bool):
        return bool(mode)
    if mode not in tuple(InterfaceAddMode):
        raise ArgumentError(f"addMode is {mode!r}, and should be True, False or an InterfaceAddMode")
    return not InterfaceAddMode(mode) & InterfaceAddMode.StrictNameChecking


def _triangles(bodies: Sequence[BodyState]) -> TriMesh:
    return trimesh_of(scene.Mesh.merged([links_triangles(body.scene.links, body.link_transforms()) for body in bodies]))
