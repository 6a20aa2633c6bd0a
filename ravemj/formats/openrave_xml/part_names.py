"""Names of links and joints by which a written document refers to them."""

from ravemj.errors import Diagnostics
from ravemj.formats.openrave_xml.values import words
from ravemj.model.scene import Joint, KinBody, Link


class PartNames:
    """Names in the document: the parts' own, unless the reader would confuse two parts.

    The reader finds links by a single word in any letter case, and merges links of equal names; joints with DOFs need
    different names.

    Attributes:
        links: The name of each link.
        joints: The name of each joint, active ones and then passive ones.
    """

    def __init__(self, body: KinBody, diagnostics: Diagnostics) -> None:
        referenced = body.referenced_links
        self.links: list[str] = []
        known = {link.name.lower() for link in body.links}
        taken, taken_any_case = set[str](), set[str]()
        for index, link in enumerate(body.links):
            name = link.name
            in_any_case = name.lower() in taken_any_case
            is_word = words(name) == [name] or not name
            is_taken = (name and name in taken) or (index in referenced and (in_any_case or not is_word))
            self.links.append(_renamed("link", link, body, known, diagnostics) if is_taken else name)
            taken.add(self.links[-1])
            taken_any_case.add(self.links[-1].lower())
        joints = [joint.name for joint in body.all_joints]
        active = set(joints[: len(body.joints)])
        listed = {
            joint for manipulator in body.manipulators for joint in manipulator.gripper_joints
        }  # in a list of words
        self.joints: list[str] = []
        known = {name.lower() for name in joints}
        taken = set[str]()
        for index, joint in enumerate(body.all_joints):
            name = joint.name
            is_taken = (name in active and name in taken) or (index in listed and words(name) != [name])
            self.joints.append(_renamed("joint", joint, body, known, diagnostics) if is_taken else name)
            taken.add(self.joints[-1])
        self._in_file = dict(zip(reversed(joints), reversed(self.joints), strict=True))  # of one name, the first counts
        self._is_renamed = any(name != given for name, given in self._in_file.items())

    def equation(self, text: str) -> str:
        """Return an equation with the names that joints have in the file."""
        if not self._is_renamed:
            return text
        from ravemj.model.expressions import substitute  # noqa: PLC0415 - rarely wanted

        return substitute(text, self._in_file)


def _renamed(kind: str, part: Link | Joint, body: KinBody, known: set[str], diagnostics: Diagnostics) -> str:
    """Return a valid, unused name for a link or joint; add it to the used names ``known`` (lower case), and warn."""
    name = "_".join(words(part.name)) or kind
    numbered = (f"{name}_{count}" for count in range(1, len(known) + 2))
    given = next(other for other in numbered if other.lower() not in known)
    known.add(given.lower())
    message = f"the {kind} '{part.name}' of '{body.name}' is called '{given}' in the file"
    diagnostics.warn("renamed", message, part.source)
    return given
