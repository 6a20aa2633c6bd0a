"""What ``scripts/bench`` measures: one module for each area, with a function that returns rows.

A new area is a module with such a function, and a line in ``AREAS``.
"""

from collections.abc import Callable

from benchmarks import (
    calls,
    certificates,
    collada,
    collision,
    drawing,
    dynamics,
    grasps,
    grazing,
    growth,
    ik,
    imports,
    kinematics,
    loading,
    memory,
    narrow_planning,
    page,
    planning,
    reading,
    regions,
    robots,
    sensors,
    video,
    viewer,
    whole_body,
    window,
)
from benchmarks.measure import Row

AREAS: dict[str, Callable[[], list[Row]]] = {
    "calls": calls.rows,
    "kinematics": kinematics.rows,
    "dynamics": dynamics.rows,
    "collision": collision.rows,
    "ik": ik.rows,
    "whole_body": whole_body.rows,
    "planning": planning.rows,
    "certificates": certificates.rows,
    "grasps": grasps.rows,
    "grazing": grazing.rows,
    "narrow": narrow_planning.rows,
    "regions": regions.rows,
    "loading": loading.rows,
    "reading": reading.rows,
    "collada": collada.rows,
    "robots": robots.rows,
    "growth": growth.rows,
    "imports": imports.rows,
    "sensors": sensors.rows,
    "video": video.rows,
    "viewer": viewer.rows,
    "page": page.rows,
    "drawing": drawing.rows,
    "memory": memory.rows,
    "window": window.rows,
}
