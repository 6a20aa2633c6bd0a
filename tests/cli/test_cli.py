"""The commands as users run them: what they print, what they write, how they fail."""

import base64
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import time
import zlib
from pathlib import Path

import av
import mujoco
import numpy as np
import pytest
from command_line import (
    RAYS_DREW,
    TUTORIAL_CAMERA,
    colour_at,
    environment,
    finish,
    heed_interrupts,
    on_terminal,
    plain,
    pose,
    ravemj_command,
    run,
)
from conftest import DATA, one_in
from PIL import Image, ImageSequence
from waiting import PATIENCE, await_that

import ravemj
from ravemj.cli import main
from ravemj.graphics.rendering import contexts

MODELS = DATA.parent.parent / "models"
COMMANDS = ["play", "render", "convert", "check", "diff", "info", "ik", "plan", "run", "shell", "alias", "doctor"]
SMALL = ("--size", "96x72")
CSV = "time,Joint1,Joint0\n0,0,0\n0.5,0,1.5707963267948966\n1,0,3.141592653589793\n"


@pytest.fixture
def folder(tmp_path) -> Path:
    """A folder with the tutorial's model and camera, and motions."""
    for name in ("env.xml", "double-pendulum.xml"):
        (tmp_path / name).write_bytes((DATA / "tutorial" / name).read_bytes())
    (tmp_path / "camera.json").write_text(json.dumps(TUTORIAL_CAMERA.tolist()))
    (tmp_path / "swing.csv").write_text(CSV)
    return tmp_path


def listing(folder: Path) -> dict[str, bytes]:
    """Return the files of a folder with their content."""
    return {str(path.relative_to(folder)): path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file()}


def said(done: subprocess.CompletedProcess[str], code: int = 0) -> str:
    """Check the exit code and return standard output."""
    assert (done.returncode, done.stderr) == (code, "")
    return done.stdout


def frames_of(folder: Path) -> list[np.ndarray]:
    return [np.asarray(Image.open(path)) for path in sorted(folder.glob("frame_*.png"))]


# Videos


def test_play_writes_an_mp4_of_the_swing_for_every_player(folder):
    size = (321, 241)
    words = (
        "-o",
        "swing.mp4",
        "--camera",
        "camera.json",
        "--size",
        "321x241",
        "--fps",
        "10",
        "--background",
        "1,1,0.8",
    )
    printed = said(ravemj_command(folder, "play", "env.xml", *words))
    wrote, shadows = r"wrote .*/swing\.mp4 \(1 s, 11 frames of 321x241 by \w+\)\n", r"no shadows, .*--shadows .*\n"
    assert re.fullmatch(f"{wrote}({shadows})?", printed)
    with av.open(str(folder / "swing.mp4")) as video:
        stream = video.streams.video[0]
        assert (stream.codec_context.name, stream.codec_context.pix_fmt) == ("h264", "yuv420p")
        assert (stream.width, stream.height) == (322, 242), "odd sizes are padded"
        assert stream.average_rate == 10
        frames = [frame.to_ndarray(format="rgb24") for frame in video.decode(stream)]
    assert len(frames) == 11
    assert pose(frames[0], size) == "hanging"
    assert pose(frames[-1], size) == "upright"
    assert pose(frames[5], size) == "level", "half of the way to pi"
    assert np.abs(frames[0][3, 3].astype(int) - [255, 255, 204]).max() <= 4
    assert sorted(listing(folder)) == ["camera.json", "double-pendulum.xml", "env.xml", "swing.csv", "swing.mp4"]


@pytest.mark.parametrize("name", one_in(2, ["swing.gif", "swing.webp"]))
def test_play_writes_animations_that_keep_the_time(folder, name):
    words = ("-o", name, "--camera", "camera.json", "--size", "160x120", "--fps", "8")
    said(ravemj_command(folder, "play", "env.xml", *words))
    with Image.open(folder / name) as animation:
        frames = [
            (np.asarray(frame.convert("RGB")), frame.info["duration"]) for frame in ImageSequence.Iterator(animation)
        ]
        assert animation.info["loop"] == 0
    pictures, delays = zip(*frames, strict=True)
    assert sum(delays) == pytest.approx(9 / 8 * 1000, abs=10)
    assert {picture.shape for picture in pictures} == {(120, 160, 3)}
    assert (pose(pictures[0]), pose(pictures[-1])) == ("hanging", "upright")


def test_play_writes_a_folder_to_the_goal_and_replaces_its_own_kind_only(folder):
    words = ("--camera", "camera.json", "--size", "160x120", "--fps", "4", "--to", "1.5707963,0")
    said(ravemj_command(folder, "play", "env.xml", "-o", "frames/", *words))
    pictures = frames_of(folder / "frames")
    assert len(pictures) == 5
    assert (pose(pictures[0]), pose(pictures[-1])) == ("hanging", "level")
    said(ravemj_command(folder, "play", "env.xml", "-o", "frames", *words, "--duration", "0.5"))
    assert len(list((folder / "frames").iterdir())) == 3
    (folder / "frames" / "notes.txt").write_text("mine")
    before = listing(folder)
    failed = ravemj_command(folder, "play", "env.xml", "-o", "frames", *words)
    assert failed.returncode == 1
    assert "notes.txt" in failed.stderr
    assert listing(folder) == before


def test_play_without_output_and_display_writes_beside_the_user(folder):
    printed = said(ravemj_command(folder, "play", "env.xml", *SMALL, "--fps", "5"))
    assert printed.startswith(f"wrote {folder.resolve()}/env.mp4 ")
    with av.open(str(folder / "env.mp4")) as video:
        assert sum(1 for _ in video.decode(video=0)) == 6


@pytest.mark.parametrize("kind", one_in(2, ["csv", "npz"]))
def test_play_follows_a_file_in_the_time_that_is_asked_for(folder, kind):
    times, angles = [0, 0.5, 1], [[0, 0], [np.pi / 2, 0], [np.pi, 0]]
    np.savez(folder / "swing.npz", time=times, values=angles)
    words = ("--camera", "camera.json", "--size", "160x120", "--fps", "2", "--duration", "4")
    said(ravemj_command(folder, "play", "env.xml", "-o", "frames", "--trajectory", f"swing.{kind}", *words))
    pictures = frames_of(folder / "frames")
    assert len(pictures) == 9
    assert [pose(pictures[index]) for index in (0, 4, 8)] == ["hanging", "level", "upright"]


def test_the_default_goal_is_moved_into_the_limits_and_a_goal_outside_is_said(folder):
    words = ("--camera", "camera.json", "--size", "240x180", "--fps", "1")
    # Both joints turn about +x of the world: at pi/2 each, the red arm is level and the blue one stands up.
    done = ravemj_command(folder, "play", DATA / "limited.xml", "-o", "a", *words)
    assert (done.returncode, done.stderr.count("\n")) == (0, 1)
    assert "'Elbow' loads at 1.5708, not at 0" in done.stderr
    last = frames_of(folder / "a")[-1]
    assert colour_at(last, (0, 0.1, 0)) == "red"
    assert colour_at(last, (0, 0.2, 0.1)) == "blue"
    done = ravemj_command(folder, "play", DATA / "limited.xml", "-o", "b", "--to", "3.14,1.5707963267948966", *words)
    assert done.returncode == 0
    _, warning = done.stderr.splitlines()
    assert re.match(r".*/limited\.xml:\d+: warning\[value-outside-limits\]: .*'Shoulder'.*1\.57", warning)
    assert np.array_equal(frames_of(folder / "b")[-1], last)


def test_negative_numbers_need_no_equals_sign(folder):
    words = ("--camera", "camera.json", "--size", "160x120")
    said(ravemj_command(folder, "render", "env.xml", "-o", "a.png", "--q", "-1.5707963,0", *words))
    picture = np.asarray(Image.open(folder / "a.png"))
    assert [colour_at(picture, (0, -along, 0)) for along in (0.1, 0.3)] == ["red", "blue"]


@pytest.mark.stress
@pytest.mark.parametrize("name", one_in(3, ["long.mp4", "long.gif", "long"]))
def test_interrupting_a_long_play_leaves_nothing(folder, name):
    heed_interrupts()
    before = listing(folder)
    command = [sys.executable, "-m", "ravemj", "play", "env.xml", "-o", name, *SMALL, "--duration", "1000"]
    with subprocess.Popen(command, cwd=folder, env=environment(folder), stdout=-1, stderr=-1, text=True) as process:
        await_that(lambda: list(folder.glob(".ravemj-*")))
        time.sleep(0.3)
        process.send_signal(signal.SIGINT)
        printed = process.communicate(timeout=PATIENCE)
    assert (process.returncode, *printed) == (130, "", "ravemj: interrupted\n")
    assert listing(folder) == before
    assert not list(folder.glob(".ravemj-*"))
    assert not (folder / name).exists()


def test_progress_is_shown_on_a_terminal_until_ctrl_c(folder):
    heed_interrupts()
    terminal = on_terminal(folder, "-m", "ravemj", "play", "env.xml", "-o", "long.mp4", *SMALL, "--duration", "1000")
    terminal.expect("drawing long.mp4")
    terminal.expect(r"\d+/30001")
    terminal.expect("frames")
    terminal.expect(r"0:\d\d:\d\d")
    terminal.sendintr()
    terminal.expect(r"\x1b\[\?25h")  # the cursor is there again
    assert finish(terminal) == ("ravemj: interrupted\n", 130)
    assert not list(folder.glob("*.mp4"))
    assert not list(folder.glob(".ravemj-*"))


@pytest.mark.stress
def test_progress_makes_room_for_the_result(folder):
    terminal = on_terminal(folder, "-m", "ravemj", "play", "env.xml", "-o", "short.mp4", *SMALL, "--fps", "5")
    terminal.expect("wrote ")
    printed, code = finish(terminal)
    assert code == 0
    assert re.search(r"frames of 96x72 by \w+\)", printed)


# Pictures, tables and translations


def test_render_writes_a_page_whose_sliders_move_the_joints(folder):
    printed = said(ravemj_command(folder, "render", "env.xml", "-o", "arm.html", "--q", "0.5,0.25"))
    assert printed == "wrote arm.html (any browser shows it, with a slider for each joint)\n"
    packed = re.search(r'<script id="scene" type="text/plain">([^<]*)</script>', (folder / "arm.html").read_text())[1]
    content = zlib.decompress(base64.b64decode(packed))
    document = json.loads(content[4 : 4 + int.from_bytes(content[:4], "little")])
    sliders = [(slider["name"], slider["value"]) for slider in document["mechanism"]["sliders"]]
    assert sliders == [("Joint0", 0.5), ("Joint1", 0.25)]


def test_render_draws_the_pose_from_the_camera(folder):
    words = (
        "-o",
        "frame.png",
        "--q",
        "0.785,0.785",
        "--size",
        "320x240",
        "--camera",
        "camera.json",
        "--background",
        "0,1,0",
    )
    assert said(ravemj_command(folder, "render", "env.xml", *words)) == "wrote frame.png\n"
    picture = np.asarray(Image.open(folder / "frame.png"))
    assert picture.shape == (240, 320, 3)
    assert np.abs(picture[2, 2].astype(int) - [0, 255, 0]).max() <= 1
    q = 0.785
    elbow = 0.2 * np.array([0, np.sin(q), -np.cos(q)])
    assert colour_at(picture, tuple(elbow / 2)) == "red"
    assert colour_at(picture, tuple(elbow + 0.1 * np.array([0, np.sin(2 * q), -np.cos(2 * q)]))) == "blue"


@pytest.mark.parametrize(
    ("model", "reason"),
    [
        ("away", "turn the camera"),
        pytest.param("<Body/>", "the model has no shapes", marks=pytest.mark.stress),
        pytest.param("there", "", marks=pytest.mark.stress),
    ],
)
def test_a_picture_of_nothing_is_reported(model, reason, tmp_path):
    shape = '<Body name="a"><Geom type="box"><extents>1 1 1</extents></Geom></Body>'
    text = f'<KinBody name="k">{model if model.startswith("<") else shape}</KinBody>'
    (tmp_path / "k.xml").write_text(text)
    z = -5 if model == "there" else 5  # the camera looks along its z axis
    T_world_camera = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, z], [0, 0, 0, 1]]
    (tmp_path / "camera.json").write_text(json.dumps(T_world_camera))
    camera = [] if model.startswith("<") else ["--camera", "camera.json"]
    done = ravemj_command(tmp_path, "render", "k.xml", "-o", "k.png", "--size", "64x48", *camera)
    assert (done.returncode, done.stdout) == (0, "wrote k.png\n")
    assert (f"nothing is in view: {reason}" in done.stderr) == bool(reason)


@pytest.mark.parametrize(("variable", "note"), [("", RAYS_DREW), ("disable", "")])
def test_rays_are_explained_unless_they_are_asked_for(folder, monkeypatch, capsys, variable, note):
    monkeypatch.setattr(contexts, "_order", lambda: ())
    monkeypatch.setenv("MUJOCO_GL", variable)
    monkeypatch.chdir(folder)
    for words in (("render", "-o", "a.png"), ("play", "-o", "a.mp4", "--fps", "2")):
        assert main([*words, "env.xml", *SMALL]) == 0
        assert capsys.readouterr().err == note


@pytest.mark.parametrize(
    "text",
    one_in(
        3,
        [
            json.dumps({"camera": TUTORIAL_CAMERA.tolist()}),
            "0 0 -1 1\n1 0 0 0\n0 -1 0 0\n0 0 0 1\n",
            "array([[ 0.,  0., -1.,  1.],\n   [ 1.,  0.,  0.,  0.],\n [ 0., -1., -0.,  0.],\n [ 0.,  0.,  0.,  1.]])\n",
        ],
    ),
    ids=["json", "text", "as-printed"],
)
def test_cameras_are_read_as_people_keep_them(folder, text):
    (folder / "kept.txt").write_text(text)
    said(ravemj_command(folder, "render", "env.xml", "-o", "a.jpg", "--size", "160x120", "--camera", "kept.txt"))
    assert pose(np.asarray(Image.open(folder / "a.jpg"))) == "hanging"


def test_info_lists_what_the_model_has(folder):
    printed = said(ravemj_command(folder, "info", "env.xml"))
    assert printed.startswith("robot Pendulum: 3 links, 2 DOFs, 21.6549 kg\n")
    lines = printed.splitlines()
    assert lines[2:5] == [
        "Base  5.655 kg",
        "└╴Arm0  8 kg  ← Joint0: hinge, DOF 0, circular",
        "  └╴Arm1  8 kg  ← Joint1: hinge, DOF 1, circular",
    ]
    cells = [line.split() for line in lines]
    assert ["#", "link", "mass", "[kg]", "centre", "of", "mass", "[m]", "shapes"] in cells
    assert ["1", "Arm0", "8", "0.1", "0", "0", "box"] in cells
    assert ["1", "Joint1", "circular", "0", "5.42", "50", "0", "3"] in cells
    limited = ravemj_command(folder, "info", DATA / "limited.xml")
    assert "-1.571 to 1.571 rad" in limited.stdout


ALL_PARTS = """<Robot name="all"><KinBody>
<Body name="base"/><Body name="arm"/><Body name="hand"/><Body name="finger"/><Body name="plate"/>
<Joint name="j0" type="slider"><Body>base</Body><Body>arm</Body><axis>0 0 1</axis><limits>0 0.5</limits></Joint>
<Joint name="j1" type="hinge"><Body>arm</Body><Body>hand</Body><axis>0 0 1</axis><limitsdeg>0 90</limitsdeg></Joint>
<Joint name="j2" type="hinge"><Body>hand</Body><Body>finger</Body><axis>1 0 0</axis><limits>0 1</limits></Joint>
<Joint name="j3" type="hinge" mimic_pos="2*j2" mimic_vel="|j2 2"><Body>hand</Body><Body>plate</Body></Joint>
<Joint name="loop" type="hinge" enable="false"><Body>plate</Body><Body>finger</Body></Joint></KinBody>
<Manipulator name="m"><base>base</base><effector>hand</effector><joints>j2</joints>
<closingdirection>-1</closingdirection></Manipulator>
<AttachedSensor name="eye"><link>hand</link><Sensor type="BaseCamera"><KK>500 510 320 240</KK><width>640</width>
<height>480</height></Sensor></AttachedSensor>
</Robot>
"""


def test_info_shows_tree_followers_manipulators_and_sensors_in_100_columns(folder):
    (folder / "all.xml").write_text(ALL_PARTS)
    printed = said(ravemj_command(folder, "info", "all.xml"))
    lines = printed.splitlines()
    assert max(map(len, lines)) <= 100
    assert lines[2:8] == [
        "base  1 kg",
        "└╴arm  1 kg  ← j0: slider, DOF 0, 0 to 0.5 m",
        "  └╴hand  1 kg  ← j1: hinge, DOF 1, 0 to 1.571 rad",
        "    ├╴finger  1 kg  ← j2: hinge, DOF 2, 0 to 1 rad",
        "    └╴plate  1 kg  ← j3: hinge, follows 2*j2",
        "loop closes a loop between plate and finger",
    ]
    cells = [line.split() for line in lines]
    assert ["j3", "hinge", "hand", "plate", "0", "2*j2"] in cells
    assert ["m", "base", "hand", "0-1", "2", "-1"] in cells
    assert ["eye", "hand", "BaseCamera", "640x480,", "f", "500", "510,", "c", "320", "240"] in cells


def test_info_prints_the_numbers_as_json(folder):
    (folder / "all.xml").write_text(ALL_PARTS)
    (body,) = json.loads(said(ravemj_command(folder, "info", "all.xml", "--json")))["bodies"]
    assert (body["name"], body["mass"], body["dof"], len(body["links"])) == ("all", 5, 3, 5)
    assert [joint["dofs"] for joint in body["joints"]] == [[0], [1], [2]]
    assert body["joints"][1]["axes"][0]["upper"] == pytest.approx(np.pi / 2)
    passive = {joint["name"]: joint for joint in body["passive_joints"]}
    assert (passive["j3"]["follows"], passive["loop"]["closes_loop"]) == ("2*j2", True)
    assert body["manipulators"][0]["arm_dofs"] == [0, 1]
    assert body["sensors"][0]["camera"] == {"fx": 500, "fy": 510, "cx": 320, "cy": 240, "width": 640, "height": 480}
    (pendulum,) = json.loads(said(ravemj_command(folder, "info", "env.xml", "--json")))["bodies"]
    assert pendulum["joints"][0]["axes"][0]["lower"] is None, "circular"
    assert pendulum["links"][1]["geometries"][0]["half_extents"] == [0.1, 0.01, 0.01]


@pytest.mark.parametrize("name", one_in(3, ["arm.dae", "arm.zae", "arm.robot.xml"]))
def test_diff_finds_nothing_in_what_convert_writes(folder, name):
    assert said(ravemj_command(folder, "convert", "env.xml", "-o", name)) == f"wrote {name}\n"
    assert said(ravemj_command(folder, "diff", "env.xml", name)) == "no differences in 1 body\n"
    assert json.loads(said(ravemj_command(folder, "diff", "env.xml", name, "--json"))) == []


def test_diff_tells_what_differs(folder):
    text = (folder / "double-pendulum.xml").read_text()
    (folder / "double-pendulum.xml").write_text(text.replace("<maxvel>3.42</maxvel>", "<maxvel>3.43</maxvel>"))
    other = folder / "other"
    other.mkdir()
    (other / "env.xml").write_text((folder / "env.xml").read_text())
    (other / "double-pendulum.xml").write_text(text)
    found = json.loads(said(ravemj_command(folder, "diff", "env.xml", "other/env.xml", "--json"), 1))
    assert [(entry["part"], entry["quantity"], entry["first"], entry["second"]) for entry in found] == [
        ("'Pendulum' joint 'Joint0'", "max velocity", 3.43, 3.42)
    ]
    assert found[0]["difference"] == pytest.approx(0.01 / 3.43)
    table = said(ravemj_command(folder, "diff", "env.xml", "other/env.xml"), 1)
    assert "max velocity" in table
    assert said(ravemj_command(folder, "diff", "env.xml", "other/env.xml", "--tolerance", "0.1")).startswith("no diff")


def test_diff_ends_otherwise_where_a_model_cannot_be_read(folder):
    done = ravemj_command(folder, "diff", "env.xml", "nosuch.xml")
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.startswith("nosuch.xml: error: there is no such file")


def test_convert_writes_what_mujoco_loads(folder):
    assert said(ravemj_command(folder, "convert", "env.xml", "-o", "out.xml")) == "wrote out.xml\n"
    text = (folder / "out.xml").read_text()
    assert said(ravemj_command(folder, "convert", "env.xml")) == text
    model = mujoco.MjModel.from_xml_string(text)
    assert model.nq == 2
    assert [model.joint(index).name for index in range(2)] == ["Joint0", "Joint1"]


REACHED = "0.3,0.3,0.9,0.7071,0,0.7071,0"


def test_ik_finds_all_that_reach_a_pose_and_says_what_speaks_against_them(folder):
    found = json.loads(said(ravemj_command(folder, "ik", "puma560", "--to", REACHED, "--json")))
    robot = ravemj.load(ravemj.model_path("puma560")).GetRobots()[0]
    arm = robot.GetActiveManipulator()
    goal = ravemj.matrixFromPose([0.5**0.5, 0, 0.5**0.5, 0, 0.3, 0.3, 0.9])
    assert len(found) == 8
    within = arm.ik(goal).valid.sum()
    beyond = [any(word.startswith("beyond limits") for word in solution["trouble"]) for solution in found]
    assert sum(beyond) == 8 - within == 1, "a turn within the limits counts"
    distances = [np.linalg.norm(solution["values"]) for solution in found]
    assert distances == sorted(distances), "the nearest first"
    for solution in found:
        robot.SetDOFValues(solution["values"], checklimits=0)
        assert np.allclose(arm.GetTransform(), goal, atol=1e-9)
        lower, upper = robot.GetDOFLimits()
        within = (lower <= solution["values"]).all() and (solution["values"] <= upper).all()
        assert within == (not any(word.startswith("beyond limits") for word in solution["trouble"]))
        assert robot.CheckSelfCollision() == any(" hits " in word for word in solution["trouble"])
        assert solution["valid"] == (not solution["trouble"])


def test_ik_prints_a_table_describes_the_solver_and_draws_every_solution(folder):
    done = ravemj_command(
        folder, "ik", "puma560", "--to", REACHED, "-o", "arms.png", "--size", "80x60", "--background", "lime"
    )
    assert done.returncode == 0
    assert done.stdout.count("°") == 48
    assert "wrote arms.png" in done.stdout
    with Image.open(folder / "arms.png") as picture:
        assert picture.size == (80, 60)
        assert picture.getpixel((0, 0)) == (0, 255, 0)
    described = said(ravemj_command(folder, "ik", "puma560", "--describe"))
    assert "spherical wrist" in described
    assert "64 of 64" in described


def test_ik_starts_from_values_of_a_file_and_takes_other_types(folder):
    (folder / "start.json").write_text('{"joint1": -2.6, "joint2": 1.5}')
    words = ("ik", "puma560", "--to", REACHED, "--json", "--from", "start.json")
    first, *_ = json.loads(said(ravemj_command(folder, *words)))
    assert first["values"][0] == pytest.approx(-2.65, abs=0.01)
    flat = json.loads(
        said(ravemj_command(folder, "ik", "scara", "--to", "0.3,0.2", "--type", "TranslationXY2D", "--json"))
    )
    robot = ravemj.load(ravemj.model_path("scara")).GetRobots()[0]
    robot.SetDOFValues(flat[0]["values"], robot.GetActiveManipulator().GetArmIndices())
    assert robot.GetActiveManipulator().GetTransform()[:2, 3] == pytest.approx([0.3, 0.2], abs=1e-9)


def test_ik_out_of_reach(folder):
    done = ravemj_command(folder, "ik", "puma560", "--to", "9,9,9,1,0,0,0")
    assert (done.returncode, done.stderr) == (1, "")
    assert re.search(r"out of reach; the nearest that it reaches is 1[\d.]+ m and [\d.]+° away", done.stdout)
    point = ravemj_command(folder, "ik", "puma560", "--to", "9,0,0")
    assert re.search(r"the nearest that it reaches is [78]\.\d+ m away", point.stdout)
    plan = ravemj_command(folder, "plan", "puma560", "--pose", "9,0,0")
    assert re.search(r"no motion: .* the nearest that it reaches is [78]\.\d+ m away", plan.stderr)


def test_ik_between_the_samples_of_a_free_joint(folder):
    """A pose of a Panda for which no sample of its last joint has a solution within the limits."""
    robot = ravemj.load(ravemj.model_path("panda")).GetRobots()[0]
    robot.SetDOFValues([-1.87, -1.69, -0.3, -0.75, 1.75, 1.79, 2.84], range(7))
    w, x, y, z, *place = robot.GetActiveManipulator().GetTransformPose()
    goal = ",".join(map(str, [*place, w, x, y, z]))
    found = json.loads(said(ravemj_command(folder, "ik", "panda", "--to", goal, "--json")))
    assert any(one["valid"] and one["branch"].startswith("j7=") for one in found)


FEET = ("--keep", "left_foot,right_foot")


def test_ik_reaches_with_a_whole_body(folder):
    done = ravemj_command(
        folder, "ik", "biped", "--reach", "left_hand=0.35,0.2,0.5", *FEET, "-o", "biped.png", "--size", "80x60"
    )
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.endswith("all goals are met\nwrote biped.png\n")
    assert "base x,y,z" in done.stdout
    with Image.open(folder / "biped.png") as picture:
        assert picture.size == (80, 60)
    found = json.loads(
        said(ravemj_command(folder, "ik", "biped", "--reach", "left_hand=0.35,0.2,0.5", *FEET, "--json"))
    )
    robot = ravemj.load(ravemj.model_path("biped")).GetRobots()[0]
    feet = robot.GetManipulator("left_foot").GetTransform()
    robot.SetDOFValues(found["values"])
    *place, w, x, y, z = found["base"]
    robot.SetTransform([w, x, y, z, *place])
    assert np.allclose(robot.GetManipulator("left_foot").GetTransform(), feet, atol=1e-8)
    assert np.allclose(robot.GetManipulator("left_hand").GetTransform()[:3, 3], [0.35, 0.2, 0.5], atol=1e-4)


def test_ik_reaches_with_the_whole_body_of_a_urdf(folder):
    """A robot of a user's own, which stands at the origin and stretched, since a URDF says no more."""
    ravemj_command(folder, "convert", "biped", "-o", "own.urdf")
    words = ("ik", "own.urdf", "--reach", "left_hand=0.4,0.1,0.2", *FEET, "--json")
    done = ravemj_command(folder, *words)
    found = json.loads(done.stdout)
    assert (done.returncode, found["reason"]) == (0, "met")
    assert found["base"][:3] != [0, 0, 0]
    assert max(np.abs(found["residuals"][foot]).max() for foot in ("left_foot", "right_foot")) < 1e-6


def test_ik_of_a_whole_body_says_what_is_missed(folder):
    words = ("ik", "biped", "--reach", "left_hand=2,0,1", "--reach", "right_hand=0.2,-0.2,0.6,1,0,0,0", *FEET)
    done = ravemj_command(folder, *words)
    assert (done.returncode, done.stderr) == (1, "")
    assert "left_hand is" in done.stdout.splitlines()[-1]
    assert "right_hand is" in done.stdout.splitlines()[-1], "each task that is not met has its reason"
    fixed = json.loads(said(ravemj_command(folder, "ik", "panda", "--reach", "arm=0.3,0.1,0.5", "--json")))
    assert fixed["base"] == [0, 0, 0, 1, 0, 0, 0], "without --keep the base stays"


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("--reach", "hand=1,2,3"), "'Biped' has no manipulator or link 'hand'; did you mean 'left_hand'? Its"),
        (("--reach", "left_hand=1,2"), "--reach: found 2 values for 'left_hand', expected x,y,z"),
        (("--reach", "left_hand"), "'left_hand' is not NAME=x,y,z"),
        (("--reach", "left_hand=1,2,x"), "'x' is not a finite number"),
        (("--reach", "left_hand=0,0,0,0,0,0,0"), "the quaternion is 0 0 0 0"),
        (("--to", "1,2,3", "--keep", "left_foot"), "--keep: goes with --reach"),
        (("--reach", "left_hand=1,2,3", "--manip", "left_hand"), "--type and --manip go with --to"),
        (("--reach", "left_hand=1,2,3", "--keep", "wheel"), "no manipulator or link 'wheel'"),
    ],
)
def test_ik_of_a_whole_body_refuses(words, message, folder):
    done = ravemj_command(folder, "ik", "biped", *words)
    assert done.returncode in (1, 2)
    assert message in done.stderr
    assert "Traceback" not in done.stderr


PENDULUM_AND = '<Environment><Robot file="double-pendulum.xml"/>{}</Environment>'
WALL = """<KinBody name="wall{0}"><Body name="wall{0}" type="static"><Translation>0 {0} 0.18</Translation>
<Geom type="box"><extents>0.1 0.01 0.15</extents></Geom></Body></KinBody>"""
ROUND_THE_WALL = ("plan", "walled.xml", "--from", "level.json", "--to", "2.9,0")


@pytest.fixture
def walled(folder) -> Path:
    (folder / "walled.xml").write_text(PENDULUM_AND.format(WALL.format(0.25)))
    (folder / "level.json").write_text('{"Joint0": 1.57}')
    return folder


@pytest.mark.parametrize("name", one_in(2, ["plan.csv", "plan.npz"]))
def test_plan_writes_a_motion_round_a_wall_that_play_takes(walled, name):
    printed = said(ravemj_command(walled, *ROUND_THE_WALL, "-o", name))
    found = (
        r"found after \d+ iterations in [\d.]+ s: [\d.]+ s of motion, \d+ waypoints\ncertified: smallest gap .*\nwrote "
    )
    assert re.fullmatch(found + name + "\n", printed)
    env = ravemj.load(walled / "walled.xml")
    robot = env.GetRobots()[0]
    motion = ravemj.read_motion(walled / name, ["Joint0", "Joint1"], [0, 0])
    assert motion.values[0].tolist() == [1.57, 0]
    assert np.cos(motion.values[-1]) == pytest.approx(np.cos([2.9, 0]))
    for values in motion.frames(200):
        robot.SetDOFValues(values)
        assert not env.CheckCollision(robot)
    again = ravemj_command(walled, *ROUND_THE_WALL, "-o", f"again-{name}")
    assert again.stdout.partition(" in ")[0] == printed.partition(" in ")[0]
    assert ravemj.read_motion(walled / f"again-{name}", ["Joint0", "Joint1"], [0, 0]).values.tolist() == (
        motion.values.tolist()
    ), "one seed, one motion"
    said(ravemj_command(walled, "play", "walled.xml", "--trajectory", name, "-o", "a.gif", *SMALL, "--fps", "2"))


def test_plan_draws_trees_also_of_a_search_in_vain(walled):
    picture = (*SMALL, "-o", "a.png", "--show-tree")
    assert "wrote a.png" in ravemj_command(walled, *ROUND_THE_WALL, *picture).stdout
    drawn = np.asarray(Image.open(walled / "a.png")).astype(int)
    reddish = drawn[..., 0] - drawn[..., 2] > 100
    assert (reddish & (drawn[..., 1] > 80)).any(), "the tree of the goal is orange"
    (walled / "a.png").unlink()
    sides = "".join(WALL.format(side).replace("0.15", "0.5").replace("0.18", "0") for side in (0.1, -0.1))
    (walled / "walled.xml").write_text(PENDULUM_AND.format(sides))
    in_vain = ("plan", "walled.xml", "--to", "3.14,0", "--time-limit", "0.2")
    done = ravemj_command(walled, *in_vain, *picture)
    assert (done.returncode, done.stdout) == (1, "wrote a.png\n")
    why = r"ravemj: error: no motion: the time was used up after \d+ iterations, "
    why += r"with trees of \d+ and \d+ configurations; most lines "
    why += r"were stopped by link '\w+' of '\w+' with link 'wall\S+' of 'wall\S+'\n"
    assert re.fullmatch(why, done.stderr)
    done = ravemj_command(walled, *in_vain, "-o", "a.mp4")
    assert (done.returncode, done.stdout) == (1, "")
    assert not (walled / "a.mp4").exists()


def test_plan_takes_the_tool_of_a_named_arm_to_a_pose(folder):
    words = ("plan", "workshop", "--manip", "panda_arm", "--pose", "0.3,0.3,0.7,0,1,0,0", "-o", "plan.csv")
    said(ravemj_command(folder, *words))
    env = ravemj.load(ravemj.model_path("workshop"))
    robot = env.GetRobot("panda")
    names = [joint.GetName() for joint in robot.GetJoints()]
    robot.SetDOFValues(ravemj.read_motion(folder / "plan.csv", names, robot.GetDOFValues()).values[-1])
    goal = ravemj.matrixFromPose([0, 1, 0, 0, 0.3, 0.3, 0.7])
    assert np.allclose(robot.GetActiveManipulator().GetTransform(), goal, atol=1e-6)


@pytest.mark.parametrize("name", one_in(2, ["plan.csv", "plan.npz"]))
def test_a_planned_motion_plays_with_the_robot_whose_joints_it_names(folder, name):
    values = "1,0.6,0,-1.6,0,2.2,0.8"
    said(ravemj_command(folder, "plan", "workshop", "--manip", "panda_arm", "--to", values, "-o", name))
    for file, words in {"alone.html": (), "named.html": ("--robot", "panda")}.items():
        said(ravemj_command(folder, "play", "workshop", "--trajectory", name, "-o", file, "--fps", "5", *words))
        assert "<title>panda</title>" in (folder / file).read_text()
    assert (folder / "alone.html").read_text() == (folder / "named.html").read_text()


def test_a_plan_is_a_page_of_its_robot(folder):
    words = ("plan", "workshop", "--robot", "scara", "--to", "1.5,-2,0.1,0", "--show-tree", "-o", "plan.html")
    printed = said(ravemj_command(folder, *words))
    assert re.search(r"\nwrote .*plan\.html \([\d.]+ s; any browser plays it\)\n$", printed)
    assert "<title>scara</title>" in (folder / "plan.html").read_text()


def test_play_takes_a_trajectory_file_of_openrave(folder):
    env = ravemj.load(folder / "env.xml")
    trajectory = ravemj.RaveCreateTrajectory(env, "")
    spec = env.GetRobots()[0].GetActiveConfigurationSpecification("linear")
    spec.AddDeltaTimeGroup()
    trajectory.Init(spec)
    trajectory.Insert(0, [0, 0, 0, np.pi, 0, 1.0])
    trajectory.SaveToFile(folder / "swing.xml", 0x8000)
    words = ("--camera", "camera.json", "--size", "160x120", "--fps", "2", "-o", "frames", "--duration", "2")
    said(ravemj_command(folder, "play", "env.xml", "--trajectory", "swing.xml", *words))
    assert [pose(picture) for picture in frames_of(folder / "frames")][::2] == ["hanging", "level", "upright"]


@pytest.mark.parametrize(
    "words",
    one_in(
        3,
        [
            "info workshop",
            "play workshop -o a.html",
            "render workshop -o a.png",
            "ik workshop --to 0,0,0",
            "plan workshop --to 0",
            "view workshop --web",
        ],
    ),
)
def test_a_robot_that_the_model_lacks_is_said_with_a_guess(folder, words):
    done = ravemj_command(folder, *words.split(), "--robot", "pandda")
    known = "the model has puma, panda, scara; did you mean panda?"
    _check_failure(done, 1, re.escape(f"ravemj: error: --robot: there is no robot 'pandda'; {known}"))
    done = ravemj_command(folder, *words.split(), "--robot", "table")
    _check_failure(done, 1, "ravemj: error: --robot: 'table' is a body, not a robot; the model has puma")


IK_OF_THE_SCARA = ("ik", "workshop", "--robot", "scara", "--to", "0.3,0.2", "--type", "TranslationXY2D", "--json")


def test_robots_are_chosen(folder):
    shown = json.loads(said(ravemj_command(folder, "info", "workshop", "--robot", "scara", "--json")))
    assert [body["name"] for body in shown["bodies"]] == ["scara"]
    found = said(ravemj_command(folder, *IK_OF_THE_SCARA))
    assert {len(solution["values"]) for solution in json.loads(found)} == {4}
    scara = ("--robot", "scara")
    for name, words in {"a": (*scara, "--q", "1,1,0,0"), "b": scara}.items():
        said(ravemj_command(folder, "render", "workshop", "-o", f"{name}.png", *SMALL, *words))
    pictures = [np.asarray(Image.open(folder / f"{name}.png")).astype(int) for name in "ab"]
    assert np.abs(pictures[0] - pictures[1]).max() > 50
    rows, columns = np.nonzero(pictures[1][..., 0] - pictures[1][..., 2] > 100)
    assert abs(rows.mean() / 72 - 0.5) < 0.15, "the robot is in the middle"
    assert abs(columns.mean() / 96 - 0.5) < 0.15


def test_doctor_says_what_draws_here(folder):
    printed = said(ravemj_command(folder, "doctor"))
    assert "display: none" in printed
    assert {"egl", "osmesa", "glfw", "ray"} <= {line.split()[0] for line in printed.splitlines() if line.strip()}
    assert mujoco.mj_versionString() in printed


@pytest.mark.parametrize("command", COMMANDS)
def test_help_has_examples(capsys, command):
    with pytest.raises(SystemExit) as end:
        main([command, "--help"])
    assert end.value.code == 0
    assert f"\nexamples:\n  ravemj {command}" in capsys.readouterr().out


def test_help_names_every_command(folder):
    printed = said(ravemj_command(folder, "--help"))
    assert all(re.search(rf"^    {command} +\w", printed, re.MULTILINE) for command in COMMANDS)
    assert re.fullmatch(r"ravemj \d+\.\d+\.\d+\n", said(ravemj_command(folder, "--version")))


@pytest.mark.parametrize("words", one_in(3, [["--help"], ["--version"], ["ik", "--help"]]))
def test_help_needs_no_mujoco(folder, words):
    (folder / "mujoco.py").write_text("raise ImportError('this mujoco cannot be imported')")
    code = f"import sys; sys.argv = {['ravemj', *words]}; from ravemj.cli import main; sys.exit(main())"
    assert "ravemj" in said(run(folder, "-c", code))
    assert "this mujoco" in run(folder, "-c", "import ravemj; ravemj.load").stderr


# What goes wrong

JOINT = """<Robot name="r"><KinBody><Body name="a"/>
<Body name="b"/>
<Joint name="j" type="hinge">
{}</Joint></KinBody></Robot>"""
URDF = '<robot name="r"><link name="a"/><link name="b"/><joint name="j" type="fixed">{}</joint></robot>'
BAD_MODELS = {
    "missing.xml": (None, "missing.xml: error: "),
    "words.txt": ("no XML at all\n", "words.txt:1: error: this is not XML"),
    "binary.xml": (b"\x7fELF\0\0", "binary.xml: error: this is a binary file, not XML"),
    "empty.xml": ("", "empty.xml: error: the file is empty"),
    "root.xml": ("<!-- -->\n<Foo/>\n", "root.xml:2: error: .*<Foo>"),
    "open.xml": ("<Robot>\n<KinBody>\n</Robot>\n", "open.xml:3: error: "),
    "body.xml": (JOINT.format("<Body>a</Body><Body>c</Body>"), r"body.xml:\d: error: .*'c'"),
    "include.xml": ('<Environment>\n<Robot file="gone.xml"/>\n</Environment>', r"include.xml:2: error: .*gone\.xml"),
    "mjcf.xml": ("<mujoco/>", "mjcf.xml:1: error: there is no body in it"),
    "urdf.xml": (URDF.format('<parent link="a"/>'), "urdf.xml:1: error: joint 'j' has no <child>"),
    "links.xml": (URDF.format(""), "links.xml:1: error: joint 'j' has no <parent>"),
    "latin.xml": (
        '<?xml version="1.0" encoding="utf-8"?>\n<Robot>\n<KinBody name="caf\xe9"/></Robot>'.encode("latin-1"),
        "latin.xml:3: error: the byte 0xE9 is not UTF-8.*encoding=",
    ),
    "inside.xml": (
        '<Environment>\n<Robot file="open.xml"/>\n</Environment>',
        r"open.xml:3: error: .*included from inside\.xml:2",
    ),
    "number.xml": (
        JOINT.format("<Body>a</Body><Body>b</Body>\n<axis>0 zero 1</axis>\n"),
        r"number.xml:5: error: <axis>.*0 zero 1",
    ),
    "extents.xml": (
        '<KinBody name="r"><Body name="a"><Geom type="box">\n<Extents>1 one 1</Extents></Geom></Body></KinBody>',
        r"extents.xml:2: error: .*1 one 1",
    ),
}


@pytest.mark.parametrize("name", BAD_MODELS)
def test_a_bad_model_is_one_line_with_file_and_line(folder, name):
    for file, (text, _) in BAD_MODELS.items():
        if text is not None:
            (folder / file).write_bytes(text if isinstance(text, bytes) else text.encode())
    (folder / "a.png").write_text("kept")
    before = listing(folder)
    done = ravemj_command(folder, "render", name, "-o", "a.png")
    _check_failure(done, 1, BAD_MODELS[name][1])
    assert listing(folder) == before


def _check_failure(done: subprocess.CompletedProcess[str], code: int, pattern: str) -> None:
    assert done.returncode == code, done.stderr
    assert done.stdout == ""
    assert "Traceback" not in done.stderr
    assert len(done.stderr.splitlines()) == 1, f"more than one line: {done.stderr}"
    assert re.match(pattern, done.stderr), done.stderr


BAD_FILES = {
    "scaled.json": "[[1,0,0,0],[0,2,0,0],[0,0,1,0],[0,0,0,1]]",
    "mirror.json": "[[1,0,0,0],[0,1,0,0],[0,0,-1,0],[0,0,0,1]]",
    "words.txt": "1 0 0 0\n0 1 0 0\n0 0 one 0\n0 0 0 1\n",
    "three.json": "[1, 2, 3]",
    "column.csv": "time,Joint0,Elbow\n0,0,0\n",
    "notime.csv": "Joint0,Joint1\n0,0\n",
    "nan.csv": "time,Joint0,Joint1\n0,0,0\n1,nan,0\n",
    "short.csv": "time,Joint0,Joint1\n0,0\n",
    "back.csv": "time,Joint0,Joint1\n1,0,0\n0,0,0\n",
    "mixed.csv": "time,puma_joint1,puma_joint2,panda_joint1\n0,0,0,0\n",
    "panda.csv": "time,panda_joint1\n0,0\n",
    "one.csv": "time,Joint0\n0,0\n",
    "junk.npz": "junk",
}
TO_A = "play env.xml -o a.mp4 "
BAD_WORDS = [
    ("dance env.xml", 2, "ravemj: error: .*'dance'"),
    ("infoo env.xml", 2, "ravemj: error: .*'infoo' is none of .* did you mean info"),
    ("info env.xml --jsn", 2, "ravemj info: error: .*--jsn.* did you mean --json.* see ravemj info --help"),
    ("help", 2, "ravemj: error: .*'help' is none of .* completion; see ravemj --help"),
    ("--vers", 2, "ravemj: error: unknown: --vers; did you mean --version"),
    ("alias --instal", 2, "ravemj alias: error: unknown: --instal; did you mean --install"),
    ("info env.xml --js", 2, "ravemj info: error: unknown: --js; did you mean --json"),
    ("convert env.xml --act=position", 2, "ravemj convert: error: unknown: --act=position; see"),
    ("run --py script.py --py", 2, "ravemj run: error: unknown: --py; did you mean --py2"),
    ("run", 2, "ravemj run: error: the following arguments are required: SCRIPT; see"),
    ("info pendlum", 1, "pendlum: error: there is no such file; .* did you mean pendulum, which comes with ravemj"),
    ("convert env.xml --base foxed", 2, "ravemj convert: error: .*'foxed' is none of fixed, free, openrave"),
    ("play", 2, "ravemj play: error: .*MODEL"),
    ("render env.xml", 2, "ravemj render: error: .*-o"),
    ("alias", 2, "ravemj alias: error: .*--install"),
    (TO_A + "--to nan,0", 2, "ravemj play: error: .*'nan' is not a finite number"),
    (TO_A + "--to up,0", 2, "ravemj play: error: .*'up' is not a finite number"),
    (TO_A + "--to -inf,0", 2, "ravemj play: error: .*'-inf' is not a finite number"),
    (TO_A + "--to 1", 1, "ravemj: error: --to: found 1, expected 2: one for each DOF of 'Pendulum'"),
    (TO_A + "--to 1,0 --trajectory swing.csv", 2, "ravemj play: error: .*--trajectory"),
    (TO_A + "--size 0x9", 2, "ravemj play: error: .*640x480"),
    (TO_A + "--size 100000x100000", 2, "ravemj play: error: .*16384x16384"),
    (TO_A + "--background rde", 2, "ravemj play: error: .*'rde' is not a colour such as red"),
    (TO_A + "--fps 0", 2, "ravemj play: error: .*--fps"),
    (TO_A + "--duration 1e12", 1, "ravemj: error: .*3e\\+13 frames, and at most 1,000,000"),
    (TO_A + "--duration -1", 2, "ravemj play: error: .*--duration"),
    (TO_A + "--background 1,2,3", 2, "ravemj play: error: .*'1,2,3' is not a colour"),
    (TO_A + "--camera scaled.json", 1, "scaled.json: error: .*rotation"),
    (TO_A + "--camera mirror.json", 1, "mirror.json: error: .*reflection"),
    (TO_A + "--camera words.txt", 1, "words.txt:3: error: .*'one'"),
    (TO_A + "--camera three.json", 1, "three.json: error: "),
    (TO_A + "--camera gone.json", 1, "gone.json: error: "),
    (TO_A + "--trajectory column.csv", 1, "column.csv:1: error: .*'Elbow'.*Joint0, Joint1"),
    (TO_A.replace("env.xml", "workshop") + "--trajectory mixed.csv", 1, "mixed.csv:1: error: .*'panda_joint1'.*'puma'"),
    (
        TO_A.replace("env.xml", "workshop") + "--robot puma --trajectory panda.csv",
        1,
        "panda.csv:1: error: column 2 is named 'panda_joint1', which is a joint of 'panda', not of 'puma'; a table",
    ),
    (TO_A + "--trajectory notime.csv", 1, "notime.csv:1: error: .*'time'"),
    (TO_A + "--trajectory nan.csv", 1, "nan.csv:3: error: "),
    (TO_A + "--trajectory short.csv", 1, "short.csv:2: error: "),
    (TO_A + "--trajectory back.csv", 1, "back.csv:3: error: "),
    (TO_A + "--trajectory one.csv --duration 2", 1, ".*error: .*one row"),
    (TO_A + "--trajectory junk.npz", 1, "junk.npz: error: "),
    (TO_A + "--trajectory gone.csv", 1, "gone.csv: error: "),
    (TO_A + "--trajectory env.xml", 1, "env.xml: error: "),
    ("play env.xml -o gone/a.mp4", 1, "ravemj: error: .*gone"),
    ("play env.xml -o env.xml/a.mp4", 1, "ravemj: error: .*env.xml"),
    ("play env.xml -o .", 1, "ravemj: error: "),
    ("play env.xml -o a.gif --fps 100", 1, "ravemj: error: .*50 frames"),
    ("play env.xml -o a.ogg", 1, "ravemj: error: .*'.ogg' is none of .html, .yaml, .*.mp4"),
    ("plan puma560 --to 0,0,0,0,0,0 -o a.ogg", 1, "ravemj: error: .*'.ogg' is none of .csv, .npz, .png"),
    ("render env.xml -o a.bmp", 1, "ravemj: error: .*a.bmp.*png"),
    ("render env.xml -o a", 1, "ravemj: error: .* no suffix.*png"),
    ("render env.xml -o gone/a.png", 1, "ravemj: error: .*gone"),
    ("render env.xml -o a.png --q 1,2,3", 1, "ravemj: error: --q: found 3, expected 2: .*'Pendulum': Joint0, Joint1$"),
    ("convert env.xml -o gone/a.xml", 1, "ravemj: error: .*gone"),
    (
        "convert env.xml -o a.png",
        1,
        "ravemj: error: cannot write a.png: '.png' is none of .dae, .zae, .urdf, .json, .xml",
    ),
    ("plan env.xml --to 1,1 -o a.xyz", 1, "ravemj: error: cannot write .*'.xyz' is none of .csv, .npz, .png, .*.mp4"),
    ("play env.xml -o a.xyz", 1, "ravemj: error: cannot write a.xyz: '.xyz' is none of .html, .yaml, .*.mp4"),
    ("convert env.xml -o .", 1, "ravemj: error: "),
    ("ik puma560 --to 1,2", 1, "ravemj: error: --to: found 2, expected x,y,z,qw,qx,qy,qz"),
    ("ik puma560 --to 0,0,1,0,0,0,0", 1, "ravemj: error: --to: the quaternion"),
    ("ik env.xml --to 0,0,1", 1, "ravemj: error: robot 'Pendulum' has no manipulator"),
    ("ik puma560 --manip leg --to 0,0,1", 1, "ravemj: error: --manip: there is no manipulator 'leg'; .*PUMA560' has"),
    ("ik puma560 --to 0,0,1 --from gone.json", 1, "gone.json: error: "),
    ("ik puma560 --to 0,0,1 --from three.json", 1, "three.json: error: found 3 values, expected 6 joint values"),
    ("ik workshop --manip panda_am --to 0,0,1", 1, ".*has puma_arm, panda_arm, scara_arm; did you mean panda_arm"),
    ("ik workshop --robot scara --manip panda_arm --to 0,0,1", 1, ".*'panda_arm'; robot 'scara' has scara_arm"),
    ("ik puma560", 2, "ravemj ik: error: .*--to"),
    ("plan puma560", 2, "ravemj plan: error: .*--to"),
    ("plan puma560 --to 0,0,0,0,0,0 --pose 0,0,0", 2, "ravemj plan: error: .*--pose"),
    ("plan puma560 --to 0,0,0,0,0,0 --seed -1", 2, "ravemj plan: error: .*'-1' is not a whole number"),
    ("plan puma560 --to 0,0,0,0,0,0 --time-limit 0", 2, "ravemj plan: error: .*--time-limit"),
    (
        "plan puma560 --to 1,2",
        1,
        "ravemj: error: --to: found 2, expected 6: one for each joint of 'arm': joint1, joint2",
    ),
    ("plan puma560 --to 0,0,0,0,0,0 -o gone/a.csv", 1, "ravemj: error: .*gone"),
    ("plan puma560 --to 9,0,0,0,0,0", 1, r"ravemj: error: no motion: goal: joint 'joint1' is 9, outside its limits \["),
    ("plan puma560 --to -2.4,-0.7,-2.9,-1.3,1,-3.2", 1, ".*no motion: goal: it collides: link 'base' .*'link4' of"),
    ("plan puma560 --pose 9,9,9", 1, "ravemj: error: no motion: no joint values take 'arm' of 'PUMA560' there"),
    ("plan workshop --manip panda_arm --pose 0.2,0.2,0.35,0,1,0,0", 1, ".*no motion: all .* nearest: .* hits table"),
    ("plan puma560 --pose 1,2", 1, "ravemj: error: --pose: found 2, expected"),
    ("plan puma560 --pose 0,0,1,0,0,0,0", 1, "ravemj: error: --pose: the quaternion"),
    ("plan env.xml --pose 0,0,1", 1, "ravemj: error: robot 'Pendulum' has no manipulator"),
    ("plan puma560 --manip leg --to 0,0,1", 1, "ravemj: error: --manip: there is no manipulator 'leg'; .*PUMA560' has"),
    ("plan puma560 --near 0,0,1 --upright 400", 2, ".*argument --upright: 400 is more than 180 degrees"),
    ("plan puma560 --near 0,0,1 --upright 180.5", 2, ".*argument --upright: 180.5 is more than 180 degrees"),
    ("plan puma560 --near 0,0,1 --upright 0", 2, ".*argument --upright: 0 is not above 0"),
    ("plan puma560 --near 0,0,1 --within 1e300", 2, ".*argument --within: '1e300' is too large: .* 1e\\+100"),
    ("plan puma560 --near 1e300,0,1", 2, ".*argument --near: '1e300' is too large"),
    ("plan puma560 --pose 0,0,1,-1e300,0,0,0", 2, ".*argument --pose: '-1e300' is too large"),
    ("plan puma560 --to 0,0,0,0,0,0 --from gone.json", 1, "gone.json: error: "),
    ("run gone.py", 1, "gone.py: error: "),
    ("run .", 1, r"\.: error: this is a folder"),
    ("run a.png", 1, "a.png: error: this is a binary file, not a Python script"),
    ("run env.xml", 1, "env.xml: error: this is a model, not a Python script; open it with ravemj shell env.xml"),
]


@pytest.mark.parametrize(("words", "code", "pattern"), BAD_WORDS, ids=[words for words, _, _ in BAD_WORDS])
def test_a_bad_argument_is_one_line_and_touches_nothing(folder, monkeypatch, capsys, words, code, pattern):
    for file, text in BAD_FILES.items():
        (folder / file).write_text(text)
    for file in ("a.mp4", "a.gif", "a.png"):
        (folder / file).write_text("kept\0")
    before = listing(folder)
    if words.startswith(("run", "alias", "play")) or len(words) < 6:
        done = ravemj_command(folder, *words.split())
    else:  # in this process, which is quick
        monkeypatch.chdir(folder)
        try:
            ended = main(words.split())
        except SystemExit as end:
            ended = end.code
        done = subprocess.CompletedProcess(words, ended, *capsys.readouterr())
    _check_failure(done, code, pattern)
    assert listing(folder) == before


@pytest.mark.parametrize("words", ["info", "check", "diff env.xml", "render -o a.png", "run", "play env.xml --camera"])
def test_an_empty_name_is_said(folder, monkeypatch, capsys, words):
    monkeypatch.chdir(folder)
    with pytest.raises(SystemExit) as end:
        main([*words.split(), ""])
    assert end.value.code == 2
    assert "the name is empty; see ravemj" in capsys.readouterr().err


def test_no_words_at_all_get_the_help(folder):
    done = ravemj_command(folder)
    assert (done.returncode, done.stdout) == (2, "")
    assert all(f"    {command} " in done.stderr for command in COMMANDS)


@pytest.mark.parametrize(
    ("colour", "pixel"), [("red", [255, 0, 0]), pytest.param("#00ff80", [0, 255, 128], marks=pytest.mark.stress)]
)
def test_the_background_may_be_a_colour_of_css(folder, colour, pixel):
    said(ravemj_command(folder, "render", "env.xml", "-o", "b.png", "--size", "32x24", "--background", colour))
    assert list(Image.open(folder / "b.png").getpixel((0, 0))) == pixel


def test_an_unwritable_folder_is_said_before_anything_is_drawn(folder):
    target = folder / "locked"
    target.mkdir()
    target.chmod(0o555)
    where = "/proc" if os.access(target, os.W_OK) else "locked"  # root may write anywhere but in /proc
    for words in (("play", "env.xml", "-o", f"{where}/a.mp4"), ("convert", "env.xml", "-o", f"{where}/a.xml")):
        _check_failure(ravemj_command(folder, *words), 1, f"ravemj: error: cannot write {where}/a")
    target.chmod(0o755)
    assert not list(target.iterdir())


def test_a_model_is_not_overwritten_by_its_translation(folder):
    before = listing(folder)
    for target in ("env.xml", "./double-pendulum.xml"):
        _check_failure(ravemj_command(folder, "convert", "env.xml", "-o", target), 1, "ravemj: error: ")
        assert listing(folder) == before


@pytest.mark.stress
@pytest.mark.parametrize(
    ("words", "unbuffered"),
    [
        ("convert env.xml", ""),
        pytest.param("convert env.xml", "1", marks=pytest.mark.stress),
        pytest.param("info env.xml", "", marks=pytest.mark.stress),
    ],
)
def test_a_full_disk_under_standard_output_is_one_line(folder, words, unbuffered):
    if not os.path.exists("/dev/full"):
        pytest.skip("there is no /dev/full here")
    command = f"{sys.executable} -m ravemj {words} > /dev/full"
    variables = environment(folder, PYTHONUNBUFFERED=unbuffered)
    done = subprocess.run(command, shell=True, cwd=folder, env=variables, capture_output=True, text=True, check=False)
    _check_failure(done, 1, "ravemj: error: .*[Nn]o space left")


@pytest.mark.stress
@pytest.mark.parametrize("words", one_in(2, ["info env.xml", "convert env.xml"]))
def test_a_reader_that_goes_away_is_no_error_to_talk_about(folder, words):
    command = f"{sys.executable} -m ravemj {words} | true"
    done = subprocess.run(
        command, shell=True, cwd=folder, env=environment(folder), capture_output=True, text=True, check=False
    )
    assert (done.stdout, done.stderr) == ("", "")


def test_warnings_of_a_model_are_said_and_strict_makes_them_errors(folder):
    text = (folder / "double-pendulum.xml").read_text().replace("<Body name=", "<Nonsense/><Body name=", 1)
    (folder / "odd.xml").write_text(text)
    line = text[: text.index("<Nonsense/>")].count("\n") + 1
    done = ravemj_command(folder, "info", "odd.xml")
    assert done.returncode == 0
    assert re.fullmatch(rf"odd.xml:{line}: warning\[[\w-]+\]: .*Nonsense.*\n", done.stderr, re.IGNORECASE)
    _check_failure(ravemj_command(folder, "info", "odd.xml", "--strict"), 1, f"odd.xml:{line}: error: ")


@pytest.mark.parametrize(
    "words",
    one_in(
        6,
        [
            "play env.xml -o a.mp4 --size 96x72 --fps 3",
            "render env.xml -o a.png --size 96x72",
            "convert env.xml",
            "check env.xml",
            "info env.xml",
            "run script.py",
        ],
    ),
)
def test_commands_import_what_they_need_and_raise_no_warnings_of_python(folder, words):
    """In processes of their own, which most other tests do not start; ``alias``, ``shell`` and ``view`` do."""
    (folder / "script.py").write_text("import openravepy\nprint(openravepy.Environment())\n")
    assert said(ravemj_command(folder, *words.split(), PYTHONWARNINGS="error", PYTHONDEVMODE="1"))


def test_plain_removes_what_steers_terminals():
    assert plain("\x1b[?25l\x1b[32mgreen\x1b[0m\r\n") == "green\n"


COMPLETE = """eval "$("$PYTHON" -m ravemj completion bash)"
ravemj() { "$PYTHON" -m ravemj "$@"; }
for COMP_LINE in "$@"; do
    COMP_POINT=${#COMP_LINE} COMP_WORDS=($COMP_LINE) COMP_CWORD=$((${#COMP_WORDS[@]} - 1)) COMPREPLY=()
    _python_argcomplete ravemj
    echo "${COMPREPLY[@]}"
done
"""


COMPLETIONS = [
    {
        "play pu": ["puma560", "puma.dae"],
        "render env.xml --back": ["--background"],
        "ik workshop --manip p": ["puma_arm", "panda_arm"],
    },
    {
        "pl": ["play", "plan"],
        "completion f": ["fish"],
        **{
            f"{command} workshop --robot p": ["puma", "panda"]
            for command in ("play", "render", "info", "ik", "plan", "view")
        },
        "ik workshop --robot scara --manip s": ["scara_arm"],
        "ik gone --manip p": [],
    },
]


@pytest.mark.skipif(shutil.which("bash") is None, reason="there is no bash")
@pytest.mark.parametrize("completions", one_in(2, COMPLETIONS))
def test_bash_completes_commands_options_and_models(folder, completions):
    (folder / "puma.dae").touch()
    (folder / "puma.txt").touch()
    command = ["bash", "-c", COMPLETE, "bash", *(f"ravemj {line}" for line in completions)]
    done = subprocess.run(
        command, cwd=folder, env={**os.environ, "PYTHON": sys.executable}, capture_output=True, text=True, check=True
    )
    assert [line.split() for line in done.stdout.splitlines()] == [*completions.values()]


@pytest.mark.parametrize("shell", ["zsh", "fish"])
def test_other_shells_get_their_own_words(folder, shell):
    printed = said(ravemj_command(folder, "completion", shell))
    assert "ravemj" in printed
    if shutil.which(shell):
        subprocess.run([shell, "-n"], input=printed, text=True, check=True)
