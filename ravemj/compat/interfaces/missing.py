"""Helpers that ravemj does not have; their constructors raise ``UnsupportedError``, a ``NotImplementedError``."""

from ravemj.compat.refusal import lacking


@lacking("caging of handles", "__init__(robot plannername maxvelmult)")
class TaskCaging:
    """Opens doors by caging their handles."""


@lacking(
    "visual feedback",
    """
    __init__(robot maxvelmult ignoresensorcollision) ComputeVisibility(checkocclusion)
    ComputeVisibleConfiguration(pose)
    MoveToObserveTarget(affinedofs smoothpath planner sampleprob maxiter execute outputtraj)
    ProcessVisibilityExtents(numrolls transforms extents sphere conedirangles) SampleVisibilityGoal(numsamples)
    SetCameraAndTarget(sensorindex sensorname manipname convexdata sensorrobot targetlink targetgeomname raydensity)
    SetCameraTransforms(transforms mindist) SetParameter(raydensity raymindist allowableocclusion)
    VisualFeedbackGrasping(graspset usevisibility planner graspdistthresh visgraspthresh numgradientsamples maxiter
        execute outputtraj)
    clone(envother)
    """,
)
class VisualFeedback:
    """Moves a camera to where it sees an object."""


@lacking(
    "planning of grasps",
    """
    __init__(robot friction avoidlinks plannername) ConvexHull(points returnplanes returnfaces returntriangles)
    Grasp(direction roll position standoff target stablecontacts forceclosure transformrobot onlycontacttarget
        tightgrasp graspingnoise execute translationstepmult outputfinal manipulatordirection coarsestep finestep
        vintersectplane chuckingdirection ordereddofindices avoidcontact)
    GraspThreaded(approachrays standoffs preshapes rolls manipulatordirections target transformrobot
        onlycontacttarget tightgrasp graspingnoise forceclosurethreshold collisionchecker translationstepmult
        numthreads startindex maxgrasps finestep)
    clone(envother)
    """,
)
class Grasper:
    """Simulates how a hand closes around a body, and rates the grasp."""
