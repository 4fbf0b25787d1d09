# Configuration of the documentation site: `scripts/docs` builds it. Pages are Markdown (MyST), the theme is furo.
# C++ pages come from the docstrings through Doxygen and breathe; `scripts/docs` runs Doxygen first.
import os
import pathlib
import re

root = pathlib.Path(__file__).resolve().parent.parent
header = (root / "lib/eom/version.hpp").read_text()
version = release = ".".join(re.search(rf"EOM_VERSION_{part} (\d+)", header)[1] for part in ("MAJOR", "MINOR", "PATCH"))

project = "eomgen"
author = "eomgen contributors"
copyright = author
language = "en"

extensions = ["myst_parser", "breathe"]
myst_enable_extensions = ["dollarmath", "colon_fence"]
myst_heading_anchors = 4
exclude_patterns = ["schema", "images/make"]
breathe_projects = {"eomgen": os.environ.get("EOMGEN_DOXYGEN_XML", str(root / "build/docs/xml"))}
breathe_default_project = "eomgen"
breathe_default_members = ("members",)

html_theme = "furo"
html_title = f"eomgen {version}"
# Links to files outside docs/ are checked by tests/architecture.
suppress_warnings = ["myst.xref_missing", "ref.myst"]
