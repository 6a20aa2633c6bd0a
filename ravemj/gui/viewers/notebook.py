"""Viewers in the cells of notebooks."""

import html
import importlib.util
import os
import sys
from typing import Any

_HEIGHT = 480
_PROXY = "jupyter_server_proxy"
_PREFIX = "JUPYTERHUB_SERVICE_PREFIX"
"""The variable that says where JupyterHub has a user's server."""


def in_notebook() -> bool:
    """Return whether Python runs for a notebook."""
    ipython: Any = sys.modules.get("IPython")
    return ipython is not None and hasattr(ipython.get_ipython(), "kernel")


def is_proxied() -> bool:
    """Return whether browsers come through the notebook's server, which ``jupyter-server-proxy`` lets them."""
    return in_notebook() and importlib.util.find_spec(_PROXY) is not None


def frame(url: str, path: str) -> str:
    """Return the HTML that shows a page in a cell: its URL, or behind a proxy its port and path, ``8080/secret/``."""
    if is_proxied():
        url = f"{os.environ.get(_PREFIX, '/')}proxy/{path}"
    address = html.escape(url)
    return (
        f'<iframe src="{address}" title="ravemj viewer" style="width: 100%; height: {_HEIGHT}px; border: 0" '
        f'allow="fullscreen"></iframe><div><a href="{address}" target="_blank" rel="noopener">in a tab of its own</a>'
        "</div>"
    )


def show(viewer: object) -> None:
    """Show an object below the cell that runs."""
    from IPython.display import display  # noqa: PLC0415 - only where IPython runs  # pyright: ignore

    display(viewer)
