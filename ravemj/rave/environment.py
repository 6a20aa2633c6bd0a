"""The environment: what scripts load models into and get robots from."""

import itertools
import logging
import os
import weakref
from types import TracebackType
from typing import Self

import mujoco
from numpy.typing import ArrayLike

from ravemj.errors import Diagnostic, Diagnostics, SourceError, send_warnings
from ravemj.openrave_xml import Reading
from ravemj.rave.kinbody import KinBody
from ravemj.rave.physics import PhysicsEngine
from ravemj.rave.robot import Robot
from ravemj.readers import read_file
from ravemj.rendering import Camera
from ravemj.simulation import BodyState, Simulation
from ravemj.studio import Format, Frame, Studio, checked_colour
from ravemj.viewers import Viewer, open_viewer

_LOG = logging.getLogger("ravemj")
_numbers = itertools.count(1)
_environments: "weakref.WeakValueDictionary[int, Environment]" = weakref.WeakValueDictionary()


class Environment:
    """A world with robots and other bodies.

    Example:
        >>> import ravemj
        >>> env = ravemj.Environment()
        >>> env.Load("models/env.xml")
        True
        >>> robot = env.GetRobots()[0]
        >>> robot.SetDOFValues([0.785, 0.785])
        >>> picture = env.render(640, 480)
    """

    def __init__(self) -> None:
        self._number = next(_numbers)
        self._simulation = Simulation()
        self._studio = Studio(self._simulation)
        self._viewer: Viewer | None = None
        self._found = Diagnostics()
        self._files: list[str] = []
        _environments[self._number] = self

    def Load(self, filename: str | os.PathLike[str]) -> bool:
        """Add the content of a model file to the environment.

        Args:
            filename: An OpenRAVE XML file with an environment, a robot or a kinbody. It is looked for in the working
                folder, then in the folders of the environment variable ``OPENRAVE_DATA``.

        Returns:
            False where OpenRAVE's ``Load`` is False: the file is missing or broken, or refers to what is not there.
            The reason is logged, and what could be read is in the environment all the same. ``ravemj.load`` raises
            instead.

        Raises:
            openrave_exception: a body of that name is in the environment already (``BodyNameConflict``).

        Example:
            >>> env.Load("env.xml")
            True
        """
        reading = read_file(filename)
        self._add(reading)
        if reading.failure is not None:
            _LOG.error("%s", reading.failure)
        return reading.failure is None and all(finding.severity != "error" for finding in reading.diagnostics)

    def _add(self, reading: Reading) -> None:
        self._files.extend(reading.files)
        for finding in reading.diagnostics:
            self._found.add(finding)
        for body in reading.scene.bodies:
            self._simulation.add(body)
        if reading.scene.view is not None:
            self._simulation.view = reading.scene.view
        if reading.scene.gravity is not None:
            self._simulation.set_gravity(reading.scene.gravity)
        send_warnings(reading.diagnostics)

    def GetBodies(self) -> list[KinBody]:
        """Return all bodies, robots included, in the order in which they were added."""
        return [self._wrap(state) for state in self._simulation.bodies]

    def GetRobots(self) -> list[Robot]:
        """Return the robots, in the order in which they were added.

        Example:
            >>> robot = env.GetRobots()[0]
        """
        return [body for body in self.GetBodies() if isinstance(body, Robot)]

    def GetKinBody(self, name: str) -> KinBody | None:
        """Return the body or robot of that name, or None."""
        state = self._simulation.body(name)
        return None if state is None else self._wrap(state)

    def GetRobot(self, name: str) -> Robot | None:
        """Return the robot of that name, or None.

        Example:
            >>> robot = env.GetRobot("Pendulum")
        """
        body = self.GetKinBody(name)
        return body if isinstance(body, Robot) else None

    def _wrap(self, state: BodyState) -> KinBody:
        return (Robot if state.scene.is_robot else KinBody)(self, state)

    def SetViewer(self, viewername: str, showviewer: bool = True) -> bool:
        """Attach a viewer, in place of the one before.

        With a display a window opens and shows every change from then on, while the script goes on. Without one, as
        on a server, the viewer draws when it is asked for pictures, so that scripts run there just the same.

        The camera starts with the view that the loaded file asks for, else from above; ``GetViewer().SetCamera``
        moves it.

        Args:
            viewername: ``'window'`` or one of OpenRAVE's names, such as ``'qtcoin'``: a window if there is a display.
                ``'offscreen'``: never a window. ``''`` removes the viewer.
            showviewer: False: never a window.

        Returns:
            True if there is a viewer now.

        Example:
            >>> env.SetViewer("qtcoin")
            True
            >>> viewer = env.GetViewer()
            >>> viewer.SetBkgndColor([0.8, 0.85, 0.9])
        """
        if self._viewer is not None:
            self._viewer.close()
            self._viewer = None
        if viewername:
            self._viewer = open_viewer(self._simulation, self._studio, viewername, showviewer)
        return self._viewer is not None

    def GetViewer(self) -> Viewer | None:
        """Return the viewer, or None before ``SetViewer``."""
        return self._viewer

    def GetPhysicsEngine(self) -> PhysicsEngine:
        """Return what holds gravity; never None."""
        return PhysicsEngine(self._simulation)

    def Reset(self) -> None:
        """Remove all bodies."""
        self._simulation.clear()

    def Destroy(self) -> None:
        """Close the viewer and remove all bodies."""
        self.SetViewer("")
        self.Reset()
        self._studio.close()

    def render(
        self,
        width: int = 640,
        height: int = 480,
        *,
        camera: ArrayLike | None = None,
        background: ArrayLike | None = None,
    ) -> Frame:
        """Draw a picture, with or without a display.

        Args:
            width: Columns [pixels].
            height: Rows [pixels].
            camera: ``T_world_camera``, 4x4, z forward and y down; None: the viewer's camera if there is a viewer, else
                the file's, else a view of the whole scene.
            background: Red, green, blue from 0 to 1; None: the viewer's, else the file's, else white.

        Returns:
            The picture, shape (height, width, 3), uint8, top row first.

        Raises:
            ArgumentError: the camera is no rigid transform, or the background no colour.
            RenderingError: nothing can draw here; ``ravemj doctor`` says why.

        Example:
            >>> import imageio.v3
            >>> imageio.v3.imwrite("pendulum.png", env.render(640, 480))
        """
        view = self.default_camera(width / height) if camera is None else Camera.from_matrix(camera)
        colour = self.background if background is None else checked_colour(background)
        return self._studio.picture(view, colour, Format(width, height, shadows=True))

    def default_camera(self, aspect: float = 4 / 3) -> Camera:
        """Return the camera of pictures that name none: the viewer's, else the file's, else one that shows all.

        Args:
            aspect: Width of the picture divided by its height.
        """
        return self._studio.camera_for_stills(aspect) if self._viewer is None else self._viewer.camera

    @property
    def background(self) -> tuple[float, float, float]:
        """The background of pictures that name none: the viewer's, else the file's, else white."""
        return self._simulation.view.background if self._viewer is None else self._viewer.background

    @property
    def simulation(self) -> Simulation:
        """The bodies and their MuJoCo model; below the OpenRAVE API."""
        return self._simulation

    @property
    def studio(self) -> Studio:
        """What draws the environment."""
        return self._studio

    @property
    def mjcf(self) -> str:
        """The environment as MJCF, the text that is compiled."""
        return self._simulation.compile().mjcf.text

    @property
    def spec(self) -> mujoco.MjSpec:
        """MuJoCo's editable form of the environment, for cameras and actuators of your own."""
        return self._simulation.compile().spec

    @property
    def model(self) -> mujoco.MjModel:
        """The compiled MuJoCo model; a new one after bodies were added."""
        return self._simulation.compile().model

    @property
    def data(self) -> mujoco.MjData:
        """The state of the MuJoCo model."""
        return self._simulation.compile().data

    @property
    def diagnostics(self) -> tuple[Diagnostic, ...]:
        """What was found in the loaded files and, once the model is compiled, in their translation."""
        return (*self._found, *self._simulation.diagnostics)

    @property
    def files(self) -> tuple[str, ...]:
        """Paths of all files that were read: models, what they include, and meshes."""
        return tuple(dict.fromkeys(self._files))

    def __enter__(self) -> Self:
        """Hold the environment's lock: no other thread reads or changes it meanwhile."""
        self._simulation.lock.acquire()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        """Let go of the lock."""
        self._simulation.lock.release()

    def __repr__(self) -> str:
        return f"RaveGetEnvironment({self._number})"

    def __str__(self) -> str:
        names = ", ".join(body.GetName() for body in self.GetBodies())
        return f"<environment:{self._number}, bodies={names or 'none'}>"

    def _repr_png_(self) -> bytes:
        """Return the picture that notebooks show for an environment."""
        from ravemj.video import png_bytes  # noqa: PLC0415 - only notebooks want it

        return png_bytes(self.render(480, 360))


def RaveGetEnvironment(id: int) -> Environment | None:  # OpenRAVE's name of the argument
    """Return the environment of that number, as ``repr(env)`` shows it, or None."""
    return _environments.get(id)


def load(path: str | os.PathLike[str]) -> Environment:
    """Load a model file into a new environment, or raise.

    Args:
        path: An OpenRAVE XML file with an environment, a robot or a kinbody.

    Returns:
        The environment; ``env.diagnostics`` has what was found on the way.

    Raises:
        SourceError: the file is missing or broken; the message names file and line, and ``diagnostics`` has what was
            found before.

    Example:
        >>> env = ravemj.load("models/env.xml")
        >>> env.GetRobots()[0].GetDOF()
        2
    """
    reading = read_file(path)
    env = Environment()
    try:
        if reading.failure is not None:
            raise reading.failure
        env._add(reading)  # pyright: ignore[reportPrivateUsage]
        env.simulation.compile()
    except SourceError as error:
        error.diagnostics = (*reading.diagnostics, *env.simulation.diagnostics)
        if error.cause is not None:
            error.add_note(str(error.cause))
        raise
    return env
