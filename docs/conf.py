"""How Sphinx builds these pages; ``scripts/docs --html`` calls it."""

import sys
from pathlib import Path

sys.path[:0] = [str(Path(__file__).parent / "extensions"), str(Path(__file__).parent.parent)]

import ravemj  # noqa: E402 - this repository's

project = "ravemj"
version = release = ravemj.__version__
html_title = f"ravemj {release}"
html_theme = "furo"
html_static_path = ["extensions/pages.css"]
html_css_files = ["pages.css"]
html_extra_path = ["motions"]  # beside the pages that hold them
html_copy_source = html_show_sourcelink = False
html_show_copyright = html_show_sphinx = False

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "sphinx.ext.viewcode", "reference", "figures"]
myst_heading_anchors = 3

toc_object_entries_show_parents = "hide"
autodoc_typehints = "none"  # the extension writes them
autoclass_content = "both"
autodoc_member_order = "bysource"
python_use_unqualified_type_names = True
napoleon_google_docstring = True
napoleon_numpy_docstring = False
napoleon_attr_annotations = False
napoleon_use_ivar = True

nitpick_ignore_regex = [  # pages of others, which a build without network knows nothing of
    ("py:class", r"(collections|concurrent|mujoco|np|numpy|optparse|os|weakref)\..*|EllipsisType|NDArray|Path"),
    ("py:class", r"Parameters|Result"),  # type variables
    # Names of types: of JSON, of functions that scripts hand in, of what modules take.
    (
        "py:class",
        r"Argument|(Grasp)?Answer|GraspResult|Hull|Run|Viewpoint"
        r"|BodyCallback|Certify|Command|Constraint|Feedback|FilterFunction|Json|PlanCallback|RootSets"
        r"|SaveArguments|Send|Sets|State|Waypoints|Executor|Function|Items|Method|Model|Progress|Proof|Told",
    ),
    ("py:class", r"Animation|View"),  # results with a line or two to say
    (
        "py:class",
        r"Body|BodyConfiguration|BodyPart|DescribedSensor|BatchSolutions|IkBatch|ArmSolutions|ravemj\.core\.handles\.Handle|IkParameterizationData|Simulation|SimulationRenderer|_\w+",
    ),  # below the API
]
