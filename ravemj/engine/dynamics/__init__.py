"""Velocities, derivatives and dynamics of one body, in one configuration or in many at once.

``tree`` knows which joint carries which, ``slopes`` how the joints follow the DOFs, ``posture`` does the mechanics, and
``body`` feeds it with the present state. Nothing here spans the rest of the world.
"""

from ravemj.engine.dynamics.body import BodyDynamics
from ravemj.engine.dynamics.posture import Inertias, Posture, cross
from ravemj.engine.dynamics.coupling import VelocityMap, first_values, rotation_rate
from ravemj.engine.dynamics.tree import Tree

__all__ = ["BodyDynamics", "Inertias", "Posture", "Tree", "VelocityMap", "cross", "first_values", "rotation_rate"]
