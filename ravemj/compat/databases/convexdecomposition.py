"""Convex decomposition of links; MuJoCo computes its own hulls."""

from ravemj.compat.databases.model import DatabaseGenerator
from ravemj.compat.refusal import lacking, refusing
from ravemj.rave.robot import Robot

PARTS = "files of convex parts"


class ConvexDecompositionError(Exception):
    """Convex decomposition failed."""

    def __init__(self, msg: str = "") -> None:
        super().__init__(msg)
        self.msg = msg

    def __str__(self) -> str:
        return str(self.msg)


@lacking(
    PARTS,
    """
    ComputePaddedConvexDecompositionFromTriMesh(trimesh padding)
    ComputePaddedConvexHullFromTriMesh(trimesh padding)
    GetGeometryInfosFromLink(ilink preservetransform color) LoadHDF5() LoadPickle() SaveHDF5() SavePickle()
    ShowLink(ilink progressive) generate(padding minTriangleConvexHullThresh convexHullLinks **named)
    getfilename(read) getversion() setrobot() show(options) testPointsInside(points)
    @ComputeHullPlanes(hull thresh) @CreateOptionParser() @GenerateTrimeshFromHulls(hulls)
    @PadMesh(vertices indices padding mergeDuplicated rtol atol setNormalsAwayFromCenter)
    @RunFromParser(Model parser args **named) @transformHull(T hull)
    """,
)
class ConvexDecompositionModel(DatabaseGenerator):
    """Convex parts of the links, which need no computation: collisions use hulls anyway.

    Args:
        robot: The robot.
        padding: Not used.
    """

    capability = PARTS

    def __init__(self, robot: Robot, padding: float = 0.0) -> None:
        del padding
        super().__init__(robot)

    def load(self) -> bool:
        """Return True: the model is always available."""
        return True

    def autogenerate(self, options: object = None) -> None:
        """Do nothing."""

    def save(self, params: object = None) -> None:
        """Do nothing."""


run = refusing("convexdecomposition.run", PARTS, "*arguments **named")
