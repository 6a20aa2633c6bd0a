"""Resolution of scoped ids (SID paths such as ``a/b/c``) and of the parameters that stand for them."""

from collections import deque
from collections.abc import Iterator
from typing import NamedTuple

from lxml import etree

from ravemj.formats.collada.library import Library
from ravemj.formats.meshes.collada.document import Element, child, children, local_name, numbers, words

_MOST_ELEMENTS = 200_000
_LONGEST_CHAIN = 20

_MODELS = {
    "instance_articulated_system",
    "instance_kinematics_model",
    "instance_joint",
    "instance_physics_model",
    "instance_node",
    "instance_formula",
}


class Found(NamedTuple):
    """The result of resolving a reference.

    Attributes:
        element: The element.
        through: The instances of other elements that the way there goes through.
    """

    element: Element
    through: tuple[Element, ...] = ()


class References:
    """Resolves SID paths, and keeps an index of each scope."""

    def __init__(self, library: Library) -> None:
        self._library = library
        self._scopes: dict[Element, dict[str, Found]] = {}

    def resolve(self, path: str, scope: Element) -> Found | None:
        """Return what a path of names leads to.

        The first name is an id, or a sid in the scope or in one around it; ``.`` is the scope itself. The others are
        sids, each below the one before; where that is an instance, in what it is an instance of.

        Args:
            path: Names with ``/`` between them.
            scope: The element that the path stands in.
        """
        first, *rest = path.strip().split("/")
        for start in self._starts(first, scope):
            found: Found | None = start
            for name in rest:
                found = None if found is None else self._below(found, name)
            if found is not None:
                return found
        return None

    def _starts(self, name: str, scope: Element) -> Iterator[Found]:
        if name == ".":
            yield Found(scope)
            return
        for element in self._library.document_of(scope).identified(name):
            yield Found(element)
        for around in (scope, *scope.iterancestors()):
            found = self._scope(around).get(name)
            if found is not None:
                yield found

    def _below(self, found: Found, name: str) -> Found | None:
        inner = self._scope(found.element).get(name)
        return None if inner is None else Found(inner.element, (*found.through, *inner.through))

    def _scope(self, element: Element) -> dict[str, Found]:
        """Return the elements below one by their sids; of equal ones the nearest, and of these the first, counts."""
        names = self._scopes.get(element)
        if names is not None:
            return names
        names = self._scopes[element] = {}
        queue: deque[Found] = deque([Found(element)])
        entered = {element}
        while queue and len(entered) < _MOST_ELEMENTS:
            around, through = queue.popleft()
            target = self._target(around)
            if target is not None and target not in entered:
                entered.add(target)
                queue.append(Found(target, (*through, around)))
            for item in around.iterchildren(etree.Element):
                if item in entered:
                    continue
                entered.add(item)
                name = item.get("sid") or (item.get("symbol") if local_name(item) == "bind" else None)
                if name:
                    names.setdefault(name, Found(item, through))
                if len(item) or item.get("url"):
                    queue.append(Found(item, through))
        return names

    def _target(self, element: Element) -> Element | None:
        """Return what an instance is an instance of; None for other elements."""
        if not element.get("url") or local_name(element) not in _MODELS:
            return None
        return self._library.follow(element)

    def parameter(self, name: str, *scopes: Element) -> Found | None:
        """Return the element that a parameter stands for.

        Args:
            name: Its name, or a path of names.
            scopes: Where to look for it, in this order.

        Returns:
            What the chain of parameters ends at: an element that is no parameter, or a parameter with a plain value.
        """
        found = next((item for scope in scopes if (item := self.resolve(name, scope)) is not None), None)
        for _ in range(_LONGEST_CHAIN):
            path = None if found is None else _reference(found.element)
            if found is None or path is None:
                return found
            inner = self.resolve(path, found.element)
            found = None if inner is None else Found(inner.element, (*found.through, *inner.through))
        return None

    def value(self, element: Element | None, *scopes: Element) -> Element | None:
        """Return the element that has the plain value of another one, which may name a parameter instead."""
        if element is None:
            return None
        param = child(element, "param")
        if param is None:
            return element
        name = (param.get("ref") or "".join(words(param))).strip()
        found = self.parameter(name, element, *scopes) if name else None
        return None if found is None else found.element

    def number(self, element: Element | None, *scopes: Element) -> float | None:
        """Return a number that stands in an element, in its ``<float>``, or in the parameter that it names."""
        value = self.value(element, *scopes)
        if value is None:
            return None
        plain = next(children(value, "float", "int"), value)
        values = numbers(plain)
        return float(values[0]) if len(values) else None

    def truth(self, element: Element | None, default: bool, *scopes: Element) -> bool:
        """Return a truth value that stands in an element, in its ``<bool>``, or in the parameter that it names."""
        value = self.value(element, *scopes)
        text = words(child(value, "bool") if child(value, "bool") is not None else value)
        return default if not text else text[0].lower() not in {"false", "0"}


def _reference(element: Element) -> str | None:
    """Return the path that a parameter stands for, or None for what is no parameter or has a plain value."""
    if local_name(element) == "bind":
        param = child(element, "param")
        return None if param is None else param.get("ref") or "".join(words(param))
    if local_name(element) not in {"newparam", "setparam"}:
        return None
    text = words(child(element, "SIDREF"))
    return "".join(text) if text else None
