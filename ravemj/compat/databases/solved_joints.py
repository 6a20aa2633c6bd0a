"""Solved and free joints of an arm's IK solver, and the solver's name."""

import operator
import platform
from collections.abc import Sequence
from typing import Any

from ravemj.compat.databases.model import DatabaseGenerator
from ravemj.geometry_functions.ik_types import IkParameterizationType, goal_dof
from ravemj.ik.arms import chain_of
from ravemj.ik.chain import Chain
from ravemj.ik.redundancy import default_free, default_steps
from ravemj.model.manipulators import chain as joints_between
from ravemj.rave.iksolver import IkSolver
from ravemj.rave.library import RaveFindDatabaseFile
from ravemj.rave.manipulator import Manipulator
from ravemj.rave.robot import Robot

_VERSION = 0x1000004C
"""Version number of OpenRAVE 0.149's IK solvers, used in file names."""


class InverseKinematicsError(Exception):
    """An arm cannot be solved as requested; not an ``openrave_exception``.

    Attributes:
        parameter: The reason.
    """

    def __init__(self, parameter: object = "") -> None:
        super().__init__(parameter)
        self.parameter = parameter

    def __eq__(self, r: object) -> bool:
        return isinstance(r, InverseKinematicsError) and self.parameter == r.parameter

    def __hash__(self) -> int:
        return hash(str(self.parameter))


class SolvedJoints(DatabaseGenerator):
    """Base of ``InverseKinematicsModel`` with the arm and its joints."""

    manip: Manipulator

    def __init__(
        self,
        robot: Robot | None = None,
        iktype: IkParameterizationType | None = None,
        forceikfast: bool = False,
        freeindices: Sequence[int] | None = None,
        freejoints: Sequence[str | int] | None = None,
        manip: Manipulator | None = None,
        checkpreemptfn: object = None,
    ) -> None:
        del forceikfast, checkpreemptfn
        owner = manip.GetRobot() if robot is None and manip is not None else robot
        if not isinstance(owner, Robot):
            raise ValueError("InverseKinematicsModel: give a robot or a manipulator (robot, manip)")
        super().__init__(owner)
        arm = manip or owner.GetActiveManipulator()
        if arm is None:
            raise InverseKinematicsError(f"'{owner.GetName()}' has no manipulator; AddManipulator gives it one")
        self.manip = arm
        self.iktype: IkParameterizationType | None = None if iktype is None else IkParameterizationType(iktype)
        self.freeindices: list[int] | None = None if freeindices is None else [*map(operator.index, freeindices)]
        if freejoints is not None:
            self.freeindices = self.getIndicesFromJointNames(freejoints)
        self.solveindices: list[int] | None = None
        self.freeinc: list[float] | None = None
        self.iksolver: IkSolver | None = None
        self.ikfeasibility: str | None = None
        self.statistics: dict[str, Any] = {}
        self._check_links()
        if self.freeindices is not None:
            self._divide(self.freeindices)

    def _check_links(self) -> None:
        """Raise if a link of the arm is static, so that joints cannot move it."""
        body, base, effector = self.robot.simulation_state.scene, self.manip.GetBase(), self.manip.GetEndEffector()
        if base is None or effector is None:
            return
        for index in joints_between(body, base.GetIndex(), effector.GetIndex()) or []:
            link = body.links[body.all_joints[index].child]
            if link.static:
                message = (
                    f"link '{link.name}' of the arm '{self.manip.GetName()}' is static; SetStatic(False) lets it move"
                )
                raise InverseKinematicsError(message)

    def _chain(self) -> Chain:
        arms = self.robot.simulation_state.scene.manipulators
        description = next(arm for arm in arms if arm.name == self.manip.GetName())
        try:
            return chain_of(self.robot.simulation_state.scene, description)
        except ValueError as error:
            raise InverseKinematicsError(str(error)) from error

    def _type(self) -> IkParameterizationType:
        if self.iktype is None:
            raise InverseKinematicsError("iktype is not known; give the model one, for instance Transform6D")
        return self.iktype

    # Which joints are solved for

    def getIndicesFromJointNames(self, freejoints: Sequence[str | int]) -> list[int]:
        """Return DOF indices of joints.

        Args:
            freejoints: Names, or DOF indices.

        Raises:
            LookupError: a joint name is unknown.
        """
        indices: list[int] = []
        for name in freejoints:
            if not isinstance(name, str):
                indices.append(operator.index(name))
                continue
            joint = self.robot.GetJoint(name)
            if joint is None:
                raise LookupError(f"'{self.robot.GetName()}' has no joint '{name}'")
            indices.append(joint.GetDOFIndex())
        return indices

    def GetDefaultIndices(self, avoidPrismaticAsFree: bool = False) -> tuple[list[int], list[int]]:
        """Return the solved DOFs and the free DOFs by default.

        Args:
            avoidPrismaticAsFree: Not used.

        Raises:
            InverseKinematicsError: the model has no ``iktype``, or the arm cannot be solved.
        """
        del avoidPrismaticAsFree
        kind, chain, arm = self._type(), self._chain(), self.manip.GetArmIndices().tolist()
        if kind == IkParameterizationType.Transform6D:
            free = [] if chain.dof <= goal_dof(kind) else list(self.manip.ik_solver(kind).free)
        else:
            free = default_free(chain, kind.name, goal_dof(kind))
        return [arm[joint] for joint in range(chain.dof) if joint not in free], [arm[joint] for joint in free]

    def _divide(self, free: Sequence[int]) -> list[int]:
        """Return the arm's DOFs to solve for: all but ``free``, which must be distinct DOFs of the arm."""
        arm = self.manip.GetArmIndices().tolist()
        outside = [index for index in free if index not in arm]
        if outside:
            message = f"freeindices {outside} are outside of the arm '{self.manip.GetName()}', which has {arm}"
            raise InverseKinematicsError(message)
        if len(set(free)) < len(free):
            raise InverseKinematicsError(f"freeindices {list(free)} name a joint twice; name each once")
        return [index for index in arm if index not in free]

    def getDefaultFreeIncrements(self, freeincrot: float, freeinctrans: float) -> list[float]:
        """Return the step of each free joint [rad or m].

        Args:
            freeincrot: The step of revolute joints [rad].
            freeinctrans: The step of sliders, in units of the length of the arm.
        """
        arm = self.manip.GetArmIndices().tolist()
        free = [arm.index(index) for index in self.freeindices or []]
        return list(default_steps(self._chain(), free, freeincrot, freeinctrans)) if free else []

    # Names

    def getikname(self) -> str:
        """Return the name for ``RaveCreateIkSolver``."""
        return self._name(self._type())

    def _name(self, kind: IkParameterizationType) -> str:
        return f"ikfast ikfast.{self.manip.GetInverseKinematicsStructureHash(kind)}.{kind}.{self.manip.GetName()}"

    def getversion(self) -> int:
        """Return the version of OpenRAVE's solvers used in file names."""
        return _VERSION

    def getfilename(self, read: bool = False) -> str:
        """Return the path at which OpenRAVE would store the compiled solver; the file does not exist.

        Args:
            read: Whether the file must exist; if True, the result is ''.
        """
        return RaveFindDatabaseFile(self._file(f"{platform.machine()}.", ".so"), read)

    def getstatsfilename(self, read: bool = False) -> str:
        """Return the path at which OpenRAVE would store the statistics; the file does not exist.

        Args:
            read: Whether the file must exist; if True, the result is ''.
        """
        return RaveFindDatabaseFile(self._file("", ".pp"), read)

    def _file(self, machine: str, ending: str) -> str:
        kind = self._type()
        free = self.GetDefaultIndices()[1] if self.freeindices is None else self.freeindices
        solve = "_".join(map(str, self._divide(free)))
        indices = solve + "".join(f"_f{index}" for index in sorted(free))
        folder = f"kinematics.{self.manip.GetInverseKinematicsStructureHash(kind)}"
        return f"{folder}/ikfast{self.getversion():#x}.{kind}.{machine}{indices}{ending}"
