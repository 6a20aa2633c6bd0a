"""Collision pairs of an arm: its own links, the end effector's links, and links that the arm does not move.

The links *beyond* an arm are those of the end effector and gripper. ``motions_of_end`` serves to test them at other
tool poses.
"""

from ravemj.core.graphs import ordered_pair
from ravemj.core.transforms import Floats
from ravemj.engine.collision.pairs import Pairs
from ravemj.engine.collision.queries import LinkOf, body_and_others, held_with, itself, moved_apart, moved_links
from ravemj.engine.collision.world import CollisionWorld
from ravemj.engine.simulation import BodyState
from ravemj.model.chains import independent_links, links_beyond
from ravemj.model.scene import Manipulator


def end_and_others(world: CollisionWorld, body: BodyState, arm: Manipulator) -> Pairs:
    """Return the pairs of (links beyond an arm, and bodies they hold) and (all other bodies)."""
    return body_and_others(world, body, frozenset(links_beyond(body.scene, arm)))


def independent_and_others(world: CollisionWorld, body: BodyState, arm: Manipulator) -> Pairs:
    """Return the pairs of the links that neither arm nor gripper moves, with bodies they hold, and all other bodies."""
    return body_and_others(world, body, frozenset(independent_links(body.scene, arm)))


def end_and_rest(world: CollisionWorld, body: BodyState, arm: Manipulator, *, without_arm: bool) -> Pairs:
    """Return the pairs of (links beyond an arm, and bodies they hold) and (other links of the robot).

    ``without_arm`` ignores the links of the arm itself.
    """
    end = set(links_beyond(body.scene, arm))
    others = independent_links(body.scene, arm) if without_arm else range(len(body.scene.links))
    return itself(world, body, frozenset(ordered_pair(a, b) for a in end for b in others if b not in end))


def arm_and_others(world: CollisionWorld, body: BodyState, arm: Manipulator, *, without_end: bool) -> Pairs:
    """Return the pairs of (links that an arm moves, and bodies they hold) and (all other bodies).

    ``without_end`` ignores the links beyond the arm and bodies they hold.
    """

    def make() -> Pairs:
        left_out = set(links_beyond(body.scene, arm)) if without_end else set[int]()
        return body_and_others(world, body, moved_links(body.scene, arm.arm_dofs) - left_out)

    return world.kept(("arm and others", body, arm, without_end), make)


def arm_and_rest(world: CollisionWorld, body: BodyState, arm: Manipulator, *, without_end: bool) -> Pairs:
    """Return the pairs of a robot's links, with bodies they hold, that an arm moves relative to each other.

    ``without_end`` ignores pairs of a link beyond the arm and a link that the arm does not move.
    """

    def make() -> Pairs:
        end, moved = set(links_beyond(body.scene, arm)), moved_links(body.scene, arm.arm_dofs)
        apart = moved_apart(body.scene, arm.arm_dofs)
        if without_end:
            apart = frozenset((a, b) for a, b in apart if not ({a, b} & end and {a, b} - moved))
        return itself(world, body, apart)

    return world.kept(("arm and rest", body, arm, without_end), make)


def motions_of_end(body: BodyState, arm: Manipulator, motion: Floats) -> dict[LinkOf, Floats]:
    """Return a map from each link beyond an arm, and of bodies held there, to the displacement ``motion`` (4, 4).

    It is the argument of ``CollisionWorld.moved``.
    """
    end = set(links_beyond(body.scene, arm))
    held = [held_body for grab in body.grabs if grab.link in end for held_body in held_with(grab.body)]
    links = [(held_body, link) for held_body in held for link in range(len(held_body.scene.links))]
    return dict.fromkeys([*((body, link) for link in end), *links], motion)
