"""Motions without collisions, and times for them.

``space`` says what a configuration is: limits, distances, ways round. ``edges`` tests straight lines and finds what is
allowed nearby, ``trees``, ``rrt`` and ``randomized_astar`` find paths of lines, ``shortcuts`` shortens them;
``ompl_search`` asks OMPL. ``retiming`` gives paths times, ``ramps`` and ``ramp_shortcuts`` make motions of constant
accelerations faster, and ``verification`` looks at every moment of the result. Arrays and functions in, arrays out:
what collides is asked of a function.
"""
