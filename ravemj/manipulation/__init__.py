"""Manipulation: arms, grippers and whole robots, combining collision checking, inverse kinematics and planning.

``bodies`` makes one configuration of what moves, and tests it; ``motions`` finds paths and ``processing`` makes timed
motions of them. ``arm_search`` finds joint values for a goal of the tool, tests them, and says why others are rejected;
``certification`` proves that motions are without collisions;
``tool`` has errors of the tool, and its constraints. Bodies are those of ``engine``; objects of OpenRAVE's API appear
in ``rave`` only.
"""
