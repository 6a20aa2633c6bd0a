"""Manipulation: arms, grippers and whole robots, combining collision checking, inverse kinematics and planning.

``bodies`` combines the moving DOFs into one configuration and tests it; ``motions`` plans paths; ``processing`` turns
them into timed motions. ``arm_search`` finds collision-free joint values for a goal of the tool, and reports why
others are rejected; ``certification`` proves that motions are collision-free; ``tool`` computes errors of the tool,
and constrains it. Bodies are those of ``engine``; objects of OpenRAVE's API appear only in ``rave``.
"""
