"""The viewer whose window is a page in a browser."""

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
"""So many tabs find their own view again after their connection was lost."""


class WebViewer(Viewer):
    """A viewer in a browser: ``viewer.url`` opens it. Each page has a camera of its own; all share what is selected.

    Pages of this machine only can connect, and only with the secret that is in the URL.

    Attributes:
        url: The page.
        server: Listens for pages.
    """

    _internal = ("announce", "attend", "dismiss", "first_scene", "server", "welcome")

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
            simulation: What it shows.
            renderer: What draws the pictures.
            name: Name of the viewer.
            host: Interface that browsers come to; another than the default lets those of other machines in.
            port: Number of the port; 0: any that is free.
            token: The secret in the address; None: a new one.
            any_name: Whether browsers may know this machine by any name, as they do behind a proxy.

        Raises:
            RenderingError: this port cannot be had.
            ArgumentError: the token is too short, or has letters that no address has.
        """
        super().__init__(simulation, renderer, name)
        self._clients: dict[ServerConnection, Client] = {}
        self._uploads: dict[ServerConnection, PageUploads] = {}
        self._quota = UploadQuota()
        self._views: dict[str, Interaction] = {}
        self._videos: list[tuple[Interaction, str, bytes]] = []  # whoever asked for them, and files for the browser
        self._lock = threading.Lock()
        self._scenes = Scenes()
        self._ended = Flag()  # open: a page may come before the server is returned
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
        with self._simulation.lock, self._lock:  # in this order: who has the first one may be here
            super().SetCamera(transform, focalDistance)
            for interaction in self._views.values():
                interaction.look_from(self.camera, self.GetCameraDistanceToFocus())

    def EnvironmentSync(self) -> None:
        """Wait until all pages were sent the environment as it is now; half a second at most, where one is slow.

        Tabs that nobody sees are not waited for.
        """
        with self._lock:
            looks = {client: client.looks for client in self._clients.values() if not client.is_stalled}
        end = time.monotonic() + _LONGEST_SYNC
        # the look that is under way may have begun before
        while any(client.looks < before + 2 for client, before in looks.items()) and time.monotonic() < end:
            time.sleep(_SYNC_STEP)

    def quitmainloop(self) -> None:
        """End ``main``; pages are told that the viewer has closed."""
        self._ended.set()

    def close(self) -> None:
        """Close the viewer and its pages."""
        self._end()
        super().close()
        for _, name, _ in self._videos:
            _LOG.warning("the video %s is lost: no page was there to take it", name)

    def announce(self) -> None:
        """Show the page below the cell of a notebook; elsewhere, log its address."""
        if in_notebook():
            show(self)
        else:
            _LOG.warning("the viewer is at %s", self.url)

    def _repr_mimebundle_(self, **_: object) -> dict[str, str]:
        """Return what notebooks show for a viewer: its page where the server answers, and a picture."""
        try:
            picture = self.render()
        except RavemjError:  # nothing can draw here, or MuJoCo refuses a body
            picture = None
        bundle = mimebundle(self.url, picture, lambda: self.GetEnv().animation()._repr_html_())
        return {"text/plain": repr(self), **bundle}

    def first_scene(self) -> str:
        """Return the name of the surfaces that a new page will draw; empty where somebody has the environment."""
        with self._simulation.lock.attempt(_SYNC_STEP) as is_free, suppress(RavemjError):  # which the page says
            if is_free:
                model = self._simulation.compiled().model
                return self._scenes.of(model, self._simulation.version, AS_IT_IS).name
        return ""

    def welcome(self, connection: ServerConnection) -> None:
        """Take a page up; one that was here before has the view that it had.

        Frames of one tab, and tabs that were duplicated, ask for the same view: who comes while it is shown has another
        one, with a number behind its name.
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
            client = self._clients[connection] = Client(self._simulation, self._renderer, view, self._scenes)
            client.tab = tab
            self._uploads[connection] = PageUploads(self._quota)

    def attend(self, connection: ServerConnection, messages: Iterable[str | bytes]) -> float:
        """Do what a page says and send it a picture if one is due; return how long to wait for more that it says [s].

        The viewer's camera becomes that of the page where it was moved last.
        """
        client = self._clients[connection]
        client.take_in(messages, self.server.complain)
        style = PageStyle(self.look, self._choices.shadows, self._title)
        picture = client.attend(connection, style, is_watched=bool(self._image_callbacks))
        if client.take_moved():
            with self._lock:  # or a script's camera, which comes to the views one by one, would be lost
                self.interaction.look_as(client.interaction.view)
        if picture is not None:
            self._image_callbacks.call(picture)
        for name, content in self._videos_for(client.interaction):
            client.send_file(connection, name, content)
        for request in client.interaction.controls.take_requests():
            self._grant(request, client, connection, style)
        if client.pieces:
            self._take_pieces(client, self._uploads[connection])
        return client.patience

    def _take_pieces(self, client: Client, uploads: PageUploads) -> None:
        """Take in what a page sends of files, and add complete ones."""
        notices = client.interaction.controls.notices
        while client.pieces:
            trouble = uploads.add(client.pieces.popleft())
            if trouble:
                self.server.complain(trouble)
                notices.say(trouble)
        while uploads.complete:
            uploads.complete.pop(0).add_to(self.GetEnv(), notices)

    def _grant(self, request: Request | str, client: Client, connection: ServerConnection, style: PageStyle) -> None:
        """Do what a button asked for that needs the page, or writes here."""
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
        """Keep a video until the page that asked for it takes it, or another one if that has gone."""
        with self._lock:
            self._videos.append((interaction, name, content))

    def _videos_for(self, interaction: Interaction) -> list[tuple[str, bytes]]:
        """Return the videos that a page gets, and forget them."""
        with self._lock:
            others = {client.interaction for client in self._clients.values()} - {interaction}
            found = [(name, content) for asker, name, content in self._videos if asker not in others]
            self._videos = [video for video in self._videos if video[0] in others]
        return found

    def dismiss(self, connection: ServerConnection) -> None:
        """Forget a page that has left, in the thread that drew for it."""
        with self._lock:
            client, uploads = self._clients.pop(connection, None), self._uploads.pop(connection, None)
            is_last = not self._clients
        if is_last:
            self._recorder.stop()
        if uploads is not None:
            uploads.close()
        if client is not None:
            client.interaction.let_go()
        self._renderer.close()


def _first_scene(reference: "weakref.ref[WebViewer]") -> str:
    viewer = reference()
    return "" if viewer is None else viewer.first_scene()


def _serve(reference: "weakref.ref[WebViewer]", connection: ServerConnection) -> None:
    """Exchange messages with a page until it leaves, or the viewer is closed or gone, which waiting does not keep."""
    viewer = reference()
    if viewer is None:
        return
    viewer.welcome(connection)
    messages: list[str | bytes] = []
    try:
        while viewer is not None and viewer.is_open:
            patience = viewer.attend(connection, messages)
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
            viewer.dismiss(connection)


def _tab(connection: ServerConnection) -> str:
    """Return the name that a page gives itself, or an own one for those that do not."""
    request = connection.request
    found = None if request is None else re.search(r"\?tab=([A-Za-z0-9-]{1,40}(?:\.\d{1,3})?)$", request.path)
    return found[1] if found else f"#{id(connection)}"
