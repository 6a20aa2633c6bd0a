"""Grasps of a body by a hand."""

from ravemj.compat.databases.model import DatabaseGenerator


class GraspingModel(DatabaseGenerator):
    """Grasps of a body by a hand."""

    capability = "planning of grasps"
