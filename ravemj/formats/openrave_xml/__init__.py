"""Reader of OpenRAVE's XML format, which returns a ``Scene``.

One ordered walk over the document fills mutable bodies by OpenRAVE's rules; each body is frozen at the end of its
outermost element. For each kind of element there is a table of supported tags and a table of ignored tags with reasons;
all other tags are reported.
"""

from ravemj.formats.openrave_xml.environment import Reading, read

__all__ = ["Reading", "read"]
