"""From where a camera on an arm sees a body."""

from ravemj.compat.databases.model import DatabaseGenerator, refusing

SEEING = "visual feedback"


class VisibilityModel(DatabaseGenerator):
    """From where a camera on an arm sees a body."""

    capability = SEEING

    def autogenerate(self, options: object = None, gmodel: object = None) -> None:
        """Refuse to compute the model; see ``DatabaseGenerator.autogenerate``."""
        del gmodel
        super().autogenerate(options)

    GripperVisibility = staticmethod(refusing("GripperVisibility", SEEING, "manip"))
    SetCameraTransforms = refusing("SetCameraTransforms", SEEING, "self transforms")
    ShowTransform = refusing("ShowTransform", SEEING, "self relativepose options")
    computeValidTransform = refusing(
        "computeValidTransform", SEEING, "self returnall checkcollision computevisibility randomize"
    )
    generate = refusing("generate", SEEING, "self preshapes sphere conedirangles localtransforms")
    getCameraImage = refusing("getCameraImage", SEEING, "self delay")
    moveToPreshape = refusing("moveToPreshape", SEEING, "self")
    pruneTransformations = refusing("pruneTransformations", SEEING, "self thresh numminneighs maxdist translationonly")
    show = refusing("show", SEEING, "self options")
    showtransforms = refusing("showtransforms", SEEING, "self options")
    targetgeomname = None
    targetlink = None
    visibilitytransforms = None


run = refusing("visibilitymodel.run", SEEING, "*arguments **named")
