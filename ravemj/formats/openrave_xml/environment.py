"""``<Environment>`` and other roots: bodies and sensors in document order, background and camera."""

import math
import os
from dataclasses import dataclass, field, replace

from ravemj.core.transforms import ZERO, Pose, Vec3, Wxyz, multiply, wxyz_from_axis_angle
from ravemj.errors import Diagnostics, Source, SourceError, UnnamedError
from ravemj.formats.file_access import FileAccess
from ravemj.formats.openrave_xml.context import Context, uncomputable
from ravemj.formats.openrave_xml.given import NOTHING, Attributes, adapt, with_given
from ravemj.formats.openrave_xml.kinbody import read_body
from ravemj.formats.openrave_xml.sensor import read_sensor
from ravemj.formats.openrave_xml.tags import NO_EFFECT_HERE, Tag
from ravemj.formats.openrave_xml.tree import Element, content_of, parse
from ravemj.formats.openrave_xml.values import ROTATIONS, axis_angle, vector
from ravemj.formats.urdf import GIVEN as URDF_GIVEN
from ravemj.formats.urdf import check_robot, is_urdf
from ravemj.model.scene import AttachedSensor, KinBody, Scene, View

_DEFAULT_CAMERA_POSITION: Vec3 = (0.0, 1.5, 0.8)
_DEFAULT_CAMERA_WXYZ: Wxyz = wxyz_from_axis_angle((1.0, 0.0, 0.0), -0.5)

_HALF_TURN_X: Wxyz = wxyz_from_axis_angle((1.0, 0.0, 0.0), math.pi)

INTERFACES = (
    "collisionchecker",
    "module",
    "controller",
    "planner",
    "iksolver",
    "sensorsystem",
    "trajectory",
    "viewer",
    "spacesampler",
)

NO_PHYSICS = "of a physics engine, only the gravity means something to MuJoCo"

_KNOWN_CLASSES = {
    "ode", "bullet", "pqp", "fcl_", "fcl", "genericcollisionchecker",
    "idealcontroller", "idealvelocitycontroller", "redirectcontroller", "odevelocity",
    "qtcoin", "qtosg", "generictrajectory", "mt19937", "halton", "robotconfiguration",
    "basemanipulation", "taskmanipulation", "taskcaging", "visualfeedback", "logging", "ikfast", "grasper",
    "birrt", "basicrrt", "rastar", "workspacetrajectorytracker", "linearsmoother", "parabolicsmoother",
}  # fmt: skip
"""Plugin classes, other than bodies, that every OpenRAVE installation has."""


@dataclass(frozen=True, slots=True)
class Reading:
    """The result of reading a file.

    Attributes:
        scene: The scene; after a failure, what was read before.
        diagnostics: The diagnostics.
        failure: The error that ended the reading, or None.
        named_files: The files that were read, including meshes, each with the element that names it; see
            ``FileAccess``.
        renames: Whether a body is renamed if the environment already has a body of its name.
    """

    scene: Scene
    diagnostics: Diagnostics
    failure: SourceError | None
    named_files: dict[str, Source | None] = field(default_factory=dict[str, Source | None])
    renames: bool = False

    @property
    def files(self) -> tuple[str, ...]:
        """The paths of the files that were read."""
        return tuple(self.named_files)


def read(
    path: str | os.PathLike[str],
    given: Attributes = NOTHING,
    content: bytes | None = None,
    access: FileAccess | None = None,
) -> Reading:
    """Read an OpenRAVE XML file whose root is an environment, a robot or a kinbody.

    Args:
        path: The file.
        given: Additional attributes of the root.
        content: Its content, if already read.
        access: The files that may be read; by default those of a model that its user opens.
    """
    path = os.fspath(path)
    context = Context(access or FileAccess.opened(path))
    document = _FileContents(context)
    failure = None
    try:
        parsed = parse(content_of(path) if content is None else content, path, None, context.documents.budget)
        failure = parsed.error
        context.check_end(parsed)
        known = URDF_GIVEN if is_urdf(parsed.root) else ()
        if failure is not None and known:  # half a URDF is no robot
            raise failure
        document.read(with_given(parsed.root, given, context, known))
    except SourceError as error:
        failure = error
    except RecursionError:
        failure = SourceError("the elements are nested too deeply", Source(path))
    scene = Scene(tuple(document.bodies), document.view, document.gravity, tuple(document.sensors))
    return Reading(scene, context.diagnostics, failure, {path: None} | context.access.files, document.renames)


class _FileContents:
    """Bodies, sensors and view read from a file so far."""

    def __init__(self, context: Context) -> None:
        self.context = context
        self.bodies: list[KinBody] = []
        self.sensors: list[AttachedSensor] = []
        self._names: set[tuple[str, str]] = set()
        self.view: View | None = None
        self.gravity: Vec3 | None = None
        self.renames = False

    def read(self, root: Element) -> None:
        """Read a root element, such as ``<Environment>``; raise if it belongs to another format."""
        readers = {"robot": self.read_body, "kinbody": self.read_body, "sensor": self.read_sensor}
        check_robot(root)
        if is_urdf(root):
            self.read_urdf(root)
            return
        if root.tag == "environment":
            self.read_environment(root)
        elif root.tag in readers:
            if root.complete:
                readers[root.tag](root)
        elif root.tag in INTERFACES:
            _EnvironmentScope(self).read_interface(root)
        else:
            if root.tag == "mujoco":
                message = "MJCF is read from a file of its own, and not as a part of OpenRAVE's XML"
                raise SourceError(message, root.source, "load it in addition")
            raise SourceError(
                f"the root element is <{root.spelled}>, and OpenRAVE expects <Environment>, <Robot> or <KinBody>",
                root.source,
            )

    def read_environment(self, element: Element) -> None:
        """Read an ``<Environment>``: first the file that it includes, then its children."""
        self.context.check_attributes(element, ENVIRONMENT_ATTRIBUTES, {})
        root = self.context.include(element)
        if root is not None:
            self.read(root)
        environment = _EnvironmentScope(self)
        self.context.walk(element, ENVIRONMENT_TAGS, ENVIRONMENT_IGNORED, environment)
        # An <Environment> that ends sets the background, but the camera only where it has tags of it.
        camera = environment.view.T_world_camera or (self.view and self.view.T_world_camera)
        self.view = replace(environment.view, T_world_camera=camera)
        for child in element.children:
            if not child.complete and child.tag == "environment":
                self.read_environment(child)

    def read_body(self, element: Element) -> None:
        try:
            body, refusal = read_body(element, self.context)
        except ArithmeticError as error:
            raise uncomputable(element) from error
        self._take_name("body", body.name, element)
        self.bodies.append(body)
        if refusal is not None:
            raise refusal

    def read_urdf(self, root: Element) -> None:
        """Read the body of a URDF; allow renaming it if the environment already has its name."""
        from ravemj.formats.urdf.robot import read_robot, settle  # noqa: PLC0415 - most models are none

        self.renames = True
        try:
            body = read_robot(root, self.context, root.attributes)
            adapt(body, root, self.context)
            self.bodies.append(settle(body, self.context))
        except ArithmeticError as error:
            raise uncomputable(root) from error
        if body.refusal is not None:
            raise body.refusal

    def read_sensor(self, element: Element) -> None:
        """Read a sensor that is not attached to a robot."""
        sensor = read_sensor(element, self.context)
        if sensor is not None:
            self._take_name("sensor", sensor.name, element)
            self.sensors.append(sensor)

    def _take_name(self, kind: str, name: str, element: Element) -> None:
        check_name(name, element)
        if (kind, name) in self._names:
            raise SourceError(f"there already is a {kind} '{name}'", element.source, "give it another name")
        self._names.add((kind, name))


class _EnvironmentScope:
    def __init__(self, document: _FileContents) -> None:
        self.document = document
        self.view = View()

    @property
    def _diagnostics(self) -> Diagnostics:
        return self.document.context.diagnostics

    def read_environment(self, element: Element) -> None:
        self.document.read_environment(element)

    def read_body(self, element: Element) -> None:
        self.document.read_body(element)

    def read_sensor(self, element: Element) -> None:
        self.document.read_sensor(element)

    def read_background(self, element: Element) -> None:
        self.view = replace(self.view, background=vector(element, self._diagnostics))

    def read_camera_position(self, element: Element) -> None:
        camera = self._camera()._replace(position=vector(element, self._diagnostics))
        self.view = replace(self.view, T_world_camera=camera)

    def read_camera_rotation(self, element: Element) -> None:
        """Set the camera's orientation from an axis and an angle [deg]."""
        camera = self._camera()._replace(wxyz=axis_angle(element, self._diagnostics))
        self.view = replace(self.view, T_world_camera=camera)

    def read_camera_matrix(self, element: Element) -> None:
        camera = self._camera()._replace(wxyz=ROTATIONS["rotationmat"](element, self._diagnostics))
        self.view = replace(self.view, T_world_camera=camera)

    def read_old_camera_rotation(self, element: Element) -> None:
        """Set the camera's orientation from the deprecated tag: axis and angle, after a half turn about x."""
        turned = multiply(axis_angle(element, self._diagnostics), _HALF_TURN_X)
        self.view = replace(self.view, T_world_camera=self._camera()._replace(wxyz=turned))

    def read_physics(self, element: Element) -> None:
        """Read the gravity of a physics engine; for ODE it is zero by default."""
        self.document.context.check_attributes(element, PHYSICS_ATTRIBUTES, {})
        kind = element.attributes.get("type", "").lower()
        if kind not in {"ode", "bullet", "genericphysicsengine", ""}:
            message = f"there is no physics engine '{kind}' here"
            self._diagnostics.error("unknown-interface", message, element.source)
            return
        if kind == "ode":
            self.document.gravity = ZERO
        for properties in element.children:
            if properties.tag != "odeproperties":
                self.document.context.leave_out(properties, NO_PHYSICS)
                continue
            for child in properties.children:
                if child.tag == "gravity":
                    self.document.gravity = vector(child, self._diagnostics)
                else:
                    self.document.context.leave_out(child, NO_PHYSICS)

    def read_interface(self, element: Element) -> None:
        """Report an interface that ravemj ignores, such as a viewer; an unknown class is an error, as in OpenRAVE."""
        kind = element.attributes.get("type", "")
        name = kind.split()[0].lower() if kind.split() else ""
        if name and name not in _KNOWN_CLASSES:
            message = f"there is no {element.tag} of type '{kind}' here"
            self._diagnostics.error("unknown-interface", message, element.source)
        else:
            self._diagnostics.warn("ignored-tag", f"<{element.spelled}> is left out: {NO_EFFECT_HERE}", element.source)

    def _camera(self) -> Pose:
        return self.view.T_world_camera or Pose(_DEFAULT_CAMERA_POSITION, _DEFAULT_CAMERA_WXYZ)


_INTERFACE = Tag(
    _EnvironmentScope.read_interface,
    "it has no effect on the model; an unknown class is reported as an error",
    left_out=True,
)
ENVIRONMENT_TAGS: dict[str, Tag[_EnvironmentScope]] = {
    "environment": Tag(_EnvironmentScope.read_environment, "its content is added"),
    "robot": Tag(_EnvironmentScope.read_body, "see below; also as the root"),
    "kinbody": Tag(_EnvironmentScope.read_body, "see below; also as the root"),
    "sensor": Tag(_EnvironmentScope.read_sensor, "see below; also as the root; no robot carries it"),
    "bkgndcolor": Tag(_EnvironmentScope.read_background, "red green blue, from 0 to 1", once=True),
    "camtrans": Tag(_EnvironmentScope.read_camera_position, "position of the camera [m]", once=True),
    "camrotationaxis": Tag(
        _EnvironmentScope.read_camera_rotation, "axis x y z, angle [deg]; z looks forward, y down", once="rotation"
    ),
    "camrotmat": Tag(_EnvironmentScope.read_camera_matrix, "nine numbers, row by row", once="rotation"),
    "camrotaxis": Tag(
        _EnvironmentScope.read_old_camera_rotation, "deprecated: a half turn about x comes first", once="rotation"
    ),
    "physicsengine": Tag(_EnvironmentScope.read_physics, "only its gravity; `ode` without one has none"),
    **dict.fromkeys(INTERFACES, _INTERFACE),
}
ENVIRONMENT_ATTRIBUTES = {"file": "read first, as if its content stood here"}
PHYSICS_ATTRIBUTES = {"type": "ode, bullet or GenericPhysicsEngine"}
ENVIRONMENT_IGNORED = {
    "plugin": "plugins are not loaded",
    "unit": "OpenRAVE keeps it as a label and scales nothing; lengths are in metres here",
    "camfocal": "no viewer turns about a point yet",
}


def check_name(name: str, element: Element) -> None:
    """Check that a body or a sensor can be found by its name.

    Raises:
        UnnamedError: the name is empty.
        SourceError: it has spaces or control characters.
    """
    if not name and "file" in element.attributes:
        message = f"<{element.spelled}> has no name, and its file '{element.attributes['file']}' gives none"
        raise UnnamedError(message, element.source, 'check the path, or write name="…"')
    if not name:
        raise UnnamedError(f"<{element.spelled}> has no name", element.source, 'write name="…"')
    if " " in name or not name.isprintable():  # other spaces than this one are not printable
        hint = "scripts find bodies by names of one word; write _ in their place"
        raise SourceError(f"the name {name!r} has spaces or control characters", element.source, hint)
