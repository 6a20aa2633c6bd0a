"""Encoding of pictures for browsers."""

import io

from ravemj.graphics.simulation_renderer import Frame

_CRISP_QUALITY = 95


def as_jpeg(picture: Frame, quality: int) -> bytes:
    """Encode a picture, shape (height, width, 3), as JPEG with a quality from 1 to 95."""
    return _file(picture, "JPEG", quality=quality)


def as_still(picture: Frame, *, is_exact: bool) -> bytes:
    """Encode a picture, shape (height, width, 3), in best quality: as PNG if ``is_exact``, else as JPEG."""
    if is_exact:
        return _file(picture, "PNG", compress_level=1)
    return _file(picture, "JPEG", quality=_CRISP_QUALITY, subsampling=0)


def _file(picture: Frame, kind: str, **options: int) -> bytes:
    from PIL import Image  # noqa: PLC0415 - slow to import

    file = io.BytesIO()
    Image.fromarray(picture).save(file, kind, **options)
    return file.getvalue()
