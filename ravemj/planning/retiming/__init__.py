"""Times for paths: each kind of retimer says how long a segment takes, and how it is driven.

``segments.retime`` goes from waypoint to waypoint; ``linear``, ``parabolic``, ``polynomials`` and ``jerk_limited`` are
the kinds. The times are OpenRAVE's.
"""
