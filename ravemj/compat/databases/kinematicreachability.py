"""Which poses an arm reaches."""

from ravemj.compat.databases.model import DatabaseGenerator
from ravemj.compat.refusal import lacking, refusing

REACH = "maps of what arms reach"


@lacking(
    REACH,
    """
    ComputeNN(translationonly) LoadHDF5() LoadPickle() SaveHDF5() SavePickle()
    UniformlySampleSpace(maxradius delta) getOrderedArmJoints()
    generatepcg(maxradius translationonly xyzdelta quatdelta usefreespace)
    show(showrobot contours opacity figureid xrange options) @getManipulatorLinks(manip)
    """,
)
class ReachabilityModel(DatabaseGenerator):
    """Which poses an arm reaches."""

    capability = REACH

    @lacking(
        REACH,
        "__init__(poses transmult) kSearch(poses k eps) kFRSearch(pose radiussq k eps) "
        "kFRSearchArray(poses radiussq k eps)",
    )
    class QuaternionKDTree:
        """Finds the poses that are near others."""

    reachability3d = None
    reachabilitystats = None
    xyzdelta = None


run = refusing("kinematicreachability.run", REACH, "*arguments **named")
