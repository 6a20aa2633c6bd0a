"""The module ``urdf`` of the plugin or_urdf, which ROS scripts use to load robots."""

import json
import logging
from typing import TYPE_CHECKING

from ravemj.errors import ArgumentError, Source, SourceError
from ravemj.formats.file_access import FileAccess
from ravemj.formats.urdf import OR_URDF
from ravemj.formats.urdf.packages import Packages
from ravemj.rave.interface import Module
from ravemj.rave.kinbody import KinBody

if TYPE_CHECKING:
    from ravemj.rave.environment import Environment

_LOG = logging.getLogger("ravemj")


def urdf_module(env: "Environment", xmlid: str) -> Module:
    """Make a module that adds robots from URDF files.

    Like or_urdf's, it sorts links and joints by name, gives bodies unique names, makes a KinBody of a URDF without an
    SRDF, and answers with the name of the body.
    """

    def load_uri(arguments: str) -> str | None:
        """Add a robot: ``LoadURI URDF [SRDF]``, files or URIs ``package://…``."""
        uris = arguments.split()
        if not 1 <= len(uris) <= 2:
            raise ArgumentError("LoadURI: write the URDF, and behind a blank the SRDF if there is one")
        try:
            files = [_file(uri) for uri in uris]
        except SourceError as error:
            _LOG.error("%s", error)
            return None
        return _added(env, env.ReadKinBodyURI(files[0], _given(files[1:])))

    def load(arguments: str) -> str | None:
        """Deprecated name of ``LoadURI``."""
        _LOG.warning("the command 'load' of the module urdf is deprecated; use LoadURI")
        return load_uri(arguments)

    def load_string(arguments: str) -> str | None:
        """Add a robot from text: ``LoadString {"urdf": "<robot …>", "srdf": "<robot …>"}``."""
        try:
            texts = json.loads(arguments)
            urdf, srdf = texts["urdf"], texts.get("srdf", "")
        except (ValueError, TypeError, KeyError, AttributeError, RecursionError):
            raise ArgumentError('LoadString: write JSON with texts: {"urdf": "…", "srdf": "…"}') from None
        if not (isinstance(urdf, str) and isinstance(srdf, str)):
            raise ArgumentError("LoadString: urdf and srdf should be texts")
        return _added(env, env.ReadKinBodyData(urdf, _given([srdf] if srdf else [])))

    return Module(env, xmlid, lambda arguments: None, {"LoadURI": load_uri, "load": load, "LoadString": load_string})


def _given(srdf: list[str]) -> dict[str, str]:
    return {"like": OR_URDF, **({"srdf": srdf[0]} if srdf else {})}


def _file(uri: str) -> str:
    """Return the file of a URI; a path stays as it is.

    Raises:
        SourceError: the package does not exist.
    """
    if "://" not in uri:
        return uri
    package_file = Packages("", FileAccess.opened(uri), {}).find(uri)
    if package_file.path is None:
        raise SourceError(f"there is no file {uri}", Source(uri), "set ROS_PACKAGE_PATH for package://")
    return package_file.path


def _added(env: "Environment", body: KinBody | None) -> str | None:
    """Add a body, renamed if its name is taken, and return its name."""
    if body is None:
        return None
    env.Add(body, True)
    return body.GetName()
