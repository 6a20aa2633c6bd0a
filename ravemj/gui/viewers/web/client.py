"""Server side of one page: handles the page's events, and sends pictures or geometry."""

import base64
import json
import logging
import time
from collections import deque
from collections.abc import Callable, Iterable
from dataclasses import asdict
from typing import NamedTuple, Protocol

from ravemj.engine.simulation import Simulation
from ravemj.errors import RavemjError
from ravemj.graphics.rendering import Look
from ravemj.graphics.simulation_renderer import Format, Frame, SimulationRenderer
from ravemj.gui.interaction import Event, Interaction, Leave, Move, Overlay, Resize
from ravemj.gui.interaction.shortcuts import page_sections
from ravemj.gui.viewers.recorder import free_path
from ravemj.gui.viewers.sharpness import CRISP, LARGEST_SIDE, LEAST_SIDE, REST, Level, Sharpness, bounded_size, period
from ravemj.gui.viewers.viewer import LOCKED, PATIENCE
from ravemj.gui.viewers.web import encoding
from ravemj.gui.viewers.web.feed import Feed, Stage
from ravemj.gui.viewers.web.frame_pacing import ConnectionPacing
from ravemj.gui.viewers.web.messages import DrawingSide, PageSize, Ready, Rejections, UploadChunk, parse
from ravemj.gui.viewers.web.scenes import Scenes
from ravemj.gui.viewers.window_renderer import appearance

_LOG = logging.getLogger("ravemj")
_PERIOD = 1 / 60
_HALF = 0.5
"""Maximum resolution while moving on slow connections, relative to the view's."""

_MOST_PIXELS = 1920 * 1440
_MOST_AT_ONCE = 100
"""Maximum number of messages handled before the next frame: pointer moves arrive faster than frames can be drawn."""


_Update = Frame | list[str | bytes]
"""Update to send to a page: a picture, or messages if the page renders the scene itself."""


class Connection(Protocol):
    """Protocol of connections to pages, as in ``websockets``."""

    def recv(self, timeout: float | None = None) -> str | bytes:
        """Wait for a message."""
        ...

    def send(self, message: str | bytes) -> None:
        """Send text or bytes."""
        ...


class PageStyle(NamedTuple):
    """Appearance of all pages of a viewer: background, floor, lights, shadows, title."""

    look: Look
    shadows: bool | None
    title: str


def receive(connection: Connection, seconds: float) -> list[str | bytes]:
    """Return the pending messages of a page; if there are none, wait for messages, at most for a time [s]."""
    messages: list[str | bytes] = []
    try:
        messages.append(connection.recv(timeout=seconds))
        while len(messages) < _MOST_AT_ONCE:
            messages.append(connection.recv(timeout=0))
    except TimeoutError:
        pass
    return messages


class Client:
    """Serves one page, in its own thread.

    Attributes:
        interaction: Interaction and viewpoint of the page.
        chunks: Received chunks of files that were dropped on the page.
        tab: Name of the view; a page that reconnects with this name gets the view again.
        updates: Counter, increased whenever the page is known to show the current state of the bodies.
    """

    def __init__(
        self,
        simulation: Simulation,
        renderer: SimulationRenderer,
        interaction: Interaction,
        scenes: Scenes,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self.interaction = interaction
        self._clock = clock
        self.updates = 0
        self._simulation = simulation
        self._renderer = renderer
        self._scenes = scenes
        self._feed: Feed | None = None  # only for pages that render the scene themselves
        self._stage: Stage | None = None
        self._acknowledged = 0
        self._pacing = ConnectionPacing(clock)
        self._sharpness = Sharpness()
        self._overlay: Overlay | None = None
        self._tree: object = None
        self._free_at = self._clock()
        self._sees_bodies = False
        self._has_moved = False
        self._ratio = 1.0
        self._waiting: deque[Event] = deque([Leave()])  # releases keys and buttons of an earlier connection
        self._seen: object = None
        self._seen_view: object = None
        self._says_locked = False
        self._complaint = ""
        self.chunks: deque[UploadChunk] = deque()
        self.tab = ""
        self._changed_at = 0.0
        self._is_crisp = True

    @property
    def patience(self) -> float:
        """Time to wait for messages [s]; 0 if messages are pending."""
        return 0.0 if len(self._waiting) > _MOST_AT_ONCE else period(self._clock() - self._changed_at)

    @property
    def is_stalled(self) -> bool:
        """Whether the page does not acknowledge frames, like a hidden tab."""
        return self._pacing.is_stalled

    def pop_moved(self) -> bool:
        """Return whether the user has moved the camera of the page since the last call."""
        has_moved, self._has_moved = self._has_moved, False
        return has_moved

    def queue_messages(self, messages: Iterable[str | bytes], complain: Rejections) -> None:
        """Parse messages and queue their events for ``handle_messages``; invalid ones are skipped."""
        for text in messages:
            try:
                message = parse(text)
            except ValueError as error:
                self._acknowledged += 1
                complain(str(error), text)
                continue
            if isinstance(message, Ready):
                self._pacing.shown()
                continue
            self._acknowledged += 1
            if isinstance(message, UploadChunk):
                self.chunks.append(message)
                continue
            if isinstance(message, DrawingSide):
                self._feed, self._seen = Feed() if message.itself else None, None
                continue
            if isinstance(message, PageSize):
                message = self._resize(message, complain)
            if isinstance(message, Move) and self._waiting and isinstance(self._waiting[-1], Move):
                self._waiting.pop()  # only the latest pointer position counts
            self._waiting.append(message)

    def _resize(self, shape: PageSize, complain: Rejections) -> Resize:
        sides = shape.ratio * shape.width, shape.ratio * shape.height
        if min(sides) < LEAST_SIDE or max(sides) > LARGEST_SIDE:
            complain(f"pictures have {LEAST_SIDE} to {LARGEST_SIDE} pixels a side, not these", sides)
        self._ratio = shape.ratio
        return Resize(round(shape.width), round(shape.height))

    def handle_messages(self, connection: Connection, style: PageStyle, *, is_watched: bool = False) -> Frame | None:
        """Handle the queued events; send an update if the page is ready and the view changed or came to rest.

        Args:
            connection: Connection to the page.
            style: Appearance of the page.
            is_watched: Whether a picture is also needed if the page renders the scene itself, as for image callbacks.

        Returns:
            The picture, or None if nothing was sent or no picture is needed.
        """
        try:
            update = self._update_if_due(style)
            if not isinstance(update, list):
                picture = update
            else:
                picture = self._picture(self.interaction.overlay(), style) if update and is_watched else None
        except RavemjError as error:
            if error.message != self._complaint:
                _LOG.error("a page cannot show the environment: %s", error)
                self._complaint = error.message
            self._seen = None
            return None
        if update is not None:
            self._send(connection, update, style)
            self.updates += self._sees_bodies
        return picture

    def _update_if_due(self, style: PageStyle) -> _Update | None:
        """Handle the queued events; return the update to send to the page, or None if none is due."""
        now = self._clock()
        # A short timeout, since the thread that holds the lock may be waiting for this one to end.
        with self._simulation.lock.attempt(_PERIOD) as self._sees_bodies:
            self._simulation.published.is_wanted = not self._sees_bodies
            overlay = self._overlay_if_due(style, now) if self._sees_bodies else None
        if not self._sees_bodies:
            return self._update_of_view(style, now)
        if overlay is None:
            return None
        if self._feed is not None and self._stage is not None:
            return self._news(self._feed, self._stage, overlay, style)
        return self._picture(overlay, style, self._level(now))

    def _overlay_if_due(self, style: PageStyle, now: float) -> Overlay | None:
        """Handle the queued events under the simulation's lock; return the overlay if an update is due, else None."""
        self._free_at = now
        self.interaction.advance(now)
        before = self.interaction.view.camera
        while self._waiting:
            self.interaction.handle(self._waiting.popleft())
        self._has_moved |= self.interaction.view.camera is not before
        if not self._pacing.is_free:
            return None
        acknowledged = self._acknowledged if self._feed else 0  # pages wait for it when they predict drags
        seen = appearance(self._simulation), self.interaction.appearance, style, self._ratio, acknowledged
        has_changed = seen != self._seen or self._says_locked
        if not self._is_due(now, has_changed=has_changed):
            self.updates += 1
            return None
        self._seen, self._seen_view, self._says_locked = seen, self._view(style), False
        self._overlay = overlay = self.interaction.overlay()
        if self._feed is not None:
            self._stage = Stage.from_simulation(
                self._simulation, overlay, self._scenes, style.look, shadows=style.shadows
            )
        return overlay

    def _update_of_view(self, style: PageStyle, now: float) -> _Update | None:
        """Handle only view events, while other threads hold the simulation's lock; return the update if due."""
        before = self.interaction.view.camera
        self._waiting = deque(self.interaction.handle_view_events(list(self._waiting)))
        self._has_moved |= self.interaction.view.camera is not before
        self.interaction.advance_view(now)
        is_long = now - self._free_at > PATIENCE
        if self._overlay is None or not self._pacing.is_free:
            return None
        seen = self._view(style)
        if not self._is_due(now, has_changed=seen != self._seen_view or is_long != self._says_locked):
            return None
        self._seen_view, self._says_locked = seen, is_long
        self._seen = None  # bodies may leave their published poses before the lock is released
        lines = tuple(line for line in self._overlay.lines if line != LOCKED)
        self._overlay = self._overlay._replace(lines=(LOCKED, *lines) if is_long else lines)
        if self._feed is not None and self._stage is not None:
            self._stage = self._stage.with_published(self._simulation.published)
            return self._news(self._feed, self._stage, self._overlay, style)
        level = self._level(now)
        return self._renderer.render_again(self.interaction.drawn_view.camera, style.look, self._form(level, style))

    def _view(self, style: PageStyle) -> object:
        """Return a key that changes if the view must be redrawn.

        It ignores texts, and body poses that the simulation has not published yet.
        """
        view, published = self.interaction.drawn_view, self._simulation.published.number
        return view.camera, view.size, self.interaction.mode, style, self._ratio, published

    def _is_due(self, now: float, *, has_changed: bool) -> bool:
        """Return whether to draw a frame: the view has changed, or has come to rest and needs full quality."""
        if has_changed:
            self._changed_at, self._is_crisp = now, False
        elif self._is_crisp or now - self._changed_at < REST:
            return False
        else:
            self._is_crisp = True
        return True

    def _level(self, now: float) -> Level:
        if self._is_crisp:
            return CRISP
        level = self._sharpness.level_while_moving(now)
        return level._replace(scale=min(level.scale, _HALF)) if self._pacing.is_halved else level

    def _picture(self, overlay: Overlay, style: PageStyle, level: Level = CRISP) -> Frame:
        begin = self._clock()
        camera, form = self.interaction.drawn_view.camera, self._form(level, style)
        picture = self._renderer.render(camera, style.look, form, gizmos=overlay.primitives, style=overlay.style)
        self._sharpness.add_measurement(level, self._clock() - begin)
        return picture

    def _form(self, level: Level, style: PageStyle) -> Format:
        width, height = (max(round(self._ratio * length), 1) for length in self.interaction.view.size)
        shrink = min((_MOST_PIXELS / (width * height)) ** 0.5, LARGEST_SIDE / max(width, height), 1.0) * level.scale
        size = bounded_size(shrink * width, shrink * height)
        return Format(*size, shadows=style.shadows, samples=level.samples, scale=shrink)

    def send_picture(self, connection: Connection, style: PageStyle) -> None:
        """Send the current picture to be saved by the browser."""
        shaded = style._replace(shadows=style.shadows is not False)
        content = encoding.as_still(self._picture(self.interaction.overlay(), shaded), is_exact=True)
        self.send_file(connection, free_path(".png").name, content)

    def send_file(self, connection: Connection, name: str, content: bytes) -> None:
        """Send a file to be saved by the browser."""
        connection.send(json.dumps({"task": "save", "name": name, "data": base64.b64encode(content).decode()}))

    def send_text(self, connection: Connection, text: str) -> None:
        """Send a text for the browser's clipboard."""
        connection.send(json.dumps({"task": "copy", "text": text}))

    def _send(self, connection: Connection, update: _Update, style: PageStyle) -> None:
        pacing, overlay = self._pacing, self._overlay
        if isinstance(update, list):
            if update:
                pacing.sent(is_moving=False)
            for message in update:
                connection.send(message)
        elif overlay is not None:
            pacing.sent(is_moving=not self._is_crisp)
            labels = overlay.labels_on(self.interaction.drawn_view)
            text = {**self._text(overlay, style), "labels": labels, "crisp": self._is_crisp}
            if overlay.tree is self._tree:  # only if it has changed, since it may be long
                del text["tree"]
            self._tree = overlay.tree
            connection.send(json.dumps(text, default=asdict))
            if self._is_crisp:
                connection.send(encoding.as_still(update, is_exact=pacing.is_good))
            else:
                connection.send(encoding.as_jpeg(update, pacing.quality))

    def _news(self, feed: Feed, stage: Stage, overlay: Overlay, style: PageStyle) -> list[str | bytes]:
        """Return messages with all changes, for a page that renders the scene itself."""
        labels = [(*label.point.tolist(), label.text) for label in overlay.labels]
        text = {**self._text(overlay, style), "labels": labels, "look": stage.look, "crisp": True}
        return feed.messages(stage, self.interaction.drawn_view, text, self._acknowledged)

    def _text(self, overlay: Overlay, style: PageStyle) -> dict[str, object]:
        """Return the texts and controls of a page, by message field."""
        return {
            "lines": overlay.lines,
            "textSize": overlay.text_size,
            "mode": self.interaction.mode.value,
            "title": style.title,
            "cursor": overlay.cursor,
            "controls": overlay.controls,
            "help": page_sections() if overlay.help else (),
            "tree": overlay.tree,
            "chosen": overlay.chosen,
            "tab": self.tab,
        }
