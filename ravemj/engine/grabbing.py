"""Rules of grabbing."""

from collections.abc import Iterable, Sequence

from ravemj.core.transforms import inverse
from ravemj.engine.collision.queries import touching_links
from ravemj.engine.simulation.body import BodyState, GrabbedBody


def grab_as_it_stands(holder: BodyState, body: BodyState, link: int, ignored: Iterable[int]) -> GrabbedBody:
    """Return the grab of a body by a link at their present relative pose.

    Collisions with the link, the links in contact at present, and ``ignored`` are ignored.
    """
    touched = touching_links(holder.simulation.collisions(), holder, body)
    T_link_body = inverse(holder.link_transform(link)) @ body.link_transform(0)
    return GrabbedBody(body, link, T_link_body, frozenset({link, *ignored, *touched}))


def still_possible(holder: BodyState, grabs: Sequence[GrabbedBody]) -> list[GrabbedBody]:
    """Return the grabs of a body that are still possible.

    If ``holder`` is in a copied world, the grabbed bodies are replaced by those of the same name there.
    """
    world = holder.simulation
    bodies = [grab.body if grab.body.simulation is world else world.body(grab.body.scene.name) for grab in grabs]
    return [
        grab._replace(body=body)
        for grab, body in zip(grabs, bodies, strict=True)
        if body is not None and world.holds(holder) and world.holds(body) and not body.carries(holder)
    ]
