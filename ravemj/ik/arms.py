"""From a manipulator of a scene to a chain, and back to the DOFs of its body."""

from dataclasses import dataclass

import numpy as np

from ravemj.ik.chain import Chain
from ravemj.ik.vectors import Floats
from ravemj.joints import parent_child_pose
from ravemj.manipulators import chain as joints_between
from ravemj.scene import KinBody, Manipulator


class ArmError(ValueError):
    """A manipulator that is no chain of revolute and prismatic joints; the text says why, and what to do."""
