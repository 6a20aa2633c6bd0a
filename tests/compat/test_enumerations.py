"""Every enumeration of OpenRAVE's surface: members, numbers, texts and combinations."""

import copy
import itertools
import operator
import pickle
from enum import Enum

import api_surface
import pytest

import ravemj
from ravemj.rave.enums import IkReturnAction, SaveParameters

ENUMERATIONS = [name for name in api_surface.names() if name.kind == "enum"]
OPERATORS = {"|": operator.or_, "&": operator.and_, "^": operator.xor, "-": operator.sub, "<": operator.lt}
MORE = {
    "DOFAffine": {"XYZ"},
    "ErrorCode": {"InvalidURI", "BodyNameConflict", "SensorNameConflict", "BodyIdConflict"},
    "GeometryType": {"None_"},
    "IkParameterizationType": {"none"},
    "TriangulateOptions": {"Obstacles"},
}
"""Members that OpenRAVE's Python does not have."""


def members_of(name):
    """Return OpenRAVE's numbers by name."""
    inside = (one for one in api_surface.names() if one.kind == "=" and one.module == name.module)
    return {one.path.rpartition(".")[2]: int(one.rest) for one in inside if one.path.rpartition(".")[0] == name.path}


@pytest.fixture(params=ENUMERATIONS, ids=lambda name: name.path)
def both(request):
    """An enumeration and OpenRAVE's numbers."""
    kind = api_surface.thing_of(request.param)
    assert isinstance(kind, type)
    assert issubclass(kind, Enum)
    return kind, members_of(request.param)


def test_all_members_have_openraves_numbers(both):
    kind, numbers = both
    ours = {name: int(member) for name, member in kind.__members__.items()}
    assert {name: number for name, number in ours.items() if name not in MORE.get(kind.__name__, ())} == numbers
    assert set(dir(kind)) >= numbers.keys()


def test_texts_end_in_the_name(both):
    kind, numbers = both
    for name, number in numbers.items():
        member = getattr(kind, name)
        assert str(member) == f"{kind.__name__}.{member.name}"
        assert repr(member) == f"<{kind.__name__}.{member.name}: {number}>"
        assert kind.__members__[member.name] is member
        assert f"{member:d}" == str(number)


def test_members_stand_for_their_numbers(both):
    kind, numbers = both
    for name, number in numbers.items():
        member = getattr(kind, name)
        assert kind(number) is member
        assert (member == number, hash(member), [10, 11][member == number]) == (True, hash(number), 11)
        assert copy.deepcopy(member) is pickle.loads(pickle.dumps(member)) is member


def test_combinations_are_whole_numbers(both):
    kind, numbers = both
    for one, other in itertools.product(numbers, repeat=2):
        for operation in OPERATORS.values():
            expected = operation(numbers[one], numbers[other])
            for left, right in (
                (getattr(kind, one), getattr(kind, other)),
                (getattr(kind, one), numbers[other]),
                (numbers[one], getattr(kind, other)),
            ):
                assert operation(left, right) == expected
                assert type(operation(left, right)) is type(expected)
    for name, number in numbers.items():
        assert (~getattr(kind, name), type(~getattr(kind, name))) == (~number, int)


@pytest.mark.parametrize("kind", [one for one in map(api_surface.thing_of, ENUMERATIONS) if hasattr(one, "names")])
def test_dictionaries_list_the_members(kind):
    assert kind.names == dict(kind.__members__)
    assert {number: int(member) for number, member in kind.values.items()} == {int(one): int(one) for one in kind}


def test_flags_are_made_of_any_number():
    rejected = IkReturnAction(0x8101)
    assert (int(rejected), str(rejected)) == (0x8101, "33025")
    assert rejected.name == "Reject|RejectJointLimits|RejectCustomFilter"
    assert IkReturnAction(5).name == "Reject|4"
    assert rejected is IkReturnAction(0x8101) is pickle.loads(pickle.dumps(rejected))
    assert len(IkReturnAction) == len(list(IkReturnAction)) == 10
    assert SaveParameters(~SaveParameters.LinkEnable) & SaveParameters.LinkEnable == 0
    for wrong in ("x", None, 1.5):
        with pytest.raises(ValueError, match=r"IkReturnAction: value: is .*, and should be a whole number"):
            IkReturnAction(wrong)


def test_other_numbers_of_lists_are_refused():
    with pytest.raises(ValueError, match="GeometryType: value: is 99, and should be the number of a member"):
        ravemj.GeometryType(99)
