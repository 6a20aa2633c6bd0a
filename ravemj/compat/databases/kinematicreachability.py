"""Which poses an arm reaches."""

from ravemj.compat.databases.model import DatabaseGenerator, lacking, refusing

REACH = "maps of what arms reach"


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
        "QuaternionKDTree": "poses transmult",
        "getManipulatorLinks": "manip",
    },
)
class ReachabilityModel(DatabaseGenerator):
    """Which poses an arm reaches."""

    reachability3d = None
    reachabilitystats = None
    xyzdelta = None


run = refusing("kinematicreachability.run", REACH, "*arguments **named")
