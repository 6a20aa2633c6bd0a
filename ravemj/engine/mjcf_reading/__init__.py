"""Reading of MJCF: MuJoCo parses and compiles it, and the compiled values fill a ``BodyBuilder``.

Only MuJoCo can evaluate defaults, classes, includes, frames, replicas and attached models, and infer masses. So this
package belongs to the engine, and ``formats.readers`` imports it for MJCF. ``document`` scans the text for element
positions and referenced files; ``compiling`` runs MuJoCo's compiler; ``trees`` converts the result to bodies, with
``joints``, ``shapes`` and ``motors``; ``followers``, ``pairs``, ``keyframes`` and ``tools`` add mimic joints, adjacent
links, values and manipulators; ``losses`` reports unsupported features.
"""

from dataclasses import replace

from ravemj.engine.mjcf_reading.compiling import CompiledModel, compile_document
from ravemj.engine.mjcf_reading.document import MjcfDocument
from ravemj.engine.mjcf_reading.followers import add_followers
from ravemj.engine.mjcf_reading.keyframes import add_keyframes
from ravemj.engine.mjcf_reading.losses import report_losses
from ravemj.engine.mjcf_reading.own import own_bodies, own_scene
from ravemj.engine.mjcf_reading.pairs import add_adjacent
from ravemj.engine.mjcf_reading.tools import add_cameras, add_manipulators
from ravemj.engine.mjcf_reading.trees import TreeReader
from ravemj.errors import Source, SourceError
from ravemj.formats.file_access import FileAccess
from ravemj.formats.openrave_xml import Reading
from ravemj.formats.openrave_xml.context import Context
from ravemj.formats.openrave_xml.given import Attributes, check_given, give
from ravemj.formats.urdf.robot import settle
from ravemj.model.scene import Scene, View

_GRAVITY = (0.0, 0.0, -9.81)
"""MuJoCo's default gravity [m/s²]."""

__all__ = ["read_mjcf"]


def read_mjcf(path: str, content: bytes, given: Attributes, access: FileAccess) -> Reading:
    """Read a model of MuJoCo.

    Args:
        path: The file, or a name for the text in messages.
        content: Its text.
        given: Attributes of the bodies passed by the caller, such as a prefix; see ``openrave_xml.given``.
        access: The files that may be read.

    Returns:
        The result; its ``failure`` is the error that ended the reading.
    """
    context = Context(access)
    failure, scene = None, Scene()
    check_given(given, Source(path), context, ("name", "prefix", "skipgeometry"))
    try:
        scene = _scene(compile_document(MjcfDocument.parse(path, content, access)), given, context)
    except SourceError as error:
        failure = error
    except ArithmeticError:
        failure = SourceError("a number in the file is too large to compute with", Source(path))
    return Reading(scene, context.diagnostics, failure, {path: None} | access.files, renames=True)


def _scene(compiled: CompiledModel, given: Attributes, context: Context) -> Scene:
    reader, model = TreeReader(compiled), compiled.model
    content, touching = own_scene(reader, context.diagnostics)
    own = own_bodies(reader, touching, context.diagnostics)
    roots = {root for _, own_roots in own for root in own_roots}
    trees = [tree for tree in reader.read() if tree.root not in roots]
    if not (trees or own or (content is not None and content.sensors)):
        raise SourceError("there is no body in it", compiled.document.tags[0].source)
    add_followers(model, trees, context.diagnostics)
    for tree in trees:
        add_adjacent(model, tree, reader.shapes.colliding)
    add_keyframes(model, trees)
    add_manipulators(reader, trees, context)
    view: View | None = add_cameras(reader, trees)
    builders = [tree.builder for tree in trees]
    arms = [arm for part in (*builders, *(body for body, _ in own)) for arm in part.manipulators]
    report_losses(compiled, len(arms), context.diagnostics)
    give(given, builders)
    bodies = [body for body, _ in own]
    for builder in builders:
        bodies.append(settle(builder, context))
        if builder.refusal is not None:
            raise builder.refusal
    x, y, z = (float(part) for part in model.opt.gravity)
    gravity = (x, y, z)
    if content is None:
        return Scene(tuple(bodies), view, gravity)
    own_gravity = _GRAVITY if content.gravity is None else content.gravity
    is_same = all(abs(component - other) < 1e-9 for component, other in zip(gravity, own_gravity, strict=True))
    return replace(content, bodies=tuple(bodies), gravity=content.gravity if is_same else gravity)
