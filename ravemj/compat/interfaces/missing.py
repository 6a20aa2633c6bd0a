"""Helpers that ravemj does not support; their constructors raise ``UnsupportedError``, a ``NotImplementedError``."""

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
    """Moves a camera to a pose from which it sees an object."""
