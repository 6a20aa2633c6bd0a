"""Mimic equations in a canonical text form, independent of the spelling in a file."""

from collections.abc import Mapping

from ravemj.model.expressions import ExpressionError, joint_variables, parse, partials, substitute
from ravemj.model.scene import KinBody


def mimic_texts(body: KinBody) -> list[dict[str, str]]:
    """Return for each joint, active ones first, its mimic equation and partial derivatives, with a description as key.

    The key of the equation is ``follows``; joints that are not mimic joints have an empty dictionary.
    """
    names = joint_variables([joint.name for joint in body.all_joints])
    texts_by_joint: list[dict[str, str]] = [{} for _ in body.all_joints]
    for texts, joint in zip(texts_by_joint, body.all_joints, strict=True):
        if joint.mimic is not None:
            texts["follows"] = _respelled(joint.mimic.position, names)
            for order, text in (("velocity", joint.mimic.velocity), ("acceleration", joint.mimic.acceleration)):
                for name, partial in _partials(text).items():
                    texts[f"{order} with '{name}'"] = _respelled(partial, names)
    return texts_by_joint


def _partials(text: str) -> dict[str, str]:
    """Return the partial derivatives in a text by variable; of an invalid text, the text under the key ""."""
    try:
        return partials(text)
    except ExpressionError:
        return {"": text}


def _respelled(equation: str, names: Mapping[str, str]) -> str:
    """Return an equation in canonical spelling; return an invalid one unchanged."""
    try:
        return str(parse(substitute(equation, names), set(names.values())))
    except ExpressionError:
        return equation.strip()
