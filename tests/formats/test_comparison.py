"""Every field of every part of a scene counts when two scenes are compared."""

from dataclasses import fields, replace

import numpy as np
import pytest

from ravemj.core.transforms import Pose
from ravemj.errors import Source
from ravemj.model import scene as parts
from ravemj.model.comparison import compare
from ravemj.model.expressions import parse
from ravemj.model.scene import Mesh, Scene
from ravemj.model.scene.record import Record

SOURCE = Source("model.xml", 1)
TRIANGLE = Mesh(np.eye(3), np.array([[0, 1, 2]]))
UNIT = Pose((0.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0))
MOVED = Pose((0.1, 0.2, 0.3), (0.6, 0.0, 0.8, 0.0))
SHAPES = (
    parts.Box((1.0, 2.0, 3.0)),
    parts.CalibrationBoard((1.0, 2.0, 3.0)),
    parts.Sphere(1.0),
    parts.Cylinder(1.0, 2.0),
    parts.Capsule(1.0, 2.0),
    parts.Container((3.0, 3.0, 3.0), (2.0, 2.0, 2.0), (1.0, 1.0, 1.0), (1.0, 1.0, 1.0)),
    parts.Prism(((0.0, 0.0), (1.0, 0.0), (0.0, 1.0)), 1.0),
    parts.TriMesh(TRIANGLE),
    parts.NoShape(),
)
PARAMETERS = parts.Parameters((("a", (1.0,)),), (("b", (2,)),), (("c", "d"),))


def geometry(shape):
    return parts.Geometry(
        shape=shape,
        T_link_geometry=UNIT,
        name="shape",
        diffuse=(0.1, 0.2, 0.3),
        ambient=(0.4, 0.5, 0.6),
        transparency=0.5,
        visible=True,
        display=(parts.Surface(TRIANGLE, (0.1, 0.2, 0.3), 0.5),),
        collision_mesh=TRIANGLE,
        source=SOURCE,
    )


def link(name, geometries=()):
    return parts.Link(
        name=name,
        T_world_link=UNIT,
        inertial=parts.Inertial(1.0, (0.0, 0.0, 0.0), ((1.0, 0.1, 0.0), (0.1, 2.0, 0.0), (0.0, 0.0, 3.0)), UNIT.wxyz),
        geometries=geometries,
        static=False,
        enabled=True,
        groups=(("other", (geometry(parts.Sphere(2.0)),)),) if geometries else (),
        parameters=PARAMETERS,
        source=SOURCE,
    )


def joint(name, parent, child, **more):
    axis = parts.Axis((0.0, 0.0, 1.0), lower=-1.0, upper=1.0)
    given = {"kind": "hinge", "axes": (axis,), "T_parent_child": MOVED, "places_child": True, **more}
    return parts.Joint(name=name, parent=parent, child=child, anchor=(0.0, 0.0, 0.0), source=SOURCE, **given)


def sensor(name, device, link=0, type=None):
    return parts.AttachedSensor(name=name, link=link, T_link_sensor=UNIT, type=type, device=device, source=SOURCE)


def robot():
    mimic = parts.Mimic("2*first", "|first 2", "|first 0", parse("2*joint0", {"joint0"}), (0,))
    return parts.KinBody(
        name="robot",
        is_robot=True,
        links=(link("a", tuple(map(geometry, SHAPES))), *(link(name, (geometry(SHAPES[0]),)) for name in "bcd")),
        joints=(joint("first", 0, 1, parameters=PARAMETERS),),
        passive_joints=(joint("second", 1, 2, mimic=mimic),),
        adjacent=((0, 2),),  # which joints do not make adjacent
        manipulators=(
            parts.Manipulator(
                name="arm",
                base=0,
                effector=1,
                T_effector_tool=UNIT,
                direction=(0.0, 0.0, 1.0),
                arm_dofs=(0,),
                gripper_joints=(0,),
                gripper_dofs=(0,),
                chucking_direction=(1.0,),
                source=SOURCE,
            ),
        ),
        sensors=(
            sensor("unknown", None, type="nose"),
            *(sensor(kind.name, kind.device, type=kind.name) for kind in parts.SENSOR_KINDS.values()),
        ),
        grabs=(parts.Grab(body="load", link=1, T_link_body=UNIT, ignored=(1,)),),
        source=SOURCE,
    )


SCENE = Scene(
    (robot(),),
    parts.View((0.1, 0.2, 0.3), UNIT),
    (0.0, 0.0, -9.81),
    (sensor("loose", parts.SENSOR_KINDS["basecamera"].device, None, "BaseCamera"),),
    "a workshop",
)

EQUAL = {
    **{
        (name, "source"): "where something stands in a file says nothing about it"
        for name in ("AttachedSensor", "Geometry", "Joint", "KinBody", "Link", "Manipulator")
    },
    ("Geometry", "render_file"): "the triangles are compared, wherever they come from",
    ("Geometry", "collision_file"): "the triangles are compared, wherever they come from",
    ("Mesh", "known_digest"): "it follows from the numbers",
    ("Joint", "keeps_moving"): "scripts set it, and no file says it",
    ("KinBody", "element"): "it is where the body stands in its file",
    ("Manipulator", "ik_solver"): "it says how poses are reached; COLLADA does not have it",
    **dict.fromkeys(
        (("KinBody", "configurations"), ("NamedConfiguration", "name"), ("NamedConfiguration", "values")),
        "states of an SRDF are names of joint values, and no part of the robot; other formats do not have them",
    ),
}
"""Fields in which scenes may differ, and why."""

OTHERS = {
    ("Joint", "kind"): "slider",
    ("Joint", "parent"): 3,
    ("Joint", "child"): 3,
    ("Axis", "joint_torque"): 7.0,
    ("Axis", "speed_torques"): ((0.0, 5.0), (10.0, 1.0)),
    ("Joint", "mimic"): parts.Mimic("first", "", "", parse("joint0", {"joint0"}), (0,)),
    ("Mimic", "position"): "3*first",
    ("Mimic", "velocity"): "|first 3",
    ("Mimic", "acceleration"): "|first 3",
    ("Mimic", "expression"): parse("-joint0", {"joint0"}),
    ("Joint", "axes"): (parts.Axis((1.0, 0.0, 0.0)),),
    ("AttachedSensor", "type"): "ear",
    ("AttachedSensor", "device"): parts.Tactile(),
    ("Geometry", "shape"): parts.Sphere(7.0),
    ("Link", "parameters"): parts.NO_PARAMETERS,
    ("Joint", "parameters"): parts.NO_PARAMETERS,
    ("Axis", "direction"): (1.0, 0.0, 0.0),
    ("Inertial", "axes"): (0.0, 1.0, 0.0, 0.0),
    ("Manipulator", "direction"): (1.0, 0.0, 0.0),
    ("View", "T_world_camera"): None,
    ("Geometry", "display"): None,
    ("Geometry", "collision_mesh"): None,
    ("Scene", "view"): parts.View(),
    ("Mesh", "triangles"): np.array([[0, 2, 1]]),
    ("ForceTorque", "correction"): (1.0,) * 36,
    ("JointEncoder", "resolution"): (1.0,),
    ("Link", "inertial"): parts.Inertial(7.0, (0.0, 0.0, 0.0), ((1.0, 0.0, 0.0), (0.0, 2.0, 0.0), (0.0, 0.0, 3.0))),
}
"""Other values of fields where none can be made of the present one."""


def classes():
    """Yield the classes that scenes consist of, some of them twice: ``dataclass`` makes those with slots anew."""
    pending = [Mesh, *Record.__subclasses__()]
    while pending:
        kind = pending.pop()
        pending += kind.__subclasses__()
        if "__dataclass_fields__" in vars(kind):
            yield kind


FIELDS = sorted({(kind.__name__, field.name) for kind in classes() for field in fields(kind)})


CHANGES = {
    bool: lambda value: not value,
    int: lambda value: value + 1,
    float: lambda value: value + 0.25,
    str: lambda value: value + "x",
    Pose: lambda value: value._replace(position=(7.0, 8.0, 9.0)),
    Mesh: lambda value: Mesh(value.vertices + 1.0, value.triangles),
    np.ndarray: lambda value: value + 1.0,
}


def another(value):
    """Return a value that differs from another one."""
    for kind, change in CHANGES.items():
        if isinstance(value, kind):
            return change(value)
    first, *rest = value
    if isinstance(first, Record) or (isinstance(first, tuple) and isinstance(first[0], str)):
        return tuple(rest)
    return (another(first), *rest)


def altered(value, name, field):
    """Return a part of a scene with another value in a field of the first object of a class in it, or None."""
    if type(value).__name__ == name and hasattr(value, field):
        present = getattr(value, field)
        return replace(value, **{field: OTHERS[name, field] if (name, field) in OTHERS else another(present)})
    if isinstance(value, Record):
        for inner in value.__slots__:
            found = altered(getattr(value, inner), name, field)
            if found is not None:
                return replace(value, **{inner: found})
    elif isinstance(value, tuple):
        for place, inner in enumerate(value):
            found = altered(inner, name, field)
            if found is not None:
                return (*value[:place], found, *value[place + 1 :])
    return None


def test_a_scene_equals_itself():
    assert compare(SCENE, SCENE) == []
    assert compare(SCENE, replace(SCENE, bodies=(robot(),))) == []


@pytest.mark.parametrize(("name", "field"), [one for one in FIELDS if one not in EQUAL])
def test_a_field_counts(name, field):
    other = altered(SCENE, name, field)
    assert other is not None, f"SCENE has no {name}"
    assert compare(SCENE, other)
    assert compare(other, SCENE)


def test_the_exceptions_are_fields():
    assert set(EQUAL) <= set(FIELDS)
    assert set(OTHERS) <= set(FIELDS)
