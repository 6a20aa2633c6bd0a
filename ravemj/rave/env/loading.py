"""Model files, and models as text."""

import logging
import os
from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

from ravemj.errors import ArgumentError, Diagnostic, send_warnings
from ravemj.rave.env.base import EnvironmentPart
from ravemj.rave.interface import checked_kind
from ravemj.rave.kinbody import KinBody
from ravemj.rave.robot import Robot

if TYPE_CHECKING:
    from ravemj.formats.openrave_xml import Reading

Attributes = Mapping[str, str]
"""OpenRAVE's options of reading; all are ignored."""

_LOG = logging.getLogger("ravemj")


class Loading(EnvironmentPart):
    """Reads models."""

    def Load(self, filename: str | os.PathLike[str], atts: Attributes | None = None) -> bool:
        """Add the content of a model file to the environment.

        Args:
            filename: An OpenRAVE XML file with an environment, a robot or a kinbody, a COLLADA file (``.dae``,
                ``.zae``), or a mesh file. It is looked for in the working folder, then in the folders of the
                environment variable ``OPENRAVE_DATA``.
            atts: OpenRAVE's options of reading; ignored.

        Returns:
            False where OpenRAVE's ``Load`` is False: the file is missing or broken, or refers to what is not there.
            The reason is logged, and what could be read is in the environment all the same. ``ravemj.load`` raises
            instead.

        Raises:
            openrave_exception: a body of that name is in the environment already (``BodyNameConflict``).

        Example:
            >>> env = ravemj.Environment()
            >>> env.Load("models/env.xml")
            True
        """
        del atts
        checked_kind(filename, (str, os.PathLike), "Load: filename", "a path")
        return self._take(_read_file(filename))

    LoadURI = Load

    def LoadData(self, data: str | bytes, atts: Attributes | None = None) -> bool:
        """Add the content of a model that is given as text, as ``Load`` adds that of a file.

        Args:
            data: An OpenRAVE XML or COLLADA document; files that it names are looked for in the working folder.
            atts: OpenRAVE's options of reading; ignored.

        Returns:
            False where the text is broken or refers to what is not there, as ``Load`` does.

        Raises:
            openrave_exception: a body of that name is in the environment already (``BodyNameConflict``).

        Example:
            >>> env.LoadData('<KinBody name="a"><Body><Geom type="sphere"><radius>1</radius></Geom></Body></KinBody>')
            True
        """
        del atts
        checked_kind(data, (str, bytes), "LoadData: data", "a text")
        return self._take(_read_data(data))

    def _take(self, reading: "Reading") -> bool:
        self._add(reading)
        if reading.failure is not None:
            _LOG.error("%s", reading.failure)
        return reading.failure is None and all(finding.severity != "error" for finding in reading.diagnostics)

    def _add(self, reading: "Reading") -> None:
        self._note(reading)
        with self._simulation.lock:
            for body in reading.scene.bodies:
                self._simulation.add(body)
            if reading.scene.view is not None:
                self._simulation.view = reading.scene.view
            if reading.scene.gravity is not None:
                self._simulation.set_gravity(reading.scene.gravity)
        for viewer in self._viewers:
            viewer.take_over(reading.scene.view)
        send_warnings(reading.diagnostics)

    def _note(self, reading: "Reading") -> None:
        self._check_alive()
        self._files.update(dict.fromkeys(reading.files))
        self._found.update(dict.fromkeys(reading.diagnostics))

    def ReadKinBodyURI(self, *arguments: "KinBody | str | Attributes | None") -> KinBody | None:
        """Read a body from a file without adding it: ``ReadKinBodyURI(filename[, atts])``.

        Also ``ReadKinBodyURI(body, filename[, atts])``, which makes that body anew.

        Returns:
            The body, for ``env.Add``; None, with the reason in the log, if there is none in the file.

        Example:
            >>> mug = env.ReadKinBodyURI("mug.kinbody.xml")
            >>> env.Add(mug)
        """
        body, filename = _read_arguments("ReadKinBodyURI", arguments)
        return self._read(_read_file(filename), body, is_robot=False)

    ReadKinBodyXMLFile = ReadKinBodyURI

    def ReadKinBodyData(self, *arguments: "KinBody | str | Attributes | None") -> KinBody | None:
        """Return a body from text without adding it: ``ReadKinBodyData(data[, atts])``; see ``ReadKinBodyURI``."""
        body, data = _read_arguments("ReadKinBodyData", arguments)
        return self._read(_read_data(data), body, is_robot=False)

    ReadKinBodyXMLData = ReadKinBodyData

    def ReadRobotURI(self, *arguments: "KinBody | str | Attributes | None") -> Robot | None:
        """Return a robot from a file without adding it: ``ReadRobotURI(filename[, atts])``; see ``ReadKinBodyURI``.

        A body that the file does not call a robot becomes one.
        """
        body, filename = _read_arguments("ReadRobotURI", arguments)
        robot = self._read(_read_file(filename), body, is_robot=True)
        return robot if isinstance(robot, Robot) else None

    ReadRobotXMLFile = ReadRobotURI

    def ReadRobotData(self, *arguments: "KinBody | str | Attributes | None") -> Robot | None:
        """Return a robot from text without adding it: ``ReadRobotData(data[, atts])``; see ``ReadRobotURI``."""
        body, data = _read_arguments("ReadRobotData", arguments)
        robot = self._read(_read_data(data), body, is_robot=True)
        return robot if isinstance(robot, Robot) else None

    ReadRobotXMLData = ReadRobotData

    def _read(self, reading: "Reading", into: KinBody | None, *, is_robot: bool) -> KinBody | None:
        """Make a body of what was read, that is not added; the first one counts."""
        self._note(reading)
        send_warnings(reading.diagnostics)
        if reading.failure is not None or not reading.scene.bodies:
            _LOG.error("%s", reading.failure or "there is no body in it")
            return None
        scene = reading.scene.bodies[0]
        scene = replace(scene, is_robot=scene.is_robot or is_robot)
        if into is None:
            return self.wrap(self._simulation.create(scene))
        with self._simulation.lock:
            into.simulation_state.rebuild(replace(scene, is_robot=into.IsRobot()))
        return into

    @property
    def diagnostics(self) -> tuple[Diagnostic, ...]:
        """What was found in the loaded files and, once the model is compiled, in their translation."""
        return (*self._found, *self._simulation.diagnostics)

    @property
    def files(self) -> tuple[str, ...]:
        """Paths of all files that were read: models, what they include, and meshes."""
        return tuple(self._files)


def _read_arguments(
    caller: str, arguments: "tuple[KinBody | str | Attributes | None, ...]"
) -> tuple[KinBody | None, str]:
    """Return the body to fill, if one is given, and the file or text."""
    given = [argument for argument in arguments if isinstance(argument, str | os.PathLike)]
    into = arguments[0] if arguments and isinstance(arguments[0], KinBody) else None
    if not given:
        raise ArgumentError(f"{caller}: takes a text, optionally after a body, not {arguments!r}")
    return into, os.fspath(given[0])


# Readers are imported when they are asked for: that takes a while, and not every script reads a file.


def _read_file(path: str | os.PathLike[str]) -> "Reading":
    from ravemj.formats.readers import read_file  # noqa: PLC0415

    return read_file(path)


def _read_data(data: str | bytes) -> "Reading":
    from ravemj.formats.readers import read_data  # noqa: PLC0415

    return read_data(data)
