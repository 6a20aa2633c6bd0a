"""Methods that load models into environments, and their arguments."""

# The fields of infos have the names that OpenRAVE gives them.
# pyright: reportPrivateUsage=false

import logging
import os
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from ravemj.core.arguments import checked_kind
from ravemj.core.output import temporary_folder
from ravemj.engine.compiled import Compiled
from ravemj.engine.simulation import BodyState
from ravemj.engine.simulation.body import GrabbedBody
from ravemj.errors import (
    ArgumentError,
    Diagnostic,
    Diagnostics,
    ErrorCode,
    ManipulatorError,
    RavemjError,
    Source,
    SourceError,
    UnnamedError,
    send_warning,
    send_warnings,
)
from ravemj.formats.data_folders import existing
from ravemj.formats.file_access import FileAccess
from ravemj.formats.suffixes import format_of
from ravemj.model.scene import Grab, Mesh, Scene
from ravemj.rave.env.description import Description
from ravemj.rave.env.saving import placed_errors, read_json
from ravemj.rave.infos import EnvironmentBaseInfo
from ravemj.rave.kinbody import KinBody
from ravemj.rave.robot import Robot
from ravemj.rave.sensors import Sensor
from ravemj.rave.trimesh import TriMesh, trimesh_of

if TYPE_CHECKING:
    from ravemj.formats.openrave_xml import Reading


Attributes = Mapping[str, str]
"""Attributes for the bodies of a file, by name; see ``Load``."""

Text = str | bytes | os.PathLike[str]
Argument = KinBody | Text | Attributes | None


def warn_of_attributes(path: str, given: Attributes) -> None:
    """Warn about attributes of a JSON file, which have no effect because its bodies have names."""
    diagnostics = Diagnostics()
    for name in given:
        diagnostics.warn("unknown-attribute", f"nothing reads '{name}' for a JSON file", Source(path))
    send_warnings(diagnostics)


def read_arguments(
    caller: str, arguments: tuple[Argument, ...], named: dict[str, Argument]
) -> tuple[KinBody | None, str | bytes, Attributes]:
    """Parse the arguments of ``ReadKinBodyURI`` and similar methods.

    Return the body to replace (or None), the file name or text, and the attributes.
    """
    given = [*arguments, *(named.pop(name) for name in ("filename", "data", "atts") if name in named)]
    if named:
        raise TypeError(f"{caller}: has no argument {', '.join(named)}")
    into = given[0] if given and isinstance(given[0], KinBody) else None
    text, atts, *rest = *(given if into is None else given[1:]), None, None
    if len(rest) > 2 or not isinstance(text, str | bytes | os.PathLike):
        raise ArgumentError(f"{caller}: takes a text, optionally after a body and before attributes, not {arguments!r}")
    return into, os.fspath(text), checked_attributes(atts, caller)


def checked_attributes(atts: object, caller: str) -> Attributes:
    """Return the user's attributes with names in lower case.

    Raises:
        ArgumentError: they are not strings by name.
    """
    if atts is None:
        return {}
    given = cast("Mapping[object, object]", checked_kind(atts, Mapping, f"{caller}: atts", "a dict of texts"))
    wanted = f"{caller}: atts: a name or value"
    return {
        checked_kind(name, str, wanted, "a text").lower(): checked_kind(value, str, wanted, "a text")
        for name, value in given.items()
    }


_LOG = logging.getLogger("ravemj")

_NAME_CONFLICTS = {ErrorCode.BodyNameConflict.name, ErrorCode.SensorNameConflict.name}


class Loading(Description):
    """Methods that load models."""

    _internal = ("add_file", "named_files")

    def Load(self, filename: Text, atts: Attributes | None = None) -> bool:
        """Add the content of a model file to the environment.

        Args:
            filename: An OpenRAVE XML file with an environment, a robot, a kinbody or a sensor; a URDF, whose SRDF is
                looked for beside it, or a xacro; a COLLADA file (``.dae``, ``.zae``); OpenRAVE's JSON (``.json``, see
                ``LoadJSON``); or a mesh file. Relative paths are searched in the working folder, then in the folders of
                the environment variable ``OPENRAVE_DATA``. The manual's page "Which files a model may read" lists the
                files that it may refer to.
            atts: Attributes as those of a ``<Robot>``: ``name`` replaces the name of the body, ``prefix`` is put before
                the names of its parts, ``skipgeometry`` "1" leaves out its shapes, ``scalegeometry`` ("2" or "2 3 4")
                multiplies its lengths, except the sizes of boxes, spheres and cylinders of XML. Attributes apply to
                files of one robot, kinbody or mesh, and to COLLADA files, but not to an ``<Environment>``. With a URDF,
                ``srdf`` names its SRDF ("none" ignores the one beside it, and guesses no manipulators), ``state`` a
                group state of it, which gives the joint values, ``packages`` folders of packages ("NAME=FOLDER",
                several separated as in PATH), and ``args`` arguments of a xacro ("name:=value", separated by blanks).
                Attributes that have no effect are reported as warnings.

        Returns:
            Whether the whole file was loaded. As in OpenRAVE, the result is False if the file is missing or broken,
            refers to a missing file, or has a body or sensor without a name or with one that is taken. The reason is
            logged, and the bodies before the error are in the environment; ``ravemj.load`` raises an error instead.
            Bodies of COLLADA and mesh files get another name if theirs is taken.

        Example:
            >>> env = ravemj.Environment()
            >>> env.Load("models/env.xml")
            True
        """
        checked_kind(filename, (str, bytes, os.PathLike), "Load: filename", "a path")
        if format_of(os.fsdecode(filename)) == "json":
            return self._try_json(os.fsdecode(filename), checked_attributes(atts, "Load"))
        reading = self._read_file(filename, checked_attributes(atts, "Load"))
        try:
            return self._take(reading)
        except RavemjError as error:
            if error.GetCode() not in _NAME_CONFLICTS:
                raise
            _LOG.error("%s: %s", os.fsdecode(filename), error)
            return False

    LoadURI = Load

    def add_file(self, path: str, dropped: Sequence[str] = ()) -> str:
        """Add the file ``path`` that was dropped on a viewer, completely or not at all.

        It may refer to files in its folder and to the files ``dropped`` with it. Bodies whose names are taken are
        renamed. Return the error with file and line, or the missing mesh of an added body; empty if the file is
        complete.
        """
        path = os.path.abspath(path)
        access = FileAccess.dropped(path, dropped)
        try:
            if format_of(path) == "json":
                self._try_elsewhere(path)
                self._load_json(path)
                return ""
            trouble = self._add_dropped(path, access)
        except RavemjError as error:
            trouble = str(error)
        return access.named(trouble)

    def _add_dropped(self, path: str, access: FileAccess) -> str:
        reading = self._read_file(path, {}, access)
        broken = [finding for finding in reading.diagnostics if finding.severity == "error"]
        if reading.failure is not None or broken:
            return str(broken[0] if broken else reading.failure)
        if not reading.scene.bodies and not reading.scene.sensors:
            return f"{path}: the file has no body and no sensor"
        Compiled(reading.scene, Diagnostics())  # raises an error if MuJoCo rejects the bodies
        self._add(replace(reading, renames=True, diagnostics=access.named_diagnostics()))
        missing = [finding for finding in reading.diagnostics if finding.code == "missing-file"]
        others = f" (and {len(missing) - 1} more)" if len(missing) > 1 else ""
        return f"{missing[0]}{others}" if missing else ""

    def _try_elsewhere(self, path: str) -> None:
        """Load a JSON file into a temporary environment, so that errors in it leave this one unchanged."""
        trial = type(self)()
        try:
            trial._load_json(path)
            Compiled(Scene(tuple(body.scene for body in trial._simulation.bodies)), Diagnostics())
        finally:
            trial._environment.Destroy()

    def _try_json(self, path: str, given: Attributes) -> bool:
        warn_of_attributes(path, given)
        try:
            self._load_json(path)
        except SourceError as error:
            _LOG.error("%s", error)
            return False
        return True

    def _load_json(self, path: str) -> None:
        """Load an environment from JSON; see ``LoadJSON``. After an error, objects read so far are kept."""
        self._check_alive()
        with placed_errors(path):
            self.LoadJSON(self._json_content(path))

    def _json_content(self, path: str) -> dict[str, Any]:
        file, content = read_json(path)
        self._files[file] = None
        return content

    def LoadData(self, data: str | bytes, atts: Attributes | None = None) -> bool:
        """Add a model that is given as text, as ``Load`` adds a file.

        Args:
            data: An OpenRAVE XML or COLLADA document. Files that it names are searched in the working folder.
            atts: Attributes for its body; see ``Load``.

        Returns:
            Whether the whole text was loaded; False if it is broken or refers to a missing file.

        Raises:
            openrave_exception: the environment has a body of the same name (``BodyNameConflict``), or a body has no
                name (``Failed``). Bodies of COLLADA documents get another name if theirs is taken.

        Example:
            >>> env.LoadData('<KinBody name="a"><Body><Geom type="sphere"><radius>1</radius></Geom></Body></KinBody>')
            True
        """
        checked_kind(data, (str, bytes), "LoadData: data", "a text")
        reading = self._read_data(data, checked_attributes(atts, "LoadData"))
        loaded = self._take(reading)
        if isinstance(reading.failure, UnnamedError):
            raise reading.failure
        return loaded

    def _read_file(self, path: Text, given: Attributes, access: FileAccess | None = None) -> "Reading":
        from ravemj.formats.readers import read_file  # noqa: PLC0415 - takes a while, and not every script reads a file

        return read_file(os.fsdecode(path), given, self._metre, access)

    def _read_data(self, data: str | bytes, given: Attributes) -> "Reading":
        from ravemj.formats.readers import read_data  # noqa: PLC0415

        return read_data(data, given, self._metre)

    def _take(self, reading: "Reading") -> bool:
        self._add(reading)
        if reading.failure is not None:
            _LOG.error("%s", reading.failure)
        return reading.failure is None and all(finding.severity != "error" for finding in reading.diagnostics)

    def _add(self, reading: "Reading") -> None:
        self._note(reading)
        added: dict[str, BodyState] = {}
        with self._simulation.lock:
            for body in reading.scene.bodies:
                name = self._simulation.free_name(body.name) if reading.renames else body.name
                state = self._simulation.add(body if name == body.name else replace(body, name=name))
                added[body.name] = state
                if self._body_callbacks:
                    self._tell_of_body(self.wrap(state), 1)
            for body in reading.scene.bodies:
                self._hold(added[body.name], body.grabs, added, reading.diagnostics)
            if reading.scene.view is not None:
                self._simulation.view = reading.scene.view
            if reading.scene.gravity is not None:
                self._simulation.set_gravity(reading.scene.gravity)
            self.annotations.description = reading.scene.description or self.annotations.description
            for sensor in reading.scene.sensors:
                self.AddSensor(Sensor(self._environment, sensor), reading.renames)
        for viewer in self._viewers:
            viewer.apply_loaded(reading.scene.view)
        send_warnings(reading.diagnostics)

    def _hold(
        self, holder: BodyState, grabs: Sequence[Grab], added: Mapping[str, BodyState], diagnostics: Diagnostics
    ) -> None:
        """Make a body grab the bodies that its file declares as grabbed; warn of those not in ``added``."""
        for grab in grabs:
            held = added.get(grab.body)
            if held is None or held is holder:
                message = f"there is no other body '{grab.body}' in the file for '{holder.scene.name}' to hold"
                diagnostics.warn("unknown-body", message, holder.scene.source)
                continue
            T_link_body = np.array(grab.T_link_body.matrix())
            holder.grabs = [*holder.grabs, GrabbedBody(held, grab.link, T_link_body, frozenset(grab.ignored))]

    def _note(self, reading: "Reading") -> None:
        self._check_alive()
        self._files.update(reading.named_files)
        self._found.update(dict.fromkeys(reading.diagnostics))

    def ReadKinBodyURI(self, *arguments: Argument, **named: Argument) -> KinBody | None:
        """Return a body from a file without adding it: ``ReadKinBodyURI(filename[, atts])``.

        The form ``ReadKinBodyURI(body, filename[, atts])`` replaces an existing body. ``atts`` are as for ``Load``.

        Returns:
            The body, for ``env.Add``; None with a logged reason if the file is missing, broken or has no body.

        Example:
            >>> mug = env.ReadKinBodyURI("mug.kinbody.xml")
            >>> env.Add(mug)
        """
        into, filename, given = read_arguments("ReadKinBodyURI", arguments, named)
        return self._read_uri(filename, given, into, is_robot=False)

    ReadKinBodyXMLFile = ReadKinBodyURI

    def ReadKinBodyData(self, *arguments: Argument, **named: Argument) -> KinBody | None:
        """Return a body from text without adding it: ``ReadKinBodyData(data[, atts])``; see ``ReadKinBodyURI``."""
        into, data, given = read_arguments("ReadKinBodyData", arguments, named)
        return self._read(self._read_data(data, given), into, is_robot=False)

    ReadKinBodyXMLData = ReadKinBodyData

    def ReadRobotURI(self, *arguments: Argument, **named: Argument) -> Robot | None:
        """Return a robot from a file without adding it: ``ReadRobotURI(filename[, atts])``; see ``ReadKinBodyURI``.

        A kinbody of the file becomes a robot.
        """
        into, filename, given = read_arguments("ReadRobotURI", arguments, named)
        robot = self._read_uri(filename, given, into, is_robot=True)
        return robot if isinstance(robot, Robot) else None

    ReadRobotXMLFile = ReadRobotURI

    def ReadRobotData(self, *arguments: Argument, **named: Argument) -> Robot | None:
        """Return a robot from text without adding it: ``ReadRobotData(data[, atts])``; see ``ReadRobotURI``."""
        into, data, given = read_arguments("ReadRobotData", arguments, named)
        robot = self._read(self._read_data(data, given), into, is_robot=True)
        return robot if isinstance(robot, Robot) else None

    ReadRobotXMLData = ReadRobotData

    def _read_uri(self, filename: Text, given: Attributes, into: KinBody | None, *, is_robot: bool) -> KinBody | None:
        path = os.fsdecode(filename)
        if format_of(path) != "json":
            return self._read(self._read_file(path, given), into, is_robot=is_robot)
        warn_of_attributes(path, given)
        try:
            return self._body_of_json(path, into, is_robot=is_robot)
        except SourceError as error:
            self._unread = str(error)
            _LOG.error("%s", error)
            return None

    def _body_of_json(self, path: str, into: KinBody | None, *, is_robot: bool) -> KinBody:
        """Return the first body of a JSON file without adding it: rebuild the body ``into`` or, if None, make one."""
        content = self._json_content(path)
        info = EnvironmentBaseInfo()
        with placed_errors(path):
            self._read_json(info, content)
            if not info._vBodyInfos:
                raise SourceError("there is no body in it", Source(path))
            first = info._vBodyInfos[0]
            first._uri = f"file:{os.path.abspath(path)}"
            first._isRobot = into.IsRobot() if into is not None else first._isRobot or is_robot
            body = self._new_body(is_robot=first._isRobot) if into is None else into
            body.InitFromKinBodyInfo(first)
        return body

    def _read(self, reading: "Reading", into: KinBody | None, *, is_robot: bool) -> KinBody | None:
        """Return the first body of a parsed file without adding it; log an error and return None if there is none."""
        self._note(reading)
        send_warnings(reading.diagnostics)
        failure = reading.failure
        if isinstance(failure, ManipulatorError):
            send_warning(Diagnostic("warning", "bad-manipulator", failure.message, failure.source, failure.hint))
        elif failure is not None or not reading.scene.bodies:
            self._unread = str(failure or "the file has no body")
            _LOG.error("%s", self._unread)
            return None
        scene = reading.scene.bodies[0]
        scene = replace(scene, is_robot=scene.is_robot or is_robot)
        if into is None:
            return self.wrap(self._simulation.create(scene))
        with self._simulation.lock:
            into.simulation_state.rebuild(replace(scene, is_robot=into.IsRobot()))
            into.annotations.description = scene.description
        return into

    def ReadTrimeshURI(self, filename: str, atts: Attributes | None = None) -> TriMesh | None:
        """Return all triangles of a mesh file, in metres and in the frame of the file.

        Args:
            filename: The file; see ``Load``.
            atts: ``scalegeometry`` ("2" or "2 3 4") scales the triangles; other attributes have no effect.

        Returns:
            The triangles; None with a logged reason if the file is missing or broken.
        """
        from ravemj.formats.meshes import read_mesh  # noqa: PLC0415 - slow to import

        factors = [float(word) for word in checked_attributes(atts, "ReadTrimesh").get("scalegeometry", "1").split()]
        x, y, z = (factors * 3)[:3]
        try:
            parts = read_mesh(existing(filename), (x, y, z))
        except SourceError as error:
            _LOG.error("%s", error)
            return None
        return trimesh_of(Mesh.merged(part.mesh for part in parts))

    ReadTrimeshFile = ReadTrimeshURI

    def ReadTrimeshData(self, data: str | bytes, formathint: str, atts: Attributes | None = None) -> TriMesh | None:
        """Return the triangles of a mesh that is given as the content of a file; see ``ReadTrimeshURI``.

        Args:
            data: The content.
            formathint: The suffix of the format, for instance ``stl``.
            atts: As for ``ReadTrimeshURI``.
        """
        with temporary_folder() as folder:
            path = os.path.join(folder, f"mesh.{formathint.lstrip('.')}")
            with open(path, "wb") as file:
                file.write(data if isinstance(data, bytes) else data.encode())
            return self.ReadTrimeshURI(path, atts)

    def ReadInterfaceURI(self, filename: Text, atts: Attributes | None = None) -> KinBody | Sensor | None:
        """Return a robot, body or sensor from a file without adding it; other interfaces cannot be read.

        Args:
            filename: The file; see ``Load``.
            atts: Attributes for the body; see ``Load``.

        Returns:
            The first robot or body, else the first sensor; None with a logged reason if there is none.
        """
        given = checked_attributes(atts, "ReadInterfaceURI")
        if format_of(os.fsdecode(filename)) == "json":
            return self._read_uri(filename, given, None, is_robot=False)
        reading = self._read_file(filename, given)
        if reading.failure or reading.scene.bodies or not reading.scene.sensors:
            return self._read(reading, None, is_robot=False)
        self._note(reading)
        send_warnings(reading.diagnostics)
        return Sensor(self._environment, reading.scene.sensors[0])

    ReadInterfaceXMLFile = ReadInterfaceURI

    @property
    def diagnostics(self) -> tuple[Diagnostic, ...]:
        """Warnings and errors about the loaded files and, once the model is compiled, about their translation."""
        return (*self._found, *self._simulation.diagnostics)

    @property
    def files(self) -> tuple[str, ...]:
        """Paths of all read files: models, included files, and meshes."""
        return tuple(self._files)

    @property
    def named_files(self) -> dict[str, Source]:
        """Files named in other files, and the positions of these references."""
        return {path: source for path, source in self._files.items() if source is not None}
