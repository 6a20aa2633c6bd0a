"""The equations of mimic joints as texts that do not depend on how a file spells them."""

from collections.abc import Mapping

from ravemj.model.expressions import ExpressionError, joint_variables, parse, partials, substitute
from ravemj.model.scene import KinBody


def mimic_texts(body: KinBody) -> list[dict[str, str]]:
    """Return for each joint, active ones first, its equation and partial derivatives by what they are.

    A joint that follows none has none.
    """
    names = joint_variables([joint.name for joint in body.all_joints])
    found: list[dict[str, str]] = [{} for _ in body.all_joints]
    for texts, joint in zip(found, body.all_joints, strict=True):
        if joint.mimic is not None:
            texts["follows"] = _respelled(joint.mimic.position, names)
            for order, text in (("velocity", joint.mimic.velocity), ("acceleration", joint.mimic.acceleration)):
                for name, partial in _partials(text).items():
                    texts[f"{order} with '{name}'"] = _respelled(partial, names)
    return found


def _partials(text: str) -> dict[str, str]:
    """Return the partial derivatives in a text by what they are with; of what is none, the text."""
    try:
        return partials(text)
    except ExpressionError:
        return {"": text}


def _respelled(equation: str, names: Mapping[str, str]) -> str:
    """Return an equation as its tree is spelled; of what is none, the text."""
    try:
        return str(parse(substitute(equation, names), set(names.values())))
    except ExpressionError:
        return equation.strip()
