"""Velocities, derivatives and dynamics of one body in its present configuration.

``tree`` knows which joint carries which, ``coupling`` how velocities follow the DOFs, ``rows`` reads what MuJoCo writes
off by DOF, and ``body`` calls MuJoCo's functions with all three.
"""

from ravemj.engine.dynamics.body import BodyDynamics
from ravemj.engine.dynamics.coupling import Coupling, CouplingMap, first_values, rotation_rate
from ravemj.engine.dynamics.tree import NONE, Tree

__all__ = ["NONE", "BodyDynamics", "Coupling", "CouplingMap", "Tree", "first_values", "rotation_rate"]
