"""Arms, grippers and whole robots: what joins collisions, inverse kinematics and planning.

``bodies`` makes one configuration of what moves, and tests it; ``motions`` finds paths and ``processing`` makes timed
motions of them. ``arm_search`` finds joint values for a goal of the tool, tests them, and says why others are rejected;
``tool`` has errors of the tool, and its constraints. Bodies are those of ``engine``; objects of OpenRAVE's API appear
in ``rave`` only.
"""
