"""Layout of the help in a window: rows of text in one or two columns, wrapped to their width."""

import textwrap
from collections.abc import Iterator
from typing import NamedTuple

from ravemj.gui.interaction.mode_buttons import Panel, Rect
from ravemj.gui.interaction.shortcuts import sections

_MARGIN, _PADDING, _LINE = 8.0, 6.0, 18.0
_WIDEST, _TWO_COLUMNS = 900.0, 640.0
"""Maximum width of the help, and minimum width for two columns [points]."""

_KEY_WIDTH, _SHORT = 58.0, 8
"""Column of descriptions [points], and maximum length of keys with a description beside them [letters]."""

_LETTER = 6.4
"""Mean width of a letter in running text [points]."""

_GLASS = (0.09, 0.1, 0.12, 0.95)
_CLEAR = (0.0, 0.0, 0.0, 0.0)
_GROOVE, _SCROLL_BAR = (0.45, 0.45, 0.48, 1.0), 4.0
_HEADING, _FAINT, _WHITE = (143, 188, 255), (195, 202, 211), (255, 255, 255)


class _Text(NamedTuple):
    indent: float
    text: str
    rgb: tuple[int, int, int]


class HelpLayout(NamedTuple):
    """Rectangle of the help, maximum index of its first visible row, and its panels."""

    rect: Rect
    last_row: int
    panels: tuple[Panel, ...]


def help_layout(size: tuple[int, int], first_row: int) -> HelpLayout:
    """Return the layout of the help for a view of a size [points], scrolled to ``first_row``."""
    width = min(_WIDEST, size[0] - 2 * _MARGIN)
    columns = 2 if width >= _TWO_COLUMNS else 1
    column_width = (width - 2 * _PADDING) / columns
    rows = list(_rows(column_width - 2 * _PADDING))
    fitting = max(int((size[1] - 2 * _MARGIN - 2 * _PADDING) / _LINE), 1)
    shown = min(-(-len(rows) // columns), fitting)
    last_row = max(len(rows) - columns * shown, 0)
    first = min(max(first_row, 0), last_row)
    height = shown * _LINE + 2 * _PADDING
    rect = Rect((size[0] - width) / 2, max((size[1] - height) / 2, _MARGIN), width, height)
    panels = [Panel(rect, _GLASS)]
    if last_row:
        part = height / len(rows)
        panels.append(Panel(Rect(rect.x, rect.y + first * part, _SCROLL_BAR, columns * shown * part), _GROOVE))
    for number, row in enumerate(rows[first : first + columns * shown]):
        column, line = divmod(number, shown)
        x, y = rect.x + 2 * _PADDING + column * column_width, rect.y + _PADDING + line * _LINE
        for indent, text, rgb in row:
            panels.append(Panel(Rect(x + indent, y, column_width, _LINE), _CLEAR, text, is_left=True, text_rgb=rgb))
    return HelpLayout(rect, last_row, tuple(panels))


def _rows(width: float) -> Iterator[list[_Text]]:
    for title, entries in sections():
        yield [_Text(0.0, title, _HEADING)]
        for to, how in entries:
            if len(how) <= _SHORT:
                first, *others = _wrapped(to, width - _KEY_WIDTH)
                yield [_Text(_PADDING, how, _FAINT), _Text(_KEY_WIDTH, first, _WHITE)]
                yield from ([_Text(_KEY_WIDTH, other, _WHITE)] for other in others)
            else:
                yield from ([_Text(_PADDING, part, _WHITE)] for part in _wrapped(to, width - _PADDING))
                yield from ([_Text(3 * _PADDING, part, _FAINT)] for part in _wrapped(how, width - 3 * _PADDING))


def _wrapped(text: str, width: float) -> list[str]:
    return textwrap.wrap(text, max(int(width / _LETTER), 1))
