"""File formats in which ravemj writes models, and their suffixes."""

SUFFIXES = {
    "collada": (".dae", ".zae"),
    "openrave": (".robot.xml", ".kinbody.xml", ".env.xml"),
    "urdf": (".urdf",),
    "json": (".json",),
    "mjcf": (".xml", ".mjcf"),
}
"""Suffixes by format, the usual one first.

``formats/writers`` writes the first three, ``rave/env/saving`` JSON, as OpenRAVE's ``Info`` objects define it, and
``engine/export`` MJCF, which needs the compiled model.
"""


def format_of(path: str) -> str | None:
    """Return the format of a file name, or None."""
    known = ((suffix, form) for form, suffixes in SUFFIXES.items() for suffix in suffixes)
    return next((form for suffix, form in known if path.lower().endswith(suffix)), None)
