"""Sphinx configuration: pages are executed, warnings are errors, reference and nomenclature come from the package."""

import os
import sys
from pathlib import Path

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE))
os.environ.pop("MPLBACKEND", None)  # which tests set: pages show what they draw

import generate  # noqa: E402

project = "torsional"
author = "The torsional developers"
copyright = "2026, The torsional developers"
release = generate.release()

extensions = ["myst_nb", "sphinx.ext.autodoc", "sphinx.ext.viewcode", "mathml"]
html_math_renderer = "mathml"
myst_update_mathjax = False
exclude_patterns = ["_build", "jupyter_execute"]
html_theme = "furo"
html_static_path = ["_static"]
html_css_files = ["formulas.css"]
html_title = f"torsional {release}"

myst_enable_extensions = ["dollarmath", "amsmath", "deflist", "colon_fence"]
myst_heading_anchors = 3
nb_execution_mode = "auto"
nb_execution_raise_on_error = True
nb_execution_timeout = 300
nb_merge_streams = True
nb_output_stderr = "warn"  # a page that warns its reader is not finished

suppress_warnings = ["ref.python"]  # several kernels' tables have a column `torque`: a reference to one may be to any

autodoc_member_order = "bysource"
autodoc_typehints = "signature"

generate.write_all(HERE / "_generated")


def setup(app):
    """Docstrings are plain text with code in double backticks; see `generate.restructured`."""
    app.connect("autodoc-process-docstring", generate.process_docstring)
