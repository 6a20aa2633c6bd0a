"""Torque limits of joints with motors: at rest and at speed, turning and sliding, from files and from infos."""

# ruff: noqa: SLF001 - names of OpenRAVE

import itertools
import math

import numpy as np
import pytest

import ravemj

FILE = """<Environment><KinBody name="k"><Body name="a"/><Body name="b"/>
<Joint name="j" type="{kind}"><Body>a</Body><Body>b</Body><axis>0 0 1</axis><limits>-9 9</limits><maxvel>1000</maxvel>
<maxtorque>10</maxtorque>{motor}</Joint></KinBody></Environment>"""
MOTOR = '<actuator type="electric_motor"><gear_ratio>{gear}</gear_ratio>{rest}</actuator>'
CURVE = ((1.0, 0.8), (3.0, 0.5), (3.0, 0.4), (5.0, 0.1))


def body(kind, motor=""):
    env = ravemj.Environment()
    assert env.LoadData(FILE.format(kind=kind, motor=motor))
    return env.GetKinBody("k")


def points(curve):
    return "".join(f"<max_speed_torque_point>{speed} {torque}</max_speed_torque_point>" for speed, torque in curve)


def limit(curve, turns):
    """The first point of the curve that is as fast decides, and the one before it."""
    if turns <= curve[0][0]:
        return curve[0][1]
    for (slow, much), (fast, little) in itertools.pairwise(curve):
        if turns <= fast:
            return little if fast == slow else much + (turns - slow) / (fast - slow) * (little - much)
    return curve[-1][1]


@pytest.mark.parametrize("kind", ["hinge", "slider"])
@pytest.mark.parametrize("gear", [0.5, 1.0, 50.0])
@pytest.mark.parametrize("curve", [CURVE[:1], CURVE[:2], CURVE])
@pytest.mark.parametrize("way", ["file", "info"])
def test_the_speed_decides(kind, gear, curve, way):
    made = body(kind, MOTOR.format(gear=gear, rest=points(curve)))
    if way == "info":
        env, info = made.GetEnv(), made.GetJoints()[0].GetInfo()
        links = [link.GetInfo() for link in made.GetLinks()]
        info._infoElectricMotor = ravemj.ElectricMotorActuatorInfo(gear_ratio=gear, max_speed_torque_points=curve)
        made = ravemj.RaveCreateKinBody(env, "")
        made.Init(links, [info])
        made.SetName("other")
        env.Add(made)
    joint, turn = made.GetJoints()[0], 2 * math.pi if kind == "hinge" else 1.0
    for turns in (0, 0.5, 1, 2, -2, 2.9, 4, -4.5, 5, 9):
        made.SetDOFVelocities([turns * turn / gear])
        expected = limit(curve, abs(turns)) * gear
        assert joint.GetMaxTorque() == pytest.approx(expected)
        assert joint.GetMaxTorque(0) == pytest.approx(expected)
        assert made.GetDOFMaxTorque() == pytest.approx([expected])
    assert joint.GetTorqueLimits().tolist() == made.GetDOFTorqueLimits().tolist() == [10]


@pytest.mark.parametrize("setter", ["joint", "body"])
def test_limits_that_are_set_are_those_of_the_joint(setter):
    made = body("hinge", MOTOR.format(gear=2, rest="<max_instantaneous_torque>3</max_instantaneous_torque>"))
    (made.GetJoints()[0].SetTorqueLimits if setter == "joint" else made.SetDOFTorqueLimits)([7])
    assert made.GetDOFTorqueLimits().tolist() == made.GetJoints()[0].GetTorqueLimits().tolist() == [7]
    assert made.GetDOFMaxTorque().tolist() == [6]
    free = body("hinge")
    (free.GetJoints()[0].SetTorqueLimits if setter == "joint" else free.SetDOFTorqueLimits)([7])
    assert free.GetDOFTorqueLimits().tolist() == free.GetDOFMaxTorque().tolist() == [7]


def test_a_motor_without_a_peak_torque():
    assert body("hinge", MOTOR.format(gear=2, rest="")).GetDOFMaxTorque().tolist() == [10]
    nominal = body("hinge", MOTOR.format(gear=2, rest="<nominal_torque>3</nominal_torque>"))
    assert nominal.GetDOFMaxTorque().tolist() == [6]
    assert nominal.GetDOFTorqueLimits().tolist() == [10]


def test_infos_keep_the_motor():
    made = body("hinge", MOTOR.format(gear=2, rest=points(CURVE) + "<viscous_friction>3</viscous_friction>"))
    info = made.GetJoints()[0].GetInfo()
    assert info._infoElectricMotor.viscous_friction == 3
    again = ravemj.RaveCreateKinBody(made.GetEnv(), "")
    again.Init([link.GetInfo() for link in made.GetLinks()], [info])
    again.SetName("again")
    made.GetEnv().Add(again)
    for speed in np.linspace(0, 20, 9):
        for one in (made, again):
            one.SetDOFVelocities([speed])
        assert again.GetDOFMaxTorque() == pytest.approx(made.GetDOFMaxTorque())
