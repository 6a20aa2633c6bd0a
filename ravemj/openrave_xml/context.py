"""What every part of the reader needs: where to report, where files are, and how to walk over an element."""

import difflib
import os
from collections.abc import Callable, Collection, Mapping
from typing import TypeVar

from ravemj.errors import Diagnostics, Source, SourceError
from ravemj.openrave_xml.tree import Element, parse_file

Target = TypeVar("Target")

IGNORED = "OpenRAVE reads it and makes nothing of it"
NOT_YET = "this version of ravemj does not read it yet"


def reasons(reason: str, *names: str) -> dict[str, str]:
    """Return a table that gives one reason for each name."""
    return dict.fromkeys(names, reason)


class Context:
    """One reading of one file, with the files that it includes.

    Attributes:
        diagnostics: Takes every finding.
    """

    def __init__(self) -> None:
        self.diagnostics = Diagnostics()

    def walk(
        self,
        element: Element,
        handlers: Mapping[str, Callable[[Target, Element], None]],
        ignored: Mapping[str, str],
        target: Target,
    ) -> None:
        """Hand each child element to its handler, in document order; report the others.

        Args:
            element: The parent of the children.
            handlers: What to do with a child, by tag.
            ignored: Known tags without effect, and the reason.
            target: First argument of the handlers.
        """
        for child in element.children:
            handler = handlers.get(child.tag)
            if handler is not None:
                handler(target, child)
            elif child.tag in ignored:
                self.diagnostics.warn(
                    "ignored-tag", f"<{child.spelled}> is left out: {ignored[child.tag]}", child.source
                )
            else:
                self.diagnostics.warn(
                    "unknown-tag",
                    f"OpenRAVE knows no <{child.spelled}> in <{element.spelled}> and skips it with all that it holds",
                    child.source,
                    did_you_mean(child.tag, handlers),
                )

    def check_attributes(self, element: Element, known: Collection[str], ignored: Mapping[str, str]) -> None:
        """Report the attributes of an element that nothing reads."""
        for name in element.attributes:
            if name in known:
                continue
            if name in ignored:
                message = f"the attribute '{name}' of <{element.spelled}> is left out: {ignored[name]}"
                self.diagnostics.warn("ignored-attribute", message, element.source)
            else:
                message = f"OpenRAVE knows no attribute '{name}' of <{element.spelled}> and skips it"
                self.diagnostics.warn("unknown-attribute", message, element.source, did_you_mean(name, known))

    def include(self, element: Element) -> Element | None:
        """Return the root of the file that an element's ``file`` attribute names.

        Returns:
            None without the attribute, and where the file is missing (OpenRAVE goes on in silence).

        Raises:
            SourceError: the file includes itself, or cannot be parsed.
        """
        name = element.attributes.get("file")
        if name is None:
            return None
        path = self._find(name, element.source)
        if path is None:
            return None
        chain: Source | None = element.source
        while chain is not None:
            if os.path.realpath(chain.file) == os.path.realpath(path):
                raise SourceError(f"the file includes itself through {name}", element.source)
            chain = chain.included_from
        return parse_file(path, element.source)

    def _find(self, name: str, source: Source) -> str | None:
        """Look a file up beside the file that names it, then in ``OPENRAVE_DATA``."""
        data_folders = filter(None, os.environ.get("OPENRAVE_DATA", "").split(os.pathsep))
        folders = [os.path.dirname(source.file), *data_folders]
        candidates = [os.path.join(folder, name) for folder in dict.fromkeys(folders)]
        for candidate in candidates:
            if os.path.isfile(candidate):
                return candidate
        looked = ", ".join(dict.fromkeys(candidates))
        self.diagnostics.warn("missing-file", f"there is no file {name}; looked at {looked}", source)
        return None


def did_you_mean(name: str, known: Collection[str]) -> str:
    """Return a hint with the known name that looks most like the one given, or nothing."""
    similar = difflib.get_close_matches(name, list(known), n=1)
    return f"did you mean '{similar[0]}'?" if similar else ""
