"""Data that scripts attach to interfaces under an id, as OpenRAVE's readers of custom XML tags do."""

from typing import Any

from ravemj.core.api_object import ApiObject


class Readable(ApiObject):
    """A value with an id. ``stringreaders.CreateStringReadable`` makes one from a text."""

    def __init__(self, id: str, data: Any = "") -> None:  # noqa: ANN401 - what JSON can hold
        self._id = str(id)
        self._data = data

    def GetXMLId(self) -> str:
        """Return the id."""
        return self._id

    def SerializeXML(self, options: int = 0) -> str:
        """Return the value as an XML element whose tag is the id; ``options`` has no effect."""
        from xml.sax.saxutils import escape  # noqa: PLC0415 - imports urllib, which is slow

        del options
        return f"<{self._id}>{escape(str(self._data))}</{self._id}>"

    def SerializeJSON(self, unitScale: float = 1.0, options: int = 0) -> Any:  # noqa: ANN401 - what JSON can hold
        """Return the value.

        Args:
            unitScale: Not used.
            options: Not used.
        """
        del unitScale, options
        return self._data

    def DeserializeJSON(self, obj: Any, unitScale: float = 1.0) -> None:  # noqa: ANN401 - what JSON can hold
        """Set the value.

        Args:
            obj: The value.
            unitScale: Not used.
        """
        del unitScale
        self._data = obj

    def __repr__(self) -> str:
        return f"stringreaders.CreateStringReadable({self._id!r}, {self._data!r})"


class ReadableInterface(ApiObject):
    """An object with values under ids."""

    _readables: dict[str, Readable] | None = None

    def GetReadableInterface(self, id: str) -> Readable | None:
        """Return the value under ``id``, or None."""
        return (self._readables or {}).get(id)

    def GetReadableInterfaces(self) -> dict[str, Readable]:
        """Return all values by their ids."""
        return dict(self._readables or {})

    def SetReadableInterface(self, id: str, readable: Readable | None) -> None:
        """Attach a value.

        Args:
            id: The id.
            readable: The value; None removes the value of that id.
        """
        kept = {key: one for key, one in (self._readables or {}).items() if key != id}
        self._readables = kept if readable is None else kept | {id: readable}


class stringreaders:  # noqa: N801 - OpenRAVE's name
    """Makes values from texts."""

    @staticmethod
    def CreateStringReadable(id: str, data: str) -> Readable:
        """Return a text under an id.

        Args:
            id: The id.
            data: The text.
        """
        return Readable(id, str(data))


class xmlreaders:  # noqa: N801 - OpenRAVE's name
    """Makes values from texts, under OpenRAVE's older names."""

    @staticmethod
    def CreateStringXMLReadable(xmlid: str, data: str) -> Readable:
        """Return a text under an id.

        Args:
            xmlid: The id.
            data: The text.
        """
        return Readable(xmlid, str(data))


class SerializableData(ApiObject):
    """A text that scripts attach and read back.

    Args:
        data: The text.
    """

    def __init__(self, data: str = "") -> None:
        self._data = data

    def Serialize(self, options: int = 0) -> str:
        """Return the text; ``options`` has no effect."""
        del options
        return self._data

    def Deserialize(self, data: str) -> None:
        """Set the text to ``data``."""
        self._data = data

    def Close(self) -> None:
        """Clear the text."""
        self._data = ""

    close = Close
