"""Bodies that a robot grabs and releases while it plays a trajectory: its groups ``grab``."""

from typing import NamedTuple

import numpy as np

from ravemj.trajectories.waypoints import Waypoints


class GrabChange(NamedTuple):
    """A body that is grabbed or released.

    Attributes:
        time: When, from the start of the trajectory [s].
        link: Index of the link that holds the body.
        body: ``GetEnvironmentBodyIndex()`` of the body; negative: it is released.
    """

    time: float
    link: int
    body: int


def grab_changes(waypoints: Waypoints, robot_name: str) -> list[GrabChange]:
    """Return what a trajectory grabs and releases, in the order of time.

    A group ``grab ROBOT LINK …`` has a value for each link of these indices: the index of a body to grab with it, the
    negative index of one to release, or 0 for no change.
    """
    times = waypoints.times()
    found: list[GrabChange] = []
    for group in waypoints.groups:
        if group.kind != "grab" or group.body != robot_name:
            continue
        links = [int(word) for word in group.name.split()[2:] if word.isdecimal()]
        bodies = waypoints.data[:, group.columns][:, : len(links)].round().astype(int)
        found += [
            GrabChange(float(times[row]), links[column], int(bodies[row, column]))
            for row, column in zip(*np.nonzero(bodies), strict=True)
        ]
    return sorted(found, key=lambda change: change.time)
