"""Gains of position servos from the inertias and loads of a robot's motors."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from ravemj.core.transforms import Floats
from ravemj.engine.dynamics.coupling import Coupling, CouplingMap
from ravemj.engine.dynamics.tree import CoordinateTree
from ravemj.engine.kinematics import BodyKinematics
from ravemj.formats.mjcf import legal_inertial
from ravemj.model.bounds import link_bounds
from ravemj.model.gains import Gains
from ravemj.model.scene import AXES, KinBody

TIMESTEP = 0.002
"""MuJoCo's time step [s]."""

FREQUENCY = 60.0
"""Minimum natural frequency of a servo [rad/s]."""

SAG = 0.005
"""Maximum sag under gravity [rad]; for sliders a tenth of it [m]."""

STEP = 0.1
"""Step that servos follow without overshoot [rad]; for sliders a tenth of it [m]."""

POSES = 32
"""Number of random configurations, besides the start, in which inertias and loads are measured."""

_FARTHEST = 2.0
"""Maximum distance of sampled slider positions from the start pose [m], since some limits are kilometres."""

_FOOT = 0.02
"""Height above the lowest point of a standing robot [m] below which a link is a foot."""


class ServoLoads(NamedTuple):
    """Inertia and load of each DOF's motor; arrays of shape (dof,).

    Attributes:
        inertia: Largest inertia [kg m^2 or kg].
        torque: Largest torque of gravity [N m or N].
        friction: Torque of dry friction [N m or N].
        start: Torque of gravity at the start pose [N m or N].
        effort: Largest torque of the motor [N m or N]; infinite if it is unknown.
        slides: Whether the DOF slides.
    """

    inertia: Floats
    torque: Floats
    friction: Floats
    start: Floats
    effort: Floats
    slides: NDArray[np.bool_]


def servo_gains(loads: ServoLoads, timestep: float = TIMESTEP, stiffness: Floats | None = None) -> Gains:
    """Return gains with which servos hold a robot against gravity and follow steps without overshoot.

    A DOF of inertia M, loaded with the torque T, is a mass on a spring of stiffness kp with a damper kv:

    * It sags by ``T / kp``, stops within ``D / kp`` of its target with the dry friction D, and has the natural
      frequency ``sqrt(kp / M)``. So ``kp = max(M w^2, (T + D) / sag)`` with w = 60 rad/s, and 5 mrad (0.5 mm) of sag.
    * Critical damping is ``2 sqrt(kp M')``, where M' is M plus the armature. After a step s the motor is at its limit
      E; gravity leaves ``F = max(E - T, E / 5)`` to brake. Halfway, the speed is at most ``sqrt(s F / M')``, and the
      damper has to reverse the torque: ``kv sqrt(s F / M') >= kp s / 2``, which ``kv = kp sqrt(s M' / (2 F))`` does
      with a margin. The larger kv is taken: ``kv = b sqrt(M')``.
    * A simulation with the time step h cannot represent motions faster than ``1 / h``. If axes are aligned, one of them
      moves far less inertia than M, since the others give way. An armature, as of a rotor behind a gear, is a lower
      bound of the inertia. With ``kp (2 h)^2`` no mode is faster than ``1 / (2 h)``. With ``kv h / 2`` a motor at its
      limit cannot change the speed from ``E / kv`` to less than ``-E / kv`` in one step and back in the next,
      endlessly. That is ``a = (b h / 2) sqrt(M + a)``, a quadratic equation. The larger armature is taken.

    M and T include the mimic joints of the DOF.

    Args:
        loads: Inertias, loads and efforts.
        timestep: Time step of the simulation [s].
        stiffness: Given stiffnesses [N m/rad or N/m], shape (dof,); NaN selects the rule above.

    Returns:
        Stiffness [N m/rad or N/m], damping [N m s/rad or N s/m] and armature [kg m^2 or kg] of each DOF.

    Example:
        >>> import numpy as np
        >>> from ravemj.engine.servo_gains import ServoLoads, servo_gains
        >>> one, none = np.ones(1), np.zeros(1)
        >>> servo_gains(ServoLoads(one, none, none, none, np.full(1, np.inf), none > 0)).kp
        array([3600.])
    """
    scale = np.where(loads.slides, 0.1, 1.0)
    kp = np.maximum(loads.inertia * FREQUENCY**2, (loads.torque + loads.friction) / (SAG * scale))
    if stiffness is not None:
        kp = np.where(np.isnan(stiffness), kp, stiffness)
    left = np.maximum(loads.effort - loads.torque, loads.effort / 5)
    ratio = np.maximum(2 * np.sqrt(kp), kp * np.sqrt(STEP * scale / (2 * left)))
    square = (ratio * timestep / 2) ** 2
    armature = np.maximum(kp * (2 * timestep) ** 2, square / 2 + np.sqrt(square**2 / 4 + square * loads.inertia))
    return Gains(kp, ratio * np.sqrt(loads.inertia + armature), armature)


def loads_of(body: KinBody, start: Floats, gravity: Sequence[float], *, stands: bool = False) -> ServoLoads:
    """Measure the loads of a body at its start pose and random poses within its limits, with its base fixed.

    Args:
        body: The body.
        start: Joint values of the start pose [rad or m], shape (dof,).
        gravity: Gravitational acceleration [m/s^2].
        stands: Whether the base is free, so that the feet support the body's weight at the start pose.
    """
    legal = replace(body, links=tuple(replace(link, inertial=legal_inertial(link.inertial)) for link in body.links))
    kinematics = BodyKinematics(legal)
    tree = CoordinateTree(kinematics)
    couplings = CouplingMap(kinematics, tree)
    kinematics.model.opt.gravity[:] = gravity
    axes = body.dof_axes
    inertia, torque, first = np.zeros(len(axes)), np.zeros(len(axes)), np.zeros(len(axes))
    for number, values in enumerate(_poses(body, start)):
        kinematics.set_values(values)
        coupling = couplings.at(values, second=False)
        mass, load = _measured(kinematics, coupling)
        inertia, torque = np.maximum(inertia, mass), np.maximum(torque, load)
        if number == 0:
            first = load
            if stands:
                mass, load = _standing(kinematics, coupling, legal, gravity)
                inertia, torque = np.maximum(inertia, mass), np.maximum(torque, load)
    inertia += [axis.armature for axis in axes]
    friction = np.array([axis.coulomb_friction for axis in axes])
    effort = np.array([axis.max_torque or np.inf for axis in axes])
    return ServoLoads(inertia, torque, friction, first, effort, _slides(body))


def _slides(body: KinBody) -> NDArray[np.bool_]:
    """Return for each DOF whether it is prismatic."""
    return np.array([letter == "P" for joint in body.joints for letter in AXES[joint.kind]], dtype=bool)


def _poses(body: KinBody, start: Floats) -> Iterator[Floats]:
    """Yield the start pose, then random poses within the limits and near the start; the same at each call."""
    yield start
    reach = [(-np.pi, np.pi) if axis.circular else (axis.lower, axis.upper) for axis in body.dof_axes]
    lower, upper = np.array(reach).reshape(-1, 2).T
    near = np.where(_slides(body), _FARTHEST, np.inf)
    lower, upper = np.maximum(lower, start - near), np.minimum(upper, start + near)
    yield from np.random.default_rng(0).uniform(lower, np.maximum(lower, upper), (POSES, len(reach)))


def _measured(kinematics: BodyKinematics, coupling: Coupling) -> tuple[Floats, Floats]:
    """Return the effective inertia of each DOF, and the magnitude of its gravity torque."""
    model, data = kinematics.model, kinematics.data
    kinematics.place_coms()
    full, bias = np.zeros((model.nv, model.nv)), np.zeros(model.nv)
    mujoco.mj_crb(model, data)
    mujoco.mj_fullM(model, data, full)
    mujoco.mj_rne(model, data, 0, bias)
    inner = np.arange(model.nv)[kinematics.inner_qvel]
    mass = coupling.backward(coupling.backward(full[np.ix_(inner, inner)]).T)
    return np.diag(mass).copy(), np.abs(coupling.backward(bias[inner]))


def _standing(
    kinematics: BodyKinematics, coupling: Coupling, body: KinBody, gravity: Sequence[float]
) -> tuple[Floats, Floats]:
    """Return inertia and torque of each DOF due to the robot's weight if half of the feet carry it, as in a trot."""
    transforms = kinematics.link_transforms()
    bounds = [link_bounds(link, T_world_link) for link, T_world_link in zip(body.links, transforms, strict=True)]
    lows = [np.inf if extent is None else extent.low[2] for extent in bounds]
    feet = [index for index, low in enumerate(lows) if np.isfinite(low) and low <= min(lows) + _FOOT]
    inertia, torque = np.zeros(kinematics.dof), np.zeros(kinematics.dof)
    mass = sum(link.inertial.mass for link in body.links) / max(len(feet) // 2, 1)
    jacobian = np.zeros((3, kinematics.model.nv))
    inner = np.arange(kinematics.model.nv)[kinematics.inner_qvel]
    for foot in feet:
        box = bounds[foot]
        if box is not None:
            point = np.array([*(box.low + box.high)[:2] / 2, box.low[2]])
            mujoco.mj_jac(kinematics.model, kinematics.data, jacobian, None, point, int(kinematics.body_ids[foot]))
            by_dof = coupling.backward(jacobian[:, inner].T)
            torque = np.maximum(torque, np.abs(by_dof @ np.asarray(gravity)) * mass)
            inertia = np.maximum(inertia, (by_dof**2).sum(axis=1) * mass)
    return inertia, torque
