"""The site: ``sphinx-build -W -b html docs docs/_build``, with the extra ``docs``."""

from importlib.metadata import version as installed

project = "exactmesh"
author = "The exactmesh developers"
copyright = author  # Sphinx's own name
release = version = installed("exactmesh")

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "sphinx.ext.viewcode"]
exclude_patterns = ["_build"]

myst_heading_anchors = 3

autodoc_member_order = "bysource"
autodoc_typehints = "signature"
autodoc_type_aliases = {"npt.ArrayLike": "ArrayLike", "FloatArray": "FloatArray", "IntArray": "IntArray"}
napoleon_google_docstring = True
napoleon_numpy_docstring = False
napoleon_use_ivar = True
#: An attribute's name is looked for in all classes; that several have one of that name is no fault.
suppress_warnings = ["ref.python"]

html_theme = "furo"
html_title = "exactmesh"
html_static_path = ["_static"]
