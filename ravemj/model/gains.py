"""Servo gains."""

from typing import NamedTuple

from ravemj.core.transforms import Floats


class Gains(NamedTuple):
    """Servo gains of a body's DOFs; arrays of shape (dof,).

    Attributes:
        kp: Stiffness [N m/rad or N/m].
        kv: Damping [N m s/rad or N s/m].
        armature: Inertia of the rotor at the joint, in addition to that of the model [kg m^2 or kg].
    """

    kp: Floats
    kv: Floats
    armature: Floats

    def row(self, dof: int) -> tuple[float, float, float]:
        """Return stiffness, damping and armature of one DOF, in six digits."""
        kp, kv, armature = (float(f"{numbers[dof]:.6g}") for numbers in self)
        return kp, kv, armature
