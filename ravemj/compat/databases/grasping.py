"""Grasps of a body by a hand: a table that is generated once, stored, and used by planners."""

# ruff: noqa: PLR0913, PLR0917 - OpenRAVE's arguments

import logging
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from ravemj.compat.databases.grasp_valid import ValidGrasps
from ravemj.compat.interfaces import BaseManipulation, Grasper, TaskManipulation
from ravemj.compat.refusal import lacking, refusing
from ravemj.core.arguments import checked_kind
from ravemj.core.transforms import Floats
from ravemj.errors import ArgumentError
from ravemj.formats.databases.grasp_tables import VERSION, Owner, StoredGrasps, read_grasps, write_grasps
from ravemj.manipulation.grasping.table import table_columns
from ravemj.manipulation.grasping.wrenches import volume
from ravemj.rave.environment import Environment
from ravemj.rave.kinbody import KinBody
from ravemj.rave.library import RaveFindDatabaseFile
from ravemj.rave.robot import Robot

if TYPE_CHECKING:
    from ravemj.compat.databases.grasp_generation import Tried

LINES = "command lines of databases"

_LOG = logging.getLogger("ravemj")
_Check = Callable[[Floats, tuple[Floats, Floats], Floats, dict[str, float]], object]


@lacking(
    LINES,
    """
    generatepcg(preshapes standoffs rolls approachrays graspingnoise forceclosure forceclosurethreshold
        checkgraspfn manipulatordirections translationstepmult finestep friction avoidlinks plannername boxdelta
        spheredelta normalanglerange)
    @CreateOptionParser() @InitializeFromParser(Model parser defaultviewer args *margs **named)
    """,
)
class GraspingModel(ValidGrasps):
    """Grasps of a body by the active manipulator of a robot.

    Args:
        robot: The robot.
        target: The body to grasp.
        maxvelmult: Not used.
        graspparametersdof: User-defined grasp properties: name and number of columns.

    Attributes:
        grasps: One grasp in each row, shape (n, ``totaldof``).
        graspindices: Column indices of each property, by name: ``igrasptrans`` (``T_target_tool``, 12 numbers by
            columns), ``igraspdir``, ``igrasppreshape``, ``forceclosure`` (``mindist``) and others of OpenRAVE's.
        totaldof: Number of columns.
        target: The body to grasp.
        manip: The manipulator.
        grasper: The helper that closes the hand, after ``load``, ``generate`` or ``init``.
        numthreads: Number of processes of ``generate``.
        disableallbodies: Whether ``generate`` ignores bodies other than robot and target.
        rejected: After ``generate``, the number of rejected candidates for each reason.

    Example:
        >>> gmodel = databases.grasping.GraspingModel(robot, env.GetKinBody("mug"))
        >>> if not gmodel.load():
        ...     gmodel.autogenerate()
        >>> grasps, indices = gmodel.computeValidGrasps(returnnum=1)
        >>> gmodel.moveToPreshape(grasps[0])
        >>> T_world_tool = gmodel.getGlobalGraspTransform(grasps[0], collisionfree=True)
    """

    capability = LINES
    collision_escape_offset = 9e-5
    graspsetname = "default"

    def __init__(
        self,
        robot: Robot,
        target: KinBody,
        maxvelmult: float | None = None,
        graspparametersdof: Mapping[str, int] | None = None,
    ) -> None:
        del maxvelmult
        super().__init__(checked_kind(robot, Robot, "GraspingModel: robot"))
        self.target = checked_kind(target, KinBody, "GraspingModel: target")
        if robot.GetActiveManipulator() is None:
            raise ArgumentError(f"GraspingModel: robot '{robot.GetName()}' has no manipulator, and a hand is needed")
        self.graspindices, self.totaldof = table_columns(self.manip.GetGripperDOF(), graspparametersdof)
        self._more = dict(graspparametersdof or {})
        self.grasps: Floats = np.zeros((0, self.totaldof))
        self.grasper: Grasper | None = None
        self.basemanip: BaseManipulation | None = None
        self.translationstepmult: float | None = None
        self.finestep: float | None = None
        self.numthreads, self.disableallbodies = 1, True
        self.rejected: Counter[str] = Counter()
        self._tried = self._candidates = 0

    def clone(self, envother: Environment) -> "GraspingModel":
        """Return the model for robot and target of the same names in another environment.

        Args:
            envother: The environment.
        """
        robot, target = envother.GetRobot(self.robot.GetName()), envother.GetKinBody(self.target.GetName())
        if robot is None or target is None:
            missing = self.robot if robot is None else self.target
            raise ArgumentError(f"clone: envother has no '{missing.GetName()}'")
        robot.SetActiveManipulator(self.manip.GetName())
        other = type(self)(robot, target, graspparametersdof=self._more)
        other._take(self._stored())
        return other

    # Files

    def getversion(self) -> int:
        """Return the version of the table: OpenRAVE's 10."""
        return VERSION

    def has(self) -> bool:
        """Return whether the model has grasps and a ``grasper``."""
        return len(self.grasps) > 0 and self.grasper is not None

    def getfilename(self, read: bool = False) -> str:
        """Return the path of the grasp table in OpenRAVE's database; the format of the file is ``.npz``.

        Args:
            read: Whether the file has to exist; if it does not, the result is ''.
        """
        hashes = f"{self.manip.GetStructureHash()}.{self.target.GetKinematicsGeometryHash()}"
        name = f"robot.{self.robot.GetKinematicsGeometryHash()}/graspset.{hashes}.pp"
        return RaveFindDatabaseFile(name, read)

    def _unfinished_folder(self) -> str:
        return f"{self.getfilename(False)}.unfinished"

    def save(self, params: object = None) -> None:
        """Write the table to its file; an existing file is kept with the suffix ``.old``.

        Args:
            params: OpenRAVE's; not used.

        Raises:
            OutputError: the file cannot be written.
        """
        del params
        write_grasps(self.getfilename(False), self._stored())

    def load(self, filename: str | None = None, *, file: str | None = None) -> bool:
        """Read the grasp table; if there is none, read the grasps of an unfinished generation, with a warning.

        Args:
            filename: A table of ravemj, or a pickle of OpenRAVE's; None: ``getfilename(True)``.
            file: Another name of ``filename``.

        Returns:
            Whether there are grasps. A damaged table in the database is reported and left alone.

        Raises:
            ArgumentError: the given file cannot be read, is damaged, or belongs to another hand.
        """
        path = filename or file
        if path is not None:
            try:
                self._take(self._fitting(path))
            except OSError as error:
                raise ArgumentError(f"load: cannot read {path}: {error.strerror or error}") from error
            return self.has()
        self._ready_grasper()
        path = self.getfilename(True)
        try:
            return self._take(self._fitting(path)) if path else self._load_unfinished()
        except (ArgumentError, OSError) as error:
            _LOG.warning("%s", error)
            return False

    def _fitting(self, path: str) -> StoredGrasps:
        """Read a grasp table; raise if it was generated for another hand."""
        stored = read_grasps(path)
        owner, here = stored.owner, self._owner()
        need = {name: len(part) for name, part in self.graspindices.items() if name not in self._more}
        wrong = [name for name in ("igrasptrans", "igraspdir", "igrasppreshape") if name not in stored.columns]
        wrong += [name for name, part in stored.columns.items() if len(part) != need.get(name, len(part))]
        if wrong or (owner.joints and owner.joints != here.joints):
            joints = ", ".join(here.joints) or "no joints"
            made = f"'{owner.manip}' of '{owner.robot}' ({', '.join(owner.joints)})" if owner.robot else "another hand"
            raise ArgumentError(
                f"{path} is a table of {made}, and '{here.manip}' of '{here.robot}' has {joints}: "
                "choose its manipulator, or generate grasps for this one"
            )
        for what, saved, expected in (
            (f"robot '{here.robot}'", owner.robot_hash, here.robot_hash),
            (f"target '{here.target}'", owner.target_hash, here.target_hash),
        ):
            if saved and saved != expected:
                hint = "grasps may miss; computeValidGrasps tests them, generate makes new ones"
                _LOG.warning("%s was made for other links or shapes than those of %s: %s", path, what, hint)
        if stored.tried < stored.candidates:
            self._warn_partial(path, stored.tried, stored.candidates)
        return stored

    def _load_unfinished(self) -> bool:
        """Load the grasps of an interrupted generation; return False if there are none."""
        folder = Path(self._unfinished_folder())
        if not folder.is_dir():
            return False
        from ravemj.compat.databases import grasp_generation as generation  # noqa: PLC0415 - rare, imports much

        parts = generation.unfinished(folder)
        if parts is None:
            return False
        generated = generation.collected(self.graspindices, parts)
        self._warn_partial(str(parts), generated.tried, generated.candidates)
        self._tried, self._candidates = generated.tried, generated.candidates
        if len(generated.rows):
            self.grasps = generated.rows
        return self.has()

    def _warn_partial(self, path: str, tried: int, total: int) -> None:
        text = "%s is partial: %d of %d candidates are tried; the generation goes on if it is called in the same way"
        _LOG.warning(text, path, tried, total)

    def _owner(self) -> Owner:
        joints = [self.robot.GetJointFromDOFIndex(int(index)).GetName() for index in self.manip.GetGripperIndices()]
        names = self.robot.GetName(), self.manip.GetName(), self.target.GetName()
        return Owner(
            *names, tuple(joints), self.robot.GetKinematicsGeometryHash(), self.target.GetKinematicsGeometryHash()
        )

    def _stored(self) -> StoredGrasps:
        grasper = self._ready_grasper()
        settings = {
            "friction": grasper.friction,
            "avoidlinks": [link.GetName() for link in grasper.avoidlinks],
            "plannername": grasper.plannername,
            "translationstepmult": self.translationstepmult,
            "finestep": self.finestep,
            "graspsetname": self.graspsetname,
        }
        return StoredGrasps(self.grasps, self.graspindices, self._owner(), settings, self._tried, self._candidates)

    def _take(self, stored: StoredGrasps) -> bool:
        """Set the model's grasps, columns and settings to those of a table; return whether it has any grasps."""
        given = stored.settings
        self.grasps, self.graspindices = stored.rows, dict(stored.columns)
        self.totaldof = stored.rows.shape[1]
        self._tried, self._candidates = stored.tried, stored.candidates
        self.translationstepmult, self.finestep = given.get("translationstepmult"), given.get("finestep")
        self.graspsetname = str(given.get("graspsetname") or "default")
        links = [link for link in self.robot.GetLinks() if link.GetName() in (given.get("avoidlinks") or [])]
        self.init(given.get("friction"), links, given.get("plannername"))
        return self.has()

    # Generation

    def autogenerateparams(self, options: object = None) -> tuple[Any, ...]:
        """Return the arguments of ``generate`` for this hand, in their order.

        Args:
            options: OpenRAVE's command line options, such as ``boxdelta`` and ``standoffs``, which replace defaults.
        """

        def option(name: str, default: object = None) -> Any:  # noqa: ANN401 - any option
            value = getattr(options, name, None)
            return default if value is None else value

        friction, noise = option("friction", 0.3), option("graspingnoise")
        delta, sphere = option("boxdelta"), option("spheredelta")
        angles = {"normalanglerange": option("normalanglerange", 0), "directiondelta": option("directiondelta", 0.4)}
        if delta is None and sphere is not None:
            approach = self.computeSphereApproachRays(delta=sphere, **angles)
        else:
            approach = self.computeBoxApproachRays(delta=0.02 if delta is None else delta, **angles)
        standoffs, rolls = option("standoffs"), option("rolls")
        return (
            option("preshapes"), standoffs, rolls, approach, noise, True, 1e-9, None, None,
            option("translationstepmult"), option("finestep"), friction, option("avoidlinks"), option("plannername"),
        )  # fmt: skip

    def autogenerate(self, options: object = None) -> None:
        """Generate grasps from the sides of the target's box with ``autogenerateparams``, and save them.

        Args:
            options: As ``autogenerateparams``.

        Raises:
            ArgumentError: as ``generate``.
        """
        parts = self._generate(*self.autogenerateparams(options))
        self.save()
        self._forget(parts)

    def generate(self, *args: Any, **kwargs: Any) -> None:  # noqa: ANN401 - the arguments of `_generate`
        """Generate grasps: test each combination of approach ray, roll, preshape, standoff and direction.

        The tests run as a ``ravemj.sweep``, in several processes: after an interruption, the same call resumes.

        Args:
            args: In this order, or by name: ``preshapes``, values of the gripper joints, (n, joints), None: opened;
                ``standoffs`` [m], None: 0 and 0.025; ``rolls`` [rad], None: quarter turns; ``approachrays``, points and
                outward normals in the target, (n, 6), None: ``computeBoxApproachRays(boxdelta)``, or those of a sphere
                with ``spheredelta``; ``graspingnoise``, displacement of the target in 20 more runs [m];
                ``forceclosure``, whether grasps have to be in force closure; ``forceclosurethreshold``, least
                ``mindist``; ``checkgraspfn``, function of contacts, final configuration, row and a dict with
                ``mindist`` and ``volume`` that returns whether to keep a grasp, called when it is found;
                ``manipulatordirections``, axes of the tool that point along the approach, (n, 3);
                ``translationstepmult`` and ``finestep``, steps; ``friction``, None: 0.4; ``avoidlinks``, links that
                must not touch; ``plannername``; ``boxdelta`` and ``spheredelta``, distance of rays;
                ``normalanglerange``, angle of rays from normals [rad].
            kwargs: The same by name.

        Raises:
            ArgumentError: the manipulator has no gripper joints, the target has no geometries or is grabbed, or there
                are no candidates.
            SweepError: testing failed with an error.
        """
        self._forget(self._generate(*args, **kwargs))

    def _generate(
        self,
        preshapes: ArrayLike | None = None,
        standoffs: ArrayLike | None = None,
        rolls: ArrayLike | None = None,
        approachrays: ArrayLike | None = None,
        graspingnoise: float | Sequence[float] | None = None,
        forceclosure: bool = True,
        forceclosurethreshold: float = 1e-9,
        checkgraspfn: _Check | None = None,
        manipulatordirections: ArrayLike | None = None,
        translationstepmult: float | None = None,
        finestep: float | None = None,
        friction: float | None = None,
        avoidlinks: Sequence[Any] | None = None,
        plannername: str | None = None,
        boxdelta: float | None = None,
        spheredelta: float | None = None,
        normalanglerange: float = 0,
    ) -> Path:
        """Generate grasps, and return the folder with the files of the candidates."""
        from ravemj.compat.databases import grasp_generation as generation  # noqa: PLC0415 - imports much

        self._check_hand()
        if approachrays is None and boxdelta is None and spheredelta is not None:
            approachrays = self.computeSphereApproachRays(spheredelta, normalanglerange)
        elif approachrays is None:
            approachrays = self.computeBoxApproachRays(0.02 if boxdelta is None else boxdelta, normalanglerange)
        noise, tries = np.ravel([graspingnoise or 0.0, 20])[:2]
        links = [link if isinstance(link, str) else link.GetName() for link in avoidlinks or []]
        self.init(0.4 if friction is None else friction, [self.robot.GetLink(name) for name in links], plannername)
        self.translationstepmult = self.translationstepmult if translationstepmult is None else translationstepmult
        self.finestep = self.finestep if finestep is None else finestep
        joints = self.manip.GetGripperDOF()
        parts = {
            "igrasproll": _rows([0, np.pi / 2, np.pi, 1.5 * np.pi] if rolls is None else rolls, 1, "rolls"),
            "igrasppreshape": _rows(self._opened() if preshapes is None else preshapes, joints, "preshapes"),
            "igraspstandoff": _rows([0, 0.025] if standoffs is None else standoffs, 1, "standoffs"),
            "imanipulatordirection": _rows(
                self.manip.GetLocalToolDirection() if manipulatordirections is None else manipulatordirections,
                3, "manipulatordirections",
            ),
        }  # fmt: skip
        columns = table_columns(joints, self._more)
        self.graspindices, self.totaldof = columns
        closing = self.manip.GetChuckingDirection().astype(float)
        rows = generation.candidates(*columns, _rows(approachrays, 6, "approachrays"), parts, closing)
        if not len(rows):
            raise ArgumentError("generate: there are no approach rays that meet the target; a smaller delta gives more")
        names = self.robot.GetName(), self.manip.GetName(), self.target.GetName()
        steps = self.translationstepmult, self.finestep
        threshold = float(forceclosurethreshold) if forceclosure else None
        assert self.grasper is not None
        rating = float(self.grasper.friction), links, plannername
        settings = generation.Settings(*names, self._more, *rating, *steps, float(noise), int(tries), threshold)
        job = generation.GenerationJob(self._unfinished_folder(), self.numthreads, self.disableallbodies)
        check = None if checkgraspfn is None else _checking(self, checkgraspfn)
        generated, folder = generation.generate(self, rows, settings, job, check)
        self.grasps = generated.rows if len(generated.rows) else np.zeros((0, self.totaldof))
        self.rejected, self._tried, self._candidates = generated.rejected, generated.tried, generated.candidates
        if not len(self.grasps):
            counts = "; ".join(f"{count}: {reason}" for reason, count in self.rejected.most_common(5))
            _LOG.warning("none of %d candidates is a grasp of '%s' (%s)", len(rows), names[2], counts)
        return folder

    def _forget(self, parts: Path) -> None:
        from ravemj.compat.databases.grasp_generation import forget  # noqa: PLC0415 - it is imported already

        forget(parts)

    def _check_hand(self) -> None:
        """Raise if the hand has no gripper joints, or the target cannot be grasped by this robot."""
        robot, manip, target = self.robot, self.manip, self.target
        if not manip.GetGripperDOF():
            raise ArgumentError(
                f"GraspingModel: manipulator '{manip.GetName()}' of '{robot.GetName()}' has no gripper joints, and "
                "grasps need fingers that close: list them in its <joints>, or choose another manipulator"
            )
        if target == robot:
            raise ArgumentError(f"GraspingModel: target '{target.GetName()}' is the robot; expected a body to grasp")
        if target.GetEnv() != robot.GetEnv() or not robot.simulation_state.simulation.holds(target.simulation_state):
            place = f"the environment of robot '{robot.GetName()}'"
            raise ArgumentError(f"GraspingModel: target '{target.GetName()}' is not in {place}; add it first")
        self._check_shapes()
        if robot.IsGrabbing(target):
            raise ArgumentError(f"GraspingModel: '{robot.GetName()}' holds '{target.GetName()}'; release it first")

    def _opened(self) -> Floats:
        """Return the gripper joint values after opening the fingers; the robot is not changed."""
        with self.robot, self.target:
            self.robot.SetActiveManipulator(self.manip)
            self.target.Enable(False)
            final, _ = TaskManipulation(self.robot).ReleaseFingers(execute=False, outputfinal=True)
        assert final is not None
        return final


def _rows(values: ArrayLike, width: int, name: str) -> Floats:
    """Convert an argument of ``generate`` to an array of shape (n, width)."""
    array = np.asarray(values, dtype=float)
    if array.size % width or (array.ndim > 1 and array.shape[-1] != width) or not np.isfinite(array).all():
        mistake = f"have shape {array.shape}" if np.isfinite(array).all() else "are not finite"
        raise ArgumentError(f"generate: {name} {mistake}; expected finite numbers of shape (n, {width})")
    return array.reshape(-1, width)


def _checking(model: GraspingModel, check: _Check) -> Callable[["Tried"], bool]:
    """Return a function that closes the fingers as in a grasp, then returns the result of ``checkgraspfn``."""
    friction = model.grasper.friction if model.grasper else 0.0

    def checked(grasp: "Tried") -> bool:
        positions, normals = grasp.contacts[:, :3], grasp.contacts[:, 3:]
        mindist = float(grasp.row[model.graspindices["forceclosure"][0]])
        numbers = {"mindist": mindist, "volume": volume(positions, normals, friction)}
        with model.robot:
            model.robot.SetActiveManipulator(model.manip)
            model.setFinalFingerValues(grasp.row)
            return bool(check(grasp.contacts, (grasp.values, grasp.T_world_robot), grasp.row, numbers))

    return checked


run = refusing("grasping.run", LINES, "*arguments **named")
