"""Reloading a model while it is shown."""

import argparse
import math
import os
import warnings
from dataclasses import replace

from ravemj.cli.checking import FATAL_CODES
from ravemj.cli.models import failure_of, hold_bases, loaded, model_file
from ravemj.errors import Diagnostic, RavemjError, RavemjWarning, Source, SourceError
from ravemj.gui.interaction import Selection
from ravemj.gui.viewers import Viewer
from ravemj.rave import Environment
from ravemj.rave.enums import CheckLimitsAction

_Stamps = dict[str, tuple[int, int] | None]


class Reloader:
    """Reloads the model of a viewer, preserving camera, joint values and selection.

    If reading fails, the viewer shows the error with file and line, and keeps the last valid model.
    """

    def __init__(self, env: Environment, viewer: Viewer, options: argparse.Namespace) -> None:
        """Start with the loaded model.

        Args:
            env: The environment loaded from the model.
            viewer: The environment's viewer.
            options: The options of the command: the models, and ``watch``: whether to reload them when a file changes,
                or only on request.
        """
        self._env, self._viewer, self._options = env, viewer, options
        self._files = env.files
        self._stamps = _stamps(self._files)
        self._error = ""
        self._known = {(finding.code, finding.message) for finding in env.diagnostics if _is_error(finding)}
        viewer.interaction.controls.display.wants_reload = False

    def update(self) -> None:
        """Reload the model if requested, or if a watched file has changed."""
        display = self._viewer.interaction.controls.display
        is_asked, display.wants_reload = display.wants_reload, False
        stamps = _stamps(self._files)
        if not is_asked and not (self._options.watch and stamps != self._stamps):
            return
        self._stamps = stamps
        notices = self._viewer.interaction.controls.notices
        notices.withdraw(self._error)
        self._error = ""
        try:
            gone = next((file for file, stamp in stamps.items() if stamp is None), None)
            if gone is not None and not is_asked:
                raise SourceError("the file is gone", Source(gone), "the last model stays until it is back")
            fresh = self._read()
        except RavemjError as error:
            self._error = str(error)
            if isinstance(error, SourceError):
                self._watch_also(error.source)
            notices.say(self._error, math.inf)
            return
        try:
            self._copy_state(fresh)
        finally:
            fresh.Destroy()
        notices.say(f"Read {os.path.basename(model_file(self._options.model))} again")

    def _read(self) -> Environment:
        """Load the model's changed files into a new environment.

        Raises:
            RavemjError: The files cannot be read, or MuJoCo rejects the model.
        """
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", RavemjWarning)
            fresh = loaded(self._options)
            fresh.StopSimulation()
            if self._env.simulation.physics is not None:
                hold_bases(fresh)
            with fresh:
                _ = fresh.model
        broken = [finding for finding in fresh.diagnostics if _is_error(finding)]
        if {(finding.code, finding.message) for finding in broken} - self._known:
            fresh.Destroy()
            raise failure_of(broken)
        return fresh

    def _copy_state(self, fresh: Environment) -> None:
        env, interaction = self._env, self._viewer.interaction
        with env:
            values = {
                (body.GetName(), joint.GetName()): joint.GetValues()
                for body in env.GetBodies()
                for joint in body.GetJoints()
            }
            selected = interaction.selection
            for body in fresh.GetBodies():
                for joint in body.GetJoints():
                    before = values.get((body.GetName(), joint.GetName()))
                    if before is not None and len(before) == joint.GetDOF():
                        first = joint.GetDOFIndex()
                        body.SetDOFValues(
                            before, range(first, first + len(before)), CheckLimitsAction.CheckLimitsSilent
                        )
            env.Clone(fresh)
            interaction.select(_found_again(selected, env))
        self._files = fresh.files
        self._stamps = _stamps(self._files)

    def _watch_also(self, source: Source) -> None:
        """Watch a file that could not be read, in addition to the others."""
        if source.file not in self._files:
            self._files = (*self._files, source.file)
            self._stamps = _stamps(self._files)


def _is_error(finding: Diagnostic) -> bool:
    return finding.severity == "error" or finding.code in FATAL_CODES


def _found_again(selected: Selection | None, env: Environment) -> Selection | None:
    """Return the selection of the equally named link and DOF in a new environment; None if one is missing."""
    body = None if selected is None else env.GetKinBody(selected.body.scene.name)
    if selected is None or body is None:
        return None
    state, link = body.simulation_state, body.GetLink(selected.body.scene.links[selected.link].name)
    joint = None if selected.dof is None else body.GetJoint(selected.body.scene.joint_of_dof(selected.dof).name)
    if link is None or (selected.dof is not None and joint is None):
        return None
    dof = None if joint is None else joint.GetDOFIndex()
    return replace(selected, body=state, link=link.GetIndex(), dof=dof)


def _stamps(files: tuple[str, ...]) -> _Stamps:
    """Return modification time [ns] and size of each file; None for a missing file, as while it is being saved."""
    stamps: _Stamps = {}
    for file in files:
        try:
            status = os.stat(file)
            stamps[file] = status.st_mtime_ns, status.st_size
        except OSError:
            stamps[file] = None
    return stamps
