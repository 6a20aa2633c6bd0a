"""``openravepy.misc``: helper functions of scripts."""

from ravemj.compat.misc.arms import MultiManipIKSolver
from ravemj.compat.misc.comparing import CompareBodies, CompareEnvironments, sequence_cross_product
from ravemj.compat.misc.drawing import DrawAxes, DrawCircle, DrawIkparam, DrawIkparam2, DrawLabel
from ravemj.compat.misc.sampling import SpaceSamplerExtra
from ravemj.compat.misc.scripts import (
    InitOpenRAVELogging,
    LoadTrajectoryFromFile,
    OpenRAVEGlobalArguments,
    SetViewerUserThread,
    mkdir_recursive,
    myproduct,
)
from ravemj.core.api_object import published
from ravemj.geometry_functions.solids import TSP, ComputeBoxMesh, ComputeCylinderYMesh, ComputeGeodesicSphereMesh

__all__ = [
    "TSP",
    "CompareBodies",
    "CompareEnvironments",
    "ComputeBoxMesh",
    "ComputeCylinderYMesh",
    "ComputeGeodesicSphereMesh",
    "DrawAxes",
    "DrawCircle",
    "DrawIkparam",
    "DrawIkparam2",
    "DrawLabel",
    "InitOpenRAVELogging",
    "LoadTrajectoryFromFile",
    "MultiManipIKSolver",
    "OpenRAVEGlobalArguments",
    "SetViewerUserThread",
    "SpaceSamplerExtra",
    "mkdir_recursive",
    "myproduct",
    "sequence_cross_product",
]

for _name in __all__:
    globals()[_name] = published(globals()[_name], __name__)
