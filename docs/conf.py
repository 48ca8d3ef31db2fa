"""How the documentation is built: everything from this checkout, nothing from the network."""

from __future__ import annotations

import os
import re
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent / "extensions"))
# One thread for linear algebra: the examples run while pages are written on the other cores.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from coaxshell import __version__

project = "coaxshell"
author = "coaxshell contributors"
copyright = "coaxshell contributors, BSD-3-Clause"
version = release = __version__

extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "sphinx_copybutton",
    "sphinx_gallery.gen_gallery",
    "mathml",
    "sources",
    "generated",
    "typography",
]
exclude_patterns = [
    "built",
    "checks",
    "extensions",
    "pictures",
    "generated/doctrees",
    "generated/report",
    "tutorials/**/*.py",
    "tutorials/*.ipynb",
    "**/sg_execution_times.rst",
    "sg_execution_times.rst",
]
suppress_warnings = ["config.cache"]  # the gallery's settings hold names that Sphinx does not need to compare
nitpicky = False

# Markdown
myst_enable_extensions = ["dollarmath", "amsmath", "deflist", "colon_fence", "fieldlist"]
myst_heading_anchors = 4
myst_links_external_new_tab = False
html_math_renderer = "mathml"
math_eqref_format = "({number})"

# Reference, from the docstrings
autodoc_member_order = "bysource"
autodoc_typehints = "none"  # the docstrings tell types together with shapes and units
autodoc_preserve_defaults = False  # read from the source, they lack the keywords that many functions share, which ends in an error
autoclass_content = "class"
napoleon_google_docstring = False
napoleon_use_rtype = False
napoleon_use_param = False
napoleon_use_ivar = False
python_use_unqualified_type_names = True
python_display_short_literal_types = True
python_maximum_signature_line_length = 88
add_module_names = False

# Gallery: the examples are run at every build, and every one is also a notebook.
sphinx_gallery_conf = {
    "examples_dirs": "../examples",
    "gallery_dirs": "tutorials",
    "filename_pattern": r"\.py$",
    "within_subsection_order": "FileNameSortKey",
    "capture_repr": ("_repr_html_",),
    "download_all_examples": False,
    "show_memory": False,
    "write_computation_times": False,
    "show_signature": False,
    "min_reported_time": 1e6,
    "abort_on_example_error": True,
    "remove_config_comments": True,
    "image_scrapers": ("figures.scrape",),
    "matplotlib_animations": False,
    "copyfile_regex": r".*\.(csv|toml)$",
}
copybutton_exclude = ".linenos, .gp, .go"
copybutton_prompt_text = r"\$ |>>> "
copybutton_prompt_is_regexp = True

# Pages
html_theme = "furo"
html_title = f"coaxshell {release}"
html_static_path = ["static"]
html_css_files = ["coaxshell.css"]
html_copy_source = False
html_show_sourcelink = False
html_theme_options = {
    "navigation_with_keys": True,
    "light_css_variables": {"color-brand-primary": "#005b93", "color-brand-content": "#0067a5", "color-brand-visited": "#0067a5"},
    "dark_css_variables": {"color-brand-primary": "#6cc0f5", "color-brand-content": "#7cc6f6", "color-brand-visited": "#7cc6f6"},
}
pygments_style = "friendly"
pygments_dark_style = "native"


def without_placeholders(app, what, name, obj, options, signature, result):
    """Show a required argument as one: its default in the code only tells that it was left out."""
    return (re.sub(r"\s*=\s*<required>", "", signature) if signature else signature, result)


def no_type_before_a_colon(app, what, name, obj, options, lines):
    """Keep a colon in the one line of an attribute from being read as the end of its type."""
    if what in ("attribute", "data", "property") and lines:
        lines[0] = re.sub(r":(?=\s)", " \N{EN DASH}", lines[0])


def setup(app):
    """Connect what is too small for an extension."""
    app.connect("autodoc-process-signature", without_placeholders)
    app.connect("autodoc-process-docstring", no_type_before_a_colon, priority=400)
