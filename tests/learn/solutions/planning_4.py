"""planning-4: Which waypoints of a path are needed?

Given is a path, shape (n, 2), and a function: `is_free(a, b)` tells whether the straight line from a to b is free.
The lines between neighbours are. Shorten the path: begin at the first waypoint, go straight to the last waypoint that
can be reached from there on a free line, and so on from that, up to the end. Return the waypoints that are left, in
order.

If all lines are free, only the first and the last waypoint are left.

By hand: numpy's functions are enough.
"""

import numpy as np


def shortened(path, is_free):
    """Return the waypoints that are left, shape (m, 2)."""
    kept = [0]
    while kept[-1] < len(path) - 1:
        here = kept[-1]
        kept.append(max(k for k in range(here + 1, len(path)) if is_free(path[here], path[k])))
    return path[kept]
