"""Picklable records of an environment's bodies and their state."""

from typing import NamedTuple

from ravemj.core.transforms import Floats, Vec3
from ravemj.engine.kinematics import Configuration
from ravemj.engine.simulation.body import BodyState, GrabbedBody
from ravemj.engine.simulation.world import Simulation
from ravemj.model.scene import KinBody, View


class BodyRecord(NamedTuple):
    """Record of a body and its state.

    Attributes:
        scene: Description of the body.
        place: Index in the world, from 1.
        link_enabled: For each link, whether it takes part in collision checks.
        rest_poses: Link poses that determine which links touch at rest, see ``tested_pairs``; None outside a world.
        configuration: Joint values and link poses; None if they are those of the description.
        velocities: Link velocities, shape (links, 6).
        grabs: For each grab: index of the body, link, ``T_link_body`` and ignored links.
    """

    scene: KinBody
    place: int
    link_enabled: tuple[bool, ...]
    rest_poses: Floats | None
    configuration: Configuration | None
    velocities: Floats
    grabs: tuple[tuple[int, int, Floats, frozenset[int]], ...]

    @classmethod
    def from_body(cls, body: BodyState) -> "BodyRecord":
        """Return the record of a body."""
        return cls(
            body.scene,
            body.index,
            body.link_enabled,
            body.rest_poses,
            body.configuration().configuration if body.known_kinematics else None,
            body.link_velocities(),
            tuple((grab.body.index, *grab[1:]) for grab in body.grabs),
        )


class WorldRecord(NamedTuple):
    """Record of all bodies of an environment, its view and its gravity [m/s^2]."""

    bodies: tuple[BodyRecord, ...]
    view: View
    gravity: Vec3

    @classmethod
    def from_simulation(cls, simulation: Simulation) -> "WorldRecord":
        """Return the record of a world. The caller holds the lock."""
        return cls(tuple(map(BodyRecord.from_body, simulation.bodies)), simulation.view, simulation.gravity)

    def put_into(self, simulation: Simulation) -> None:
        """Add the bodies to an empty world, and set its view and gravity."""
        simulation.view = self.view
        simulation.set_gravity(self.gravity)
        bodies: dict[int, BodyState] = {}
        for record in self.bodies:
            body = bodies[record.place] = simulation.create(record.scene)
            body.link_enabled, body.rest_poses = record.link_enabled, record.rest_poses
            if record.configuration is not None:
                body.own_kinematics.restore(record.configuration)
            body.set_link_velocities(record.velocities)
            simulation.insert(body, record.place)
        for record in self.bodies:
            bodies[record.place].grabs = [
                GrabbedBody(bodies[place], link, transform, ignored) for place, link, transform, ignored in record.grabs
            ]
