"""Pictures as files that browsers show."""

import io

from ravemj.graphics.simulation_renderer import Frame

_CRISP_QUALITY = 95


def moving(picture: Frame, quality: int) -> bytes:
    """Return a picture, shape (height, width, 3), as JPEG of a quality from 1 to 95."""
    return _file(picture, "JPEG", quality=quality)


def resting(picture: Frame, *, is_exact: bool) -> bytes:
    """Return a picture, shape (height, width, 3), as crisp as can be: as PNG if exact, else as JPEG."""
    if is_exact:
        return _file(picture, "PNG", compress_level=1)
    return _file(picture, "JPEG", quality=_CRISP_QUALITY, subsampling=0)


def _file(picture: Frame, kind: str, **options: int) -> bytes:
    from PIL import Image  # noqa: PLC0415 - slow to import

    file = io.BytesIO()
    Image.fromarray(picture).save(file, kind, **options)
    return file.getvalue()
