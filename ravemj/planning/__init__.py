"""Collision-free motions and their timing.

``space`` defines configurations: limits, distances, circular values. ``edges`` tests straight lines and finds allowed
configurations nearby; ``rrt`` and ``randomized_astar`` find paths of straight lines, and ``shortcuts`` shortens them;
``ompl_search`` runs OMPL. ``retiming`` times paths, ``ramps`` and ``shortcuts`` make motions of constant accelerations
faster, and ``verification`` checks the result at all times. Input and output are arrays and functions; a function tests
collisions.
"""
