"""Sphinx configuration: make docs."""

import os
from importlib import metadata

project, author = "damperopt", "the damperopt authors"
release = metadata.version("damperopt")
extensions = ["myst_nb", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "sphinx-mathjax-offline"]
exclude_patterns = ["_build", "notebooks/*.ipynb"]

html_theme = "pydata_sphinx_theme"
html_title = "damperopt"
html_sidebars = {"**": []}
html_theme_options = {"show_prev_next": True, "navigation_with_keys": True}

myst_enable_extensions = ["dollarmath", "deflist"]
myst_heading_anchors = 3
suppress_warnings = ["myst.header"]  # the page of coefficients begins its sections where its generator does

# notebooks and the validation page run in their own folders; DOCS_EXECUTE=off builds the text alone
nb_execution_mode = os.environ.get("DOCS_EXECUTE", "force")
nb_execution_timeout = 300
nb_execution_raise_on_error = True
nb_merge_streams = True
nb_render_markdown_format = "gfm"  # tables that cells write

napoleon_numpy_docstring, napoleon_google_docstring = True, False
napoleon_use_rtype = False
autodoc_typehints = "none"
autodoc_member_order = "bysource"
