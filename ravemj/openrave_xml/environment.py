"""``<Environment>`` and the other roots: bodies in document order, background and camera."""

import os
from collections.abc import Callable
from dataclasses import dataclass, replace

from ravemj.errors import Diagnostics, SourceError
from ravemj.openrave_xml.body import read_body
from ravemj.openrave_xml.context import IGNORED, NOT_YET, Context, reasons
from ravemj.openrave_xml.tree import Element, parse_file
from ravemj.openrave_xml.values import ROTATIONS, axis_angle, vector
from ravemj.scene import KinBody, Scene, View
from ravemj.transforms import Pose, Vec3, Wxyz, wxyz_from_axis_angle

_DEFAULT_CAMERA_POSITION: Vec3 = (0.0, 1.5, 0.8)
_DEFAULT_CAMERA_WXYZ: Wxyz = wxyz_from_axis_angle((1.0, 0.0, 0.0), -0.5)

_INTERFACES = (
    "physicsengine",
    "collisionchecker",
    "sensor",
    "module",
    "controller",
    "planner",
    "iksolver",
    "sensorsystem",
    "trajectory",
    "viewer",
    "spacesampler",
)


@dataclass(frozen=True, slots=True)
class Reading:
    """What became of a file.

    Attributes:
        scene: What was read; with a failure, what was read before it.
        diagnostics: Every finding.
        failure: What ended the reading, or None.
    """

    scene: Scene
    diagnostics: Diagnostics
    failure: SourceError | None


def read(path: str | os.PathLike[str]) -> Reading:
    """Read an OpenRAVE XML file whose root is an environment, a robot or a kinbody."""
    context = Context()
    document = _Document(context)
    failure = None
    try:
        document.read(parse_file(os.fspath(path)))
    except SourceError as error:
        failure = error
    return Reading(Scene(tuple(document.bodies), document.view), context.diagnostics, failure)


class _Document:
    """The bodies and the view of a file, as far as it is read."""

    def __init__(self, context: Context) -> None:
        self.context = context
        self.bodies: list[KinBody] = []
        self.view: View | None = None

    def read(self, root: Element) -> None:
        """Read a root element."""
        if root.tag == "environment":
            self.read_environment(root)
        elif root.tag in {"robot", "kinbody"}:
            self.read_body(root)
        else:
            raise SourceError(
                f"the root element is <{root.spelled}>, and OpenRAVE expects <Environment>, <Robot> or <KinBody>",
                root.source,
            )

    def read_environment(self, element: Element) -> None:
        """Read an ``<Environment>``: first its file, then its children."""
        self.context.check_attributes(element, {"file"}, {})
        root = self.context.include(element)
        if root is not None:
            self.read(root)
        environment = _EnvironmentScope(self)
        self.context.walk(element, _ENVIRONMENT_TAGS, ENVIRONMENT_IGNORED, environment)
        self.view = environment.view

    def read_body(self, element: Element) -> None:
        """Read a body and give it its place among the others."""
        body = read_body(element, self.context)
        check_name(body.name, element)
        if any(body.name == other.name for other in self.bodies):
            raise SourceError(f"there already is a body '{body.name}'", element.source, "give it another name")
        self.bodies.append(body)


class _EnvironmentScope:
    """An open ``<Environment>``."""

    def __init__(self, document: _Document) -> None:
        self.document = document
        self.view = View()

    @property
    def _diagnostics(self) -> Diagnostics:
        return self.document.context.diagnostics

    def read_environment(self, element: Element) -> None:
        self.document.read_environment(element)

    def read_body(self, element: Element) -> None:
        self.document.read_body(element)

    def read_background(self, element: Element) -> None:
        self.view = replace(self.view, background=vector(element, self._diagnostics))

    def read_camera_position(self, element: Element) -> None:
        camera = self._camera()._replace(position=vector(element, self._diagnostics))
        self.view = replace(self.view, T_world_camera=camera)

    def read_camera_rotation(self, element: Element) -> None:
        """Read an axis and an angle [deg]; it replaces what stood before."""
        camera = self._camera()._replace(wxyz=axis_angle(element, self._diagnostics))
        self.view = replace(self.view, T_world_camera=camera)

    def read_camera_matrix(self, element: Element) -> None:
        camera = self._camera()._replace(wxyz=ROTATIONS["rotationmat"](element, self._diagnostics))
        self.view = replace(self.view, T_world_camera=camera)

    def _camera(self) -> Pose:
        return self.view.T_world_camera or Pose(_DEFAULT_CAMERA_POSITION, _DEFAULT_CAMERA_WXYZ)


_ENVIRONMENT_TAGS: dict[str, Callable[[_EnvironmentScope, Element], None]] = {
    "environment": _EnvironmentScope.read_environment,
    "robot": _EnvironmentScope.read_body,
    "kinbody": _EnvironmentScope.read_body,
    "bkgndcolor": _EnvironmentScope.read_background,
    "camtrans": _EnvironmentScope.read_camera_position,
    "camrotationaxis": _EnvironmentScope.read_camera_rotation,
    "camrotmat": _EnvironmentScope.read_camera_matrix,
}
ENVIRONMENT_IGNORED = {
    "plugin": "plugins are not loaded",
    "unit": IGNORED,
    **reasons(NOT_YET, *_INTERFACES, "camrotaxis", "camfocal"),
}


def check_name(name: str, element: Element) -> None:
    """Check that a body can be found by its name.

    Raises:
        SourceError: the name is empty, or has spaces or control characters.
    """
    if not name:
        raise SourceError(f"<{element.spelled}> has no name", element.source, 'write name="…"')
    if any(character.isspace() or not character.isprintable() for character in name):
        raise SourceError(f"the name '{name}' has spaces or control characters", element.source)
