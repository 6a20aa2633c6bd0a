"""Timing of paths: each retimer determines the duration of a segment, and the motion on it.

``segments.retime`` times segment by segment; ``polynomials`` contains the retimers (lines, parabolas, cubic and quintic
polynomials, limited jerk), with OpenRAVE's times. ``topp_ra`` passes the waypoints without stops.
"""
