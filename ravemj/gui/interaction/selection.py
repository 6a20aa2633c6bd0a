"""The selection and its handles: selection by clicks, and start of drags."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.engine.simulation import BodyState, Simulation
from ravemj.gui.interaction import dragging
from ravemj.gui.interaction.cube import Cube, Grip
from ravemj.gui.interaction.events import Press
from ravemj.gui.interaction.joint_handle import SIZES, JointHandle, driving_dof, joint_and_axis
from ravemj.gui.interaction.notices import Notices
from ravemj.gui.interaction.picking import Hit, pick, visible_box
from ravemj.gui.interaction.pins import Pins
from ravemj.gui.interaction.viewpoint import Viewpoint, ViewRay
from ravemj.model.drawing import Primitives, merge

if TYPE_CHECKING:
    from ravemj.gui.interaction.reaching import Reach

OnSelect = Callable[[Hit, ViewRay], bool]
"""Callback before a selection; returning False prevents it."""


@dataclass(frozen=True, eq=False)
class Selection:
    """A selected body, link or joint.

    Attributes:
        body: The body.
        link: Index of the link.
        point: The clicked point, in the link frame [m], shape (3,).
        normal: Surface normal at the point, in the link frame, shape (3,).
        dof: A DOF of the selected joint; None if the body is selected.
        size: Index of the handle's scale in ``joint_handle.SIZES``.
    """

    body: BodyState
    link: int
    point: Floats
    normal: Floats
    dof: int | None = None
    size: int = 0


class Selector:
    """The selection of a viewer, with the handle (box or cylinder) of the selected body or joint.

    Attributes:
        simulation: The simulation of the bodies.
        selection: The selection, or None.
        changes: Counter, increased whenever the selection may have changed.
        pins: The pinned links.
        is_fixed: Whether drags are disabled, as in a mirror of a real robot.
    """

    is_fixed = False

    def __init__(self, simulation: Simulation, notices: Notices, on_select: OnSelect | None) -> None:
        self.simulation = simulation
        self._may_select: OnSelect = on_select or (lambda _hit, _ray: True)
        self._notices = notices
        self.selection: Selection | None = None
        self.changes = 0
        self.pins = Pins(simulation)

    def drop_removed(self) -> bool:
        """Clear the selection if its body was removed from the environment; return whether it was cleared."""
        is_gone = self.selection is not None and not self.simulation.holds(self.selection.body)
        if is_gone:
            self.selection = None
            self.changes += 1
        return is_gone

    def click(self, view: Viewpoint, press: Press) -> None:
        """Select the body under the pointer, or nothing; with Ctrl, the joint that moves the link."""
        self.changes += 1
        ray = view.ray(press.x, press.y)
        hit = pick(self.simulation, ray)
        if press.ctrl:
            if self._handle_at(ray, hit) is not None:
                self._resize()
            elif hit is not None:
                self._select_joint(hit, ray, driving_dof(hit.body.scene, hit.link))
        elif self._handle_at(ray, hit) is None:
            self._select_body(hit, ray, is_on_cube=self._cube_at(view, (press.x, press.y), hit) is not None)

    def _select_body(self, hit: Hit | None, ray: ViewRay, *, is_on_cube: bool) -> None:
        old = self.selection
        is_again = old is not None and old.dof is None and hit is not None and hit.body is old.body
        if hit is None or is_on_cube or is_again:
            self.selection = None
        else:
            self.selection = self._selection(hit) if self._may_select(hit, ray) else None

    def choose(self, view: Viewpoint, body: BodyState, link: int) -> None:
        """Select a body by one of its links; clear the selection if the link is already selected."""
        self.changes += 1
        old = self.selection
        is_again = old is not None and old.dof is None and old.body is body and old.link == link
        hit, ray = self._aimed(view, body, link)
        self.selection = self._selection(hit) if not is_again and self._may_select(hit, ray) else None

    def choose_joint(self, view: Viewpoint, body: BodyState, number: int) -> None:
        """Select a joint by its index among all joints; if it is already selected, select its next axis."""
        self.changes += 1
        joint = body.scene.all_joints[number]
        is_active = number < len(body.scene.joints) and not joint.static
        dof = body.kinematics.first_dofs[number] if is_active else driving_dof(body.scene, joint.child)
        self._select_joint(*self._aimed(view, body, joint.child), dof)

    def _aimed(self, view: Viewpoint, body: BodyState, link: int) -> tuple[Hit, ViewRay]:
        """Return a visible point of a link, or its centre if hidden, and the viewing ray to its centre."""
        box = visible_box(body, [link], np.eye(4))
        center = body.link_transform(link)[:3, 3] if box is None else box.center
        way = center - view.camera.position
        distance = float(np.linalg.norm(way))
        direction = way / distance if distance > 0 else view.camera.rotation[:, 2]
        ray = ViewRay(view.camera.position, direction)
        hit = pick(self.simulation, ray)
        is_seen = hit is not None and hit.body is body and hit.link == link
        return hit if hit is not None and is_seen else Hit(body, link, center, -direction, distance), ray

    def _select_joint(self, hit: Hit, ray: ViewRay, dof: int | None) -> None:
        if dof is None:
            self.selection = None
            self._notices.say(f"No joint moves {hit.body.scene.links[hit.link].name}")
        elif not self._may_select(hit, ray):
            self.selection = None
        else:
            self.selection = replace(self._selection(hit), dof=self._next_axis(hit.body, dof))

    def _next_axis(self, body: BodyState, first: int) -> int:
        """Return the first DOF of a joint; if one of its DOFs is already selected, the next one."""
        old = self.selection
        joint, _ = joint_and_axis(body, first)
        number = -1
        if old is not None and old.body is body and old.dof is not None:
            number = old.dof - first
        return first + (number + 1) % len(joint.axes) if -1 <= number < len(joint.axes) else first

    def _selection(self, hit: Hit) -> Selection:
        T_world_link = hit.body.link_transform(hit.link)
        rotation = T_world_link[:3, :3]
        return Selection(hit.body, hit.link, (hit.position - T_world_link[:3, 3]) @ rotation, hit.normal @ rotation)

    def _resize(self) -> None:
        if self.selection is not None:
            self.selection = replace(self.selection, size=(self.selection.size + 1) % len(SIZES))

    def start_drag(self, view: Viewpoint, press: Press) -> dragging.Follow | None:
        """Start a drag of the handle; None if the press is beside it."""
        selection = self.selection
        if selection is None:
            return None
        ray = view.ray(press.x, press.y)
        hit = pick(self.simulation, ray)
        on_cube, on_handle = self._cube_at(view, (press.x, press.y), hit), self._handle_at(ray, hit)
        if on_cube is not None:
            cube, grip = on_cube
            if grip.is_edge:
                return dragging.turn_by_edge(selection.body, cube, grip, ray)
            return dragging.move_by_face(selection.body, cube, grip)
        if on_handle is None or selection.dof is None:
            return None
        return dragging.move_joint(selection.body, selection.dof, *on_handle, ray)

    def start_reach(self, view: Viewpoint, press: Press) -> "Reach | None":
        """Start an inverse-kinematics drag of the link under the press; None if no joint moves it."""
        ray = view.ray(press.x, press.y)
        hit = pick(self.simulation, ray)
        if hit is None or not hit.body.index:
            return None
        from ravemj.gui.interaction.reaching import Reach  # noqa: PLC0415 - slow to import

        normal = view.camera.rotation[:, 2]
        pins = [link for link in self.pins.of_body(hit.body) if link != hit.link]
        try:
            if pins and hit.body.dof:
                from ravemj.gui.interaction.pinning import PinnedReach  # noqa: PLC0415 - slow to import

                reach = PinnedReach(hit.body, hit.link, hit.position, normal, pins, self._notices)
            else:
                reach = Reach(hit.body, hit.link, hit.position, normal)
        except ValueError as error:
            self._notices.say(str(error))
            return None
        self.selection = self._selection(hit)
        self.changes += 1
        return reach

    def highlight(self, view: Viewpoint, at: tuple[float, float], hit: Hit | None) -> Primitives | None:
        """Return the highlight of the handle at a point of the screen [points]; None if there is no handle."""
        on_cube, on_handle = self._cube_at(view, at, hit), self._handle_at(view.ray(*at), hit)
        if on_cube is not None:
            cube, grip = on_cube
            return cube.highlight(grip)
        return None if on_handle is None else on_handle[0].highlight()

    def _cube(self) -> Cube | None:
        selection = self.selection
        return None if selection is None or selection.dof is not None else Cube.around(selection.body)

    def _handle(self) -> JointHandle | None:
        selection = self.selection
        if selection is None or selection.dof is None:
            return None
        return JointHandle.at(selection.body, selection.dof, SIZES[selection.size])

    def _cube_at(self, view: Viewpoint, at: tuple[float, float], hit: Hit | None) -> tuple[Cube, Grip] | None:
        """Return the box handle and the grip under the pointer; None beside it, or if another body hides it."""
        cube = self._cube()
        grip = None if cube is None else cube.grip(view, *at)
        if cube is None or grip is None or self._is_hidden(grip.point, view.ray(*at), hit):
            return None
        return cube, grip

    def _handle_at(self, ray: ViewRay, hit: Hit | None) -> tuple[JointHandle, Floats] | None:
        """Return the handle of the selected joint and its point under the pointer; None if it is not visible there."""
        handle = self._handle()
        point = None if handle is None else handle.hit(ray)
        return None if handle is None or point is None or self._is_hidden(point, ray, hit) else (handle, point)

    def _is_hidden(self, point: Floats, ray: ViewRay, hit: Hit | None) -> bool:
        if hit is None or self.selection is None or hit.body is self.selection.body:
            return False
        return hit.distance < float(np.linalg.norm(point - ray.start))

    def sphere(self) -> tuple[Floats, float] | None:
        """Return centre, shape (3,), and radius [m] of the selection's bounding sphere; None without a selection."""
        selection = self.selection
        if selection is None:
            return None
        links = None if selection.dof is None else [selection.link]
        box = visible_box(selection.body, links, np.eye(4))
        return None if box is None else (box.center, float(np.linalg.norm(box.half)))

    def primitives(self) -> Primitives:
        """Return the drawings of the pins and of the handle."""
        shown, pins = self._cube() or self._handle(), self.pins.primitives()
        return pins if shown is None else merge([pins, shown.primitives()])

    def toggle_pin(self, hit: Hit | None = None) -> None:
        """Pin or unpin the hit link, by default the selected link."""
        chosen = self.selection if hit is None else hit
        if chosen is None:
            self._notices.say("Point at a link, or select one, to pin it")
            return
        self.pins.toggle(chosen.body, chosen.link)
        self.changes += 1

    @property
    def is_pinned(self) -> bool:
        """Whether the selected link is pinned."""
        selection = self.selection
        return selection is not None and selection.link in self.pins.of_body(selection.body)

    def point_line(self) -> str:
        """Return the description of the clicked point, which moves with its link; empty without a selection."""
        selection = self.selection
        if selection is None:
            return ""
        T_world_link = selection.body.link_transform(selection.link)
        rotation = T_world_link[:3, :3]
        position = rotation @ selection.point + T_world_link[:3, 3]
        return point_line(selection.body, selection.link, position, rotation @ selection.normal)

    def lines(self) -> list[str]:
        """Return the description of the selected body and joint."""
        selection = self.selection
        if selection is None:
            return []
        body = selection.body
        joint = [] if selection.dof is None else [_joint_line(body, selection.dof)]
        return [f"{'Robot' if body.scene.is_robot else 'Body'} {body.scene.name}", *joint]


def point_line(body: BodyState, link: int, position: Floats, normal: Floats) -> str:
    """Return the name of a link, a point on it [m] and the surface normal, both in the world, as text."""
    point, direction = (", ".join(f"{value:z.3f}" for value in vector.tolist()) for vector in (position, normal))
    return f"{body.scene.links[link].name}: (x, y, z) = ({point}), n = ({direction})"


def _joint_line(body: BodyState, dof: int) -> str:
    """Describe a DOF: joint name, DOF index and value, in rad and degrees or in m."""
    joint, axis = joint_and_axis(body, dof)
    value = float(body.kinematics.values()[dof])
    shown = f"{value:z.3f} m" if joint.slides(axis) else f"{value:z.3f} rad, {math.degrees(value):z.1f} deg"
    return f"Joint {body.scene.dof_names[dof]}, DOF {dof}: {shown}"
