"""Methods that make a body from shapes or from descriptions."""

# The fields of infos have the names that OpenRAVE gives them.
# pyright: reportPrivateUsage=false

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arguments import checked_kind
from ravemj.core.arrays import checked_numbers, checked_transform
from ravemj.core.transforms import Floats, Pose
from ravemj.errors import ErrorCode, RavemjError
from ravemj.model.scene import Geometry, KinBody
from ravemj.model.scene import TriMesh as Triangles
from ravemj.model.shape_bodies import body_of_geometries, box_geometries, shape_geometry, sphere_geometries
from ravemj.rave.body.structure import Structure
from ravemj.rave.enums import UpdateFromInfoResult
from ravemj.rave.infos import ExtractInfoOptions, GeometryInfo, GrabbedInfo, JointInfo, KinBodyInfo, LinkInfo, body_of
from ravemj.rave.infos.link import geometries_of
from ravemj.rave.trimesh import TriMesh, checked_mesh


class Building(Structure):
    """Methods that replace the whole body, while it is in no environment."""

    _internal = ("extracted",)

    def InitFromBoxes(self, boxes: ArrayLike, draw: bool = True, uri: str = "") -> bool:
        """Replace the body by a single static link of boxes.

        Args:
            boxes: One row for each box: centre x y z and half extents x y z [m], shape (n, 6). For rotated boxes:
                centre, the unit vectors along the x, y and z axes of the box, and half extents, shape (n, 15).
            draw: Whether the boxes are drawn. They collide either way.
            uri: The result of later calls of ``GetURI``.

        Returns:
            True.

        Raises:
            openrave_exception: the body is in an environment, or the rows have another length.
            TypeError: the argument is not a two-dimensional array.

        Example:
            >>> body = ravemj.RaveCreateKinBody(env, "")
            >>> body.InitFromBoxes([[0, 0, 0.1, 0.5, 0.5, 0.1]])
            True
            >>> body.SetName("table")
            >>> env.Add(body)
        """
        return self._become(box_geometries(_rows(boxes, (6, 15), "InitFromBoxes: boxes"), visible=bool(draw)), uri)

    def InitFromSpheres(self, spherex: ArrayLike, draw: bool = True, uri: str = "") -> bool:
        """Replace the body by a single static link of spheres.

        Args:
            spherex: One row for each sphere: centre x y z and radius [m], shape (n, 4); the spelling is OpenRAVE's.
            draw: Whether the spheres are drawn. They collide either way.
            uri: The result of later calls of ``GetURI``.

        Returns:
            True.

        Raises:
            openrave_exception: the body is in an environment, or the rows have another length.
            TypeError: the argument is not a two-dimensional array.
        """
        return self._become(
            sphere_geometries(_rows(spherex, (4,), "InitFromSpheres: spherex"), visible=bool(draw)), uri
        )

    def InitFromTrimesh(self, trimesh: TriMesh, draw: bool = True, uri: str = "") -> bool:
        """Replace the body by a single static link with the triangles of a mesh.

        Args:
            trimesh: The triangles.
            draw: Whether the triangles are drawn. They collide either way.
            uri: The result of later calls of ``GetURI``.

        Returns:
            True.

        Raises:
            openrave_exception: the body is in an environment, or a triangle has a vertex index out of range.
        """
        mesh = checked_mesh(trimesh, "InitFromTrimesh: trimesh")
        return self._become([shape_geometry(Triangles(mesh), Pose(), visible=bool(draw))], uri)

    def InitFromGeometries(self, geometries: Sequence[GeometryInfo], uri: str = "") -> bool:
        """Replace the body by a single static link of geometries.

        Args:
            geometries: The descriptions of the geometries.
            uri: The result of later calls of ``GetURI``.

        Returns:
            True.

        Raises:
            openrave_exception: the body is in an environment, or a description does not make a geometry. The body
                stays as it is.
        """
        return self._become(geometries_of(geometries), uri)

    def Init(self, linkinfos: Sequence[LinkInfo], jointinfos: Sequence[JointInfo], uri: str = "") -> bool:
        """Replace the body by links and joints.

        Args:
            linkinfos: The descriptions of the links; the first one is the root.
            jointinfos: The descriptions of the joints; joints with DOFs stand in DOF order.
            uri: The result of later calls of ``GetURI``.

        Returns:
            True.

        Raises:
            openrave_exception: the body is in an environment, or the descriptions do not make a body. The body stays
                as it is.
        """
        return self.InitFromKinBodyInfo(KinBodyInfo(_vLinkInfos=linkinfos, _vJointInfos=jointinfos, _uri=uri))

    def InitFromLinks(self, linkinfos: Sequence[LinkInfo], uri: str = "") -> bool:
        """Replace the body by links without joints.

        Args:
            linkinfos: The descriptions of the links.
            uri: The result of later calls of ``GetURI``.

        Returns:
            True.
        """
        return self.Init(linkinfos, [], uri)

    def InitFromLinkInfos(self, linkInfos: Sequence[LinkInfo], uri: str = "") -> bool:
        """Replace the body by links without joints; another name of ``InitFromLinks``.

        Args:
            linkInfos: The descriptions of the links.
            uri: The result of later calls of ``GetURI``.

        Returns:
            True.
        """
        return self.InitFromLinks(linkInfos, uri)

    def InitFromKinBodyInfo(self, info: KinBodyInfo) -> bool:
        """Replace the body, including its name, by the one of a description.

        Args:
            info: The description, for instance a result of ``ExtractInfo``.

        Returns:
            True.

        Raises:
            openrave_exception: the body is in an environment, or the description does not make a body. The body stays
                as it is.

        Example:
            >>> copy = ravemj.RaveCreateKinBody(env, "")
            >>> copy.InitFromKinBodyInfo(body.ExtractInfo())
            True
        """
        checked_kind(info, KinBodyInfo, "InitFromKinBodyInfo: info")
        T_world_link0 = info.transform()
        self._rebuild(body_of(info, self._state.scene))
        self._uri, self._id = info._uri, info._id
        if T_world_link0 is not None:
            self._state.set_transform(T_world_link0)
        return True

    def UpdateFromKinBodyInfo(self, info: KinBodyInfo) -> UpdateFromInfoResult:
        """Set the pose and the joint values of a description, which can be changed while a body is in an environment.

        Args:
            info: The description, for instance a result of ``ExtractInfo`` of a body of the same structure.

        Returns:
            ``NoChange`` or ``Success``. If links, joints or the name differ, the body stays as it is, and the result is
            ``RequireReinitialize``: remove the body from the environment, and call ``InitFromKinBodyInfo``.
        """
        with self._simulation.lock:
            before = self.ExtractInfo()
            if not info.same_structure(before):
                return UpdateFromInfoResult.RequireReinitialize
            values, T_world_link0 = info.values_by_axis(), checked_transform(info._transform, "KinBodyInfo._transform")
            present = before.values_by_axis()
            if values == present and np.array_equal(T_world_link0, before._transform):
                return UpdateFromInfoResult.NoChange
            self._state.set_transform(T_world_link0)
            if present:
                self._state.set_values(np.array([values.get(place, value) for place, value in present.items()]))
            return UpdateFromInfoResult.Success

    def SetZeroConfiguration(self) -> None:
        """Make the current configuration the zero configuration: all joint values become 0, and no link moves.

        Limits keep their numbers, so they refer to other poses than before, as in OpenRAVE.
        """
        with self._simulation.lock:
            self._state.rezero()

    def ExtractInfo(self, options: int = ExtractInfoOptions.Everything) -> KinBodyInfo:
        """Return the description of the body in its current state.

        Args:
            options: What to include, ``ExtractInfoOptions``.

        Returns:
            A ``KinBodyInfo``; for a robot a ``RobotBaseInfo``.
        """
        return KinBodyInfo(**self.extracted(options))

    def extracted(self, options: int) -> dict[str, Any]:
        """Return the fields of the info of ``ExtractInfo``.

        Args:
            options: What to include, ``ExtractInfoOptions``.
        """
        with self._simulation.lock:
            joints = [joint.GetInfo() for joint in self.GetJoints()]
            skip = options & ExtractInfoOptions.SkipDOFValues
            return {
                "_name": self.GetName(),
                "_vLinkInfos": [link.GetInfo() for link in self.GetLinks()],
                "_vJointInfos": [*joints, *(joint.GetInfo() for joint in self.GetPassiveJoints())],
                "_transform": self._state.link_transform(0) if self._state.scene.links else np.eye(4),
                "_dofValues": [] if skip else [value for joint in joints for value in joint.named_values()],
                "_isRobot": self._state.scene.is_robot,
                "_vGrabbedInfos": [GrabbedInfo.of(self._state.scene, grab) for grab in self._state.grabs],
            }

    def _become(self, geometries: Iterable[Geometry], uri: str) -> bool:
        self._uri = str(uri)
        return self._rebuild(body_of_geometries(self._state.scene, geometries))

    def _rebuild(self, body: KinBody) -> bool:
        with self._simulation.lock:
            if self._state.index:
                raise RavemjError(f"'{self.GetName()}' is in an environment; remove it first", ErrorCode.Failed)
            self._state.rebuild(body)
        return True


def _rows(numbers: ArrayLike, widths: tuple[int, ...], name: str) -> Floats:
    """Return a finite array of rows."""
    rows = checked_numbers(numbers, name)
    wanted = " or ".join(f"(n, {width})" for width in widths)
    if rows.ndim != 2:
        raise TypeError(f"{name}: has shape {rows.shape}, and should have {wanted}")
    if rows.shape[1] not in widths or not np.isfinite(rows).all():
        message = f"{name}: has shape {rows.shape}, and should be finite and have shape {wanted}"
        raise RavemjError(message, ErrorCode.Failed)
    return rows
