"""Sphinx configuration of the website; script/website stages its pages and calls Sphinx."""

import os
import pathlib
import re

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
WORK = pathlib.Path(os.environ["TAUT_WEBSITE_WORK"])  # contains source/ and doxygen/
HEADER = (ROOT / "include/taut/version.h").read_text()

project = "taut"
author = "The taut authors"
copyright = "2026 The taut authors, Apache License 2.0"
version = release = re.search(r'kVersion = "(.*)"', HEADER)[1]

extensions = ["myst_parser", "breathe"]
source_suffix = {".md": "markdown", ".rst": "restructuredtext"}
exclude_patterns = ["_static"]
suppress_warnings = ["misc.highlighting_failure"]  # pages may contain YAML with deliberate errors
myst_heading_anchors = 6
highlight_language = "text"
breathe_projects = {"taut": str(WORK / "doxygen/xml")}
breathe_default_project = "taut"
breathe_show_include = False
breathe_domain_by_extension = {"h": "cpp"}

html_theme = "furo"
html_title = f"taut {version}"
html_static_path = [str(WORK / "source/_static")]
html_css_files = ["site.css"]
html_copy_source = False
html_show_sphinx = False
html_theme_options = {"light_css_variables": {"color-brand-primary": "#0072b2", "color-brand-content": "#0072b2"},
                      "dark_css_variables": {"color-brand-primary": "#56b4e9", "color-brand-content": "#56b4e9"}}
