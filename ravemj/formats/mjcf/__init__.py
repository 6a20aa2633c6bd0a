"""A ``Scene`` becomes MJCF: text, meshes, and for every line the place in the user's file that it comes from.

Pure text, written by hand: MuJoCo's own writer keeps six digits, turns inertias and moves meshes. Here numbers
keep all their digits, every element has its own line, and names stay as they are.
"""

from ravemj.formats.mjcf.document import ASSETS, BodyNames, Mjcf, Options, write
from ravemj.formats.mjcf.geoms import rgba
from ravemj.formats.mjcf.inertia import legal_inertial

__all__ = ["ASSETS", "BodyNames", "Mjcf", "Options", "legal_inertial", "rgba", "write"]
