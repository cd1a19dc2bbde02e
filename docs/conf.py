# The site of docs/: scripts/docs builds it into build/docs.
import pathlib
import re

top = pathlib.Path(__file__).resolve().parent.parent
project = "fmbpc"
author = "fmbpc developers"
copyright = "fmbpc developers, BSD-3-Clause"
release = re.search(r"project\(fmbpc VERSION (\S+)", (top / "CMakeLists.txt").read_text())[1]
extensions = ["myst_parser", "breathe"]
breathe_projects = {"fmbpc": str(top / "build/docs/xml")}
breathe_default_project = "fmbpc"
breathe_default_members = ("members",)
source_suffix = {".md": "markdown", ".rst": "restructuredtext"}
myst_heading_anchors = 4
html_theme = "alabaster"
html_theme_options = {"description": "process control with fuzzy model-based predictive control", "page_width": "1100px", "sidebar_width": "240px",
                      "fixed_sidebar": True}
html_sidebars = {"**": ["about.html", "navigation.html", "searchbox.html"]}
html_static_path = []
suppress_warnings = ["myst.header"]
