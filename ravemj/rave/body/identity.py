"""Where a body comes from, and what tells it from others."""

import os

from ravemj.model import hashes
from ravemj.model.shape_bodies import FROM_SCRIPT
from ravemj.rave.body.base import BodyPart

_NO_FILES = frozenset({FROM_SCRIPT.file, "data"})
"""Sources of bodies that were read from no file; ``data`` is what readers call a text."""


class Identity(BodyPart):
    """The file of a body, its id, and the text that its hash is made of.

    OpenRAVE's ids, revisions and reference files belong to databases of models, which ravemj has none of: they are what
    scripts set, or empty.
    """

    _uri: str | None = None
    """What ``InitFrom…`` was given; None: the file that the body was read from."""
    _id = ""

    def GetURI(self) -> str:
        """Return the file that the body was read from, as ``file:/path``; empty where it was made in code.

        What ``InitFromBoxes`` and the like were given as ``uri`` is returned as it is.
        """
        if self._uri is not None:
            return self._uri
        file = self._state.scene.source.file
        return "" if file in _NO_FILES else f"file:{os.path.abspath(file)}"

    GetXMLFilename = GetURI

    def GetReferenceURI(self) -> str:
        """Return the file that the body refers to in OpenRAVE's JSON: empty, since none is read."""
        return ""

    def GetAssociatedFileEntries(self) -> None:
        """Return the files of a database that the body came with: None."""

    def GetId(self) -> str:
        """Return the text of ``SetId``; empty in a new body."""
        return self._id

    def SetId(self, id: str) -> None:  # OpenRAVE's name of the argument
        """Give the body an id, for scripts that know bodies by one; names stay what tells bodies apart.

        Args:
            id: The text.
        """
        self._id = str(id)

    def GetRevisionId(self) -> int:
        """Return the revision of the body in a database: 0."""
        return 0

    def GetLastModifiedAtUS(self) -> int:
        """Return when the body was last changed in a database: 0."""
        return 0

    def GetManageData(self) -> None:
        """Return what a sensor system keeps about the body: None, since there is no sensor system."""

    def serialize(self, options: int) -> str:
        """Return a text that is the same for bodies with the same links, shapes and joints.

        ``GetKinematicsGeometryHash`` is its hash. It is not the text that OpenRAVE writes.

        Args:
            options: Not used: what counts is always the same.
        """
        del options
        return hashes.text_of_body(self._state.scene)
