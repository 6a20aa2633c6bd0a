"""What sensors measure, as numbers: from bodies, their model and physics. Cameras are the renderers'."""

from ravemj.engine.sensing.figures import scan_figure, shape_figure
from ravemj.engine.sensing.lasers import Scan, ray_directions, scan, spun
from ravemj.engine.sensing.motion import Motion, acceleration_at, encoder_values, motion_at
from ravemj.engine.sensing.touch import Touches, corrected, touches, wrench

__all__ = [
    "Motion",
    "Scan",
    "Touches",
    "acceleration_at",
    "corrected",
    "encoder_values",
    "motion_at",
    "ray_directions",
    "scan",
    "scan_figure",
    "shape_figure",
    "spun",
    "touches",
    "wrench",
]
