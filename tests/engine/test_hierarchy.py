"""Which joint places which link; the outcomes are OpenRAVE's."""

import math

import numpy as np
import pytest

import ravemj

BOX = '<Geom type="box"><extents>0.1 0.1 0.1</extents></Geom>'


@pytest.fixture
def load(tmp_path):
    def load(content: str) -> ravemj.KinBody:
        path = tmp_path / "body.xml"
        path.write_text(f'<KinBody name="b">{content}</KinBody>')
        return ravemj.load(path).GetBodies()[0]

    return load


def body(name, x=0.0, y=0.0, kind="dynamic"):
    return f'<Body name="{name}" type="{kind}"><Translation>{x} {y} 0</Translation>{BOX}</Body>'


def hinge(name, first, second, anchor="0 0 0", more=""):
    return (
        f'<Joint name="{name}" type="hinge"><Body>{first}</Body><Body>{second}</Body>'
        f"<anchor>{anchor}</anchor><axis>0 0 1</axis>{more}</Joint>"
    )


def position(kinbody, link):
    return kinbody.GetLink(link).GetTransform()[:3, 3]


def test_joints_listed_the_other_way_round(load):
    kinbody = load(
        body("A")
        + body("B", 1)
        + body("C", 2)
        + hinge("j0", "B", "A", ".5 0 0")
        + '<Joint name="j1" type="slider"><Body>B</Body><Body>C</Body><axis>0 2 0</axis></Joint>'
    )
    kinbody.SetDOFValues([0.3, 0.2])
    j0 = kinbody.GetJoint("j0")
    assert (j0.GetHierarchyParentLink().GetName(), j0.GetHierarchyChildLink().GetName()) == ("A", "B")
    np.testing.assert_allclose(j0.GetAxis(), [0, 0, -1], atol=1e-15)
    np.testing.assert_allclose(position(kinbody, "B"), [0.977668, -0.14776, 0], atol=1e-6)
    np.testing.assert_allclose(position(kinbody, "C"), [1.99211, -0.252213, 0], atol=1e-5)


def test_no_axis_is_z_of_the_first_body(load):
    kinbody = load(body("A") + body("B", 1) + '<Joint name="j" type="hinge"><Body>A</Body><Body>B</Body></Joint>')
    kinbody.SetDOFValues([0.3])
    np.testing.assert_allclose(position(kinbody, "B"), [0.955336, 0.29552, 0], atol=1e-6)


def test_initial_is_the_value_of_the_written_pose(load):
    kinbody = load(body("A") + body("B", 1) + hinge("j", "A", "B", ".5 0 0", "<initial>0.5</initial>"))
    assert kinbody.GetDOFValues() == [0.5]
    np.testing.assert_allclose(position(kinbody, "B"), [1, 0, 0], atol=1e-15)
    kinbody.SetDOFValues([0.3])
    np.testing.assert_allclose(position(kinbody, "B"), [0.990033, -0.0993347, 0], atol=1e-6)


def test_limits_that_exclude_zero(load):
    with pytest.warns(ravemj.RavemjWarning, match="loads at 0.1") as caught:
        kinbody = load(body("A") + body("B", 1) + hinge("j", "A", "B", more="<limits>0.1 0.5</limits>"))
    assert [warning.message.code for warning in caught] == ["value-outside-limits"]
    assert kinbody.GetDOFValues() == [0.1]


def test_closed_loop_stays_open(load):
    corners = body("A") + body("B", 0, 1) + body("C", 1, 1) + body("D", 1, 0)
    joints = (hinge("AB", "A", "B", "0 0 0") + hinge("BC", "B", "C", "0 1 0") + hinge("CD", "C", "D", "1 1 0")) + hinge(
        "DA", "D", "A", "1 0 0"
    )
    kinbody = load(corners + joints)
    assert kinbody.GetDOF() == 4
    kinbody.SetDOFValues([0.3, -0.3, 0.3, -0.3])
    cd = kinbody.GetJoint("CD")
    assert (cd.GetHierarchyParentLink().GetName(), cd.GetHierarchyChildLink().GetName()) == ("D", "C")
    np.testing.assert_allclose(cd.GetAxis(), [0, 0, -1], atol=1e-15)
    np.testing.assert_allclose(position(kinbody, "C"), [0.70448, 0.955336, 0], atol=1e-6)
    turned = kinbody.GetLink("D").GetTransform()
    np.testing.assert_allclose(turned[:3, 3], [1, 0, 0], atol=1e-15)
    assert turned[1, 0] == pytest.approx(math.sin(0.3))


def test_static_link_is_a_parent(load):
    kinbody = load(
        body("A") + body("B", 1) + body("C", 2, kind="static") + hinge("ab", "A", "B") + hinge("bc", "B", "C")
    )
    bc = kinbody.GetJoint("bc")
    assert (bc.GetHierarchyParentLink().GetName(), bc.GetHierarchyChildLink().GetName()) == ("C", "B")
    kinbody.SetDOFValues([0.4, 0.7])
    np.testing.assert_allclose(position(kinbody, "C"), [2, 0, 0], atol=1e-15)
    np.testing.assert_allclose(position(kinbody, "B"), [math.cos(0.4), math.sin(0.4), 0], atol=1e-12)


def test_first_declared_link_is_the_root(load):
    kinbody = load(
        body("C", 2) + body("B", 1) + body("A") + hinge("j0", "A", "B", ".5 0 0") + hinge("j1", "B", "C", "1.5 0 0")
    )
    kinbody.SetDOFValues([0.3, 0.4])
    np.testing.assert_allclose(position(kinbody, "C"), [2, 0, 0], atol=1e-15)
    np.testing.assert_allclose(position(kinbody, "A"), [0.196518, 0.711527, 0], atol=1e-6)


def test_weld_has_a_dof_that_is_always_zero(load):
    kinbody = load(
        body("A")
        + body("B", 1)
        + body("C", 2)
        + hinge("weld", "A", "B", more="<limits>0 0</limits>")
        + hinge("j", "B", "C")
    )
    assert kinbody.GetDOF() == 2
    kinbody.SetDOFValues([0.0, 0.4])
    assert kinbody.GetDOFValues().tolist() == [0.0, 0.4]
    assert kinbody.qpos_indices.tolist() == [-1, 0]
    np.testing.assert_allclose(position(kinbody, "C"), [2 * math.cos(0.4), 2 * math.sin(0.4), 0], atol=1e-12)


def test_disabled_joint_is_a_weld_without_dof(load):
    disabled = hinge("off", "A", "B").replace("<Joint ", '<Joint enable="false" ')
    kinbody = load(body("A") + body("B", 1) + body("C", 2) + disabled + hinge("j", "B", "C"))
    assert kinbody.GetDOF() == 1
    assert [joint.GetName() for joint in kinbody.GetPassiveJoints()] == ["off"]
    assert kinbody.GetJoint("off").GetDOFIndex() == -1


def test_reopened_body_is_measured(load):
    """A link that is turned about the axis after its joint was made starts at that angle."""
    kinbody = load(
        body("A")
        + body("B", 1)
        + hinge("j", "A", "B")
        + '<Body name="B"><RotationAxis>0 0 1 30</RotationAxis><Translation>-1 0 0</Translation></Body>'
    )
    assert kinbody.GetDOFValues() == pytest.approx([math.pi / 6])
