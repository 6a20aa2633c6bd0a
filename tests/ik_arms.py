"""Arms for the tests of inverse kinematics: known ones, and random ones of each family."""

from dataclasses import replace

import numpy as np

from ravemj.ik.chain import Chain

RIGHT = np.pi / 2


def from_dh(rows, **more):
    """A chain by Denavit's and Hartenberg's (d, a, alpha); revolute joints only."""
    T, axes, points = np.eye(4), [], []
    for d, a, alpha in rows:
        axes.append(T[:3, 2])
        points.append(T[:3, 3])
        c, s = np.cos(alpha), np.sin(alpha)
        T = T @ np.array([[1, 0, 0, a], [0, c, -s, 0], [0, s, c, d], [0, 0, 0, 1]])
    return Chain.of(axes, points, T_base_tool=T, **more)


def from_craig(rows, tool=0.2):
    """A chain by Craig's (a, d, alpha), each of which comes before its joint."""
    T, axes, points = np.eye(4), [], []
    for a, d, alpha in rows:
        c, s = np.cos(alpha), np.sin(alpha)
        T = T @ np.array([[1, 0, 0, a], [0, c, -s, -s * d], [0, s, c, c * d], [0, 0, 0, 1]])
        axes.append(T[:3, 2])
        points.append(T[:3, 3])
    T = T.copy()
    T[:3, 3] += T[:3, 2] * tool
    return Chain.of(axes, points, T_base_tool=T)


def from_steps(axes, steps, *, rise, tool):
    """A stretched arm along x, whose axes are named; the second one and those behind it stand higher than the first."""
    points = np.cumsum([steps, np.zeros(len(steps)), [0, rise, *[0] * (len(steps) - 2)]], axis=1).T
    T = np.eye(4)
    T[:3, 3] = points[-1] + [tool, 0, 0]
    directions = [np.eye(3)["xyz".index(axis)] for axis in axes]
    return Chain.of(
        directions,
        points,
        T_base_tool=T,
        lower=[-1.6056, -1.221, -np.pi, -2.251, -np.pi, -2.16, -np.pi],
        upper=[1.6056, 1.518, np.pi, 2.251, np.pi, 2.16, np.pi],
        circular=[False, False, True, False, True, False, True],
    )


PUMA = from_dh(
    [(0.6718, 0, RIGHT), (0, 0.4318, 0), (0.15005, 0.0203, -RIGHT), (0.4318, 0, RIGHT), (0, 0, -RIGHT), (0.1, 0, 0)]
)
UR5 = from_dh(
    [
        (0.089159, 0, RIGHT),
        (0, -0.425, 0),
        (0, -0.39225, 0),
        (0.10915, 0, RIGHT),
        (0.09465, 0, -RIGHT),
        (0.0823, 0, 0),
    ]
)
PANDA = from_craig(
    [
        (0, 0.333, 0),
        (0, 0, -RIGHT),
        (0, 0.316, RIGHT),
        (0.0825, 0, RIGHT),
        (-0.0825, 0.384, -RIGHT),
        (0, 0, RIGHT),
        (0.088, 0, RIGHT),
    ]
)
WAM = from_dh(
    [
        (0, 0, -RIGHT),
        (0, 0, RIGHT),
        (0.55, 0.045, -RIGHT),
        (0, -0.045, RIGHT),
        (0.3, 0, -RIGHT),
        (0, 0, RIGHT),
        (0.06, 0, 0),
    ]
)
PANDA_LIMITED = replace(
    PANDA,
    lower=np.array([-2.8973, -1.7628, -2.8973, -3.0718, -2.8973, -0.0175, -2.8973]),
    upper=np.array([2.8973, 1.7628, 2.8973, -0.0698, 2.8973, 3.7525, 2.8973]),
)
WAM_LIMITED = replace(
    WAM,
    lower=np.array([-2.6, -2.0, -2.8, -0.9, -4.76, -1.6, -3.0]),
    upper=np.array([2.6, 2.0, 2.8, 3.1, 1.24, 1.6, 3.0]),
)
_IIWA_LIMITS = np.radians([170, 120, 170, 120, 170, 120, 175])
IIWA = from_dh(
    [
        (0.36, 0, -RIGHT),
        (0, 0, RIGHT),
        (0.42, 0, RIGHT),
        (0, 0, -RIGHT),
        (0.4, 0, -RIGHT),
        (0, 0, RIGHT),
        (0.126, 0, 0),
    ],
    lower=-_IIWA_LIMITS,
    upper=_IIWA_LIMITS,
)
OFFSET_SHOULDER = from_steps("zyxyxyx", [0, 0.117, 0.219, 0.133, 0.197, 0.1245, 0.1385], rise=0.06, tool=0.1)
"""Seven joints, the first of which stands before the others."""


def unit(rng, across=None):
    """A random direction, or one at right angles to another."""
    vector = rng.normal(size=3)
    if across is not None:
        vector = np.cross(across, vector)
    return vector / np.linalg.norm(vector)


def pose(rng):
    """A random pose."""
    T = np.eye(4)
    T[:3, :3] = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    if np.linalg.det(T[:3, :3]) < 0:
        T[:3, 0] *= -1
    T[:3, 3] = rng.uniform(-1, 1, 3)
    return T


def arm(rng, kinds):
    """A random arm of parts, one letter or more for each.

    R a revolute joint, P a prismatic one; S three axes through a point, X two; L three parallel axes, = two; and in
    groups of a plane l (revolute) and p (prismatic across the last l).
    """
    axes, points, prismatic = [], [], []
    normal = unit(rng)
    for kind in kinds:
        count = {"S": 3, "X": 2, "L": 3, "=": 2}.get(kind, 1)
        place, axis = rng.uniform(-1, 1, 3), unit(rng)
        for _ in range(count):
            if kind in "SX":
                axis = unit(rng)
            elif kind in "L=":
                place = rng.uniform(-1, 1, 3)
            axes.append(unit(rng, normal) if kind == "p" else normal if kind == "l" else axis)
            points.append(rng.uniform(-1, 1, 3) if kind in "lp" else place)
            prismatic.append(kind in "Pp")
    return Chain.of(axes, points, prismatic=prismatic, T_base_tool=pose(rng))


KINDS = (
    # a spherical wrist at the end, at the start, in between
    *("RRRS", "SRRR", "RSRR", "RRSR", "XRS", "RXS", "=RS", "R=S", "SX" + "R", "S=R", "PRRS", "RPRS", "RRPS", "PPRS"),
    *("PRPS", "RPPS", "PPPS", "SPRR", "SRPR", "SRRP", "RSPR", "PSRR", "PRSP", "SPPP", "PSPR"),
    # three parallel axes, or prismatic joints across two, anywhere
    *("LRRR", "RLRR", "RRLR", "RRRL", "LRX", "RLX", "XLR", "LXR", "lplRRR", "RllpRR", "RRpllR", "RRRlpp", "plpRRR"),
    *("RpplRR", "LPRR", "LRPR", "RLPR", "RRLP", "PRRL"),
    # three prismatic joints
    *("PRPRPR", "RPRPRP", "PPRRPR"),
    # fewer joints
    *("XRX", "RRXR", "R=RR", "XRR", "=PRR", "LRR", "RLR", "SRR", "RSR", "RRS", "PRXR", "SPR", "PPS", "LPR", "lpRRR"),
    *("RRRR", "RRPR", "PRRR", "XRR", "=RR", "LR", "SR", "PPPR", "PRPR", "RPPR", "llPl", "lllP", "PS", "LP", "RPRP"),
    *("RRR", "S", "L", "PPP", "RPR", "PRR", "RRP", "XR", "=R", "lpl", "plp", "lpp", "ppl", "RPP", "PP", "RR", "RP"),
    *("=", "X", "R", "P"),
)
