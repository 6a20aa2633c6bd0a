"""Pictures as files that browsers show."""

import io
from typing import TYPE_CHECKING

from ravemj.graphics.simulation_renderer import Frame

if TYPE_CHECKING:
    from PIL import Image

_CRISP_QUALITY = 95


def moving(picture: Frame, quality: int) -> bytes:
    """Return a picture as JPEG.

    Args:
        picture: The picture, shape (height, width, 3).
        quality: From 1 to 95.
    """
    from PIL import Image  # noqa: PLC0415 - slow to import

    return _file(Image.fromarray(picture), "JPEG", quality=quality)


def resting(picture: Frame, *, is_exact: bool) -> bytes:
    """Return a picture as crisp as can be.

    Args:
        picture: The picture, shape (height, width, 3).
        is_exact: PNG, for connections that have time for it; else JPEG with the colours of every pixel.
    """
    from PIL import Image  # noqa: PLC0415 - slow to import

    image = Image.fromarray(picture)
    if is_exact:
        return _file(image, "PNG", compress_level=1)
    return _file(image, "JPEG", quality=_CRISP_QUALITY, subsampling=0)


def _file(image: "Image.Image", kind: str, **options: int) -> bytes:
    file = io.BytesIO()
    image.save(file, kind, **options)
    return file.getvalue()
