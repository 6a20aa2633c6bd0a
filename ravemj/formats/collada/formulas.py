"""``<formula>``: how joints of a model follow others."""

from ravemj.formats.collada.library import Library
from ravemj.formats.collada.mathml import FormulaError, Writer
from ravemj.formats.collada.references import References
from ravemj.formats.meshes.collada.document import Element, child, children, local_name, words
from ravemj.model.builder import BodyBuilder, JointBuilder
from ravemj.model.mimic import Equations
from ravemj.model.scene import AXES


def read_formulas(
    library: Library, references: References, model: Element, joints: dict[Element, int], body: BodyBuilder
) -> None:
    """Give the followers of a model their equations.

    Args:
        library: The documents.
        references: Resolves paths.
        model: The ``<kinematics_model>``.
        joints: Indices of its joints in the body, by their elements.
        body: The body.
    """
    reader = _FormulaReader(library, references, model, joints, body)
    for item in children(child(model, "technique_common"), "formula", "instance_formula"):
        formula = library.follow(item) if local_name(item) == "instance_formula" else item
        if formula is not None:
            reader.read(formula)


class _FormulaReader:
    def __init__(
        self, library: Library, references: References, model: Element, joints: dict[Element, int], body: BodyBuilder
    ) -> None:
        self._library = library
        self._references = references
        self._model = model
        self._joints = joints
        self._body = body
        self._writer = Writer(self._source, self._function)
        self._metres = library.metres(model)

    def read(self, formula: Element) -> None:
        """Read a formula; a joint whose formula says nothing that can be computed stays where it is."""
        path = "".join(words(child(formula, "target", "param")))
        index = self._joint(path)
        if index is None:
            self._library.warn("broken-reference", f"there is no joint '{path}' for the formula", formula)
            return
        joint = self._body.joints[index]
        try:
            position = self._in_metres(joint, self._writer.equation(_position(formula)))
        except FormulaError as error:
            message = f"joint '{joint.name}' cannot follow: {error}; it stays where it is"
            self._library.warn("bad-mimic", message, formula)
            joint.enabled = False
            return
        joint.equations = Equations(position, *(self._partials(formula, kind) for kind in _PARTIALS))

    def _partials(self, formula: Element, kind: str) -> str:
        """Return the derivatives by each joint, as OpenRAVE writes them."""
        text = ""
        for item in _own_equations(formula, kind):
            name = self._joint_name(item.get("target") or "")
            try:
                text += f"|{name} {self._writer.equation(child(item, 'math'))} " if name else ""
            except FormulaError as error:
                self._library.warn("bad-mimic", f"a derivative is left out: {error}", item)
        return text

    def _in_metres(self, joint: JointBuilder, text: str) -> str:
        """Return the text of a position in metres or radians, from units of the file."""
        return f"{self._metres:f}*({text})" if AXES[joint.kind][0] == "P" and self._metres != 1 else text

    def _source(self, path: str) -> str | None:
        """Return the text for the value of a joint in units of the file."""
        index = self._joint(path)
        if index is None:
            return None
        joint = self._body.joints[index]
        return (
            f"({1 / self._metres:f}*{joint.name})" if AXES[joint.kind][0] == "P" and self._metres != 1 else joint.name
        )

    def _joint(self, path: str) -> int | None:
        found = self._references.resolve(path, self._model) if path else None
        return None if found is None else self._joints.get(found.element)

    def _joint_name(self, path: str) -> str | None:
        index = self._joint(path)
        return None if index is None else self._body.joints[index].name

    def _function(self, symbol: Element) -> Element | None:
        is_named = bool(symbol.get("definitionURL"))
        return self._library.follow(symbol, "formula", attribute="definitionURL") if is_named else None


_PARTIALS = ("first_partial", "second_partial")


def _own_equations(formula: Element, kind: str) -> list[Element]:
    """Return the equations of a type in OpenRAVE's technique."""
    techniques = (item for item in children(formula, "technique") if item.get("profile") == "OpenRAVE")
    return [item for technique in techniques for item in children(technique, "equation") if item.get("type") == kind]


def _position(formula: Element) -> Element | None:
    """Return the ``<math>`` for the position: OpenRAVE's own, else the common one."""
    own = _own_equations(formula, "position")
    return child(own[0], "math") if own else child(formula, "technique_common", "math")
