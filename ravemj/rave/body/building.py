"""Bodies made in code."""

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
    """Methods that make the body anew, while it is in no environment."""

    _internal = ("extracted",)

    def InitFromBoxes(self, boxes: ArrayLike, draw: bool = True, uri: str = "") -> bool:
        """Make the body one static link of boxes, in place of what it was.

        Args:
            boxes: A row for each box: centre x y z and half extents x y z [m], shape (n, 6). Or, for turned boxes,
                centre, the unit vectors along the box's x, y and z axis, and half extents, shape (n, 15).
            draw: False: the boxes collide, and are not drawn.
            uri: What ``GetURI`` returns from then on.

        Returns:
            True.

        Raises:
            openrave_exception: the body is in an environment, or the rows are of another length.
            TypeError: this is no array of rows.

        Example:
            >>> body = ravemj.RaveCreateKinBody(env, "")
            >>> body.InitFromBoxes([[0, 0, 0.1, 0.5, 0.5, 0.1]])
            True
            >>> body.SetName("table")
            >>> env.Add(body)
        """
        return self._become(box_geometries(_rows(boxes, (6, 15), "InitFromBoxes: boxes"), visible=bool(draw)), uri)

    def InitFromSpheres(self, spherex: ArrayLike, draw: bool = True, uri: str = "") -> bool:
        """Make the body one static link of spheres.

        Args:
            spherex: A row for each sphere: centre x y z and radius [m], shape (n, 4); the spelling is OpenRAVE's.
            draw: False: the spheres collide, and are not drawn.
            uri: What ``GetURI`` returns from then on.

        Returns:
            True.

        Raises:
            openrave_exception: the body is in an environment, or the rows are of another length.
            TypeError: this is no array of rows.
        """
        return self._become(
            sphere_geometries(_rows(spherex, (4,), "InitFromSpheres: spherex"), visible=bool(draw)), uri
        )

    def InitFromTrimesh(self, trimesh: TriMesh, draw: bool = True, uri: str = "") -> bool:
        """Make the body one static link with the triangles of a mesh; they stay as they are.

        Args:
            trimesh: The triangles.
            draw: False: the triangles collide, and are not drawn.
            uri: What ``GetURI`` returns from then on.

        Returns:
            True.

        Raises:
            openrave_exception: the body is in an environment, or a triangle has a corner that is not there.
        """
        mesh = checked_mesh(trimesh, "InitFromTrimesh: trimesh")
        return self._become([shape_geometry(Triangles(mesh), Pose(), visible=bool(draw))], uri)

    def InitFromGeometries(self, geometries: Sequence[GeometryInfo], uri: str = "") -> bool:
        """Make the body one static link of shapes.

        Args:
            geometries: Their descriptions.
            uri: What ``GetURI`` returns from then on.

        Returns:
            True.

        Raises:
            openrave_exception: the body is in an environment, or an info describes nothing that can be. Nothing has
                changed then.
        """
        return self._become(geometries_of(geometries), uri)

    def Init(self, linkinfos: Sequence[LinkInfo], jointinfos: Sequence[JointInfo], uri: str = "") -> bool:
        """Make the body of links and joints.

        Args:
            linkinfos: The descriptions of the links; the first one is the root.
            jointinfos: The descriptions of the joints; those with DOFs in DOF order.
            uri: What ``GetURI`` returns from then on.

        Returns:
            True.

        Raises:
            openrave_exception: the body is in an environment, or an info describes nothing that can be. Nothing has
                changed then.
        """
        return self.InitFromKinBodyInfo(KinBodyInfo(_vLinkInfos=linkinfos, _vJointInfos=jointinfos, _uri=uri))

    def InitFromLinks(self, linkinfos: Sequence[LinkInfo], uri: str = "") -> bool:
        """Make the body of links without joints.

        Args:
            linkinfos: The descriptions of the links.
            uri: What ``GetURI`` returns from then on.

        Returns:
            True.
        """
        return self.Init(linkinfos, [], uri)

    def InitFromLinkInfos(self, linkInfos: Sequence[LinkInfo], uri: str = "") -> bool:
        """Make the body of links without joints; the other name of ``InitFromLinks``.

        Args:
            linkInfos: The descriptions of the links.
            uri: What ``GetURI`` returns from then on.

        Returns:
            True.
        """
        return self.InitFromLinks(linkInfos, uri)

    def InitFromKinBodyInfo(self, info: KinBodyInfo) -> bool:
        """Make the body, its name included, of a description.

        Args:
            info: The description, for instance of ``ExtractInfo``.

        Returns:
            True.

        Raises:
            openrave_exception: the body is in an environment, or the info describes nothing that can be. Nothing has
                changed then.

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
        """Become what an info describes, as far as a body in an environment can: its pose and joint values.

        Args:
            info: The description, for instance of ``ExtractInfo`` of a body like this.

        Returns:
            ``NoChange`` or ``Success``; ``RequireReinitialize`` where links, joints or the name differ, and nothing has
            changed then: take the body out of the environment and call ``InitFromKinBodyInfo``.
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
        """Make the present configuration the zero configuration: all joint values become 0, and nothing moves.

        Limits keep their numbers, so they stand for other poses than before, as in OpenRAVE.
        """
        with self._simulation.lock:
            self._state.rezero()

    def ExtractInfo(self, options: int = ExtractInfoOptions.Everything) -> KinBodyInfo:
        """Return the description of the body as it stands, a copy.

        Args:
            options: What to take, ``ExtractInfoOptions``.

        Returns:
            A ``KinBodyInfo``; of a robot a ``RobotBaseInfo``.
        """
        return KinBodyInfo(**self.extracted(options))

    def extracted(self, options: int) -> dict[str, Any]:
        """Return the fields of ``ExtractInfo``.

        Args:
            options: What to take, ``ExtractInfoOptions``.
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
