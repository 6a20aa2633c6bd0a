"""Names of links and joints by which a written document refers to them."""

from collections.abc import Collection

from ravemj.errors import Diagnostics
from ravemj.model.scene import KinBody


class PartNames:
    """The names in the document: the parts' own, unless the reader would take one part for another.

    It finds links by a word, in any letter case, and goes on with a link of a name that it has met; joints with DOFs
    need names of their own.

    Attributes:
        links: The name of each link.
        joints: The name of each joint, active ones and then passive ones.
    """

    def __init__(self, body: KinBody, diagnostics: Diagnostics) -> None:
        referenced = body.referenced_links
        links = [link.name for link in body.links]
        known = {name.lower() for name in links}
        self.links: list[str] = []
        for index, name in enumerate(links):
            in_any_case = any(name.lower() == other.lower() for other in self.links)
            is_word = name.split() == [name] or not name
            is_taken = (name and name in self.links) or (index in referenced and (in_any_case or not is_word))
            given = _unused("_".join(name.split()) or "link", known) if is_taken else name
            self.links.append(given)
            known.add(given.lower())
            if is_taken:
                message = f"the link '{name}' of '{body.name}' is called '{given}' in the file"
                diagnostics.warn("renamed", message, body.links[index].source)
        joints = [joint.name for joint in body.all_joints]
        active = set(joints[: len(body.joints)])
        listed = {joint for one in body.manipulators for joint in one.gripper_joints}  # in a list of words
        self.joints: list[str] = []
        for index, name in enumerate(joints):
            is_taken = (name in active and name in self.joints) or (index in listed and name.split() != [name])
            known = {other.lower() for other in (*joints, *self.joints)}
            given = _unused("_".join(name.split()) or "joint", known) if is_taken else name
            self.joints.append(given)
            if is_taken:
                message = f"the joint '{name}' of '{body.name}' is called '{given}' in the file"
                diagnostics.warn("renamed", message, body.all_joints[index].source)
        self._in_file = dict(zip(reversed(joints), reversed(self.joints), strict=True))  # of one name, the first counts

    def equation(self, text: str) -> str:
        """Return an equation with the names that joints have in the file."""
        if all(name == given for name, given in self._in_file.items()):
            return text
        from ravemj.model.expressions import substitute  # noqa: PLC0415 - rarely wanted

        return substitute(text, self._in_file)


def _unused(name: str, known: Collection[str]) -> str:
    """Return a name with a number behind it that no known name, in lower case, has."""
    numbered = (f"{name}_{count}" for count in range(1, len(known) + 2))
    return next(other for other in numbered if other.lower() not in known)
