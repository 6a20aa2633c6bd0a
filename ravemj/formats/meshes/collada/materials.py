"""Colours of COLLADA materials; shared by mesh files and robots."""

from dataclasses import dataclass

from ravemj.formats.meshes.collada.document import ColladaDocument, Element, child, children, local_name, numbers
from ravemj.model.scene import Rgb

_SHADERS = ("phong", "blinn", "lambert", "constant")
_LUMINANCE = (0.212671, 0.71516, 0.072169)  # of red, green and blue, as COLLADA says for transparency by colour


@dataclass(frozen=True, slots=True)
class ColladaMaterial:
    """A material's colours; None for colours that the file does not specify.

    Attributes:
        diffuse: Colour.
        ambient: Ambient colour.
        textured: Whether the diffuse colour is a texture.
        transparency: The number in ``<transparency>``, which some writers invert.
        transparent: Red, green, blue and alpha in ``<transparent>``, which ``transparency`` multiplies.
        opaque: Interpretation of ``transparent``: ``A_ONE`` by default.
        is_phong: True if the shader is a ``<phong>``.
        alpha: Fourth number of the diffuse colour of a ``<phong>``, else of the ambient colour; 1 by default.
    """

    diffuse: Rgb | None = None
    ambient: Rgb | None = None
    textured: bool = False
    transparency: float | None = None
    transparent: tuple[float, ...] | None = None
    opaque: str = "A_ONE"
    is_phong: bool = False
    alpha: float = 1.0

    @property
    def opacity(self) -> float:
        """Opacity of the material by the standard; 1 if the values make no sense."""
        amount = 1.0 if self.transparency is None else self.transparency
        red, green, blue, alpha = self.transparent or (1.0, 1.0, 1.0, 1.0)
        by_colour = self.opaque.startswith("RGB")
        brightness = sum(weight * part for weight, part in zip(_LUMINANCE, (red, green, blue), strict=True))
        amount *= brightness if by_colour else alpha
        return 1.0 - amount if self.opaque.endswith("ZERO") else amount


def read_material(document: ColladaDocument, material: Element) -> ColladaMaterial | None:
    """Read a ``<material>`` and its effect.

    Returns:
        Its colours, or None if the effect is missing.
    """
    instance = child(material, "instance_effect")
    effect = None if instance is None else document.find("effect", instance.get("url"))
    if effect is None:
        return None
    technique = child(effect, "profile_COMMON", "technique")
    shader = next(children(technique, *_SHADERS), None)
    if shader is None:
        return ColladaMaterial()
    transparent = child(shader, "transparent")
    is_phong = local_name(shader) == "phong"
    colours = (_rgba(child(shader, name, "color")) for name in ("diffuse", "ambient"))
    return ColladaMaterial(
        _rgb(shader, "diffuse"),
        _rgb(shader, "ambient"),
        child(shader, "diffuse", "texture") is not None,
        _float(effect, child(shader, "transparency")),
        _rgba(child(transparent, "color")),
        "A_ONE" if transparent is None else transparent.get("opaque", "A_ONE"),
        is_phong,
        next((colour[3] for colour in colours if colour is not None), 1.0) if is_phong else 1.0,
    )


def bindings(instance: Element) -> dict[str, str]:
    """Return the URLs of the materials that an ``<instance_geometry>`` binds, by symbol."""
    common = child(instance, "bind_material", "technique_common")
    return {item.get("symbol", ""): item.get("target", "") for item in children(common, "instance_material")}


def _rgb(shader: Element, name: str) -> Rgb | None:
    colour = _rgba(child(shader, name, "color"))
    return None if colour is None else (colour[0], colour[1], colour[2])


def _rgba(element: Element | None) -> tuple[float, ...] | None:
    values = numbers(element).tolist()
    return (*values[:3], values[3] if len(values) > 3 else 1.0) if len(values) >= 3 else None


def _float(effect: Element, element: Element | None) -> float | None:
    """Return the number in ``element``, or in the effect's ``<newparam>`` to which it refers; None if there is none."""
    values = numbers(child(element, "float"))
    reference = child(element, "param")
    if not len(values) and reference is not None:
        sid = reference.get("ref")
        parameters = (item for item in effect.iter("{*}newparam") if item.get("sid") == sid)
        values = numbers(child(next(parameters, None), "float"))
    return float(values[0]) if len(values) else None
