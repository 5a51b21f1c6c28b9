"""Pages of the C++ API: Doxygen parses include/taut, Breathe renders it, one page per header."""

import pathlib
import subprocess

from .stage import Problem

# Marks the comment at the top of a header as the comment of the file, as Doxygen requires. Warnings are limited to
# errors: unknown parameters, broken references, broken comments.
DOXYFILE = """\
PROJECT_NAME = taut
INPUT = {include}
STRIP_FROM_PATH = {include}
STRIP_FROM_INC_PATH = {include}
RECURSIVE = YES
FILE_PATTERNS = *.h
FILTER_PATTERNS = "*.h=sed -e '1s|^/// |/// \\\\file\\n/// |'"
OUTPUT_DIRECTORY = {output}
GENERATE_XML = YES
GENERATE_HTML = NO
GENERATE_LATEX = NO
EXTRACT_ALL = YES
JAVADOC_AUTOBRIEF = YES
MARKDOWN_SUPPORT = YES
BUILTIN_STL_SUPPORT = YES
ENABLE_PREPROCESSING = YES
MACRO_EXPANSION = YES
INCLUDE_GRAPH = NO
INCLUDED_BY_GRAPH = NO
QUIET = YES
WARNINGS = YES
WARN_AS_ERROR = FAIL_ON_WARNINGS
"""


def headers(root):
    include = pathlib.Path(root) / "include"
    return sorted(str(path.relative_to(include)) for path in include.rglob("*.h"))


def about(path):
    """Returns the first sentence of the comment at the top of a header."""
    words = []
    for line in path.read_text().splitlines():
        if not line.startswith("///"):
            break
        words.append(line[3:].strip())
    sentence = " ".join(words)
    for end in (". ", ": ", "; "):
        sentence = sentence.split(end)[0]
    return sentence.rstrip(".").replace("`", "``")


def run_doxygen(root, folder):
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "Doxyfile").write_text(DOXYFILE.format(include=pathlib.Path(root) / "include", output=folder))
    done = subprocess.run(["doxygen", folder / "Doxyfile"], capture_output=True, text=True)
    if done.returncode != 0 or done.stderr.strip():
        raise Problem(f"Doxygen complains:\n{done.stderr}{done.stdout}")
    for path in (folder / "xml").glob("*_8h.xml"):  # no header documents a namespace that all headers open
        lines = path.read_text().splitlines(keepends=True)
        path.write_text("".join(line for line in lines if "<innernamespace" not in line))


def write_pages(root, to):
    """Writes api/index.rst with one line per header, and one page per header."""
    to.mkdir(parents=True, exist_ok=True)
    names = headers(root)
    rows = []
    for name in names:
        page, title = name.removeprefix("taut/").removesuffix(".h").replace("/", "_"), f"``{name}``"
        rows += [f"   * - :doc:`{name} <{page}>`", f"     - {about(pathlib.Path(root) / 'include' / name)}"]
        (to / f"{page}.rst").write_text("\n".join([title, "=" * len(title), "", f".. doxygenfile:: {name}", ""]))
    intro = ["The C++ interface", "=================", "",
             "Every header compiles alone. ``find_package(taut)`` gives them and the target ``taut::taut``;",
             "what to begin with is in :doc:`../examples/index`.", "", ".. list-table::", "   :widths: 30 70", ""]
    pages = ["", ".. toctree::", "   :hidden:", ""] + [
        "   " + name.removeprefix("taut/").removesuffix(".h").replace("/", "_") for name in names]
    (to / "index.rst").write_text("\n".join(intro + rows + pages) + "\n")
