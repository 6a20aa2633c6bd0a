"""Arms, grippers and whole robots: what joins collisions, inverse kinematics and planning.

``arm_search`` finds joint values for a goal of the tool, tests them, and says why others are rejected. Bodies are those
of ``engine``; objects of OpenRAVE's API appear in ``rave`` only.
"""
