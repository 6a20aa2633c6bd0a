"""``<Manipulator>`` and ``<AttachedSensor>``, which occur only in robots."""

from ravemj.errors import Diagnostics
from ravemj.formats.openrave_xml.context import PLACEMENT_TAGS, Context, Placed
from ravemj.formats.openrave_xml.sensor import SensorElement, read_device
from ravemj.formats.openrave_xml.tags import NO_EFFECT_HERE, Tag, reasons
from ravemj.formats.openrave_xml.tree import Element
from ravemj.formats.openrave_xml.values import number_list, vector, word, words
from ravemj.model.builder import BodyBuilder, SensorBuilder
from ravemj.model.manipulators import ManipulatorBuilder
from ravemj.model.scene import AttachedSensor


def named_link(body: BodyBuilder, element: Element, owner: str, context: Context) -> str:
    """Return the name of a link. It should already exist, although the file may define it later (test gap-29).

    ``owner`` is the part that refers to the link, for the message.
    """
    name = word(element, context.diagnostics)
    if body.find_link(name) is None:
        message = f"there is no Body '{name}' for the <{element.spelled}> of {owner}"
        context.diagnostics.error("unknown-body", message, element.source, "put it behind the Body")
    return name


class _ManipulatorScope(Placed):
    def __init__(self, body: BodyBuilder, built: ManipulatorBuilder, context: Context) -> None:
        super().__init__(context)
        self.body = body
        self.built = built

    def read_base(self, element: Element) -> None:
        self.built.base = self._link(element)

    def read_effector(self, element: Element) -> None:
        self.built.effector = self._link(element)

    def _link(self, element: Element) -> str:
        return named_link(self.body, element, "the manipulator", self.context)

    def read_gripper(self, element: Element) -> None:
        self.built.gripper_joints = words(element.text)

    def read_closing(self, element: Element) -> None:
        self.built.closing_direction = number_list(element, self.context.diagnostics)

    def read_ik_solver(self, element: Element) -> None:
        self.built.ik_solver = " ".join(words(element.text))

    def read_direction(self, element: Element) -> None:
        self.built.direction = vector(element, self.context.diagnostics)


MANIPULATOR_TAGS: dict[str, Tag[_ManipulatorScope]] = {
    **PLACEMENT_TAGS,
    "base": Tag(_ManipulatorScope.read_base, "name of the Body that the arm starts from", once=True),
    "effector": Tag(_ManipulatorScope.read_effector, "name of the Body that carries the tool", once=True),
    "joints": Tag(_ManipulatorScope.read_gripper, "names of the gripper's joints", once=True),
    "gripperjoints": Tag(_ManipulatorScope.read_gripper, "names of the gripper's joints", once=True),
    "closingdirection": Tag(_ManipulatorScope.read_closing, "sign of closing for each", once=True),
    "closingdir": Tag(_ManipulatorScope.read_closing, "the same as closingdirection", once=True),
    "chuckingdirection": Tag(_ManipulatorScope.read_closing, "the same as closingdirection", once=True),
    "direction": Tag(_ManipulatorScope.read_direction, "where the tool points: x y z", once=True),
    "iksolver": Tag(_ManipulatorScope.read_ik_solver, "its solver of inverse kinematics, and steps of free joints"),
    "palmdirection": Tag(_ManipulatorScope.read_direction, "the same as direction", once=True),
}
MANIPULATOR_ATTRIBUTES = {"name": "name of the manipulator"}
MANIPULATOR_IGNORED = {
    "armjoints": "OpenRAVE finds the arm's joints by itself, between base and effector",
}


def read_manipulator(body: BodyBuilder, element: Element, context: Context) -> None:
    """Read a ``<Manipulator>`` and append it to the body."""
    context.check_attributes(element, MANIPULATOR_ATTRIBUTES, {})
    name = element.attributes.get("name", "")
    if not name:
        name = f"manip{len(body.manipulators)}"
        context.diagnostics.warn("no-name", f"the manipulator has no name; OpenRAVE calls it {name}", element.source)
    scope = _ManipulatorScope(body, ManipulatorBuilder(name, element.source), context)
    context.walk(element, MANIPULATOR_TAGS, MANIPULATOR_IGNORED, scope)
    if not scope.built.effector:
        message = f"the manipulator '{name}' has no effector"
        context.diagnostics.error("no-effector", message, element.source, "name its last link")
    scope.built.T_effector_tool = scope.placement.pose
    body.manipulators.append(scope.built)


class _SensorScope(Placed):
    """Reading state of an ``<AttachedSensor>``."""

    def __init__(self, body: BodyBuilder, context: Context) -> None:
        super().__init__(context)
        self.body = body
        self.link: str | None = None
        self.device = SensorElement()

    def read_link(self, element: Element) -> None:
        self.link = named_link(self.body, element, "the sensor", self.context)

    def read_device(self, element: Element) -> None:
        self.device = read_device(element, self.context)


SENSOR_TAGS: dict[str, Tag[_SensorScope]] = {
    "link": Tag(_SensorScope.read_link, "name of the Body that carries it", once=True),
    **PLACEMENT_TAGS,
    "sensor": Tag(_SensorScope.read_device, "see below", once=True),
}
SENSOR_ATTRIBUTES = {"name": "name of the sensor"}
SENSOR_IGNORED = reasons(NO_EFFECT_HERE, "sendcommand")


def read_attached_sensor(body: BodyBuilder, element: Element, context: Context) -> None:
    """Read an ``<AttachedSensor>`` and append it to the body."""
    context.check_attributes(element, SENSOR_ATTRIBUTES, {})
    scope = _SensorScope(body, context)
    context.walk(element, SENSOR_TAGS, SENSOR_IGNORED, scope)
    if scope.link is None:
        message = "the sensor names no link, and is attached to nothing"
        context.diagnostics.warn("no-link", message, element.source, "add a <link>")
    sensor = AttachedSensor(
        name=element.attributes.get("name", ""),
        link=None if scope.link is None else body.find_link(scope.link),
        T_link_sensor=scope.placement.pose,
        type=scope.device.type,
        device=scope.device.device,
        source=element.source,
        is_on=scope.device.is_on,
        color=scope.device.color,
    )
    body.sensors.append(SensorBuilder(sensor, scope.link))


def check_sensors(body: BodyBuilder, diagnostics: Diagnostics) -> None:
    """Warn of sensors whose link is missing at the end of the robot.

    OpenRAVE looks up the links then (tests gap-28, robot-21).
    """
    for sensor, name in body.sensors:
        if name and body.find_link(name) is None:
            message = f"sensor '{sensor.name}' is attached to nothing: in the end there is no Body '{name}'"
            hint = "OpenRAVE puts no prefix before the link of a sensor: write the whole name, and the sensor first"
            diagnostics.warn("no-link", message, sensor.source, hint)
