"""Reachability: the poses that an arm reaches."""

from ravemj.compat.databases.model import DatabaseGenerator
from ravemj.compat.refusal import lacking, refusing

REACH = "maps of what arms reach"


@lacking(
    REACH,
    """
    ComputeNN(translationonly) LoadHDF5() LoadPickle() SaveHDF5() SavePickle()
    UniformlySampleSpace(maxradius delta) getOrderedArmJoints()
    generate(maxradius translationonly xyzdelta quatdelta usefreespace)
    generatepcg(maxradius translationonly xyzdelta quatdelta usefreespace)
    show(showrobot contours opacity figureid xrange options) @getManipulatorLinks(manip)
    """,
)
class ReachabilityModel(DatabaseGenerator):
    """Set of poses that an arm reaches."""

    capability = REACH

    @lacking(
        REACH,
        "__init__(poses transmult) kSearch(poses k eps) kFRSearch(pose radiussq k eps) "
        "kFRSearchArray(poses radiussq k eps)",
    )
    class QuaternionKDTree:
        """Nearest-neighbour search among rotations."""

    reachability3d = None
    reachabilitystats = None
    xyzdelta = None


run = refusing("kinematicreachability.run", REACH, "*arguments **named")
