"""``<parameter>``, an element of ravemj: a value that scripts attach to a link or a joint."""

from dataclasses import replace

from ravemj.formats.xml_text import XmlText
from ravemj.model.scene import Parameters

PARAMETER_MEANING = "ravemj's own: name, and type: floats, integers or text; what scripts attach"


def write_parameters(out: XmlText, parameters: Parameters, of: str | None = None) -> None:
    """Write an element for each value.

    Args:
        out: Receives the elements.
        parameters: The values.
        of: Name of the link or joint, if the enclosing element does not give it.
    """
    for name, values in parameters.floats:
        out.element("parameter", values, of=of, name=name, type="floats")
    for name, integers in parameters.integers:
        out.element("parameter", " ".join(map(str, integers)), of=of, name=name, type="integers")
    for name, text in parameters.texts:
        out.element("parameter", text, of=of, name=name, type="text")


def with_parameter(before: Parameters, name: str, kind: str, text: str) -> Parameters:
    """Return ``before`` with one more parameter.

    Raises:
        ValueError: It is of an unknown type, or its text does not match the type.
    """
    match kind:
        case "floats":
            return replace(before, floats=(*before.floats, (name, tuple(map(float, text.split())))))
        case "integers":
            return replace(before, integers=(*before.integers, (name, tuple(map(int, text.split())))))
        case "text":
            return replace(before, texts=(*before.texts, (name, text)))
        case _:
            raise ValueError(f"there is no type '{kind}' of parameters, but floats, integers and text")
