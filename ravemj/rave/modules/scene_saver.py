"""The module ``logging``, which saves scenes."""

from typing import TYPE_CHECKING

from ravemj.errors import ArgumentError
from ravemj.rave.module import Module
from ravemj.rave.modules.tokens import read_options, text

if TYPE_CHECKING:
    from ravemj.rave.environment import Environment


def scene_module(env: "Environment", xmlid: str) -> Module:
    """Make a module that saves all bodies of an environment."""

    def savescene(arguments: str) -> str:
        """Save all bodies as OpenRAVE XML: ``savescene filename F``; meshes go into the folder ``meshes`` beside F."""
        options = read_options(arguments, {"filename": text})
        if not options:
            raise ArgumentError("savescene: give the file: savescene filename F")
        env.Save(options["filename"], atts={"format": "openrave"})
        return ""

    return Module(env, xmlid, lambda arguments: None, {"savescene": savescene})
