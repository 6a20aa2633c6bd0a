"""Options of searches for solutions of inverse kinematics."""

import operator
from collections.abc import Mapping, Sequence
from typing import cast

from numpy.typing import ArrayLike

from ravemj.manipulation.arm_search import Checks
from ravemj.rave.enums import IkFilterOptions

_OPTIONS = "filteroptions"
"""Name of the argument with ``IkFilterOptions``."""

# Plain numbers: operators of flags take longer than tests of collision.
_CHECK_ENV = int(IkFilterOptions.CheckEnvCollisions)
_IGNORE_SELF = int(IkFilterOptions.IgnoreSelfCollisions)
_IGNORE_LIMITS = int(IkFilterOptions.IgnoreJointLimits)
_IGNORE_END = int(IkFilterOptions.IgnoreEndEffectorEnvCollisions)
_IGNORE_END_SELF = int(IkFilterOptions.IgnoreEndEffectorSelfCollisions)


def checks_of(options: int) -> Checks:
    """Return the tests that ``IkFilterOptions`` select."""
    return Checks(
        others=bool(options & _CHECK_ENV),
        itself=not options & _IGNORE_SELF,
        limits=not options & _IGNORE_LIMITS,
        end_and_others=not options & _IGNORE_END,
        end_and_rest=not options & _IGNORE_END_SELF,
    )


def split_options(
    caller: str, arguments: Sequence[object], named: Mapping[str, object], free_name: str = "freeparameters"
) -> tuple[ArrayLike | None, int]:
    """Return free joint values, or None, and ``IkFilterOptions`` from ``([freeparameters,] filteroptions)``.

    Raises:
        TypeError: the options are missing, or there are other arguments.
    """
    names = [free_name, _OPTIONS] if len(arguments) > 1 or free_name in named else [_OPTIONS]
    given = dict(zip([name for name in names if name not in named], arguments, strict=False)) | dict(named)
    unknown = given.keys() - {free_name, _OPTIONS}
    if unknown:
        raise TypeError(f"{caller}: has no argument {', '.join(unknown)}")
    if _OPTIONS not in given or len(given) != len(arguments) + len(named):
        raise TypeError(f"{caller}: takes param, the goal, [{free_name},] {_OPTIONS}; see IkFilterOptions")
    options = given[_OPTIONS]
    try:
        number = operator.index(cast("int", options))
    except TypeError:
        raise TypeError(f"{caller}: {_OPTIONS} are {options!r}, and should be IkFilterOptions or 0") from None
    return cast("ArrayLike | None", given.get(free_name)), number
