"""Bindings of a ``<scene>``: of models to visible nodes, and of axes to nodes and values."""

from collections.abc import Sequence
from dataclasses import dataclass

from ravemj.formats.collada.library import Library
from ravemj.formats.collada.visual import Node, find_node
from ravemj.formats.meshes.collada.document import Element, child, children, local_name, words

_OWNERS = {"instance_articulated_system", "instance_kinematics_model"}


@dataclass(frozen=True, slots=True)
class ModelBinding:
    """The node that shows a kinematics model.

    Attributes:
        owner: The instance in the kinematics scene whose parameter names the model, or None.
        instance: The ``<instance_kinematics_model>``.
        node: The node.
    """

    owner: Element | None
    instance: Element
    node: Node


@dataclass(frozen=True, slots=True)
class AxisBinding:
    """The node that an axis moves, and the value of the axis.

    Attributes:
        owner: The instance in the kinematics scene whose parameter names the axis, or None.
        through: The instance elements that the path to the axis passes through.
        axis: The ``<revolute>`` or ``<prismatic>``.
        node: The node, or None if it is missing.
        value: The value as written.
    """

    owner: Element | None
    through: tuple[Element, ...]
    axis: Element
    node: Node | None
    value: float | None


class Bindings:
    """All bindings of a kinematics scene; if an object has several bindings, the first one is used.

    Attributes:
        models: The bindings of models.
        axes: The bindings of axes.
        moved: The nodes bound to axes.
    """

    def __init__(self, models: Sequence[ModelBinding], axes: Sequence[AxisBinding]) -> None:
        self.models, self.axes = models, axes
        nodes = (binding.node for binding in (*models, *axes))
        self.moved = frozenset(node for node in nodes if node is not None)
        self._of_instance: dict[Element, list[int]] = {}
        self._of_axis: dict[Element, list[AxisBinding]] = {}
        for number, model in enumerate(models):
            self._of_instance.setdefault(model.instance, []).append(number)
        for axis in axes:
            self._of_axis.setdefault(axis.axis, []).append(axis)

    def node_of(self, owner: Element, instance: Element, model: Element) -> Node | None:
        """Return the scene node that shows an instance of a kinematics model, preferably as bound by ``owner``."""
        numbers = {number for element in (instance, model) for number in self._of_instance.get(element, ())}
        bound = [self.models[number] for number in sorted(numbers)]
        own = [binding for binding in bound if binding.owner is owner]
        return (own or bound)[0].node if bound else None

    def of_axis(self, owner: Element, instance: Element, axis: Element, holder: Element) -> AxisBinding | None:
        """Return the first binding of an axis.

        Args:
            owner: The instance in the kinematics scene.
            instance: The instance of the axis's model.
            axis: The axis.
            holder: The ``<joint>`` or ``<instance_joint>`` in the model.
        """
        bound = [binding for binding in self._of_axis.get(axis, ()) if _is_through(binding, instance, holder)]
        own = [binding for binding in bound if binding.owner is owner]
        return next(iter(own or bound), None)


def _is_through(binding: AxisBinding, instance: Element, holder: Element) -> bool:
    """Return False if the binding's path contains a model instance or joint instance other than the given ones."""
    for item in binding.through:
        kind = local_name(item)
        if kind == "instance_kinematics_model" and item is not instance:
            return False
        if kind == "instance_joint" and item is not holder:
            return False
    return True


def read_bindings(library: Library, instance: Element, scene: Element, root: Node | None) -> Bindings:
    """Read the bindings of a kinematics scene's instance to nodes of the visual scene."""
    models: list[ModelBinding] = []
    axes: list[AxisBinding] = []
    for element in children(instance, "bind_kinematics_model"):
        name = "".join(words(child(element, "param"))) or (element.get("param") or "")
        parameter = library.parameter(name, instance, scene) if name else None
        node = find_node(library, root, element.get("node") or "", element)
        if parameter is None:
            library.warn("broken-reference", f"there is no model behind the parameter '{name}'", element)
        elif node is not None:
            models.append(ModelBinding(_owner(library, name, instance, scene), parameter.element, node))
    for element in children(instance, "bind_joint_axis"):
        name = "".join(words(child(element, "axis", "param")))
        parameter = library.parameter(name, instance, scene) if name else None
        if parameter is None or local_name(parameter.element) not in {"revolute", "prismatic"}:
            library.warn("broken-reference", f"there is no axis behind the parameter '{name}'", element)
            continue
        owner = _owner(library, name, instance, scene)
        value = library.number(child(element, "value"), instance, scene)
        node = find_node(library, root, element.get("target") or "", element)
        axes.append(AxisBinding(owner, parameter.through, parameter.element, node, value))
    return Bindings(models, axes)


def _owner(library: Library, name: str, *scopes: Element) -> Element | None:
    """Return the instance in the kinematics scene that contains the parameter ``name``; None if no scope has it."""
    item_ = next((item for scope in scopes if (item := library.resolve(name, scope)) is not None), None)
    around = None if item_ is None else item_.element
    while around is not None and local_name(around) not in _OWNERS:
        around = around.getparent()
    return around
