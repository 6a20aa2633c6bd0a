"""Translation of a scene to an MJCF model that can be simulated from its start pose."""

import os
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Literal, NamedTuple

import mujoco
import numpy as np

from ravemj.core.caching import cached_property
from ravemj.core.output import AnyPath
from ravemj.core.transforms import Floats
from ravemj.engine.compiled import Compiled, compile_text
from ravemj.engine.kinematics import BodyKinematics
from ravemj.engine.servo_gains import TIMESTEP, ServoLoads, loads_of, servo_gains
from ravemj.engine.simulation import DEFAULT_GRAVITY, Simulation
from ravemj.engine.snapshot import snapshot
from ravemj.errors import ArgumentError, Diagnostics
from ravemj.formats import mjcf
from ravemj.formats.gains_file import GivenGains, check_used, gains_of, read_gains
from ravemj.formats.mjcf.actuators import Actuators
from ravemj.formats.mjcf.classes import add_classes
from ravemj.formats.mjcf.fragment import append
from ravemj.formats.mjcf.lines import XmlLines, attribute_text
from ravemj.formats.mjcf.records import SCENE, scene_text
from ravemj.formats.mjcf.sections import MjcfSections
from ravemj.model.gains import Gains
from ravemj.model.look import STUDIO_PREFIX
from ravemj.model.scene import AttachedSensor, Joint, KinBody, Scene
from ravemj.model.start_pose import named_values, start_values

HOME = "home"
"""Name of the keyframe with the start pose."""

_FREE = int(mujoco.mjtJoint.mjJNT_FREE)

_LIGHT = 1e-8
"""Inertia [kg m^2 or kg] of a joint below which a warning is given."""

_LIGHT_DISTANCE = 2.0
"""Distance of lights from the centre of a model, in multiples of its extent."""


class TranslationChoices(NamedTuple):
    """User choices of a translation to MJCF.

    Attributes:
        base: Attachment of the bodies: ``fixed`` welds all to the world; ``openrave`` frees bodies without a static
            link; ``free`` frees these and all robots.
        actuators: The kind of actuator of each DOF: ``position``, ``velocity``, ``torque``, or None.
        gains: File with servo gains that replace computed ones; see ``ravemj.formats.gains_file``.
        state: Named configuration to start from; None for the one called home, standing or half_sitting, else the
            present joint values.
        self_collision: Whether links of one robot collide.
        exclude: ``touching`` excludes pairs of links that are adjacent, that an SRDF names, or that touch at the start;
            ``none`` excludes none.
        decompose: Whether meshes collide as several convex parts.
        hull_vertices: Maximum number of vertices of a collision hull; 0 means no limit.
        merge_fixed: Whether links that cannot move become shapes and sites of their parents.
        sensors: Whether to add sensors of joints and of the base, and the model's own.
        append: File with a fragment of MJCF to add, or None.
        timestep: Time step [s], or None for MuJoCo's.
    """

    base: Literal["fixed", "free", "openrave"] = "fixed"
    actuators: Actuators | None = None
    gains: AnyPath | None = None
    state: str | None = None
    self_collision: bool = True
    exclude: Literal["touching", "none"] = "touching"
    decompose: bool = False
    hull_vertices: int = 0
    merge_fixed: bool = False
    sensors: bool = False
    append: AnyPath | None = None
    timestep: float | None = None

    def check(self) -> None:
        """Check the choices of a script.

        Raises:
            ArgumentError: a choice is unknown, or a number is too small.
        """
        for name, known in _KNOWN.items():
            value = getattr(self, name)
            if value not in known:
                raise ArgumentError(f"{name} is {value!r}; there are: {', '.join(map(str, known))}")
        if self.hull_vertices and self.hull_vertices < _LEAST_HULL:
            raise ArgumentError(f"hull_vertices is {self.hull_vertices}; a hull has {_LEAST_HULL} vertices or more")
        if self.gains is not None and self.actuators not in {"position", "velocity"}:
            raise ArgumentError("gains are for actuators of the kind position or velocity; choose one of these")
        if self.timestep is not None and not 0.0 < self.timestep < np.inf:
            raise ArgumentError(f"timestep is {self.timestep}, not a time above 0 [s]")


_KNOWN = {
    "base": ("fixed", "free", "openrave"),
    "actuators": (None, "position", "velocity", "torque"),
    "exclude": ("touching", "none"),
}
_LEAST_HULL = 4


@dataclass(frozen=True)
class Translation:
    """Translated model.

    Attributes:
        mjcf: The document and its meshes.
        bodies: The translated bodies.
        choices: The choices.
        excluded: Names of pairs of links that touch at the start pose and were excluded.
    """

    mjcf: mjcf.Mjcf
    bodies: tuple[KinBody, ...]
    choices: TranslationChoices
    excluded: tuple[tuple[str, str], ...]

    @cached_property
    def model(self) -> mujoco.MjModel:
        """The compiled document."""
        return compile_text(self.mjcf)[1]

    def on_floor(self, height: float) -> mujoco.MjModel:
        """Compile the document with a floor at a height [m]."""
        floor = XmlLines(2)
        floor.element("geom", type="plane", size=(0.0, 0.0, 0.05), pos=(0.0, 0.0, height))
        document = MjcfSections(self.mjcf.text, self.mjcf.sources)
        document.add("worldbody", floor)
        return compile_text(replace(self.mjcf, text=document.text, sources=tuple(document.sources)))[1]

    @property
    def home(self) -> mujoco.MjData:
        """The state at the start pose, with derived quantities; a new object at each access."""
        data = mujoco.MjData(self.model)
        if self.model.nkey:
            mujoco.mj_resetDataKeyframe(self.model, data, 0)
        mujoco.mj_forward(self.model, data)
        return data


def translated(
    simulation: Simulation,
    diagnostics: Diagnostics,
    choices: TranslationChoices,
    model: AnyPath,
    sensors: tuple[AttachedSensor, ...] = (),
) -> Translation:
    """Translate the bodies of a simulation in their present state; raises the errors of ``translate``.

    ``model`` is the file that they were read from. ``sensors`` are sensors without a robot, which are stored only for
    reading the document again. Other arguments as for ``translate``.
    """
    with simulation.lock:
        scene = Scene(tuple(map(snapshot, simulation.bodies)), simulation.view, simulation.gravity, sensors)
    return translate(scene, diagnostics, choices, os.path.dirname(os.fspath(model)) or ".")


def translate(scene: Scene, diagnostics: Diagnostics, choices: TranslationChoices, folder: str) -> Translation:
    """Translate a scene, and check that MuJoCo accepts the result.

    Args:
        scene: The bodies in their present state.
        diagnostics: Receives a warning for every value that MuJoCo would reject, and for motors that are too weak.
        choices: The user's choices.
        folder: Folder of the model; comments name files relative to it.

    Raises:
        CompileError: MuJoCo refuses the model.
        SourceError: a file to add is broken.
        RavemjError: CoACD is not installed, and meshes should be decomposed; or no body has the state.
    """
    choices.check()
    _check_state(scene, choices)
    starts = [start_values(body, choices.state) for body in scene.bodies]
    gains = _gains(scene, starts, choices, diagnostics) if choices.actuators else ()
    options = mjcf.Options(
        free_bases=choices.base != "fixed",
        free_robots=choices.base == "free",
        actuators=choices.actuators,
        gains=gains,
        decomposed=choices.decompose,
        excludes=choices.exclude == "touching",
        merge_fixed=choices.merge_fixed,
        hull_vertices=choices.hull_vertices,
        self_collision=choices.self_collision,
        sensors=choices.sensors,
        timestep=choices.timestep,
        folder=folder,
    )
    written = mjcf.write(scene, diagnostics, options)
    document = MjcfSections(written.text, written.sources)
    add_classes(document)
    if choices.append is not None:
        append(document, choices.append)
    written = replace(written, text=document.text, sources=tuple(document.sources))
    compiled = Compiled(scene, diagnostics, options, written=written)
    _place_lights(document, compiled.model)
    poses = _Poses(compiled.model, written.names, scene.bodies)
    start = poses.qpos(starts)
    excluded = _touching(compiled, written.names, start) if choices.exclude == "touching" else ()
    _add_excludes(document, excluded)
    if not choices.merge_fixed:
        document.add("custom", _scene_text(scene, excluded))
    if compiled.model.nq:
        document.add("keyframe", _keyframes(poses, scene.bodies, starts, choices))
    final = replace(written, text=document.text, sources=tuple(document.sources))
    translation = Translation(final, scene.bodies, choices, excluded)
    if choices.append is not None:  # its names may be those of keyframes
        _ = translation.model
    return translation


def _scene_text(scene: Scene, excluded: Sequence[tuple[str, str]]) -> XmlLines:
    """Return scene properties that belong to no body, as text from which ravemj reads them again."""
    content = XmlLines(2)
    content.text_element(SCENE, scene_text(scene, excluded))
    return content


def _check_state(scene: Scene, choices: TranslationChoices) -> None:
    known = dict.fromkeys(configuration.name for body in scene.bodies for configuration in body.configurations)
    if choices.state is not None and choices.state not in known:
        raise ArgumentError(f"there is no state '{choices.state}'; the model has {', '.join(known) or 'none'}")


def _gains(
    scene: Scene, starts: Sequence[Floats], choices: TranslationChoices, diagnostics: Diagnostics
) -> tuple[Gains | None, ...]:
    """Return the servo gains of each body: from the gains file if given, else computed."""
    given = [] if choices.gains is None else read_gains(choices.gains)
    check_used(given, [name for body in scene.bodies for name in body.dof_names])
    timestep = choices.timestep or TIMESTEP
    gains: list[Gains | None] = []
    for body, start in zip(scene.bodies, starts, strict=True):
        if not len(start):
            gains.append(None)
            continue
        stands = choices.base == "free" or (choices.base == "openrave" and not any(link.static for link in body.links))
        gravity = DEFAULT_GRAVITY if scene.gravity is None else scene.gravity
        loads = loads_of(body, start, gravity, stands=stands)
        _warn_of_motors(body, loads, diagnostics)
        gains.append(_with_given(body, loads, timestep, given))
    return tuple(gains)


def _with_given(body: KinBody, loads: ServoLoads, timestep: float, given: Sequence[GivenGains]) -> Gains:
    rows = [gains_of(name, given) for name in body.dof_names]
    gains = servo_gains(loads, timestep, np.array([np.nan if row is None else row.kp for row in rows]))
    kv = np.array([value if row is None else row.kv for row, value in zip(rows, gains.kv, strict=True)])
    return gains._replace(kv=kv)


def _warn_of_motors(body: KinBody, loads: ServoLoads, diagnostics: Diagnostics) -> None:
    """Warn of motors that are too weak for their load at the start pose, and of suspicious inertias."""
    unlimited: list[Joint] = []
    dof = 0
    for joint in body.joints:
        has_motors = joint.places_child and not (joint.static or joint.is_ball)
        for axis in range(len(joint.axes) if has_motors else 0):
            needed, effort, moved = (float(values[dof + axis]) for values in (loads.start, loads.effort, loads.inertia))
            unit = "N" if joint.slides(axis) else "N m"
            if needed > effort:
                message = f"the motor of joint '{joint.name}' gives {effort:.4g} {unit}, and gravity needs {needed:.4g}"
                diagnostics.warn("weak-motor", f"{message} at the start pose: it will sag", joint.source)
            if moved < _LIGHT:
                unit = "kg" if joint.slides(axis) else "kg m^2"
                message = (
                    f"joint '{joint.name}' moves an inertia of only {moved:.3g} {unit}, for which its servo is made"
                )
                diagnostics.warn("light-joint", message, joint.source, "give its links their mass and inertia")
            if np.isinf(effort):
                unlimited.append(joint)
        dof += len(joint.axes)
    if unlimited:
        others = f" (and {len(unlimited) - 1} more)" if len(unlimited) > 1 else ""
        message = f"joint '{unlimited[0].name}'{others} has no effort: the torque of its servo is not limited"
        diagnostics.warn("no-effort", message, unlimited[0].source)


class _Poses:
    """Converter of joint values of several bodies to ``qpos`` of their common model."""

    def __init__(self, model: mujoco.MjModel, names: Sequence[mjcf.BodyNames], bodies: Sequence[KinBody]) -> None:
        self.model = model
        self._kinematics = [BodyKinematics(body) if body.dof_axes else None for body in bodies]
        self._names = names

    def qpos(self, values: Sequence[Floats]) -> Floats:
        """Return ``qpos`` for joint values of each body, each of shape (dof,)."""
        qpos = self.model.qpos0.copy()
        for kinematics, names, chosen in zip(self._kinematics, self._names, values, strict=True):
            if kinematics is not None:
                kinematics.set_values(chosen)
                for places, joint_names in zip(kinematics.joint_qpos, names.joints, strict=True):
                    for place, name in zip(places, joint_names, strict=True):
                        joint = self.model.joint(name)
                        width = len(joint.qpos0)
                        qpos[joint.qposadr[0] :][:width] = kinematics.qpos[place : place + width]
        return qpos

    def targets(self, qpos: Floats) -> Floats:
        """Return the targets of servos that hold a pose, shape (nu,); servos have the names of their joints."""
        model, joints = self.model, {name for body in self._names for names in body.joints for name in names}
        names = [model.actuator(number).name for number in range(model.nu)]
        return np.array([qpos[model.joint(name).qposadr[0]] if name in joints else 0.0 for name in names])


def _touching(compiled: Compiled, names: Sequence[mjcf.BodyNames], qpos: Floats) -> tuple[tuple[str, str], ...]:
    """Return the pairs of links that touch in a configuration, sorted.

    Pairs of a falling body with other bodies are left out, as it may lie on them.
    """
    model, data = compiled.model, compiled.data
    data.qpos[:] = qpos
    mujoco.mj_fwdPosition(model, data)
    owner = {link: index for index, body in enumerate(names) for link in body.links}
    falling = {model.body(root).name for root in model.jnt_bodyid[model.jnt_type == _FREE].tolist()}
    falls = [not falling.isdisjoint(body.links) for body in names]
    pairs: set[tuple[str, str]] = set()
    for touch in data.contact:
        first, second = sorted(model.body(geom_body).name for geom_body in model.geom_bodyid[touch.geom].tolist())
        if first in owner and second in owner:
            first_body, other = owner[first], owner[second]
            if first_body == other or not (falls[first_body] or falls[other]):
                pairs.add((first, second))
    return tuple(sorted(pairs))


def _add_excludes(document: MjcfSections, pairs: Sequence[tuple[str, str]]) -> None:
    if pairs:
        content = XmlLines(2)
        content.comment("these touch at the start pose", None)
        for first, second in pairs:
            content.element("exclude", body1=first, body2=second)
        document.add("contact", content)


def _keyframes(
    poses: _Poses, bodies: Sequence[KinBody], starts: Sequence[Floats], choices: TranslationChoices
) -> XmlLines:
    """Return the keyframe of the start pose, and one for each other named configuration."""
    content = XmlLines(2)
    for name, values in _named_poses(bodies, starts, choices):
        qpos = poses.qpos(values)
        targets = poses.targets(qpos) if choices.actuators == "position" else np.zeros(0)
        content.element("key", name=name, qpos=tuple(qpos.tolist()), ctrl=tuple(targets.tolist()) or None)
    return content


def _named_poses(
    bodies: Sequence[KinBody], starts: Sequence[Floats], choices: TranslationChoices
) -> Iterator[tuple[str, list[Floats]]]:
    yield HOME, list(starts)
    names = dict.fromkeys(configuration.name for body in bodies for configuration in body.configurations)
    for name in names:
        values = [
            named_values(body, name) if any(one.name == name for one in body.configurations) else start
            for body, start in zip(bodies, starts, strict=True)
        ]
        if name != HOME:
            yield name, values
        elif choices.state not in {None, HOME}:
            yield "home-of-srdf", values


def _place_lights(document: MjcfSections, model: mujoco.MjModel) -> None:
    """Place the directional lights so that the shadow maps of MuJoCo's viewers contain all bodies."""
    for number in range(model.nlight):
        light = model.light(number)
        if light.name.startswith(STUDIO_PREFIX):
            position = model.stat.center - _LIGHT_DISTANCE * model.stat.extent * light.dir
            placed = f'<light name="{light.name}" pos="{attribute_text(tuple(position.round(6).tolist()))}"'
            head = f'<light name="{light.name}"'
            for index, line in enumerate(document.lines):
                if line.startswith(f"    {head}"):
                    document.lines[index] = line.replace(head, placed, 1)
