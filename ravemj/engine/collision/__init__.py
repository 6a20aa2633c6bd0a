"""Collision checking: exact tests of the shape pairs of OpenRAVE's queries."""
