"""Layout of the controls of a window, drawn as rectangles and text.

Playback is a row at the bottom, between the wheels; simulation time is a second row. Each is shown only if there is
something to control. Other controls are a column of small buttons below the mode buttons, omitted on low views.
Sliders, tree and menus open beside the column, the help over everything.
"""

from dataclasses import replace
from itertools import accumulate, count, takewhile
from typing import NamedTuple

from ravemj.gui.interaction.control import Control
from ravemj.gui.interaction.help_layout import help_layout
from ravemj.gui.interaction.mode_buttons import Panel, Rect

_MARGIN, _GAP = 8.0, 4.0
_LEFT, _RIGHT = 212.0, 62.0
"""Margins of the bottom row for the camera wheels and their labels [points]."""

_COLUMN_TOP, _COLUMN_WIDTH, _COLUMN_HEIGHT = 104.0, 44.0, 22.0
_WHEEL = 180.0
"""Margin below the column of buttons for the camera wheel, its label and the bottom row [points]."""

_BAR, _ICON = 26.0, 28.0
_CLOCK, _SPEED, _PASSED = 110.0, 44.0, 130.0
_SHORTEST_TRACK = 80.0
_JOINT_ROW, _NAME, _TRACK, _VALUE = 22.0, 180.0, 104.0, 84.0
_NARROWEST = 0.2
"""Minimum width of slider names and tracks on narrow views, as a fraction of their usual widths."""

_LETTER = 6.9
"""Typical width of a letter [points]."""

_KNOB, _SCROLL_BAR = 8.0, 4.0
_LOWEST_VIEW = 420.0
"""Minimum height of a view with the column of buttons [points]."""

_Rgba = tuple[float, float, float, float]
_BACK: _Rgba = (0.15, 0.15, 0.17, 0.8)
_ON: _Rgba = (0.2, 0.42, 0.7, 0.95)
_RECORDING: _Rgba = (0.75, 0.1, 0.1, 0.95)
_GROOVE: _Rgba = (0.45, 0.45, 0.48, 1.0)
_WHITE: _Rgba = (1.0, 1.0, 1.0, 1.0)
_CLEAR: _Rgba = (0.0, 0.0, 0.0, 0.0)
_Point = tuple[float, float]
_ENTRY_WIDTH, _ENTRY_HEIGHT = 110.0, 24.0


class ControlLayout(NamedTuple):
    """Rectangles of the controls of a view.

    Attributes:
        places: Rectangle of each control, for sliders that of the track. Controls that do not fit are omitted.
        backs: Background rectangles behind groups of controls; presses on these do not reach the scene.
        first_row: Index of the first visible row of the joint sliders, the tree or the help.
        last_row: Maximum of ``first_row``.
        name_width: Width of the names before sliders [points].
        help: Panels of the help, drawn over everything.
    """

    places: dict[Control, Rect]
    backs: tuple[Rect, ...]
    first_row: int
    last_row: int
    name_width: float = _NAME
    help: tuple[Panel, ...] = ()

    @classmethod
    def arrange(cls, controls: tuple[Control, ...], size: tuple[int, int], first_row: int = 0) -> "ControlLayout":
        """Return the layout of controls on a view of a size [points], scrolled to ``first_row``."""
        playing, time, others, menu, joints, joint_tools, tree, hiding = (
            [control for control in controls if control.group == group]
            for group in ("playing", "time", "tools", "menu", "joints", "joint tools", "tree", "help")
        )
        motion = _bar(playing, size)
        time_row = _time_bar(time, size, row=1 if motion else 0)
        backs = [_around(row) for row in (motion, time_row) if row]
        places = motion | time_row
        column = _column(others, size)
        left = min((rect.x for rect in column.values()), default=size[0] - _MARGIN - _COLUMN_WIDTH) - _MARGIN
        places |= column | _menu(menu, left, size[1])
        if hiding:
            shown_help = help_layout(size, first_row)
            places = {hiding[0]: shown_help.rect} | places  # of several controls at a point the first one counts
            return cls(places, tuple(backs), first_row, shown_help.last_row, help=shown_help.panels)
        fitting = int((size[1] - _COLUMN_TOP - 2 * _MARGIN - _BAR) / _JOINT_ROW) - bool(joint_tools)
        if fitting < 1:
            return cls(places, tuple(backs), 0, 0)
        rows = joints or tree
        last = max(len(rows) - fitting, 0)
        first = min(max(first_row, 0), last)
        part = min(max((left - _MARGIN - _VALUE) / (_NAME + _TRACK), _NARROWEST), 1.0)
        name_width, track_width = part * _NAME, part * _TRACK
        table_width = name_width + track_width + _VALUE
        table = Rect(left - table_width, _COLUMN_TOP + bool(joint_tools) * _JOINT_ROW, table_width, _JOINT_ROW)
        shown = rows[first : first + fitting]
        for number, row in enumerate(shown):
            x, width = table.x + _SCROLL_BAR, table_width - _SCROLL_BAR
            if row.is_slider:
                x, width = table.x + name_width, track_width
            places[row] = Rect(x, table.y + number * _JOINT_ROW, width, _JOINT_ROW)
        for column, tool in enumerate(joint_tools):
            width = table_width / len(joint_tools)
            places[tool] = Rect(table.x + column * width + 2, _COLUMN_TOP, width - 4, _JOINT_ROW - 2)
        if shown:
            backs.append(table._replace(height=len(shown) * _JOINT_ROW))
        return cls(places, tuple(backs), first, last, name_width)

    def at(self, point: _Point | None) -> Control | None:
        """Return the control at a point of the view [points], or None."""
        controls = (control for control, rect in self.places.items() if point is not None and rect.contains(*point))
        return next(controls, None)

    def field_at(self, point: _Point | None) -> Control | None:
        """Return the text field at a point of the view [points]: the search or a joint value; None if there is none."""
        for control, rect in self.places.items():
            field = rect._replace(x=rect.x + rect.width, width=_VALUE) if control.group == "joints" else rect
            if (control.group == "joints" or control.name == "search") and point and field.contains(*point):
                return control
        return None

    def covers(self, point: _Point | None) -> bool:
        """Return whether a point of the view [points] is on a control or its background."""
        if point is None:
            return False
        return self.at(point) is not None or any(back.contains(*point) for back in self.backs)

    def value_at(self, slider: Control, x: float) -> float:
        """Return the value of a slider whose knob is dragged to column ``x`` of the view [points]."""
        rect = self.places[slider]
        part = (x - rect.x - _KNOB / 2) / (rect.width - _KNOB)
        return slider.lower + min(max(part, 0.0), 1.0) * (slider.upper - slider.lower)

    def panels(self) -> tuple[Panel, ...]:
        """Return the rectangles and texts to draw."""
        drawn = [Panel(back, _BACK) for back in self.backs]
        if self.last_row and not self.help:
            drawn.append(self._scroll_bar(self.backs[-1]))
        labels = [control.label for control in self.places if control.group == "joints"]
        names = shortened(labels, int(self.name_width / _LETTER))
        for control, rect in self.places.items():
            if control.is_slider:
                drawn += _slider(control, rect, names.get(control.label, ""), self.name_width)
            elif control.group in {"playing", "time"}:
                drawn += _icon(control, rect)
            elif control.group == "help":
                continue
            elif control.group == "tree":
                text = _row_text(control.text, int(rect.width / _LETTER))
                drawn.append(Panel(rect, _ON if control.is_on else _CLEAR, text, is_left=True))
            else:
                colour = _BACK if not control.is_on else _RECORDING if control.name == "video" else _ON
                drawn.append(Panel(rect, colour, control.text))
        return *drawn, *self.help

    def _scroll_bar(self, table: Rect) -> Panel:
        shown = sum(control.group in {"joints", "tree"} for control in self.places)
        part = table.height / (shown + self.last_row)
        return Panel(Rect(table.x, table.y + self.first_row * part, _SCROLL_BAR, shown * part), _GROOVE)


def _bar(playing: list[Control], size: tuple[int, int]) -> dict[Control, Rect]:
    """Return the rectangles of the playback controls; narrow views omit clock and speed, or all controls."""
    room = size[0] - _LEFT - _RIGHT
    is_wide = room >= 3 * _ICON + _SHORTEST_TRACK + _CLOCK + _SPEED
    if not playing or room < 3 * _ICON + _SHORTEST_TRACK:
        return {}
    back, play, forward, seek, speed = playing
    y = size[1] - _MARGIN - _BAR
    icons = {part: Rect(_LEFT + i * _ICON, y, _ICON, _BAR) for i, part in enumerate((back, play, forward))}
    beside = _CLOCK + _SPEED if is_wide else 0.0
    track = Rect(_LEFT + 3 * _ICON, y, room - 3 * _ICON - beside, _BAR)
    if not is_wide:
        return icons | {replace(seek, text=""): track}
    return icons | {seek: track, speed: Rect(_LEFT + room - _SPEED, y, _SPEED, _BAR)}


def _time_bar(time: list[Control], size: tuple[int, int], row: int) -> dict[Control, Rect]:
    """Return the rectangles of the simulation time controls, ``row`` rows above the bottom; none if too narrow."""
    widths = (_ICON, _ICON, _PASSED, _SPEED)
    if not time or size[0] - _LEFT - _RIGHT < sum(widths):
        return {}
    y = size[1] - _MARGIN - _BAR - row * (_BAR + _GAP)
    lefts = accumulate(widths[:-1], initial=_LEFT)
    return {part: Rect(x, y, width, _BAR) for part, x, width in zip(time, lefts, widths, strict=True)}


def _around(places: dict[Control, Rect]) -> Rect:
    first, *_, last = places.values()
    return first._replace(width=last.x + last.width - first.x)


def _column(others: list[Control], size: tuple[int, int]) -> dict[Control, Rect]:
    """Return the rectangles of the buttons, in more than one column if needed; none if there is no room."""
    if size[1] < _LOWEST_VIEW:
        return {}
    step = _COLUMN_HEIGHT + _GAP
    rows = int((size[1] - _COLUMN_TOP - _WHEEL) / step)
    first_x = size[0] - _MARGIN - _COLUMN_WIDTH
    places: dict[Control, Rect] = {}
    for number, control in enumerate(others):
        column, row = divmod(number, rows)
        x = first_x - column * (_COLUMN_WIDTH + _GAP)
        places[control] = Rect(x, _COLUMN_TOP + row * step, _COLUMN_WIDTH, _COLUMN_HEIGHT)
    return places


def _menu(menu: list[Control], right: float, bottom: float) -> dict[Control, Rect]:
    """Return the rectangles of the menu entries that fit between the column's top and ``bottom``, left of ``right``."""
    tops = takewhile(lambda top: top + _ENTRY_HEIGHT < bottom, count(_COLUMN_TOP, _ENTRY_HEIGHT))
    return {
        control: Rect(right - _ENTRY_WIDTH, top, _ENTRY_WIDTH, _ENTRY_HEIGHT - 1)
        for control, top in zip(menu, tops, strict=False)
    }


def shortened(labels: list[str], most: int) -> dict[str, str]:
    """Shorten labels to ``most`` letters; they stay different from each other if possible."""
    cut: dict[str, str] = {}
    for tail in range(most // 2, most - 2):
        head = most - 2 - tail
        cut = {label: label if len(label) <= most else f"{label[:head]}..{label[-tail:]}" for label in labels}
        if len(set(cut.values())) == len(cut):
            break
    return cut


def _row_text(text: str, most: int) -> str:
    """Shorten an indented name to ``most`` letters: reduce the indentation, then drop the middle."""
    name = text.lstrip()
    indent = min(len(text) - len(name), most // 3)
    return indent * " " + shortened([name], most - indent)[name]


def _slider(control: Control, rect: Rect, name: str, name_width: float) -> list[Panel]:
    """Return the panels of a slider: groove, knob and value text, for joints also the name."""
    x, y, width, height = rect
    part = (min(max(control.value, control.lower), control.upper) - control.lower) / (control.upper - control.lower)
    middle, knob = y + height / 2, x + part * (width - _KNOB)
    groove = Panel(Rect(x + _KNOB / 2, middle - 2, width - _KNOB, 4), _GROOVE)
    done = Panel(Rect(x + _KNOB / 2, middle - 2, knob - x, 4), _WHITE)
    drawn = [groove, Panel(Rect(knob, middle - 7, _KNOB, 14), _WHITE)]
    if control.name == "seek":
        drawn.insert(1, done)
        clock = Panel(Rect(x + width, y, _CLOCK, height), _CLEAR, control.text)
        return [*drawn, clock] if control.text else drawn
    before = Panel(Rect(x - name_width, y, name_width, height), _CLEAR, name)
    number = Panel(Rect(x + width, y, _VALUE, height), _ON if control.is_on else _CLEAR, control.text)
    return [before, *drawn, number]


def _icon(control: Control, rect: Rect) -> list[Panel]:
    """Return the text of a control or its icon: triangle (play), bars (pause), both (step)."""
    x, y = rect.x + rect.width / 2, rect.y + rect.height / 2
    if control.text:
        return [Panel(rect, _CLEAR, control.text)]
    if control.name in {"play", "run"} and control.is_on:
        parts = [Rect(x - 5, y - 6, 4, 12), Rect(x + 1, y - 6, 4, 12)]
    elif control.name in {"play", "run"}:
        parts = [Rect(x - 5, y - 6 + row, 11 - 2 * abs(row - 5.5), 1) for row in range(12)]
    else:
        side = -1 if control.name == "back" else 1
        lengths = [8 - 1.6 * abs(row - 4.5) for row in range(10)]
        parts = [
            Rect(x - 4 if side > 0 else x + 4 - length, y - 5 + row, length, 1) for row, length in enumerate(lengths)
        ]
        parts.append(Rect(x + 4 if side > 0 else x - 6, y - 5, 2, 10))
    return [Panel(part, _WHITE) for part in parts]
