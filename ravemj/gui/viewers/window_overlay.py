"""Overlay of a window: text and buttons, in an antialiased font."""

import ctypes
import functools
from collections.abc import Callable
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from ravemj.gui.interaction import Overlay, Panel, Rect, Viewpoint

_SIZE = 13.0
"""Default height of letters [points]."""

_MARGIN, _LINE, _PADDING = 8.0, 18.0, 6.0
_GLASS = (0.09, 0.1, 0.12, 0.82)
_WHITE, _DARK = (255, 255, 255), (32, 36, 44)
_HALO = (255, 255, 255)
_BUTTONS = 60.0
"""Width of the mode buttons at the right [points]."""

_Rgb = tuple[int, int, int]


@functools.lru_cache(maxsize=512)
def text_image(text: str, size: int, rgb: _Rgb, halo: bool = False) -> NDArray[np.uint8]:
    """Render a line of text as an RGBA image, shape (height, width, 4), top row first.

    All texts of a size [pixels] have the same height. The colour is in 0..255; ``halo`` adds a light outline.
    """
    from PIL import Image, ImageDraw  # noqa: PLC0415 - slow to import

    font = _font(size)
    edge = max(round(size / 6), 1) if halo else 0
    width = int(font.getlength(text)) + 2 + 2 * edge
    image = Image.new("RGBA", (width, round(1.4 * size) + 2 * edge), (*(_HALO if halo else rgb), 0))
    draw = ImageDraw.Draw(image)
    draw.text((1 + edge, edge), text, font=font, fill=(*rgb, 255), stroke_width=edge, stroke_fill=(*_HALO, 210))
    return np.array(image)


@functools.cache
def _font(size: int) -> Any:  # noqa: ANN401 - of Pillow, which is slow to import
    from PIL import ImageFont  # noqa: PLC0415 - slow to import

    return ImageFont.load_default(size)


class OverlayPainter:
    """Draws the overlay into the current window; rows are counted from the top."""

    def __init__(self) -> None:
        self._pixels, self._ratio = (1, 1), 1.0

    def paint(self, overlay: Overlay, view: Viewpoint, pixels: tuple[int, int], ratio: float) -> None:
        """Draw an overlay on a window of a size in pixels; ``ratio`` is the number of pixels per point."""
        self._pixels, self._ratio = pixels, ratio
        for x, y, text in overlay.labels_on(view):
            self._text(text, x, y, _DARK, halo=True)
        self._paint_lines(overlay.lines, overlay.text_size or _SIZE)
        for panel in overlay.panels:
            self._paint_panel(panel)

    def _paint_lines(self, lines: tuple[str, ...], size: float) -> None:
        room = self._pixels[0] / self._ratio - 2 * (_MARGIN + _PADDING) - _BUTTONS
        rows = [row for line in lines for row in self._wrapped(line, room, size)]
        height = _LINE / _SIZE * size
        if rows:
            width = max(self._width(row, size) for row in rows) + 2 * _PADDING
            self._rectangle(Rect(_MARGIN, _MARGIN, width, len(rows) * height + _PADDING), _GLASS)
        for number, row in enumerate(rows):
            self._line(row, _MARGIN + _PADDING, _MARGIN + 0.5 * _PADDING + number * height, _WHITE, size)

    def _paint_panel(self, panel: Panel) -> None:
        if panel.rgba[3]:
            self._rectangle(panel.rect, panel.rgba)
        if panel.text:
            x, y, width, height = panel.rect
            if panel.is_left:
                self._line(panel.text, x + _PADDING, y + (height - _LINE) / 2, panel.text_rgb)
                return
            self._text(panel.text, x + width / 2, y + height / 2, panel.text_rgb)

    def _wrapped(self, text: str, width: float, size: float = _SIZE) -> list[str]:
        lines = [""]
        for word in text.split(" "):
            longer = f"{lines[-1]} {word}".strip()
            if lines[-1] and self._width(longer, size) > width:
                lines.append(word)
            else:
                lines[-1] = longer
        return lines

    # --- in pixels

    def _letters(self, size: float) -> int:
        return max(round(size * self._ratio), 6)

    def _width(self, text: str, size: float = _SIZE) -> float:
        return float(_font(self._letters(size)).getlength(text)) / self._ratio

    def _text(self, text: str, x: float, y: float, rgb: _Rgb, *, halo: bool = False) -> None:
        """Draw a text centred at (x, y) [points]."""
        image = text_image(text, self._letters(_SIZE), rgb, halo)
        rows, columns = image.shape[:2]
        self._image(image, round(x * self._ratio - columns / 2), round(y * self._ratio - rows / 2))

    def _line(self, text: str, x: float, y: float, rgb: _Rgb, size: float = _SIZE) -> None:
        """Draw a text that starts at (x, y), its top left corner [points]."""
        self._image(text_image(text, self._letters(size), rgb), round(x * self._ratio), round(y * self._ratio))

    def _rectangle(self, rect: Rect, rgba: tuple[float, float, float, float]) -> None:
        x, y, width, height = rect
        left, top, right, bottom = (round(self._ratio * edge) for edge in (x, y, x + width, y + height))
        mujoco.mjr_rectangle(mujoco.MjrRect(left, self._pixels[1] - bottom, right - left, bottom - top), *rgba)

    def _image(self, image: NDArray[np.uint8], left: int, top: int) -> None:
        """Blend an image into the window, clipped at its border; ``left`` and ``top`` are in pixels."""
        width, height = self._pixels
        part = image[max(-top, 0) : height - top, max(-left, 0) : width - left]
        if part.size:
            blend(part[::-1], max(left, 0), height - max(top, 0) - len(part))


_RGBA, _UNSIGNED_BYTE = 0x1908, 0x1401
_BLEND, _DEPTH_TEST, _LIGHTING, _TEXTURE_2D, _TEXTURE_CUBE = 0x0BE2, 0x0B71, 0x0B50, 0x0DE1, 0x8513
_SRC_ALPHA, _ONE_MINUS_SRC_ALPHA, _ALL_ATTRIB_BITS, _UNPACK_ALIGNMENT = 0x0302, 0x0303, 0x000FFFFF, 0x0CF5


def blend(image: NDArray[np.uint8], x: int, y: int) -> None:
    """Blend an image (height, width, 4), bottom row first, over the current window at its lower left corner (x, y)."""
    contiguous = np.ascontiguousarray(image)
    call = _gl()
    call("glPushAttrib", _ALL_ATTRIB_BITS)
    for state in (_DEPTH_TEST, _LIGHTING, _TEXTURE_2D, _TEXTURE_CUBE):
        call("glDisable", state)
    call("glEnable", _BLEND)
    call("glBlendFunc", _SRC_ALPHA, _ONE_MINUS_SRC_ALPHA)
    call("glPixelStorei", _UNPACK_ALIGNMENT, 4)
    call("glWindowPos2i", x, y)
    rows, columns = image.shape[:2]
    call("glDrawPixels", columns, rows, _RGBA, _UNSIGNED_BYTE, contiguous.ctypes.data_as(ctypes.c_void_p))
    call("glPopAttrib")


@functools.cache
def _gl() -> Callable[..., None]:
    """Return a function that calls OpenGL by function name, in the current context of GLFW."""
    import glfw  # noqa: PLC0415 - loads the libraries of the display

    glfw_module: Any = glfw
    argument_types: dict[str, tuple[Any, ...]] = {
        "glPushAttrib": (ctypes.c_uint,),
        "glPopAttrib": (),
        "glDisable": (ctypes.c_uint,),
        "glEnable": (ctypes.c_uint,),
        "glBlendFunc": (ctypes.c_uint, ctypes.c_uint),
        "glPixelStorei": (ctypes.c_uint, ctypes.c_int),
        "glWindowPos2i": (ctypes.c_int, ctypes.c_int),
        "glDrawPixels": (ctypes.c_int, ctypes.c_int, ctypes.c_uint, ctypes.c_uint, ctypes.c_void_p),
    }
    functions: dict[str, Any] = {
        name: ctypes.CFUNCTYPE(None, *types)(glfw_module.get_proc_address(name))
        for name, types in argument_types.items()
    }

    def call(name: str, *arguments: object) -> None:
        functions[name](*arguments)

    return call
