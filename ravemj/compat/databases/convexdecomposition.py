"""Convex parts of the links; MuJoCo makes its own hulls."""

from ravemj.compat.databases.model import DatabaseGenerator, refusing
from ravemj.rave.robot import Robot

PARTS = "files of convex parts"


class ConvexDecompositionError(Exception):
    """Convex parts could not be made."""

    def __init__(self, msg: str = "") -> None:
        super().__init__(msg)
        self.msg = msg

    def __str__(self) -> str:
        return str(self.msg)


class ConvexDecompositionModel(DatabaseGenerator):
    """Convex parts of the links, which need no computing here: collisions use hulls anyway.

    Args:
        robot: The robot.
        padding: For OpenRAVE.
    """

    def __init__(self, robot: Robot, padding: float = 0.0) -> None:
        del padding
        super().__init__(robot)

    capability = PARTS

    def load(self) -> bool:
        """Return whether there is something to use: True."""
        return True

    def autogenerate(self, options: object = None) -> None:
        """Do nothing."""

    def save(self, params: object = None) -> None:
        """Do nothing."""

    ComputeHullPlanes = staticmethod(refusing("ComputeHullPlanes", PARTS, "hull thresh"))
    ComputePaddedConvexDecompositionFromTriMesh = refusing(
        "ComputePaddedConvexDecompositionFromTriMesh", PARTS, "self trimesh padding"
    )
    ComputePaddedConvexHullFromTriMesh = refusing("ComputePaddedConvexHullFromTriMesh", PARTS, "self trimesh padding")
    CreateOptionParser = staticmethod(refusing("CreateOptionParser", PARTS, ""))
    GenerateTrimeshFromHulls = staticmethod(refusing("GenerateTrimeshFromHulls", PARTS, "hulls"))
    GetGeometryInfosFromLink = refusing("GetGeometryInfosFromLink", PARTS, "self ilink preservetransform color")
    LoadHDF5 = refusing("LoadHDF5", PARTS, "self")
    LoadPickle = refusing("LoadPickle", PARTS, "self")
    PadMesh = staticmethod(
        refusing(
            "ConvexDecompositionModel.PadMesh",
            PARTS,
            "vertices indices padding mergeDuplicated rtol atol setNormalsAwayFromCenter",
        )
    )
    RunFromParser = staticmethod(refusing("RunFromParser", PARTS, "Model parser args **named"))
    SaveHDF5 = refusing("SaveHDF5", PARTS, "self")
    SavePickle = refusing("SavePickle", PARTS, "self")
    ShowLink = refusing("ShowLink", PARTS, "self ilink progressive")
    generate = refusing("generate", PARTS, "self padding minTriangleConvexHullThresh convexHullLinks **named")
    getfilename = refusing("getfilename", PARTS, "self read")
    getversion = refusing("getversion", PARTS, "self")
    setrobot = refusing("setrobot", PARTS, "self")
    show = refusing("show", PARTS, "self options")
    testPointsInside = refusing("testPointsInside", PARTS, "self points")
    transformHull = staticmethod(refusing("transformHull", PARTS, "T hull"))


run = refusing("convexdecomposition.run", PARTS, "*arguments **named")
