"""``openravepy.planningutils``: functions on trajectories and configurations."""

from ravemj.compat.planningutils.chains import DHParameter, GetDHParameters
from ravemj.compat.planningutils.checking import (
    DynamicsCollisionConstraint,
    JitterActiveDOF,
    JitterCurrentConfiguration,
    JitterTransform,
    VerifyTrajectory,
)
from ravemj.compat.planningutils.editing import (
    ComputeTrajectoryDerivatives,
    ConvertTrajectorySpecification,
    GetTrajectorySegment,
    MergeTrajectories,
    ReverseTrajectory,
    SegmentTrajectory,
)
from ravemj.compat.planningutils.goals import ManipulatorIKGoalSampler
from ravemj.compat.planningutils.inserting import (
    ExtendActiveDOFWaypoint,
    ExtendWaypoint,
    InsertActiveDOFWaypointWithRetiming,
    InsertWaypointWithSmoothing,
)
from ravemj.compat.planningutils.retiming import (
    ActiveDOFTrajectoryRetimer,
    ActiveDOFTrajectorySmoother,
    AffineTrajectoryRetimer,
    RetimeActiveDOFTrajectory,
    RetimeAffineTrajectory,
    RetimeTrajectory,
    SmoothActiveDOFTrajectory,
    SmoothAffineTrajectory,
    SmoothTrajectory,
)
from ravemj.core.api_object import published

__all__ = [
    "ActiveDOFTrajectoryRetimer",
    "ActiveDOFTrajectorySmoother",
    "AffineTrajectoryRetimer",
    "ComputeTrajectoryDerivatives",
    "ConvertTrajectorySpecification",
    "DHParameter",
    "DynamicsCollisionConstraint",
    "ExtendActiveDOFWaypoint",
    "ExtendWaypoint",
    "GetDHParameters",
    "GetTrajectorySegment",
    "InsertActiveDOFWaypointWithRetiming",
    "InsertWaypointWithSmoothing",
    "JitterActiveDOF",
    "JitterCurrentConfiguration",
    "JitterTransform",
    "ManipulatorIKGoalSampler",
    "MergeTrajectories",
    "RetimeActiveDOFTrajectory",
    "RetimeAffineTrajectory",
    "RetimeTrajectory",
    "ReverseTrajectory",
    "SegmentTrajectory",
    "SmoothActiveDOFTrajectory",
    "SmoothAffineTrajectory",
    "SmoothTrajectory",
    "VerifyTrajectory",
]

for _name in __all__:
    globals()[_name] = published(globals()[_name], __name__)
