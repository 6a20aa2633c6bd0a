"""Model files."""

import logging
import os

from ravemj.errors import Diagnostic, send_warnings
from ravemj.openrave_xml import Reading
from ravemj.rave.env.base import EnvironmentPart
from ravemj.readers import read_file

_LOG = logging.getLogger("ravemj")


class Loading(EnvironmentPart):
    """Reads model files."""

    def Load(self, filename: str | os.PathLike[str]) -> bool:
        """Add the content of a model file to the environment.

        Args:
            filename: An OpenRAVE XML file with an environment, a robot or a kinbody. It is looked for in the working
                folder, then in the folders of the environment variable ``OPENRAVE_DATA``.

        Returns:
            False where OpenRAVE's ``Load`` is False: the file is missing or broken, or refers to what is not there.
            The reason is logged, and what could be read is in the environment all the same. ``ravemj.load`` raises
            instead.

        Raises:
            openrave_exception: a body of that name is in the environment already (``BodyNameConflict``).

        Example:
            >>> env.Load("env.xml")
            True
        """
        reading = read_file(filename)
        self._add(reading)
        if reading.failure is not None:
            _LOG.error("%s", reading.failure)
        return reading.failure is None and all(finding.severity != "error" for finding in reading.diagnostics)

    def _add(self, reading: Reading) -> None:
        self._files.extend(reading.files)
        for finding in reading.diagnostics:
            self._found.add(finding)
        for body in reading.scene.bodies:
            self._simulation.add(body)
        if reading.scene.view is not None:
            self._simulation.view = reading.scene.view
        if reading.scene.gravity is not None:
            self._simulation.set_gravity(reading.scene.gravity)
        send_warnings(reading.diagnostics)

    @property
    def diagnostics(self) -> tuple[Diagnostic, ...]:
        """What was found in the loaded files and, once the model is compiled, in their translation."""
        return (*self._found, *self._simulation.diagnostics)

    @property
    def files(self) -> tuple[str, ...]:
        """Paths of all files that were read: models, what they include, and meshes."""
        return tuple(dict.fromkeys(self._files))
