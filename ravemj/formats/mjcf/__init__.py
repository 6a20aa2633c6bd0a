"""Translation of a ``Scene`` to MJCF: text, meshes, and for every line its source in the user's file.

The text is generated directly, since MuJoCo's own writer keeps only six digits, rotates inertias and moves meshes. This
writer keeps all digits and names, and writes one element per line.
"""

from ravemj.formats.mjcf.document import ASSETS, BodyNames, Mjcf, write
from ravemj.formats.mjcf.geoms import rgba
from ravemj.formats.mjcf.inertia import legal_inertial
from ravemj.formats.mjcf.options import Options

__all__ = ["ASSETS", "BodyNames", "Mjcf", "Options", "legal_inertial", "rgba", "write"]
