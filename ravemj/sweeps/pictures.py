"""Pictures of a robot in many configurations: colours, depths, link labels, and poses of camera and links."""

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ravemj.core.transforms import Floats, inverse
from ravemj.errors import ArgumentError
from ravemj.graphics.rendering import Camera
from ravemj.graphics.simulation_renderer import Format
from ravemj.rave import Environment, Robot
from ravemj.sweeps.shards import Arrays, joined

Prepare = Callable[[Environment, Floats, np.random.Generator], ArrayLike | None]
"""User's function that changes an environment before a picture; it may return ``T_world_camera``, shape (4, 4)."""

OUTPUTS = ("rgb", "depth", "links")
OPTIONS = frozenset({"camera", "size", "outputs", "prepare"})

_SIZE = 640, 480
_MILLIMETRES = 1000.0
_FARTHEST = np.iinfo(np.uint16).max  # mm


def pictures(
    env: Environment, robot: Robot, items: Floats, random: np.random.Generator, options: Mapping[str, Any]
) -> Arrays:
    """Render a robot at joint values, from a camera that is fixed unless the user's function changes it.

    Args:
        env: The environment.
        robot: The robot.
        items: Joint values [rad or m], shape (N, dof).
        random: Random generator for the user's function.
        options: ``camera``: ``T_world_camera``; ``size``: width and height; ``outputs``: some of ``OUTPUTS``;
            ``prepare``: a ``Prepare``.

    Returns:
        ``rgb`` (N, height, width, 3); ``depth`` [mm] and ``links`` (N, height, width), where ``links`` are indices in
        ``link_names`` counted from 1, both 0 for the background; ``T_world_camera`` (N, 4, 4); the camera matrix ``K``
        (N, 3, 3); ``T_camera_link`` (N, links, 4, 4); and ``link_names`` (N, links).
    """
    width, height = _size(options)
    outputs = _outputs(options)
    chosen, prepare = options.get("camera"), options.get("prepare")
    usual = env.default_camera(width / height) if chosen is None else Camera.from_matrix(chosen)
    return joined(
        [
            _picture(env, robot, row, random, usual, Format(width, height, shadows=True), outputs, prepare)
            for row in items
        ]
    )


def _picture(  # noqa: PLR0913, PLR0917 - all that decides a picture
    env: Environment,
    robot: Robot,
    values: Floats,
    random: np.random.Generator,
    camera: Camera,
    form: Format,
    outputs: tuple[str, ...],
    prepare: Prepare | None,
) -> Arrays:
    robot.SetDOFValues(values, checklimits=0)
    placed = None if prepare is None else prepare(env, values, random)
    if placed is not None:
        camera = Camera.from_matrix(placed, camera.fovy)
    arrays: dict[str, NDArray[Any]] = {}
    if "rgb" in outputs:
        arrays["rgb"] = env.renderer.render(camera, env.look(), form)
    if "depth" in outputs:
        depth = np.nan_to_num(env.renderer.depth(camera, form) * _MILLIMETRES, posinf=0)
        arrays["depth"] = np.where(depth > _FARTHEST, 0, np.rint(depth)).astype(np.uint16)
    poses = [body.GetLinkTransformations() for body in env.GetBodies()]
    if "links" in outputs:
        arrays["links"] = _numbers(env, env.renderer.segment(camera, form))
    pinhole = camera.pinhole(form.width, form.height)
    arrays["T_world_camera"] = camera.T_world_camera
    arrays["K"] = np.array([[pinhole.fx, 0, pinhole.cx], [0, pinhole.fy, pinhole.cy], [0, 0, 1]])
    arrays["T_camera_link"] = inverse(camera.T_world_camera) @ np.concatenate(poses)
    links = [f"{body.GetName()}/{link.GetName()}" for body in env.GetBodies() for link in body.GetLinks()]
    arrays["link_names"] = np.array(links)
    return {name: array[None] for name, array in arrays.items()}


def _numbers(env: Environment, geoms: NDArray[np.int32]) -> NDArray[np.uint16]:
    """Return the number of the link at each pixel: from 1 in the order of bodies and links, 0 if no link is visible."""
    labels = env.simulation.collisions().labels(geoms)
    bodies = env.GetBodies()
    first = np.zeros(max(body.GetEnvironmentBodyIndex() for body in bodies) + 1, dtype=int)
    count = 1
    for body in bodies:
        first[body.GetEnvironmentBodyIndex()] = count
        count += len(body.GetLinks())
    return np.where(labels[..., 1] < 0, 0, first[labels[..., 0]] + labels[..., 1]).astype(np.uint16)


def _size(options: Mapping[str, Any]) -> tuple[int, int]:
    size = options.get("size", _SIZE)
    try:
        width, height = (int(side) for side in size)
    except (TypeError, ValueError):
        width = height = 0
    if min(width, height) < 1:
        raise ArgumentError(f"sweep: options: size is {size!r}; expected width and height in pixels")
    return width, height


def _outputs(options: Mapping[str, Any]) -> tuple[str, ...]:
    outputs = tuple(options.get("outputs", OUTPUTS))
    if not outputs or set(outputs) - set(OUTPUTS):
        raise ArgumentError(f"sweep: options: outputs are {', '.join(outputs)}; expected some of {', '.join(OUTPUTS)}")
    return outputs


def check_options(options: Mapping[str, Any]) -> None:
    """Validate the options of a ``pictures`` job.

    Raises:
        ArgumentError: an option is unknown or invalid.
    """
    width, height = _size(options)
    _outputs(options)
    if options.get("camera") is not None:
        Camera.from_matrix(options["camera"]).pinhole(width, height)
    prepare = options.get("prepare")
    if prepare is not None and not callable(prepare):
        raise ArgumentError(f"sweep: options: prepare is {prepare!r}; expected a function of env, values and random")
