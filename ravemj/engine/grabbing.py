"""Creation of grabs, and their validity in another state or world."""

from collections.abc import Iterable, Sequence

from ravemj.core.transforms import inverse
from ravemj.engine.collision.queries import touching_links
from ravemj.engine.simulation.body import BodyState, GrabbedBody


def grab_as_it_stands(holder: BodyState, body: BodyState, link: int, ignored: Iterable[int]) -> GrabbedBody:
    """Return the grab of a body by a link at their present relative pose.

    The body's collisions are ignored with the grabbing link, with links of ``holder`` that touch it at present, and
    with those in ``ignored``.
    """
    touched = touching_links(holder.simulation.collisions(), holder, body)
    T_link_body = inverse(holder.link_transform(link)) @ body.link_transform(0)
    return GrabbedBody(body, link, T_link_body, frozenset({link, *ignored, *touched}))


def still_possible(holder: BodyState, grabs: Sequence[GrabbedBody]) -> list[GrabbedBody]:
    """Return the grabs of a body that are possible: both bodies are in the world, and no body grabs itself indirectly.

    If ``holder`` is in a copied world, the grabbed bodies are replaced by those of the same name there.
    """
    world = holder.simulation
    bodies = [grab.body if grab.body.simulation is world else world.body(grab.body.scene.name) for grab in grabs]
    return [
        grab._replace(body=body)
        for grab, body in zip(grabs, bodies, strict=True)
        if body is not None and world.holds(holder) and world.holds(body) and not body.carries(holder)
    ]
