"""``openravepy.misc``: what scripts need beside the API."""

from ravemj.geometry_functions.solids import TSP, ComputeBoxMesh, ComputeCylinderYMesh, ComputeGeodesicSphereMesh
from ravemj.misc.drawing import DrawAxes, DrawCircle, DrawIkparam, DrawIkparam2
from ravemj.misc.sampling import SpaceSamplerExtra
from ravemj.misc.scripts import (
    InitOpenRAVELogging,
    LoadTrajectoryFromFile,
    OpenRAVEGlobalArguments,
    SetViewerUserThread,
    mkdir_recursive,
    myproduct,
)

__all__ = [
    "TSP",
    "ComputeBoxMesh",
    "ComputeCylinderYMesh",
    "ComputeGeodesicSphereMesh",
    "DrawAxes",
    "DrawCircle",
    "DrawIkparam",
    "DrawIkparam2",
    "InitOpenRAVELogging",
    "LoadTrajectoryFromFile",
    "OpenRAVEGlobalArguments",
    "SetViewerUserThread",
    "SpaceSamplerExtra",
    "mkdir_recursive",
    "myproduct",
]
