"""A scene compiled by MuJoCo."""

import re
import warnings
from collections.abc import Callable
from typing import TYPE_CHECKING

import mujoco
import numpy as np

from ravemj.core.caching import cached_property
from ravemj.errors import CompileError, Diagnostics, Source
from ravemj.model.inertia import principal_frame, principal_moments
from ravemj.model.scene import Inertial, KinBody, Scene

if TYPE_CHECKING:
    from ravemj.formats import mjcf

_DOF = re.compile(r"DOF (\d+)")
_LINE = re.compile(r"line (?:number=)?(\d+)", re.IGNORECASE)
_TOO_DEEP = "XML_ELEMENT_DEPTH_EXCEEDED"
_LONGEST_CHAIN = 496  # links; MuJoCo's reader of XML takes 500 elements inside one another


class Compiled:
    """Compiled scene: MJCF text, MuJoCo's editable spec, and model.

    Masses and inertias that MuJoCo rejects are replaced by the nearest valid ones in the model.
    """

    def __init__(
        self,
        scene: Scene,
        diagnostics: Diagnostics,
        options: "mjcf.Options | None" = None,
        edit: "Callable[[mujoco.MjSpec, mjcf.Mjcf], None] | None" = None,
        written: "mjcf.Mjcf | None" = None,
    ) -> None:
        """Compile a scene; ``diagnostics`` receives warnings of the translation.

        ``edit`` changes MuJoCo's spec before compilation; ``written`` is an existing translation of the scene.

        Raises:
            CompileError: MuJoCo refuses the model.
        """
        from ravemj.formats import mjcf  # noqa: PLC0415 - slow to import

        self.mjcf = written or mjcf.write(scene, diagnostics, options)
        self.spec, self.model, complaints = compile_text(self.mjcf, edit)
        for complaint in complaints:
            self._report(complaint, scene, diagnostics)

    @cached_property
    def complete_spec(self) -> mujoco.MjSpec:
        """MuJoCo's editable spec including meshes, so that it compiles by itself."""
        from ravemj.formats import mjcf  # noqa: PLC0415 - slow to import

        self.spec.assets = {f"{mjcf.ASSETS}/{name}": text.encode() for name, text in self.mjcf.assets.items()}
        return self.spec

    @cached_property
    def data(self) -> mujoco.MjData:
        """State of the model; created on first use, since that takes half as long as compiling."""
        return mujoco.MjData(self.model)

    @classmethod
    def mechanism(cls, body: KinBody) -> "Compiled":
        """Compile the links and joints of one body without shapes; each root has a free joint.

        The model has the true masses and inertias. No warnings are reported, since the translation of the whole scene
        reports them.

        Raises:
            CompileError: MuJoCo refuses the model.
        """
        from ravemj.formats import mjcf  # noqa: PLC0415 - slow to import

        scene = Scene((body,))
        compiled = cls(scene, Diagnostics(), mjcf.Options(mechanism_only=True))
        compiled.write_true_inertias(scene)
        return compiled

    def _report(self, complaint: str, scene: Scene, diagnostics: Diagnostics) -> None:
        """Convert a warning of MuJoCo to a diagnostic.

        If it names a DOF, the diagnostic has the position, in the user's file, of the link that the DOF moves.
        """
        source, about = Source("the translated model", 0), ""
        match = _DOF.search(complaint)
        if match:
            name = self.model.body(self.model.dof_bodyid[int(match[1])]).name
            for body, names in zip(scene.bodies, self.mjcf.names, strict=True):
                if name in names.links:
                    source, about = body.links[names.links.index(name)].source, f" of '{name}'"
        hint = "positions are exact; before time runs, give the link more mass or inertia"
        diagnostics.warn("near-singular", f"MuJoCo warns{about}: {complaint}", source, hint)

    def write_true_inertias(self, scene: Scene) -> None:
        """Restore true inertias of links that MuJoCo's compiler rejects, as inverse dynamics needs them."""
        for body_index, link_index in self.mjcf.altered:
            inertial = scene.bodies[body_index].links[link_index].inertial
            name = self.mjcf.names[body_index].links[link_index]
            body_id = mujoco.mj_name2id(self.model, mujoco.mjtObj.mjOBJ_BODY, name)
            if np.isfinite(inertial.mass) and np.isfinite(inertial.inertia).all():
                write_inertial(self.model, body_id, inertial)


def compile_text(
    text: "mjcf.Mjcf", edit: "Callable[[mujoco.MjSpec, mjcf.Mjcf], None] | None" = None
) -> tuple[mujoco.MjSpec, mujoco.MjModel, list[str]]:
    """Compile a document; return MuJoCo's editable spec, the model, and MuJoCo's warnings.

    Raises:
        CompileError: MuJoCo refuses the model.
    """
    from ravemj.formats import mjcf  # noqa: PLC0415 - slow to import

    try:
        with mujoco.MjVfs() as files:
            for name, content in text.assets.items():
                files[f"{mjcf.ASSETS}/{name}"] = content.encode()
            spec = mujoco.MjSpec.from_string(text.text, vfs=files)
            if edit is not None:
                edit(spec, text)
            with warnings.catch_warnings(record=True) as complaints:
                warnings.simplefilter("always")
                model = spec.compile(vfs=files)
    except ValueError as error:
        raise _compile_error(str(error), text) from None
    _keep_centers(model)
    return spec, model, [str(complaint.message) for complaint in complaints]


def _keep_centers(model: mujoco.MjModel) -> None:
    """Make MuJoCo use every inertial frame; by default it ignores those within 1e-6 of the body frame."""
    moved = (model.body_ipos != 0).any(axis=1) | (model.body_iquat[:, 0] != 1)
    model.body_sameframe[moved] = 0


def write_inertial(model: mujoco.MjModel, body_id: int, inertial: Inertial) -> None:
    """Set the mass properties of a body in a model."""
    frame = principal_frame(inertial)
    added = inertial.mass - model.body_mass[body_id]
    model.body_mass[body_id] = inertial.mass
    model.body_inertia[body_id] = principal_moments(inertial)
    model.body_ipos[body_id] = frame.position
    model.body_iquat[body_id] = frame.wxyz
    model.body_sameframe[body_id] = 0  # the frame of its inertia is not that of the body
    model.body_subtreemass[0] += added
    while body_id:
        model.body_subtreemass[body_id] += added
        body_id = model.body_parentid[body_id]


def _compile_error(message: str, text: "mjcf.Mjcf") -> CompileError:
    """Convert MuJoCo's error message to an error with the position in the user's file."""
    match = _LINE.search(message)
    line = int(match[1]) if match else 0
    source = text.source_of_line(line) or Source("the translated model", line)
    if _TOO_DEEP in message:
        reason = f"this link hangs on a chain of {_LONGEST_CHAIN} links, and MuJoCo takes no longer ones"
        return CompileError(reason, source, "split the chain into several bodies")
    reason = " ".join(message.split())
    return CompileError(f"MuJoCo refuses the translated model: {reason}", source)
