"""Collision checking: exact tests of the pairs of shapes that OpenRAVE's queries are about."""
