"""OpenRAVE's own XML format: a file becomes a ``Scene``.

One ordered walk over the document fills mutable bodies by OpenRAVE's rules; each body is frozen at the end of its
outermost element. Each kind of element has a table of the tags that it understands and a table of those that are
left out, with the reason; whatever is in neither is reported.
"""

from ravemj.formats.openrave_xml.environment import Reading, read

__all__ = ["Reading", "read"]
