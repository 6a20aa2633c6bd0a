"""The viewer in a browser."""

import itertools
import logging
import re
import threading
import time
import weakref
from collections.abc import Iterable
from contextlib import suppress
from functools import partial

from numpy.typing import ArrayLike
from websockets.exceptions import ConnectionClosed
from websockets.frames import CloseCode
from websockets.sync.server import ServerConnection

from ravemj.core.flags import Flag
from ravemj.core.forks import in_this_process
from ravemj.engine.simulation import Simulation
from ravemj.errors import RavemjError
from ravemj.graphics.rendering.style import AS_IT_IS
from ravemj.graphics.simulation_renderer import SimulationRenderer
from ravemj.gui.interaction import Interaction, Request
from ravemj.gui.viewers.notebook import in_notebook, mimebundle, show
from ravemj.gui.viewers.recorder import FrameSource
from ravemj.gui.viewers.viewer import Viewer
from ravemj.gui.viewers.web.client import Client, PageStyle, receive
from ravemj.gui.viewers.web.scenes import Scenes
from ravemj.gui.viewers.web.server import LOOPBACK, PageServer, is_local
from ravemj.gui.viewers.web.uploads import PageUploads, UploadQuota

_LOG = logging.getLogger("ravemj")
_LONGEST_SYNC, _SYNC_STEP = 0.5, 0.005
_MOST_TABS = 64
"""Number of tabs whose views are kept after a lost connection."""


class WebViewer(Viewer):
    """A viewer in a browser, at ``viewer.url``. Each page has its own camera; all pages share the selection.

    Only browsers on this machine can connect, and only with the secret in the URL.

    Attributes:
        url: Address of the page.
        server: The web server.
    """

    _internal = ("announce", "connect_page", "disconnect_page", "first_scene", "handle_messages", "server")

    def __init__(
        self,
        simulation: Simulation,
        renderer: SimulationRenderer,
        name: str,
        host: str = LOOPBACK,
        port: int = 0,
        *,
        token: str | None = None,
        any_name: bool = False,
    ) -> None:
        """Serve the page.

        Args:
            simulation: The simulation to show.
            renderer: Renders the pictures.
            name: Name of the viewer.
            host: Interface to listen on; by default, only this machine can connect.
            port: Port number; 0 selects a free one.
            token: The secret in the URL; None generates one.
            any_name: Whether any ``Host`` header is accepted, as needed behind a proxy.

        Raises:
            RenderingError: the port is not available.
            ArgumentError: the token is too short, or has invalid characters.
        """
        super().__init__(simulation, renderer, name)
        self._new_client = Client
        self._clients: dict[ServerConnection, Client] = {}
        self._uploads: dict[ServerConnection, PageUploads] = {}
        self._quota = UploadQuota()
        self._views: dict[str, Interaction] = {}
        self._videos: list[tuple[Interaction, str, bytes]] = []  # the page that requested them, and the files
        self._lock = threading.Lock()
        self._scenes = Scenes()
        self._ended = Flag()  # set early: a page may connect before the constructor of the server returns
        reference: weakref.ref[WebViewer] = weakref.ref(self)
        self.server = PageServer(
            host,
            port,
            lambda connection: _serve(reference, connection),
            self._scenes.content,
            lambda: _first_scene(reference),
            token=token,
            any_name=any_name or not is_local(host),
        )
        self._ended = self.server.closed
        self.url = self.server.url(host)
        self._end = weakref.finalize(self, in_this_process(self.server.close))

    def SetCamera(self, transform: ArrayLike, focalDistance: float = 0.0) -> None:
        """Set the camera of all pages; see ``Viewer.SetCamera``."""
        with self._simulation.lock, self._lock:  # in this order: the holder of the first lock may be in here
            super().SetCamera(transform, focalDistance)
            for interaction in self._views.values():
                interaction.look_from(self.camera, self.GetCameraDistanceToFocus())

    def EnvironmentSync(self) -> None:
        """Block until all pages were sent the present state of the environment, at most half a second.

        Hidden tabs are ignored.
        """
        with self._lock:
            looks = {client: client.updates for client in self._clients.values() if not client.is_stalled}
        end = time.monotonic() + _LONGEST_SYNC
        # an update in progress may have started earlier
        while any(client.updates < before + 2 for client, before in looks.items()) and time.monotonic() < end:
            time.sleep(_SYNC_STEP)

    def quitmainloop(self) -> None:
        """End ``main``; pages show that the viewer has closed."""
        self._ended.set()

    def close(self) -> None:
        """Close the viewer and its pages."""
        self._end()
        super().close()
        for _, name, _ in self._videos:
            _LOG.warning("the video %s is lost: no page was there to take it", name)

    def announce(self) -> None:
        """Display the page below the notebook cell; elsewhere, log its URL."""
        if in_notebook():
            show(self)
        else:
            _LOG.warning("the viewer is at %s", self.url)

    def _repr_mimebundle_(self, **_: object) -> dict[str, str]:
        """Return the notebook display of the viewer: its page if the server answers, and a picture."""
        try:
            picture = self.render()
        except RavemjError:  # no renderer works here, or MuJoCo refuses a body
            picture = None
        bundle = mimebundle(self.url, picture, lambda: self.GetEnv().animation()._repr_html_())
        return {"text/plain": repr(self), **bundle}

    def first_scene(self) -> str:
        """Return the name of the geometry that a new page needs; empty while other threads hold the lock."""
        with self._simulation.lock.attempt(_SYNC_STEP) as is_free, suppress(RavemjError):  # which the page says
            if is_free:
                model = self._simulation.compiled().model
                return self._scenes.packed(model, self._simulation.version, AS_IT_IS).name
        return ""

    def connect_page(self, connection: ServerConnection) -> None:
        """Start to serve a page; a page that reconnects gets its earlier view.

        Frames of one tab and duplicated tabs request the same view. If this is in use, the page gets a new view, whose
        name has a number appended.
        """
        wanted = _tab(connection)
        with self._lock:
            open_tabs = {client.tab for client in self._clients.values()}
            first, _, _ = wanted.partition(".")
            names = itertools.chain([wanted], (f"{first}.{number}" for number in itertools.count(1)))
            tab = next(name for name in names if name not in open_tabs)
            like = self._views.get(wanted, self.interaction)
            view = self._views.pop(tab, None) or like.another_view(has_tools=False)
            self._views[tab] = view
            for oldest in [name for name in self._views if name not in open_tabs][:-_MOST_TABS]:
                del self._views[oldest]
            client = self._clients[connection] = self._new_client(self._simulation, self._renderer, view, self._scenes)
            client.tab = tab
            self._uploads[connection] = PageUploads(self._quota)

    def handle_messages(self, connection: ServerConnection, messages: Iterable[str | bytes]) -> float:
        """Handle the messages of a page and send an update if one is due; return how long to wait for messages [s].

        The viewer's camera follows the page on which the camera was moved last.
        """
        client = self._clients[connection]
        client.queue_messages(messages, self.server.complain)
        style = PageStyle(self.look, self._choices.shadows, self._title)
        picture = client.handle_messages(connection, style, is_watched=bool(self._image_callbacks))
        if client.pop_moved():
            with self._lock:  # else a camera that a script is setting, view by view, would be lost
                self.interaction.copy_view(client.interaction.view)
        if picture is not None:
            self._image_callbacks.call(picture)
        for name, content in self._videos_for(client.interaction):
            client.send_file(connection, name, content)
        for request in client.interaction.controls.pop_requests():
            self._grant(request, client, connection, style)
        if client.chunks:
            self._add_chunks(client, self._uploads[connection])
        return client.patience

    def _add_chunks(self, client: Client, uploads: PageUploads) -> None:
        """Add the received chunks to uploads, and load completed uploads into the environment."""
        notices = client.interaction.controls.notices
        while client.chunks:
            trouble = uploads.add(client.chunks.popleft())
            if trouble:
                self.server.complain(trouble)
                notices.say(trouble)
        while uploads.complete:
            uploads.complete.pop(0).add_to(self.host(), notices)

    def _grant(self, request: Request | str, client: Client, connection: ServerConnection, style: PageStyle) -> None:
        """Perform an action that needs the page or writes files, such as a picture or a video."""
        if request is Request.PICTURE:
            try:
                client.send_picture(connection, style)
            except RavemjError as error:
                client.interaction.controls.notices.say(error.message)
        elif request is Request.VIDEO:
            source = FrameSource(client.interaction, self._renderer, self.look)
            self._recorder.record(source, self.playback, partial(self._keep_video, client.interaction))
        else:
            client.send_text(connection, request)
            _LOG.info("%s", request)

    def _keep_video(self, interaction: Interaction, name: str, content: bytes) -> None:
        """Store a video for the page that requested it, or for another page if that has disconnected."""
        with self._lock:
            self._videos.append((interaction, name, content))

    def _videos_for(self, interaction: Interaction) -> list[tuple[str, bytes]]:
        """Remove and return the videos to send to a page: its own, and those of disconnected pages."""
        with self._lock:
            others = {client.interaction for client in self._clients.values()} - {interaction}
            videos = [(name, content) for asker, name, content in self._videos if asker not in others]
            self._videos = [video for video in self._videos if video[0] in others]
        return videos

    def disconnect_page(self, connection: ServerConnection) -> None:
        """Release a page that has disconnected, in the thread that rendered for it."""
        with self._lock:
            client, uploads = self._clients.pop(connection, None), self._uploads.pop(connection, None)
            is_last = not self._clients
        if is_last:
            self._recorder.stop()
        if uploads is not None:
            uploads.close()
        if client is not None:
            client.interaction.cancel_drag()
        self._renderer.close()


def _first_scene(reference: "weakref.ref[WebViewer]") -> str:
    viewer = reference()
    return "" if viewer is None else viewer.first_scene()


def _serve(reference: "weakref.ref[WebViewer]", connection: ServerConnection) -> None:
    """Serve a page until it disconnects or the viewer is closed or collected; waiting holds no strong reference."""
    viewer = reference()
    if viewer is None:
        return
    viewer.connect_page(connection)
    messages: list[str | bytes] = []
    try:
        while viewer is not None and viewer.is_open:
            patience = viewer.handle_messages(connection, messages)
            viewer = None
            messages = receive(connection, patience) if patience else []
            viewer = reference()
        connection.close(CloseCode.GOING_AWAY)
    except ConnectionClosed as error:
        viewer = reference()
        if viewer is not None and error.sent is not None and error.sent.code == CloseCode.MESSAGE_TOO_BIG:
            viewer.server.complain("a message is too long")
    except Exception:
        _LOG.exception("a viewer's page has failed")
    finally:
        viewer = reference()
        if viewer is not None:
            viewer.disconnect_page(connection)


def _tab(connection: ServerConnection) -> str:
    """Return the tab name that a page sends, or a new one."""
    request = connection.request
    match = None if request is None else re.search(r"\?tab=([A-Za-z0-9-]{1,40}(?:\.\d{1,3})?)$", request.path)
    return match[1] if match else f"#{id(connection)}"
