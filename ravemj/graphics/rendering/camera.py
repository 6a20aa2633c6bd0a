"""Cameras in OpenRAVE's convention, and their pinhole projection.

The camera frame has +z into the scene, +x to the right of the image and +y down the image, so the up
direction of the picture is -y. OpenRAVE's ``SetCamera`` and ``GetCameraTransform``, its camera tags and its
camera sensors all use this frame. MuJoCo's and OpenGL's cameras look along -z with +y up instead; only the
renderers convert.
"""

import math
from dataclasses import dataclass, replace
from typing import NamedTuple

import mujoco
import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.caching import cached_property
from ravemj.core.transforms import Floats, Ints, normalize, rows_from_wxyz
from ravemj.errors import ArgumentError
from ravemj.graphics.rendering.style import drawn_geoms
from ravemj.model.look import first_rotation, rotation_along

DEFAULT_FOVY = math.radians(45)
"""Vertical field of view of OpenRAVE's viewers [rad]."""

RIGIDITY_TOLERANCE = 5e-3
"""Tolerance of R^T R - I: it accepts rotation matrices printed with three digits, but not scaled ones."""

_SHAPES = "a 4x4 matrix, a 3x4 matrix or a pose [w, x, y, z, tx, ty, tz]"


class Pinhole(NamedTuple):
    """Pinhole parameters; pixel coordinates are continuous, with (0, 0) in the top left corner of the image."""

    fx: float  # focal length along the columns [pixels]
    fy: float  # focal length along the rows [pixels]
    cx: float  # column of the principal point [pixels]
    cy: float  # row of the principal point [pixels]


@dataclass(eq=False)
class CameraIntrinsics:
    """Camera matrix, as returned to OpenRAVE's scripts.

    Attributes:
        K: Camera matrix [pixels], shape (3, 3).
    """

    K: Floats


@dataclass(frozen=True, eq=False)
class Camera:
    """A pinhole camera; by default its pixels are square and the principal point is in the middle of the image.

    Attributes:
        T_world_camera: Pose of the camera in the world, (4, 4), read-only. Columns: image right, image down,
            viewing direction, position of the eye [m]. The numbers are stored exactly as given.
        fovy: Vertical field of view [rad], between 0 and pi.
        calibration: Focal lengths and principal point for pictures of one size, in place of the field of view.

    Raises:
        ArgumentError: the matrix is not a rigid transform, or the field of view is out of range.
    """

    T_world_camera: Floats
    fovy: float = DEFAULT_FOVY
    calibration: Pinhole | None = None

    def __post_init__(self) -> None:
        matrix = _numbers(self.T_world_camera) + 0.0  # a copy, and -0. becomes 0.
        _check_rigid(matrix)
        matrix.flags.writeable = False
        object.__setattr__(self, "T_world_camera", matrix)
        if not 0 < self.fovy < math.pi:
            raise ArgumentError(f"camera: the vertical field of view is {self.fovy:g} rad, expected between 0 and pi")

    @classmethod
    def from_matrix(cls, matrix: ArrayLike, fovy: float = DEFAULT_FOVY) -> "Camera":
        """Create a camera from a matrix or a pose.

        Args:
            matrix: T_world_camera as 4x4 or 3x4 (nested lists or array), or as OpenRAVE's pose
                [w, x, y, z, tx, ty, tz] with a unit quaternion.
            fovy: Vertical field of view [rad].

        Raises:
            ArgumentError: ``matrix`` has another shape, is not finite, or is not a rigid transform.
        """
        numbers = _numbers(matrix)
        if numbers.shape == (3, 4):
            numbers = np.vstack([numbers, [0.0, 0.0, 0.0, 1.0]])
        elif numbers.shape == (7,):
            numbers = _matrix_from_pose(numbers)
        return cls(numbers, fovy)

    @property
    def position(self) -> Floats:
        """Eye point in the world, (3,) [m]."""
        return self.T_world_camera[:3, 3].copy()

    @cached_property
    def rotation(self) -> Floats:
        """``R_world_camera``, shape (3, 3): the rotation nearest to the given matrix, used by all projections."""
        u, _, vt = np.linalg.svd(self.T_world_camera[:3, :3])
        rotation: Floats = u @ vt
        rotation.flags.writeable = False
        return rotation

    def pinhole(self, width: int, height: int) -> Pinhole:
        """Return focal lengths and principal point for an image of a size [pixels]."""
        focal = 0.5 * height / math.tan(0.5 * self.fovy)
        return self.calibration or Pinhole(focal, focal, 0.5 * width, 0.5 * height)

    def enlarged(self, factor: float) -> "Camera":
        """Return the camera for pictures whose width and height are multiplied by a factor."""
        if self.calibration is None:
            return self
        return replace(self, calibration=Pinhole(*(factor * part for part in self.calibration)))

    def project(self, points: ArrayLike, width: int, height: int) -> tuple[Floats, Floats]:
        """Project points in the world, shape (N, 3) [m], into an image of a size [pixels].

        Returns:
            Continuous pixel coordinates, shape (N, 2), column and row: (0, 0) is the top left corner of the image and
            pixel i covers [i, i + 1); NaN for points behind the camera. And depths along the viewing direction [m],
            shape (N,).
        """
        fx, fy, cx, cy = self.pinhole(width, height)
        camera_points = (np.asarray(points, dtype=np.float64).reshape(-1, 3) - self.position) @ self.rotation
        depth = camera_points[:, 2]
        in_front = np.where(depth > 0, depth, np.nan)
        return camera_points[:, :2] * [fx, fy] / in_front[:, None] + [cx, cy], depth

    def ray_parts(self, width: int, height: int) -> tuple[Floats, Floats]:
        """Return the rays through pixel centres in the world, as the sum of a term per column and one per row.

        The terms have shapes (1, width, 3) and (height, 1, 3). The rays are not unit vectors: their component along the
        viewing direction is 1, so that ``position + depth * ray`` is the point at that depth.
        """
        fx, fy, cx, cy = self.pinhole(width, height)
        right, down, forward = self.rotation.T
        columns = (np.arange(width) + 0.5 - cx) / fx
        rows = (np.arange(height) + 0.5 - cy) / fy
        return columns[None, :, None] * right, rows[:, None, None] * down + forward


def view_from_above(center: ArrayLike, radius: float) -> Camera:
    """Return the initial view of OpenRAVE's window, straight down; arguments as for ``three_quarter_view``."""
    return _looking_at(center, radius, rotation_along((0.0, 0.0, -1.0), (0.0, 1.0, 0.0)))


def three_quarter_view(center: ArrayLike, radius: float, aspect: float = 1.0) -> Camera:
    """Return the default view of still pictures: from the front left corner and above, world +z up.

    Args:
        center: Centre of the bounding sphere to show, in the world [m], shape (3,).
        radius: Radius of the sphere [m]; it just fits into the picture's height (45 degrees) and width.
        aspect: Width of the picture divided by its height.
    """
    return _looking_at(center, radius / min(1.0, aspect), first_rotation())


def bounding_sphere(model: mujoco.MjModel, data: mujoco.MjData) -> tuple[Floats, float]:
    """Return a bounding sphere of the drawn geoms, without planes.

    The poses of the geoms must be computed (``mj_kinematics`` or ``mj_forward``).

    Returns:
        Centre in the world [m], shape (3,), and radius [m]; the unit sphere at the origin if nothing is drawn.
    """
    shown = drawn_geoms(model) & (model.geom_type != mujoco.mjtGeom.mjGEOM_PLANE)
    if not shown.any():
        return np.zeros(3), 1.0
    position = data.geom_xpos[shown]
    corners = geom_corners(model, data, np.flatnonzero(shown))
    center = 0.5 * (corners.min(axis=(0, 1)) + corners.max(axis=(0, 1)))
    by_corners = np.linalg.norm(corners - center, axis=2).max(axis=1)
    by_spheres = np.linalg.norm(position - center, axis=1) + model.geom_rbound[shown]
    return center, float(np.minimum(by_corners, by_spheres).max())


def geom_corners(model: mujoco.MjModel, data: mujoco.MjData, geoms: Ints) -> Floats:
    """Return the corners of the bounding boxes of geoms, in the world [m], shape (N, 8, 3)."""
    signs = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], dtype=np.float64)
    boxes = model.geom_aabb[geoms]
    corners = boxes[:, None, :3] + signs * boxes[:, None, 3:]
    turned: Floats = np.einsum("gij,gcj->gci", data.geom_xmat[geoms].reshape(-1, 3, 3), corners)
    return turned + data.geom_xpos[geoms][:, None]


def aim(scene: mujoco.MjvScene, camera: Camera, size: tuple[int, int], depths: tuple[float, float]) -> None:
    """Set the camera of a scene; its type ``mjCAMERA_USER`` makes ``mjv_updateScene`` preserve it.

    ``size`` is width and height of the picture [pixels], ``depths`` the near and far clipping depths [m].
    """
    near, far = depths
    right_down_forward = camera.rotation
    fx, fy, cx, cy = camera.pinhole(*size)
    left, right = -cx / fx * near, (size[0] - cx) / fx * near
    for eye in scene.camera:  # two, for stereo; a mono picture takes their mean
        eye.pos = camera.position
        eye.forward = right_down_forward[:, 2]
        eye.up = -right_down_forward[:, 1]
        eye.frustum_near, eye.frustum_far = near, far
        eye.frustum_top, eye.frustum_bottom = cy / fy * near, (cy - size[1]) / fy * near
        eye.frustum_center, eye.frustum_width = (left + right) / 2, (right - left) / 2  # half the width
        eye.orthographic = 0


def _looking_at(center: ArrayLike, radius: float, rotation: Floats) -> Camera:
    distance = (radius if radius > 0 else 1.0) / math.sin(0.5 * DEFAULT_FOVY)
    T_world_camera = np.eye(4)
    T_world_camera[:3, :3] = rotation
    T_world_camera[:3, 3] = np.asarray(center, dtype=np.float64) - distance * rotation[:, 2]
    return Camera(T_world_camera)


def _numbers(matrix: ArrayLike) -> Floats:
    try:
        return np.array(matrix, dtype=np.float64)
    except (TypeError, ValueError):
        raise ArgumentError(f"camera: expected {_SHAPES}, found something that is not an array of numbers") from None


def _matrix_from_pose(pose: Floats) -> Floats:
    w, x, y, z = (float(part) for part in pose[:4])
    length = math.sqrt(w * w + x * x + y * y + z * z)
    if not abs(length - 1) <= RIGIDITY_TOLERANCE:
        raise ArgumentError(f"camera: the pose starts with a quaternion of length {length:g}, expected 1")
    matrix = np.eye(4)
    matrix[:3, :3] = rows_from_wxyz(normalize((w, x, y, z)))
    matrix[:3, 3] = pose[4:]
    return matrix


def _check_rigid(matrix: Floats) -> None:
    if matrix.shape != (4, 4):
        raise ArgumentError(f"camera: expected {_SHAPES}, found an array of shape {matrix.shape}")
    if not np.isfinite(matrix).all():
        raise ArgumentError(f"camera: expected finite numbers, found {matrix[~np.isfinite(matrix)][0]}")
    if not np.array_equal(matrix[3], [0, 0, 0, 1]):
        row = " ".join(f"{number:g}" for number in matrix[3])
        raise ArgumentError(f"camera: expected 0 0 0 1 as the last row, found {row}")
    rotation = matrix[:3, :3]
    error = float(np.abs(rotation.T @ rotation - np.eye(3)).max())
    if error > RIGIDITY_TOLERANCE:
        limit = f"at most {RIGIDITY_TOLERANCE:g}"
        raise ArgumentError(f"camera: the 3x3 part is not a rotation: R^T R is off by {error:.3g}, expected {limit}")
    if np.linalg.det(rotation) < 0:
        raise ArgumentError("camera: the 3x3 part is a reflection: determinant -1, expected a rotation with +1")
