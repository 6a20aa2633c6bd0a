"""Motions and the files they come from."""

import csv
import io
import math
import zipfile

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from strategies import examples

from ravemj.errors import ArgumentError, SourceError
from ravemj.trajectories.motion import Motion
from ravemj.trajectories.motion_reading import read_motion

JOINTS = ["Arm0", "Arm1", "Slider"]
CURRENT = [0.1, 0.2, 0.3]
FILES = examples(150)

finite = st.floats(-1e6, 1e6)


@st.composite
def motions(draw, dof=None):
    moments = st.floats(-1e3, 1e3).map(lambda time: time if abs(time) > 1e-300 else 0.0)  # np.interp divides by them
    times = draw(st.lists(moments, min_size=1, max_size=8, unique=True).map(sorted))
    dof = draw(st.integers(0, 4)) if dof is None else dof
    return Motion(times, draw(hnp.arrays(float, (len(times), dof), elements=finite)))


@pytest.fixture
def read(tmp_path):
    def read(content, suffix=".csv"):
        path = tmp_path / f"motion{suffix}"
        path.write_bytes(content.encode() if isinstance(content, str) else content)
        return read_motion(path, JOINTS, CURRENT)

    return read


# Motion


def test_line_is_the_straight_line():
    swing = Motion.line([0.0, 1.0], [2.0, -1.0], duration=4.0)
    assert (swing.duration, swing.dof) == (4.0, 2)
    np.testing.assert_allclose(swing.sample(1.0), [0.5, 0.5])
    np.testing.assert_array_equal(swing.sample(-7.0), [0.0, 1.0])
    np.testing.assert_array_equal(swing.sample(math.inf), [2.0, -1.0])


def test_arrays_are_read_only_copies():
    values = np.zeros((2, 1))
    motion = Motion([0, 1], values)
    values[0] = 9.0
    assert motion.values[0, 0] == 0.0
    with pytest.raises(ValueError, match="read-only"):
        motion.values[0] = 1.0
    with pytest.raises(AttributeError):
        motion.times = motion.times
    motion.sample(0.0)[0] = 5.0
    motion.sample(9.0)[0] = 5.0
    assert not motion.values.any()


@given(motions())
def test_a_sample_at_a_row_is_that_row(motion):
    for time, row in zip(motion.times, motion.values, strict=True):
        np.testing.assert_array_equal(motion.sample(time), row)


@given(motions(), st.floats(0, 1))
def test_samples_stay_between_their_rows(motion, part):
    t = motion.times[0] + part * motion.duration
    after = min(np.searchsorted(motion.times, t, side="right"), len(motion.times) - 1)
    rows = motion.values[max(after - 1, 0) : after + 1]
    sample = motion.sample(t)
    assert (sample >= rows.min(axis=0)).all()
    assert (sample <= rows.max(axis=0)).all()
    columns = [np.interp(t, motion.times, column) for column in motion.values.T]
    np.testing.assert_allclose(sample, columns, rtol=1e-9, atol=1e-6)


def test_huge_values_do_not_overflow():
    swing = Motion.line([-1.7e308], [1.7e308])
    assert swing.sample(0.5) == 0.0


@given(motions(), st.sampled_from([0.1, 1, 24, 29.97, 30, 60]))
def test_frames_are_the_samples_and_end_at_the_end(motion, fps):
    count = motion.number_of_frames(fps)
    assume(count < 400)
    frames = list(motion.frames(fps))
    assert len(frames) == count
    np.testing.assert_array_equal(frames[-1], motion.values[-1])
    if count > 1:
        np.testing.assert_array_equal(frames[0], motion.values[0])
    for k, frame in enumerate(frames[:-1]):
        np.testing.assert_array_equal(frame, motion.sample(motion.times[0] + k / fps))


@pytest.mark.parametrize(
    ("duration", "fps", "count"), [(1, 30, 31), (1.01, 30, 32), (0.1, 30, 4), (2, 29.97, 61), (1e-9, 30, 2)]
)
def test_number_of_frames(duration, fps, count):
    assert Motion.line([0], [1], duration).number_of_frames(fps) == count


def test_one_row_is_one_frame():
    still = Motion([3.0], [[1.0, 2.0]])
    assert still.duration == 0
    assert [list(frame) for frame in still.frames(30)] == [[1.0, 2.0]]
    with pytest.raises(ArgumentError, match="one row"):
        still.rescaled(2.0)


@given(motions(dof=2), st.floats(0.1, 1e3), st.floats(0, 1))
def test_rescaling_keeps_the_path(motion, duration, part):
    assume(motion.duration > 1e-3 and np.diff(motion.times).min() > 1e-9)
    slow = motion.rescaled(duration)
    assert slow.times[0] == motion.times[0]
    assert slow.duration == pytest.approx(duration)
    np.testing.assert_array_equal(slow.values, motion.values)


@pytest.mark.parametrize(
    ("times", "values", "message"),
    [
        ([], np.zeros((0, 2)), "found 0 and 0 rows"),
        ([0, 1], [[1]], "found 2 and 1 rows"),
        ([0, 1], [1, 2], r"values as numbers of shape \(N, dof\), found int64 of shape \(2,\)"),
        ([[0], [1]], [[1], [2]], r"times as numbers of shape \(N,\)"),
        ([0, 1], [[1, 2], [3]], "different lengths"),
        ([0, 1], [["a"], ["b"]], "values as numbers"),
        ([0, math.nan], [[1], [2]], "expected finite times, found nan"),
        ([0, 1], [[1], [math.inf]], "expected finite values, found inf"),
        ([0, 1, 1], [[1], [2], [3]], r"found 1\.0 s after 1\.0 s"),
        ([-1.7e308, 1.7e308], [[1], [2]], "more than a float"),
    ],
)
def test_what_is_no_motion(times, values, message):
    with pytest.raises(ArgumentError, match=message):
        Motion(times, values)


@pytest.mark.parametrize("number", [0, -1, math.nan, math.inf])
def test_durations_and_fps_are_positive(number):
    swing = Motion.line([0], [1])
    for call in (swing.rescaled, swing.number_of_frames, swing.frames, lambda n: Motion.line([0], [1], n)):
        with pytest.raises(ArgumentError, match="above 0, found"):
            call(number)


def test_other_wrong_arguments():
    with pytest.raises(ArgumentError, match="found 1 and 2"):
        Motion.line([0], [1, 2])
    with pytest.raises(ArgumentError, match="nan"):
        Motion.line([0], [1]).sample(math.nan)
    with pytest.raises(ArgumentError, match="too many frames"):
        Motion.line([0], [1], 1e300).frames(1e300)
    with pytest.raises(ArgumentError, match="current: has shape"):
        read_motion("x.csv", JOINTS, [0, 0])


# CSV


def test_columns_in_any_order_and_unnamed_joints_stay(read):
    motion = read("\ufeff# a swing\r\n\r\n Slider , time,Arm0\r\n1,0,2\r\n  # half way\r\n3,0.5,-4e-1\r\n")
    np.testing.assert_array_equal(motion.times, [0.0, 0.5])
    np.testing.assert_array_equal(motion.values, [[2.0, 0.2, 1.0], [-0.4, 0.2, 3.0]])


def test_quotes_and_latin_comments_are_read(read):
    motion = read('# größe\n"time","Arm1"\n"0","1"\n'.encode("latin-1"))
    np.testing.assert_array_equal(motion.values, [[0.1, 1.0, 0.3]])


@given(motion=motions(dof=3), order=st.permutations([0, 1, 2, 3]))
@FILES
def test_csv_round_trip(read, motion, order):
    table = np.column_stack([motion.times, motion.values])[:, order]
    text = io.StringIO()
    csv.writer(text).writerows([[["time", *JOINTS][k] for k in order], *table.tolist()])
    again = read(text.getvalue())
    np.testing.assert_array_equal(again.times, motion.times)
    np.testing.assert_array_equal(again.values, motion.values)


@pytest.mark.parametrize(
    ("text", "line", "message"),
    [
        ("", 0, "no column 'time'; the first line names the columns"),
        ("# nothing\n", 0, "no column 'time'"),
        ("0,1\n1,2\n", 1, "no column 'time'"),
        ("time;Arm0\n0;1\n", 1, "separated by commas"),
        (
            "\ntime,arm0\n0,1\n",
            2,
            "column 2 is named 'arm0', which is not a joint; did you mean 'Arm0'? the joints are Arm0",
        ),
        ("time,Arm0,\n0,1,\n", 1, "column 3 has no name"),
        ("time,Arm0, Arm0\n0,1,2\n", 1, "two columns 'Arm0'"),
        ("time,Arm0,time\n0,1,2\n", 1, "two columns 'time'"),
        ("time,Arm0\n", 1, "no rows"),
        ("time,Arm0\n0,1\n\n# x\n1\n", 5, "expected 2 cells as in the first line, found 1"),
        ("time,Arm0\n0,1\n1,0,5\n", 3, "expected 2 cells as in the first line, found 3"),
        ("time,Arm0\n0,1\n1,zwei\n", 3, "'zwei' is not a finite number"),
        ("time,Arm0\n0,1\n1,\n", 3, "'' is not a finite number"),
        ("time,Arm0\n0,nan\n", 2, "'nan' is not a finite number"),
        ("time,Arm0\n-inf,0\n", 2, "'-inf' is not a finite number"),
        ("time,Arm0\n0,1e999\n", 2, "'1e999' is not a finite number"),
        ("time,Arm0\n0,1\n1,1\n1,1\n", 4, "times must increase, found 1.0 s after 1.0 s"),
        ("time,Arm0\n-1.7e308,1\n1.7e308,1\n", 0, "more than a float can hold"),
        ("time,Arm0\n0," + "1" * 200_000 + "\n", 2, "field larger than field limit"),
    ],
)
def test_wrong_tables(read, text, line, message):
    with pytest.raises(SourceError) as caught:
        read(text)
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)
    assert caught.value.source.line == line
    assert caught.value.source.file.endswith("motion.csv")


def test_bytes_that_are_not_utf8(read):
    with pytest.raises(SourceError, match=r"motion\.csv:2: .* not UTF-8"):
        read(b"#\ntime,Gel\xe4nk\n0,1\n")
    with pytest.raises(SourceError, match=r"motion\.csv:1"):
        read("time,Arm0\n0,1\n".encode("utf-16"))


def test_a_large_table_is_read_in_seconds(read):
    rows = np.column_stack([np.arange(20_000) / 100, np.ones((20_000, 3))])
    text = io.StringIO()
    csv.writer(text).writerows([["time", *JOINTS], *rows.tolist()])
    assert read(text.getvalue()).duration == pytest.approx(199.99)


# NPZ


def npz(**arrays):
    buffer = io.BytesIO()
    np.savez(buffer, **arrays)
    return buffer.getvalue()


def test_npz_round_trip(read):
    motion = read(npz(time=np.arange(3), values=np.arange(9.0).reshape(3, 3), more="ignored"), ".npz")
    np.testing.assert_array_equal(motion.times, [0, 1, 2])
    np.testing.assert_array_equal(motion.values, np.arange(9.0).reshape(3, 3))


def test_columns_of_npz_may_have_names(read):
    motion = read(npz(time=[0, 1], values=[[1, 2], [3, 4]], joints=["Slider", "Arm0"]), ".npz")
    np.testing.assert_array_equal(motion.values, [[2, 0.2, 1], [4, 0.2, 3]])


def test_wrong_npz(read):
    time, values = np.arange(2), np.zeros((2, 3))
    stored = zipfile.ZipFile(buffer := io.BytesIO(), "w")
    with stored:
        stored.writestr("time", b"no numpy array")
        stored.writestr("values.npy", b"\x93NUMPY\x01\x00\xff\xff")
    for content, message in (
        (npz(time=time, values=values, joints=["Arm0", "Arm1", "Wrist"]), "column 3 is named 'Wrist', which is not"),
        (npz(time=time, values=values, joints=["Arm0", "Arm1"]), "expected 'joints' as 3 different names"),
        (npz(time=time, values=values, joints=["Arm0", "Arm1", "Arm1"]), "expected 'joints' as 3 different names"),
        (npz(time=time, values=values, joints=[0, 1, 2]), "expected 'joints' as 3 different names"),
        (b"", "not an intact .npz"),
        (b"time,Arm0\n", "not an intact .npz"),
        (npz(time=time, values=values)[:-30], "not an intact .npz"),
        (npz(time=time, values=np.array([{}, {}], dtype=object)), "not an intact .npz"),
        (buffer.getvalue(), "not an intact .npz"),
        (npz(time=time), "no array 'values'"),
        (npz(values=values), "no array 'time'"),
        (npz(times=time), "no array '"),
        (npz(time=time, values=np.zeros((2, 4))), r"expected values of shape (N, 3), found (2, 4)"),
        (npz(time=time, values=np.zeros(2)), "of shape (2,)"),
        (npz(time=time, values=np.full((2, 3), 1j)), "complex128"),
        (npz(time=time[::-1], values=values), "times must increase"),
    ):
        with pytest.raises(SourceError) as caught:
            read(content, ".npz")
        assert message in str(caught.value)


# Files as such


def test_files_that_are_none(tmp_path):
    (tmp_path / "folder.csv").mkdir()
    (tmp_path / "folder.npz").mkdir()
    for name, message in (
        ("missing.csv", "no such file"),
        ("missing.npz", "no such file"),
        ("folder.csv", "cannot read the file"),
        ("folder.npz", "cannot read the file"),
        ("nu\0ll.csv", "null"),
        ("motion.txt", "a .csv or a .npz file, not '.txt'"),
        ("motion", "not ''"),
    ):
        with pytest.raises(SourceError, match=message):
            read_motion(tmp_path / name, JOINTS, CURRENT)


def motion_or_source_error(read, content, suffix):
    message = ""
    try:
        read(content, suffix)
    except SourceError as error:
        message = str(error)
    assert message.isprintable()


@given(content=st.binary(max_size=200), suffix=st.sampled_from([".csv", ".npz"]))
@FILES
def test_any_bytes(read, content, suffix):
    motion_or_source_error(read, content, suffix)


cells = st.sampled_from(
    ["time", *JOINTS, "0", "1", "2.5", "-1e308", "1e308", "nan", "", " ", '"', "#", "\0", "\r", "ä", "1_0"]
)


@given(rows=st.lists(st.lists(cells | st.text(max_size=4), max_size=4), max_size=5), header=st.booleans())
@FILES
def test_any_table(read, rows, header):
    start = "time,Arm0\n" if header else ""
    text = start + "\n".join(",".join(row) for row in rows)
    motion_or_source_error(read, text.encode("utf-8", "surrogatepass"), ".csv")


@given(position=st.integers(0, 10_000), bytes_=st.binary(min_size=1, max_size=6))
@FILES
def test_any_damaged_npz(read, position, bytes_):
    content = bytearray(npz(time=np.arange(4), values=np.zeros((4, 3))))
    position %= len(content)
    content[position : position + len(bytes_)] = bytes_
    motion_or_source_error(read, bytes(content), ".npz")
