"""Visibility of a body from a camera on an arm."""

from ravemj.compat.databases.model import DatabaseGenerator
from ravemj.compat.databases.visibility import GripperVisibility
from ravemj.compat.refusal import lacking, refusing

SEEING = "visual feedback"


@lacking(
    SEEING,
    """
    SetCameraTransforms(transforms) ShowTransform(relativepose options)
    computeValidTransform(returnall checkcollision computevisibility randomize)
    generate(preshapes sphere conedirangles localtransforms) getCameraImage(delay) moveToPreshape()
    pruneTransformations(thresh numminneighs maxdist translationonly) show(options) showtransforms(options)
    """,
)
class VisibilityModel(DatabaseGenerator):
    """Camera poses from which a camera on an arm sees a body."""

    capability = SEEING
    GripperVisibility = GripperVisibility

    def autogenerate(self, options: object = None, gmodel: object = None) -> None:
        """Raise an error; see ``DatabaseGenerator.autogenerate``."""
        del gmodel
        super().autogenerate(options)

    targetgeomname = None
    targetlink = None
    visibilitytransforms = None


run = refusing("visibilitymodel.run", SEEING, "*arguments **named")
