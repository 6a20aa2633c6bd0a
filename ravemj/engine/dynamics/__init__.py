"""Velocities, derivatives and dynamics of one body in its present configuration.

``tree`` contains the tree of joints, ``coupling`` the relation of velocities to DOFs, and ``body`` calls MuJoCo's
functions with both.
"""

from ravemj.engine.dynamics.body import BodyDynamics
from ravemj.engine.dynamics.coupling import Coupling, CouplingMap, first_values, rotation_rate
from ravemj.engine.dynamics.tree import NONE, CoordinateTree

__all__ = ["NONE", "BodyDynamics", "CoordinateTree", "Coupling", "CouplingMap", "first_values", "rotation_rate"]
