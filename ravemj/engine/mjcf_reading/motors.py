"""Torque limits of joints, from the joints and from the actuators that drive them."""

import mujoco
import numpy as np

_JOINT = {int(mujoco.mjtTrn.mjTRN_JOINT), int(mujoco.mjtTrn.mjTRN_JOINTINPARENT)}
_FIXED_GAIN, _NO_BIAS = int(mujoco.mjtGain.mjGAIN_FIXED), int(mujoco.mjtBias.mjBIAS_NONE)


def joint_torques(model: mujoco.MjModel) -> list[float]:
    """Return the torque or force limit of each joint [N m or N]; 0 if the model has none.

    It is the smaller of the joint's limit and that of its strongest actuator. An actuator's limit is its force limit,
    or the control limit of a motor, times the gear.
    """
    given = [0.0] * model.njnt
    for index in range(model.nu):
        if int(model.actuator_trntype[index]) in _JOINT:
            joint = int(model.actuator_trnid[index, 0])
            given[joint] = max(given[joint], _strength(model, index))
    for joint in range(model.njnt):
        if model.jnt_actfrclimited[joint]:
            own = float(np.abs(model.jnt_actfrcrange[joint]).max())
            given[joint] = min(own, given[joint] or own)
    return given


def _strength(model: mujoco.MjModel, index: int) -> float:
    """Return the maximum torque or force of an actuator on its joint; 0 without a limit."""
    gear = float(abs(model.actuator_gear[index, 0]))
    if model.actuator_forcelimited[index]:
        return gear * float(np.abs(model.actuator_forcerange[index]).max())
    is_motor = model.actuator_gaintype[index] == _FIXED_GAIN and model.actuator_biastype[index] == _NO_BIAS
    if is_motor and model.actuator_ctrllimited[index]:
        gain = float(abs(model.actuator_gainprm[index, 0]))
        return gear * gain * float(np.abs(model.actuator_ctrlrange[index]).max())
    return 0.0
