"""Which poses an arm reaches."""

from ravemj.compat.databases.model import DatabaseGenerator, lacking, refusing
from ravemj.errors import UnsupportedError

REACH = "maps of what arms reach"


class QuaternionKDTree:
    """Finds the poses that are near others; refuses to be made, since maps of what arms reach are not built.

    Args:
        poses: The poses.
        transmult: Weight of distances beside angles.
    """

    def __init__(self, poses: object, transmult: object) -> None:
        raise UnsupportedError("ReachabilityModel.QuaternionKDTree", REACH)

    kSearch = refusing("QuaternionKDTree.kSearch", REACH, "self poses k eps")
    kFRSearch = refusing("QuaternionKDTree.kFRSearch", REACH, "self pose radiussq k eps")
    kFRSearchArray = refusing("QuaternionKDTree.kFRSearchArray", REACH, "self poses radiussq k eps")


@lacking(
    REACH,
    {
        "ComputeNN": "translationonly",
        "LoadHDF5": "",
        "LoadPickle": "",
        "SaveHDF5": "",
        "SavePickle": "",
        "UniformlySampleSpace": "maxradius delta",
        "generatepcg": "maxradius translationonly xyzdelta quatdelta usefreespace",
        "getOrderedArmJoints": "",
        "show": "showrobot contours opacity figureid xrange options",
    },
    static={
        "getManipulatorLinks": "manip",
    },
)
class ReachabilityModel(DatabaseGenerator):
    """Which poses an arm reaches."""

    QuaternionKDTree = QuaternionKDTree
    reachability3d = None
    reachabilitystats = None
    xyzdelta = None


run = refusing("kinematicreachability.run", REACH, "*arguments **named")
