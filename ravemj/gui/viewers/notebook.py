"""Viewers in notebook cells: live if their server can be reached, else as a picture."""

import html
import importlib.util
import os
import sys
from base64 import b64encode
from collections.abc import Callable
from typing import Any

from ravemj.graphics.simulation_renderer import Frame
from ravemj.graphics.video import picture_bytes

_HEIGHT, _LINES = 480, 60  # pixels; the second is that of _ALONE in a narrow cell
_PROXY = "jupyter_server_proxy"
_PREFIX = "JUPYTERHUB_SERVICE_PREFIX"
"""Environment variable with the URL prefix of a user's JupyterHub server."""

_ELSEWHERE = (_PREFIX, "SSH_CONNECTION", "VSCODE_IPC_HOOK_CLI", "CODESPACES", "KAGGLE_KERNEL_RUN_TYPE")
"""Environment variables that indicate a browser on another machine, which cannot reach ports of this one."""

_ALONE = (
    "No port of this machine reaches the browser, so this page draws what was there when the cell ran. "
    "<code>pip install jupyter-server-proxy</code>, or <code>ssh -L {port}:127.0.0.1:{port}</code>, makes it live."
)


def in_notebook() -> bool:
    """Return whether Python runs in a notebook kernel."""
    ipython: Any = sys.modules.get("IPython")
    return ipython is not None and hasattr(ipython.get_ipython(), "kernel")


def is_proxied() -> bool:
    """Return whether browsers reach this machine through a proxy: ``jupyter-server-proxy`` or Colab."""
    return in_notebook() and (_in_colab() or importlib.util.find_spec(_PROXY) is not None)


def _in_colab() -> bool:
    return "google.colab" in sys.modules


def mimebundle(url: str, picture: Frame | None, still: Callable[[], str]) -> dict[str, str]:
    """Return the displayed content of a viewer in notebooks, by MIME type.

    The HTML shows the page if its server answers, else a picture, as in a saved notebook. In Colab, Colab's own
    helper shows the page.

    Args:
        url: Address of the page.
        picture: The current picture of the viewer; None if no renderer works on this machine.
        still: Returns the scene as self-contained HTML, for browsers that cannot reach this machine's ports.
    """
    port, path = url.split("/", 3)[2].rpartition(":")[2], url.split("/", 3)[3]
    if _in_colab():
        from google.colab import output  # noqa: PLC0415 # pyright: ignore - only there

        output.serve_kernel_port_as_iframe(int(port), path=f"/{path}", height=str(_HEIGHT))  # pyright: ignore
        return {}
    instead, height = "" if picture is None else _image(picture), _HEIGHT
    if is_proxied():
        url = f"{os.environ.get(_PREFIX, '/')}proxy/{port}/{path}"
    elif any(map(os.environ.get, _ELSEWHERE)):
        instead, height = f"<div>{_ALONE.format(port=port)}</div>{still()}", _HEIGHT + _LINES
    address = html.escape(url)
    # Where the server does not answer, the object has no size, and what is behind it moves up. It is no content of the
    # object, since Chromium does not show that in the cells of JupyterLab, which have content-visibility: auto.
    live = (
        f'<div style="height: {height}px; overflow: hidden"><object data="{address}" type="text/html" '
        f'aria-label="ravemj viewer" style="width: 100%; height: {height}px"></object>{instead}</div>'
        f'<div><a href="{address}" target="_blank" rel="noopener">in a tab of its own</a></div>'
    )
    png = {} if picture is None else {"image/png": b64encode(picture_bytes(picture)).decode()}
    return {"text/html": live, **png}


def _image(picture: Frame) -> str:
    data = b64encode(picture_bytes(picture, ".webp")).decode()
    style = f"max-width: 100%; max-height: {_HEIGHT}px"
    return f'<img src="data:image/webp;base64,{data}" alt="what the viewer showed" style="{style}">'


def show(viewer: object) -> None:
    """Display an object below the running cell."""
    from IPython.display import display  # noqa: PLC0415 - only where IPython runs  # pyright: ignore

    display(viewer)
