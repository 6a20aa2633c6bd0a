"""Bodies and the MuJoCo model made of them."""

import re
import warnings
from threading import RLock

import mujoco
import numpy as np

from ravemj import mjcf
from ravemj.dynamics import BodyDynamics
from ravemj.errors import CompileError, Diagnostics, ErrorCode, RavemjError, Source, send_warnings
from ravemj.kinematics import BodyKinematics
from ravemj.mjcf.document import ASSETS
from ravemj.scene import KinBody, Scene, View
from ravemj.transforms import Vec3, wxyz_from_rows

DEFAULT_GRAVITY: Vec3 = (0.0, 0.0, -9.797930195020351)
"""OpenRAVE's, where a file has no physics engine."""

_DOF = re.compile(r"DOF (\d+)")
_LINE = re.compile(r"line (?:number=)?(\d+)", re.IGNORECASE)
_TOO_DEEP = "XML_ELEMENT_DEPTH_EXCEEDED"
_LONGEST_CHAIN = 496  # links; MuJoCo's reader of XML takes 500 elements inside one another


class BodyState:
    """A body and its state; what the API objects of one body share.

    Attributes:
        scene: What the file says.
        simulation: Where the body is.
    """

    def __init__(self, scene: KinBody, simulation: "Simulation") -> None:
        self.scene = scene
        self.simulation = simulation
        self._values = np.array([axis.value for axis in scene.dof_axes])
        self._velocities = np.zeros(len(scene.dof_axes))
        self._kinematics: BodyKinematics | None = None
        self._dynamics: BodyDynamics | None = None

    @property
    def dynamics(self) -> BodyDynamics:
        """Velocities, Jacobians and inverse dynamics in the present model."""
        if self._dynamics is None:
            self._dynamics = BodyDynamics(self.kinematics)
            self._dynamics.velocities = self._velocities
        return self._dynamics

    @property
    def kinematics(self) -> BodyKinematics:
        """Joint values and link poses in the present model, which is compiled if need be."""
        if self._kinematics is None:
            self.simulation.compile()
            assert self._kinematics is not None
        return self._kinematics

    def enter(self, kinematics: BodyKinematics) -> None:
        """Take the body's place in a new model, in the configuration that it has."""
        kinematics.set_values(self._values)
        self._kinematics = kinematics

    def leave(self) -> None:
        """Keep the configuration; the model is about to go."""
        if self._kinematics is not None:
            self._values = self._kinematics.values()
            self._kinematics = None
        if self._dynamics is not None:
            self._velocities = self._dynamics.velocities
            self._dynamics = None


class Simulation:
    """The bodies of an environment, in one MuJoCo model that is compiled when it is first asked for.

    Adding bodies puts the model out of date; the next query compiles it once, and the bodies keep their joint values.

    Attributes:
        lock: Held by every reader and writer of the model's state; viewers draw in threads of their own.
        view: Background and camera that the loaded files ask for.
        diagnostics: What the last translation to MJCF found.
        version: Grows by one with each compiled model.
        gravity: Acceleration of free fall in the world [m/s^2].
    """

    def __init__(self) -> None:
        self.lock = RLock()
        self.view = View()
        self.diagnostics = Diagnostics()
        self.version = 0
        self.gravity = DEFAULT_GRAVITY
        self._bodies: dict[str, BodyState] = {}
        self._compiled: Compiled | None = None

    @property
    def bodies(self) -> tuple[BodyState, ...]:
        """The bodies, in the order in which they were added."""
        return tuple(self._bodies.values())

    def body(self, name: str) -> BodyState | None:
        """Return the body of that name, or None."""
        return self._bodies.get(name)

    def add(self, scene: KinBody) -> BodyState:
        """Add a body in its loaded configuration.

        Raises:
            RavemjError: a body of that name is already there.
        """
        with self.lock:
            if scene.name in self._bodies:
                message = f"there already is a body '{scene.name}' in the environment"
                raise RavemjError(message, ErrorCode.BodyNameConflict)
            self._forget_model()
            self._bodies[scene.name] = state = BodyState(scene, self)
            return state

    def clear(self) -> None:
        """Remove all bodies."""
        with self.lock:
            self._forget_model()
            self._bodies.clear()

    def set_gravity(self, gravity: Vec3) -> None:
        """Set the acceleration of free fall [m/s^2]."""
        with self.lock:
            self.gravity = gravity
            if self._compiled is not None:
                self._compiled.model.opt.gravity[:] = gravity

    def _forget_model(self) -> None:
        self._compiled = None
        for body in self._bodies.values():
            body.leave()

    def compile(self) -> "Compiled":
        """Return the model of the present bodies, compiled if it is out of date.

        Raises:
            CompileError: MuJoCo refuses the model.
        """
        if self._compiled is not None:
            return self._compiled
        with self.lock:
            self.diagnostics = Diagnostics()
            scene = Scene(tuple(body.scene for body in self._bodies.values()), self.view)
            compiled = Compiled(scene, self.diagnostics)
            compiled.model.opt.gravity[:] = self.gravity
            for body, names in zip(self._bodies.values(), compiled.mjcf.names, strict=True):
                body.enter(BodyKinematics(compiled.model, compiled.data, body.scene, names))
            self._compiled = compiled
            self.version += 1
            send_warnings(self.diagnostics)
            return compiled


class Compiled:
    """A scene in MuJoCo.

    Attributes:
        mjcf: The text that was compiled.
        spec: MuJoCo's editable form of it.
        model: The compiled model, with the true masses and inertias of the scene.
        data: Its state.
    """

    def __init__(self, scene: Scene, diagnostics: Diagnostics, options: mjcf.Options | None = None) -> None:
        self.mjcf = mjcf.write(scene, diagnostics, options)
        try:
            with mujoco.MjVfs() as files:
                for name, content in self.mjcf.assets.items():
                    files[f"{ASSETS}/{name}"] = content.encode()
                self.spec = mujoco.MjSpec.from_string(self.mjcf.text, vfs=files)
                with warnings.catch_warnings(record=True) as complaints:
                    warnings.simplefilter("always")
                    self.model = self.spec.compile(vfs=files)
        except ValueError as error:
            raise _compile_error(str(error), self.mjcf) from None
        for complaint in complaints:
            self._report(str(complaint.message), scene, diagnostics)
        self._write_true_inertias(scene)
        self.data = mujoco.MjData(self.model)

    def _report(self, complaint: str, scene: Scene, diagnostics: Diagnostics) -> None:
        """Record a warning of MuJoCo's, with the link that it is about where it names a DOF."""
        source, about = Source("the translated model", 0), ""
        match = _DOF.search(complaint)
        if match:
            name = self.model.body(self.model.dof_bodyid[int(match[1])]).name
            for body, names in zip(scene.bodies, self.mjcf.names, strict=True):
                if name in names.links:
                    source, about = body.links[names.links.index(name)].source, f" of '{name}'"
        hint = "positions are exact; before time runs, give the link more mass or inertia"
        diagnostics.warn("near-singular", f"MuJoCo warns{about}: {complaint}", source, hint)

    def _write_true_inertias(self, scene: Scene) -> None:
        """Give the links that MuJoCo's compiler refuses their true values back; inverse dynamics needs them."""
        for body_index, link_index in self.mjcf.altered:
            inertial = scene.bodies[body_index].links[link_index].inertial
            name = self.mjcf.names[body_index].links[link_index]
            body_id = mujoco.mj_name2id(self.model, mujoco.mjtObj.mjOBJ_BODY, name)
            inertia = np.array(inertial.inertia)
            if not (np.isfinite(inertial.mass) and np.isfinite(inertia).all()):
                continue
            moments, axes = np.linalg.eigh(inertia)
            axes[:, 0] *= np.linalg.det(axes)  # a rotation, not a reflection
            self.model.body_mass[body_id] = inertial.mass
            self.model.body_inertia[body_id] = moments
            self.model.body_iquat[body_id] = wxyz_from_rows(axes.tolist())


def _compile_error(message: str, text: mjcf.Mjcf) -> CompileError:
    """Return MuJoCo's complaint with the place in the user's file that it is about."""
    match = _LINE.search(message)
    line = int(match[1]) if match else 0
    source = text.source_of_line(line) or Source("the translated model", line)
    if _TOO_DEEP in message:
        reason = f"this link hangs on a chain of {_LONGEST_CHAIN} links, and MuJoCo takes no longer ones"
        return CompileError(reason, source, "split the chain into several bodies")
    reason = " ".join(message.split())
    return CompileError(f"MuJoCo refuses the translated model: {reason}", source)
