"""Functions that OpenRAVE keeps apart: ``from ravemj import misc``."""

from ravemj.geometry_functions.solids import TSP, ComputeBoxMesh, ComputeCylinderYMesh, ComputeGeodesicSphereMesh

__all__ = ["TSP", "ComputeBoxMesh", "ComputeCylinderYMesh", "ComputeGeodesicSphereMesh"]
