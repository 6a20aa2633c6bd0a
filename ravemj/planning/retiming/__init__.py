"""Times for paths: each kind of retimer says how long a segment takes, and how it is driven.

``segments.retime`` goes from waypoint to waypoint; ``polynomials`` has the kinds (lines, parabolas, cubic and quintic
polynomials, limited jerk), with OpenRAVE's times. ``topp_ra`` goes through the waypoints without a stop.
"""
