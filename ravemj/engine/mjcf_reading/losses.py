"""Report of model features that OpenRAVE's bodies cannot represent, once for each kind."""

from collections.abc import Iterator

import mujoco
import numpy as np

from ravemj.engine.mjcf_reading.compiling import CompiledModel
from ravemj.engine.mjcf_reading.joints import BALL
from ravemj.errors import Diagnostics

_CODE = "left-out"
_EQUALITIES = {
    int(mujoco.mjtEq.mjEQ_CONNECT): ("connect", "closed loops stay open"),
    int(mujoco.mjtEq.mjEQ_WELD): ("weld", "bodies that it holds together move apart"),
    int(mujoco.mjtEq.mjEQ_FLEX): ("flex", "soft bodies are not simulated"),
    int(mujoco.mjtEq.mjEQ_DISTANCE): ("distance", "bodies move apart"),
}


def report_losses(compiled: CompiledModel, tools: int, diagnostics: Diagnostics) -> None:
    """Report omitted features: as warnings if they change how bodies move, else as notes.

    Args:
        compiled: The model.
        tools: Number of sites that mark a tool.
        diagnostics: Receives the findings.
    """
    document, mocap = compiled.document, _held_by_mocap(compiled.model)
    root = document.tags[0].source
    for count, message, tags in _warnings(compiled.model, mocap):
        if count:
            diagnostics.warn(_CODE, message.format(f"{count} in the model"), document.first(*tags) or root)
    for count, message, tags in _notes(compiled, tools, mocap):
        if count:
            diagnostics.note(_CODE, f"{message}, {count} in the model", document.first(*tags) or root)
    for complaint in compiled.complaints:
        diagnostics.note("mujoco-warning", f"MuJoCo warns: {' '.join(complaint.split())}", root)


def _warnings(model: mujoco.MjModel, mocap: set[int]) -> Iterator[tuple[int, str, tuple[str, ...]]]:
    """Yield, for each kind of unsupported element, its count, a message with a placeholder for it, and XML tags."""
    for kind, (tag, effect) in _EQUALITIES.items():
        count = sum(int(model.eq_type[index]) == kind and index not in mocap for index in range(model.neq))
        yield count, f"<{tag}> is left out, {{}}: {effect}", (tag,)
    balls = sum(model.jnt_type[index] == BALL and bool(model.jnt_limited[index]) for index in range(model.njnt))
    yield balls, "the range of ball joints is left out, {}: they turn without limits", ("joint",)
    yield model.nflex, "flexible bodies are left out, {}; their points stay as links", ("flex", "flexcomp")


def _notes(compiled: CompiledModel, tools: int, mocap: set[int]) -> list[tuple[int, str, tuple[str, ...]]]:
    model = compiled.model
    wraps = model.wrap_type[model.tendon_adr] if model.ntendon else np.zeros(0, int)
    textures = sum(tag.name == "texture" for tag in compiled.document.tags)
    skins = sum(tag.name == "skin" for tag in compiled.document.tags)
    actuators = ("motor", "position", "velocity", "general", "intvelocity", "damper", "cylinder", "muscle", "adhesion")
    return [
        (model.nu, "actuators are left out but for the limits that they give joints", actuators),
        (model.nsensor, "sensors are left out", ("sensor",)),
        (int((wraps != mujoco.mjtWrap.mjWRAP_JOINT).sum()), "spatial tendons are left out", ("spatial",)),
        (int((model.jnt_stiffness != 0).any(axis=-1).sum()), "springs of joints are left out", ("joint",)),
        (max(model.nsite - tools, 0), "sites that mark no tool are left out", ("site",)),
        (model.nlight, "lights are left out", ("light",)),
        (textures, "textures are left out: shapes have one colour", ("texture",)),
        (skins, "skins are left out", ("skin",)),
        (len(mocap), "welds to bodies that a program moves (mocap) are left out", ("weld",)),
        (int((model.body_gravcomp != 0).sum()), "compensations of gravity are left out", ("body",)),
    ]


def _held_by_mocap(model: mujoco.MjModel) -> set[int]:
    """Return the equality indices of welds to mocap bodies; such welds pull a body but do not fix it."""
    bodies = {index for index in range(model.nbody) if model.body_mocapid[index] >= 0}
    return {
        index
        for index in range(model.neq)
        if model.eq_type[index] == mujoco.mjtEq.mjEQ_WELD
        and model.eq_objtype[index] == mujoco.mjtObj.mjOBJ_BODY
        and {int(model.eq_obj1id[index]), int(model.eq_obj2id[index])} & bodies
    }
