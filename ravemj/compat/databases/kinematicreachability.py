"""Which poses an arm reaches."""

from ravemj.compat.databases.model import DatabaseGenerator, refusing

REACH = "maps of what arms reach"


class ReachabilityModel(DatabaseGenerator):
    """Which poses an arm reaches."""

    capability = REACH

    ComputeNN = refusing("ComputeNN", REACH, "self translationonly")
    LoadHDF5 = refusing("LoadHDF5", REACH, "self")
    LoadPickle = refusing("LoadPickle", REACH, "self")
    QuaternionKDTree = staticmethod(refusing("QuaternionKDTree", REACH, "poses transmult"))
    SaveHDF5 = refusing("SaveHDF5", REACH, "self")
    SavePickle = refusing("SavePickle", REACH, "self")
    UniformlySampleSpace = refusing("UniformlySampleSpace", REACH, "self maxradius delta")
    generatepcg = refusing("generatepcg", REACH, "self maxradius translationonly xyzdelta quatdelta usefreespace")
    getManipulatorLinks = staticmethod(refusing("getManipulatorLinks", REACH, "manip"))
    getOrderedArmJoints = refusing("getOrderedArmJoints", REACH, "self")
    reachability3d = None
    reachabilitystats = None
    show = refusing("show", REACH, "self showrobot contours opacity figureid xrange options")
    xyzdelta = None


run = refusing("kinematicreachability.run", REACH, "*arguments **named")
