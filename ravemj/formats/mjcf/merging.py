"""Merging of links into the parents to which they are fixed."""

from collections.abc import Sequence

from ravemj.core.caching import cached_property
from ravemj.core.transforms import UNMOVED, Pose
from ravemj.formats.mjcf.inertia import legal_inertial
from ravemj.model.inertia import joined_inertial
from ravemj.model.joints import relative_pose
from ravemj.model.scene import Inertial, KinBody


class Merging:
    """The link tree of a body, with its merged links.

    Attributes:
        placing: Index of the parent joint of each link that has one.
        children: The child links of each link.
        names: Names of the links in the MJCF: of their bodies, or of their sites if they are merged.
    """

    def __init__(self, body: KinBody, joint_names: Sequence[tuple[str, ...]], *, merges: bool) -> None:
        """Determine the merged links of a body; ``joint_names`` are empty for fixed joints."""
        self._body, self._joint_names, self._merges = body, joint_names, merges
        self.names: list[str] = []
        joints = body.all_joints
        self.placing = {joint.child: number for number, joint in enumerate(joints) if joint.places_child}
        self.children: dict[int, list[int]] = {}
        for child, number in self.placing.items():
            self.children.setdefault(joints[number].parent, []).append(child)

    @cached_property
    def _merged(self) -> dict[int, tuple[int, Pose]]:
        """For each merged link, the link into which it is merged, and its pose in that link."""
        merged: dict[int, tuple[int, Pose]] = {}
        pending = [link for link in range(len(self._body.links)) if link not in self.placing] if self._merges else []
        while pending:
            link = pending.pop()
            for child in self.children.get(link, ()):
                if not self._joint_names[self.placing[child]]:
                    carrier, T_carrier_link = merged.get(link, (link, UNMOVED))
                    merged[child] = carrier, T_carrier_link @ self._own_pose(child)
                pending.append(child)
        return merged

    @cached_property
    def carriers(self) -> dict[int, int]:
        """For each merged link, the link into which it is merged."""
        return {link: carrier for link, (carrier, _) in self._merged.items()}

    def carrier(self, link: int) -> int:
        """Return the link whose MJCF body represents a link: itself, or the link into which it is merged."""
        return self.carriers.get(link, link)

    def pose(self, link: int) -> Pose:
        """Return ``T_body_link``: the pose of a link in its MJCF body."""
        return self._merged[link][1] if link in self._merged else UNMOVED

    def pose_in_parent(self, link: int) -> Pose:
        """Return the pose of a link in the parent of its MJCF body."""
        if link in self._merged:
            return self.pose(link)
        own = self._own_pose(link)
        if link not in self.placing:
            return own
        T_body_parent = self.pose(self._body.all_joints[self.placing[link]].parent)
        return own if T_body_parent is UNMOVED else T_body_parent @ own

    def _own_pose(self, link: int) -> Pose:
        """Return the pose of a link in its parent link, or in the world if it has none."""
        body = self._body
        if link not in self.placing:
            return body.links[link].T_world_link
        joint = body.all_joints[self.placing[link]]
        if self._joint_names[self.placing[link]]:
            return joint.T_parent_child
        if body.joints:
            return relative_pose(joint, [axis.value for axis in joint.axes])
        # no joint has placed the link
        return body.links[joint.parent].T_world_link.inverse() @ body.links[link].T_world_link

    def inertial(self, link: int, own: Inertial) -> Inertial:
        """Return the mass properties of a link together with its merged links; ``own`` are those of the link alone."""
        parts = [
            (pose, legal_inertial(self._body.links[merged].inertial))
            for merged, (carrier, pose) in self._merged.items()
            if carrier == link
        ]
        return joined_inertial([(UNMOVED, own), *parts]) if parts else own
