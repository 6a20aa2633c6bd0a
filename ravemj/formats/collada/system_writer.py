"""Writer of articulated systems: parameters of axes, mimic joints, and OpenRAVE's extras."""

import itertools
from collections.abc import Callable, Iterator

from ravemj.errors import Diagnostics
from ravemj.formats import settled
from ravemj.formats.collada.extras import inside_extra
from ravemj.formats.collada.geometry_writer import write_pose
from ravemj.formats.collada.sections import Sections
from ravemj.formats.collada.sensor import write_device
from ravemj.formats.collada.trees import Tree
from ravemj.formats.parameters import write_parameters
from ravemj.formats.xml_text import XmlText
from ravemj.model.joints import rests
from ravemj.model.scene import AttachedSensor, Axis, Joint, KinBody, Manipulator
from ravemj.model.scene.mechanism import RARE_NUMBERS

_PLAIN = Axis((0.0, 0.0, 1.0))


class SystemWriter:
    """Writes the articulated systems of a body, and binds them to its nodes."""

    def __init__(
        self, sections: Sections, diagnostics: Diagnostics, body: KinBody, number: int, trees: list[Tree]
    ) -> None:
        self._sections = sections
        self._diagnostics = diagnostics
        self._body = body
        self._number = number
        self._trees = trees
        self._name = f"body{number}"
        self._joints = body.all_joints
        self._first_dofs = list(itertools.accumulate((len(joint.axes) for joint in body.joints), initial=0))
        self._model_of_link = {link: tree.model for tree in trees for link in tree.links}
        self._model_of_joint = {joint: tree.model for tree in trees for joint in tree.joints}

    def write(self) -> None:
        """Write the kinematics and motion systems, and the instance of the motion system in the scene."""
        out = self._sections.systems
        with out.inside("articulated_system", id=f"{self._name}_kinematics"), out.inside("kinematics"):
            for tree in self._trees:
                with out.inside("instance_kinematics_model", url=f"#{tree.model}", sid=f"{tree.model}_inst"):
                    self._write_parameters(out, f"{self._name}_kinematics", tree)
            with out.inside("technique_common"):
                for index, place, axis in self._axes():
                    self._write_kinematics(index, place, axis)
        with out.inside("articulated_system", id=f"{self._name}_motion"):
            with out.inside("motion"):
                with out.inside("instance_articulated_system", url=f"#{self._name}_kinematics"):
                    for tree in self._trees:
                        self._write_parameters(out, f"{self._name}_motion", tree, f"{self._name}_kinematics")
                with out.inside("technique_common"):
                    for index, place, axis in self._axes():
                        self._write_motion(index, place, axis)
            self._write_extras()
        self._write_scene()

    def _axes(self) -> Iterator[tuple[int, int, Axis]]:
        """Yield (joint index, index of the axis in the joint, axis) of all axes."""
        for index, joint in enumerate(self._body.all_joints):
            for place, axis in enumerate(joint.axes):
                yield index, place, axis

    def _write_parameters(self, out: XmlText, scope: str, tree: Tree, inner: str = "") -> None:
        """Write parameters of a model and its axes, with names in ``scope``.

        They refer to the parameters of the scope ``inner`` if it is given, else to model and axes themselves.
        """
        named = {f"{tree.model}_inst": f"{tree.model}_inst"}
        for index in tree.joints:
            for place in range(len(self._joints[index].axes)):
                named[f"joint{index}_axis{place}"] = f"{tree.model}_inst/joint{index}/axis{place}"
        for name, path in named.items():
            named_here = f"{inner}/{inner}_{name}" if inner else f"{scope}/{path}"
            out.element_inside("newparam", "SIDREF", named_here, sid=f"{scope}_{name}")

    def _write_kinematics(self, index: int, place: int, axis: Axis) -> None:
        """Write limits, planning weight and resolution of an axis, and whether it is a DOF."""
        out, joint = self._sections.systems, self._joints[index]
        sid = f"{self._name}_axis{index}_{place}"
        with out.inside("axis_info", sid=sid, axis=f"{self._joint_path(index)}/axis{place}"):
            circular = axis.circular and not joint.slides(place)
            if axis.circular and not circular:
                message = f"the slider '{joint.name}' is circular, as none is in COLLADA; there it has limits"
                self._diagnostics.warn("not-written", message, joint.source)
            out.element_inside("newparam", "bool", circular, sid="circular")
            out.element_inside("newparam", "float", axis.weight, sid="planning_weight")
            out.element_inside("newparam", "float", axis.resolution, sid="discretization_resolution")
            out.element_inside("active", "bool", index < len(self._body.joints))
            out.element_inside("locked", "bool", False)
            if index < len(self._body.joints):
                out.element_inside("index", "int", self._first_dofs[index] + place, semantic="OpenRAVE")
            if not circular:
                with out.inside("limits"):
                    out.element_inside("min", "float", _in_file(joint, place, axis.lower))
                    out.element_inside("max", "float", _in_file(joint, place, axis.upper))

    def _write_motion(self, index: int, place: int, axis: Axis) -> None:
        out, joint = self._sections.systems, self._joints[index]
        with out.inside("axis_info", axis=f"{self._name}_kinematics/{self._name}_axis{index}_{place}"):
            out.element_inside("speed", "float", _in_file(joint, place, axis.max_velocity))
            out.element_inside("acceleration", "float", _in_file(joint, place, axis.max_acceleration))

    def _write_scene(self) -> None:
        """Instantiate the system in the kinematics scene; bind models to nodes, and axes to nodes and values."""
        out, scope = self._sections.kinematics_scene, f"{self._name}_scene"
        url = f"#{self._name}_motion"
        with out.inside("instance_articulated_system", url=url, sid=scope, name=self._body.name):
            for tree in self._trees:
                self._write_parameters(out, scope, tree, f"{self._name}_motion")
        for tree in self._trees if self._body.links else ():
            node = f"visual{tree.number}/node{tree.root}"
            self._sections.bindings.element_inside(
                "bind_kinematics_model", "param", f"{scope}_{tree.model}_inst", node=node
            )
            for index in tree.joints:
                self._bind_axes(tree, index, scope)

    def _bind_axes(self, tree: Tree, index: int, scope: str) -> None:
        """Bind a joint's axes to node transforms and, if they are DOFs, to joint values."""
        joint = self._joints[index]
        for place, axis in enumerate(joint.axes):
            name = f"joint{self._number}.{index}_axis{place}"
            target = f"visual{tree.number}/{name}" if joint.places_child else f"node{self._number}.{joint.child}"
            value = _in_file(joint, place, axis.value) if index < len(self._body.joints) else 0
            bind_axis(self._sections.bindings, target, f"{scope}_joint{index}_axis{place}", value)

    def _write_extras(self) -> None:
        """Write OpenRAVE's extras of the body, and ravemj's extras for what these cannot represent."""
        out, body = self._sections.systems, self._body
        kind = ("robot", "GenericRobot") if body.is_robot else ("kinbody", "KinBody")
        with inside_extra(out, "interface_type"):
            out.element("interface", kind[1], type=kind[0])
        for manipulator in body.manipulators:
            self._write_manipulator(manipulator)
        for number, sensor in enumerate(body.sensors):
            with inside_extra(out, "attach_sensor", sensor.name):
                self._write_sensor(number, sensor)
        for index, joint in enumerate(body.all_joints):
            axis = joint.axes[0]
            if axis.max_torque or axis.armature or axis.coulomb_friction or axis.viscous_friction:
                with inside_extra(out, "attach_actuator", f"joint{index}"):
                    self._write_actuator(index, axis)
        with inside_extra(out, "collision"):
            for first, second in body.adjacent:
                out.element("ignore_link_pair", link0=self._link_path(first), link1=self._link_path(second))
            for index, link in enumerate(body.links):
                out.element_inside("link_collision_state", "bool", link.enabled, link=self._link_path(index))
        with inside_extra(out):
            self._write_supplement()

    def _write_manipulator(self, manipulator: Manipulator) -> None:
        out, body = self._sections.systems, self._body
        if manipulator.base is None or manipulator.effector is None:
            message = f"the manipulator '{manipulator.name}' lacks its first or last link; readers leave it out"
            self._diagnostics.warn("not-written", message, manipulator.source)
            return
        with inside_extra(out, "manipulator", manipulator.name):
            out.element("frame_origin", link=self._link_path(manipulator.base))
            with out.inside("frame_tip", link=self._link_path(manipulator.effector)):
                write_pose(out, settled.pose(manipulator.T_effector_tool))
                out.element("direction", settled.direction(manipulator.direction))
            signs = iter(manipulator.chucking_direction)
            for index in manipulator.gripper_joints:
                closing = [next(signs) for _ in body.joints[index].axes]
                with out.inside("gripper_joint", joint=self._joint_path(index)):
                    for place, sign in enumerate(closing):
                        out.element_inside("closing_direction", "float", sign, axis=f"./axis{place}")

    def _write_sensor(self, number: int, sensor: AttachedSensor) -> None:
        out, name = self._sections.systems, f"{self._name}_sensor{number}"
        link = None if sensor.link is None else self._link_path(sensor.link)
        with out.inside("frame_origin", link=link):
            write_pose(out, settled.pose(sensor.T_link_sensor))
        write_device(out, self._sections.sensors, name, sensor)

    def _write_actuator(self, index: int, axis: Axis) -> None:
        """Write the motor of a joint, with a gear ratio of 1."""
        out, name = self._sections.systems, f"{self._name}_actuator{index}"
        out.element("bind_actuator", joint=self._joint_path(index))
        out.element("instance_actuator", url=f"#{name}")
        library = self._sections.actuators
        with library.inside("actuator", id=name, type="electric_motor"):
            library.element("gear_ratio", 1)
            library.element("max_instantaneous_torque", axis.max_torque)
            library.element("rotor_inertia", axis.armature)
            library.element("coloumb_friction", axis.coulomb_friction)
            library.element("viscous_friction", axis.viscous_friction)

    def _write_supplement(self) -> None:
        """Write the extras that the module ``supplement`` reads.

        They contain the order of links and joints, the names that COLLADA readers change, values of joints without
        DOFs, and torques that differ between the axes of a joint, since COLLADA has one motor per joint.
        """
        out, body = self._sections.systems, self._body
        out.element("name", body.name)
        if body.description:
            out.element("description", body.description)
        if not body.joined_links_adjacent:
            out.element("joined_links_adjacent", False)
        for index, link in enumerate(body.links):
            ignored = True if link.self_collision_ignored else None
            out.element("link", link.name, path=self._link_path(index), self_collision_ignored=ignored)
        for index, joint in enumerate(body.all_joints):
            is_kept = rests(body, index) and joint.kind != "spherical"  # a ball counts from where it is
            values = settled.values(joint) if is_kept else []
            torques = [axis.max_torque for axis in joint.axes]
            attributes = {
                "values": values if any(values) else None,
                "torques": torques if len(set(torques)) > 1 else None,
                "own_torques": None,
            }
            if any(axis.joint_torque is not None for axis in joint.axes):
                attributes["own_torques"] = [axis.own_torque for axis in joint.axes]
            if any(axis.speed_torques for axis in joint.axes):
                message = f"the motor of joint '{joint.name}' has torque limits that depend on its speed; they are lost"
                self._diagnostics.warn("not-written", message, joint.source)
            for name in RARE_NUMBERS:
                numbers = [getattr(axis, name) for axis in joint.axes]
                attributes[name] = numbers if numbers != [getattr(_PLAIN, name)] * len(numbers) else None
            out.element("joint", joint.name, path=self._joint_path(index), **attributes)
        self._write_attached()

    def _write_attached(self) -> None:
        """Write parameters, selectable geometry groups, and grabbed bodies."""
        out, body = self._sections.systems, self._body
        for index, link in enumerate(body.links):
            write_parameters(out, link.parameters, self._link_path(index))
            for number, (name, geometries) in enumerate(link.groups):
                with out.inside("group", name=name, of=self._link_path(index)):
                    for place, geometry in enumerate(geometries):
                        identity = f"group{self._number}.{index}.{number}.{place}"
                        self._sections.geometry.write(geometry, identity, out)
        for index, joint in enumerate(body.all_joints):
            write_parameters(out, joint.parameters, self._joint_path(index))
        write_grabs(out, body, self._link_path)

    def _link_path(self, index: int) -> str:
        return f"{self._model_of_link[index]}/link{index}"

    def _joint_path(self, index: int) -> str:
        return f"{self._model_of_joint[index]}/joint{index}"


def _in_file(joint: Joint, place: int, value: float) -> float:
    """Return an axis value in the unit of the file: degrees, or metres for prismatic axes."""
    return value if joint.slides(place) else settled.degrees(value)


def bind_axis(out: XmlText, target: str, parameter: str, value: float) -> None:
    """Bind the axis named by a parameter to its node and value."""
    with out.inside("bind_joint_axis", target=target):
        out.element_inside("axis", "param", parameter)
        out.element_inside("value", "float", value)


def write_grabs(out: XmlText, body: KinBody, path_of: Callable[[int], str]) -> None:
    """Write the grabbed bodies of a body, given the paths of its links."""
    for grab in body.grabs:
        ignored = " ".join(map(path_of, grab.ignored)) or None
        with out.inside("grabbed", body=grab.body, link=path_of(grab.link), ignored=ignored):
            write_pose(out, settled.pose(grab.T_link_body))
