"""Collision checking: exact tests of the pairs of shapes that OpenRAVE's questions are about."""
