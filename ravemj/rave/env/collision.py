"""Collision checking of an environment, and its shapes as triangles."""

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ravemj.core.arguments import also_named, checked_kind
from ravemj.core.arrays import checked_numbers
from ravemj.core.handles import Handle
from ravemj.core.transforms import Floats
from ravemj.errors import ArgumentError
from ravemj.rave.collision import CollisionChecker, NoCollisionChecker
from ravemj.rave.enums import TriangulateOptions
from ravemj.rave.env.contents import Contents
from ravemj.rave.env.triangulation import chosen, triangles
from ravemj.rave.kinbody import KinBody
from ravemj.rave.report import CollisionReport
from ravemj.rave.trimesh import TriMesh

CollisionCallback = Callable[[CollisionReport, bool], int]
"""A function of a report of one collision and of whether physics asks; it returns a ``CollisionAction``."""


class CollisionCallbackHandle(Handle):
    """Keeps a function registered; it is not called any more once this is closed or gone."""


class Collision(Contents):
    """Collision checking: what touches what, and what rays hit; and the triangles of all shapes."""

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
        """Return the collision checker, which answers ``CheckCollision``; never None."""
        if self._checker is None:
            self._checker = CollisionChecker(self._environment)
        return self._checker

    def SetCollisionChecker(self, collisionchecker: CollisionChecker | None) -> bool:
        """Choose the collision checker, which answers ``CheckCollision``.

        Args:
            collisionchecker: A checker of this environment; None: one for which nothing collides.

        Returns:
            True.
        """
        self._check_alive()
        checker = collisionchecker or NoCollisionChecker(self._environment)
        checked_kind(checker, CollisionChecker, "SetCollisionChecker: collisionchecker")
        if checker.GetEnv() is not self._environment:
            raise ArgumentError("SetCollisionChecker: collisionchecker was made for another environment")
        self._checker = checker
        return True

    def CheckCollision(self, *arguments: object, report: CollisionReport | None = None, **named: object) -> bool:
        """Return whether things touch or overlap.

        The forms are OpenRAVE's; ``report`` may also be the last argument:

        - ``(body)``, ``(link)``: against all other bodies.
        - ``(body, body2)``, ``(link, body)``, ``(link, link2)``: against each other, two links of one body as well.
        - ``(body, bodyexcluded, linkexcluded)`` or a link in its place: against all but the bodies and links of two
          lists.
        - ``(ray)``, ``(ray, body)``: a ray against all, or against one body. The length of its direction is its range.

        A body is tested together with what it holds, but not against it. Disabled bodies and links never collide.
        ``body.CheckSelfCollision`` tests a body against itself.

        Args:
            arguments: One of these forms; by name they are ``body``, ``link``, ``body1``, ``body2``, ``link1``,
                ``link2``, ``ray``, ``bodyexcluded``, ``linkexcluded``.
            report: Filled with what is found, as ``GetCollisionChecker().SetCollisionOptions`` asks for it.
            named: See ``arguments``.

        Raises:
            openrave_exception: an argument is None (``Assert``) or something else (``InvalidArguments``); one of two
                bodies is not in the environment.

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
        """Return where many rays first hit something.

        Args:
            rays: A row for each: start, and direction with the range as its length [m], shape (n, 6).
            body: The only body that they can hit; None: any.
            front_facing_only: Whether hits from behind, on the inside of a surface, are left out.

        Returns:
            Which rays hit something, shape (n,); and point and outward normal of each hit, shape (n, 6), zeros for a
            miss.

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
        with self._simulation.lock:
            world = self._simulation.collisions()
            targets = self.GetCollisionChecker().ray_targets(world, ... if body is None else body)
            return world.rays(rows, targets, front_facing_only=front_facing_only)

    @also_named(fncallback="callback")
    def RegisterCollisionCallback(self, callback: CollisionCallback) -> CollisionCallbackHandle:
        """Register a function that decides about each collision.

        Args:
            callback: Takes a report with one pair, and False; returns a ``CollisionAction``. What it ignores does not
                count.

        Returns:
            A handle: keep it as long as the function should be called.
        """
        self.collision_callbacks.append(callback)
        return CollisionCallbackHandle(self.collision_callbacks.remove, callback)

    def HasRegisteredCollisionCallbacks(self) -> bool:
        """Return whether there are functions of ``RegisterCollisionCallback``."""
        return bool(self.collision_callbacks)

    def Triangulate(self, body: KinBody) -> TriMesh:
        """Return all shapes of a body as triangles, in the world as the body stands now.

        Args:
            body: The body; what it holds is left out.
        """
        checked_kind(body, KinBody, "Triangulate: body")
        with self._simulation.lock:
            return triangles([body.simulation_state])

    def TriangulateScene(self, options: int = TriangulateOptions.Everything, name: str = "") -> TriMesh:
        """Return the shapes of several bodies as triangles, in the world as they stand now.

        Args:
            options: Which bodies, a ``TriangulateOptions``.
            name: The name that ``Body`` and ``AllExceptBody`` mean.
        """
        with self._simulation.lock:
            return triangles(chosen(self._simulation.bodies, TriangulateOptions(options), name))
