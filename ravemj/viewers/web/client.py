"""One page in a browser: its events in, pictures of its view out."""

import contextlib
import io
import json
import logging
import time
from typing import Protocol

from ravemj.errors import RavemjError
from ravemj.interaction import Interaction, Overlay
from ravemj.simulation import Simulation
from ravemj.studio import Format, Frame, Studio
from ravemj.viewers.painter import appearance
from ravemj.viewers.web.messages import Ready, Shape, parse

_LOG = logging.getLogger("ravemj")
_PERIOD = 1 / 60
_REST = 0.3
"""After so long without a change [s], the picture is sent once more, crisp."""

_MOVING_QUALITY, _RESTING_QUALITY = 75, 95
_MOST_PIXELS = 1920 * 1440
_PATIENCE_WITH_NONSENSE = 5
_MOST_AT_ONCE = 100
"""Messages that are taken in before the next picture."""


class Connection(Protocol):
    """What connects to a page: ``websockets``' connections do."""

    def recv(self, timeout: float | None = None) -> str | bytes:
        """Wait for a message."""
        ...

    def send(self, message: str | bytes) -> None:
        """Send text or bytes."""
        ...


class Client:
    """Serves one page, in a thread of its own."""

    def __init__(self, simulation: Simulation, studio: Studio, interaction: Interaction) -> None:
        self.interaction = interaction
        self._simulation = simulation
        self._studio = studio
        self._ratio = 1.0
        self._is_ready = False
        self._seen: object = None
        self._changed_at = 0.0
        self._is_crisp = True
        self._nonsense = 0

    def take_in(self, connection: Connection) -> None:
        """Wait for messages for at most a frame's time, and do what they say.

        Raises:
            TimeoutError: none came.
        """
        self._do(connection.recv(timeout=_PERIOD))
        with contextlib.suppress(TimeoutError):  # moves come faster than pictures can be drawn
            for _ in range(_MOST_AT_ONCE):
                self._do(connection.recv(timeout=0))

    def _do(self, text: str | bytes) -> None:
        try:
            message = parse(text)
        except ValueError as error:
            self._nonsense += 1
            if self._nonsense <= _PATIENCE_WITH_NONSENSE:
                _LOG.warning("a message of a viewer's page is ignored: %s", error)
            return
        if isinstance(message, Ready):
            self._is_ready = True
        elif isinstance(message, Shape):
            self._ratio = message.ratio
            self.interaction.handle(message.resize)
        else:
            self.interaction.handle(message)

    def show(self, connection: Connection, background: tuple[float, float, float]) -> None:
        """Send a picture if the page takes one, and anything has changed or come to rest."""
        if not self._is_ready:
            return
        try:
            overlay = self._look(background)
            picture = None if overlay is None else self._picture(overlay, background)
        except RavemjError as error:
            if self._seen is not None:
                _LOG.error("a page cannot show the environment: %s", error)
            self._seen = None
            return
        if overlay is not None and picture is not None:
            self._is_ready = False
            connection.send(_text(overlay))
            connection.send(jpeg(picture, _RESTING_QUALITY if self._is_crisp else _MOVING_QUALITY))

    def _look(self, background: tuple[float, float, float]) -> Overlay | None:
        """Return what is to be drawn over the bodies if a picture is due, else None."""
        if not self._simulation.lock.acquire(timeout=_PERIOD):  # who holds it may wait for this thread to end
            return None
        try:
            seen = appearance(self._simulation), self.interaction.version, background, self._ratio
            now = time.monotonic()
            if seen != self._seen:
                self._seen, self._changed_at, self._is_crisp = seen, now, False
            elif self._is_crisp or now - self._changed_at < _REST:
                return None
            else:
                self._is_crisp = True
            return self.interaction.overlay()
        finally:
            self._simulation.lock.release()

    def _picture(self, overlay: Overlay, background: tuple[float, float, float]) -> Frame:
        width, height = (max(round(self._ratio * length), 1) for length in self.interaction.view.size)
        shrink = min((_MOST_PIXELS / (width * height)) ** 0.5, 1.0)
        form = Format(max(int(width * shrink), 1), max(int(height * shrink), 1))
        return self._studio.picture(self.interaction.view.camera, background, form, gizmos=overlay.shapes)


def _text(overlay: Overlay) -> str:
    panels = [[*panel.rect, *panel.rgba, panel.text] for panel in overlay.panels]
    return json.dumps({"lines": overlay.lines, "panels": panels})


def jpeg(picture: Frame, quality: int) -> bytes:
    """Return a picture as the bytes of a JPEG file."""
    from PIL import Image  # noqa: PLC0415 - slow to import

    file = io.BytesIO()
    Image.fromarray(picture).save(file, "JPEG", quality=quality)
    return file.getvalue()
