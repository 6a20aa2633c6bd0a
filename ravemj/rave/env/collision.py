"""Collision checks of an environment, and its geometries as triangles."""

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ravemj.core.arguments import also_named, checked_kind
from ravemj.core.arrays import checked_numbers
from ravemj.core.handles import Handle, registered
from ravemj.core.transforms import Floats
from ravemj.engine.simulation import BodyState
from ravemj.errors import ArgumentError
from ravemj.model.bounds import links_triangles
from ravemj.model.scene import Mesh
from ravemj.rave.collision import CollisionChecker, NoCollisionChecker
from ravemj.rave.enums import TriangulateOptions
from ravemj.rave.env.contents import Contents
from ravemj.rave.env.selection import selects
from ravemj.rave.kinbody import KinBody
from ravemj.rave.report import CollisionReport
from ravemj.rave.trimesh import TriMesh, trimesh_of

CollisionCallback = Callable[[CollisionReport, bool], int]
"""A function of a report of one collision, and of whether physics has found it; it returns a ``CollisionAction``."""


class Collision(Contents):
    """Collision checks of bodies, links and rays, and the triangles of geometries."""

    TriangulateOptions = TriangulateOptions
    SelectionOptions = TriangulateOptions
    NoRobots = TriangulateOptions.NoRobots
    Robots = TriangulateOptions.Robots
    Everything = TriangulateOptions.Everything
    Body = TriangulateOptions.Body
    AllExceptBody = TriangulateOptions.AllExceptBody

    _internal = ("collision_callbacks",)

    def __init__(self) -> None:
        super().__init__()
        self.collision_callbacks: list[CollisionCallback] = []
        self._checker: CollisionChecker | None = None

    def GetCollisionChecker(self) -> CollisionChecker:
        """Return the collision checker, which ``CheckCollision`` uses; never None."""
        if self._checker is None:
            self._checker = CollisionChecker(self._environment)
        return self._checker

    def SetCollisionChecker(self, collisionchecker: CollisionChecker | None) -> bool:
        """Choose the collision checker, which ``CheckCollision`` uses.

        Args:
            collisionchecker: A checker of this environment; with None, nothing collides from now on.

        Returns:
            True.
        """
        self._check_alive()
        checker = NoCollisionChecker(self._environment) if collisionchecker is None else collisionchecker
        checked_kind(checker, CollisionChecker, "SetCollisionChecker: collisionchecker")
        if checker.GetEnv() is not self._environment:
            raise ArgumentError("SetCollisionChecker: collisionchecker was made for another environment")
        self._checker = checker
        return True

    def CheckCollision(self, *arguments: object, report: CollisionReport | None = None, **named: object) -> bool:
        """Return whether bodies, links or rays collide.

        The arguments have OpenRAVE's forms, and ``report`` may also be the last of them:

        - ``(body)``, ``(link)``: test a body or a link against all other bodies.
        - ``(body, body2)``, ``(link, body)``, ``(link, link2)``: test the two against each other; two links may belong
          to the same body.
        - ``(body, bodyexcluded, linkexcluded)``, or with a link first: test against all bodies and links except those
          of two lists.
        - ``(ray)``, ``(ray, body)``: test a ray against all bodies, or against one. The length of its direction is its
          range.

        A body is tested together with the bodies that it holds, but not against them. Disabled links never collide.
        ``body.CheckSelfCollision`` tests a body against itself.

        Args:
            arguments: One of these forms; by name they are ``body``, ``link``, ``body1``, ``body2``, ``link1``,
                ``link2``, ``ray``, ``bodyexcluded``, ``linkexcluded``.
            report: Receives the collisions, in the detail of ``GetCollisionChecker().SetCollisionOptions``.
            named: See ``arguments``.

        Raises:
            openrave_exception: an argument is None (``Assert``) or has a wrong type (``InvalidArguments``), or one of
                two bodies is not in the environment.

        Example:
            >>> env.CheckCollision(robot)
            False
            >>> report = ravemj.CollisionReport()
            >>> env.CheckCollision(ravemj.Ray([0, 0, 5], [0, 0, -10]), report)
            True
            >>> report.contacts[0].pos
            array([0.  , 0.  , 0.03])
        """
        self._check_alive()
        checker = self._checker or self.GetCollisionChecker()
        return checker.CheckCollision(*arguments, report=report, **named)

    def CheckCollisionRays(
        self, rays: ArrayLike, body: KinBody | None = None, front_facing_only: bool = False
    ) -> tuple[NDArray[np.bool_], Floats]:
        """Return the first hits of many rays.

        Args:
            rays: One row for each ray: its start, and its direction, whose length is the range [m], shape (n, 6).
            body: The body that the rays are tested against; by default all bodies.
            front_facing_only: Whether to ignore hits from behind, on the inside of a surface.

        Returns:
            Whether each ray hits, shape (n,); and the point and the outward normal of each hit in the world, shape
            (n, 6), zeros for rays without a hit.

        Example:
            >>> hits, points = env.CheckCollisionRays([[0, 0, 5, 0, 0, -10], [1, 0, 5, 0, 0, -10]])
        """
        rows = checked_numbers(rays, "CheckCollisionRays: rays")
        if rows.ndim == 1 and rows.size in {0, 6}:
            rows = rows.reshape(-1, 6)
        if rows.ndim != 2 or rows.shape[1] != 6:
            raise ArgumentError(f"CheckCollisionRays: rays have shape {rows.shape}, and should have shape (n, 6)")
        if not np.isfinite(rows).all():
            row = int(np.flatnonzero(~np.isfinite(rows).all(axis=1))[0])
            raise ArgumentError(f"CheckCollisionRays: ray {row} is {rows[row].tolist()}, and should be finite numbers")
        checker = self.GetCollisionChecker()
        with self._simulation.lock, checker.groups.world() as world:
            targets = checker.ray_targets(world, ... if body is None else body)
            return world.rays.first_hits(rows, targets, front_facing_only=front_facing_only)

    @also_named(fncallback="callback")
    def RegisterCollisionCallback(self, callback: CollisionCallback) -> Handle:
        """Register a function that decides about each collision.

        Args:
            callback: A function of a report with one pair, and of False. It returns a ``CollisionAction``; collisions
                that it ignores do not count.

        Returns:
            A handle. The function is called as long as the handle exists.
        """
        return registered(self.collision_callbacks, callback, "RegisterCollisionCallback: callback")

    def HasRegisteredCollisionCallbacks(self) -> bool:
        """Return whether functions of ``RegisterCollisionCallback`` are registered."""
        return bool(self.collision_callbacks)

    def Triangulate(self, body: KinBody) -> TriMesh:
        """Return all geometries of ``body``, without those of grabbed bodies, as triangles in the world."""
        checked_kind(body, KinBody, "Triangulate: body")
        with self._simulation.lock:
            return _triangles([body.simulation_state])

    def TriangulateScene(self, options: int = TriangulateOptions.Everything, name: str = "") -> TriMesh:
        """Return the geometries of several bodies as triangles, in the world and at their current poses.

        Args:
            options: The choice of bodies, a ``TriangulateOptions``.
            name: The name of the body, for ``Body`` and ``AllExceptBody``.
        """
        with self._simulation.lock:
            return _triangles([body for body in self._simulation.bodies if selects(options, [name], body.scene)])


def _triangles(bodies: Sequence[BodyState]) -> TriMesh:
    return trimesh_of(Mesh.merged([links_triangles(body.scene.links, body.link_transforms()) for body in bodies]))
