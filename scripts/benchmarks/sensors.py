"""Sensors: rays of lasers and of scripts."""

import math

import mujoco
import numpy as np

import ravemj
from benchmarks.measure import ROOT, Row, microseconds, take_turns

_RAYS = 1000
_GROUPS = np.ones(6, dtype=np.uint8)


def rows() -> list[Row]:
    """Compare a laser in the workshop with the ``mj_multiRay`` that it consists of."""
    env = ravemj.load(ROOT / "models" / "workshop.env.xml")
    env.StopSimulation()
    laser = ravemj.RaveCreateSensor(env, "BaseLaser2D")
    assert laser is not None
    geometry = laser.GetSensorGeometry()
    assert isinstance(geometry, ravemj.LaserGeomData)
    geometry.min_angle, geometry.max_angle = [-math.pi, 0], [math.pi * (1 - 2 / _RAYS), 0]
    geometry.resolution, geometry.max_range = [2 * math.pi / _RAYS, 0], 5.0
    laser.SetSensorGeometry(geometry)
    laser.SetTransform([1, 0, 0, 0, -0.45, 0.1, 0.75])
    laser.Configure(ravemj.Sensor.PowerOn)
    scan = laser.GetSensorData()
    assert len(scan.ranges) == _RAYS
    model, data, start = env.model, env.data, scan.positions[0]
    directions = (scan.ranges / np.linalg.norm(scan.ranges, axis=1, keepdims=True)).ravel()
    geoms, distances = np.empty(_RAYS, dtype=np.int32), np.empty(_RAYS)

    def bare() -> None:
        mujoco.mj_multiRay(
            model, data, start, directions, _GROUPS, True, -1, geoms, distances, None, _RAYS, geometry.max_range
        )

    rays = np.hstack([np.tile(start, (_RAYS, 1)), geometry.max_range * directions.reshape(-1, 3)])
    ours, cast, floor = take_turns(
        [
            microseconds(laser.GetSensorData, 10),
            microseconds(lambda: env.CheckCollisionRays(rays), 10),
            microseconds(bare, 10),
        ],
        100,
    )
    what = f"of {_RAYS} rays in the workshop : mj_multiRay"
    return [
        Row(f"GetSensorData of a laser {what}", "µs", ours, floor, 1.5),
        Row(f"CheckCollisionRays {what}", "µs", cast, floor, note="with normals"),
    ]
