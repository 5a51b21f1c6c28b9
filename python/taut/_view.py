"""`taut.view`: the interactive page of a run, in a notebook's cell or in a browser."""

import html
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import webbrowser
from typing import Sequence, Union

from taut import _core
from taut._core import Run

Source = Union[str, "os.PathLike[str]", Run]


def _command() -> list[str]:
    """Returns the start of the command line that runs `taut` of this module's version."""
    if hasattr(_core, "main"):  # a wheel contains the command
        return [sys.executable, "-m", "taut"]
    package = pathlib.Path(_core.__file__).resolve().parent
    # In a build folder, the command is next to the folder python; an installed command is on the PATH.
    beside = package.parent.parent / "taut"
    found = str(beside) if beside.is_file() else shutil.which("taut")
    if not found:
        raise FileNotFoundError("taut.view needs the command `taut`, which is neither in the build folder nor on the PATH")
    return [found]


def _folder_of(run: Source, what: str, scratch: pathlib.Path, number: int) -> str:
    """Returns the path of a run; a run in memory is written to a folder in `scratch`."""
    if isinstance(run, Run):
        folder = str(scratch / f"run_{number}")
        run.save(folder)
        return folder
    if not isinstance(run, (str, os.PathLike)):
        raise TypeError(f"{what}: {run!r}; expected a taut.Run, or the path of a run's folder or trace")
    return os.fspath(run)


class View:
    """Page of a run. A notebook shows it as the output of a cell; `show()` opens it in a browser."""

    def __init__(self, page: str, height_px: int) -> None:
        self.html = page  # text of the page: one file without references to other files
        self.height_px = height_px

    def _repr_html_(self) -> str:
        # Non-ASCII letters become numeric references, because the encoding of the notebook's page is unknown.
        escaped = html.escape(self.html).encode("ascii", "xmlcharrefreplace").decode()
        return (f'<iframe srcdoc="{escaped}" title="taut: run" allowfullscreen '
                f'style="width:100%;height:{self.height_px}px;border:0"></iframe>')

    def __repr__(self) -> str:
        return f"<taut.View: page of {len(self.html) / 1e6:.1f} MB; show() opens it, save(path) writes it>"

    def save(self, path: Union[str, "os.PathLike[str]"]) -> None:
        """Writes the page as an HTML file."""
        pathlib.Path(path).write_text(self.html, encoding="utf-8")

    def show(self) -> str:
        """Opens the page in a browser. Returns the path of its file, which the system's folder for temporary files
        keeps."""
        with tempfile.NamedTemporaryFile("w", prefix="taut_", suffix=".html", delete=False, encoding="utf-8") as file:
            file.write(self.html)
        webbrowser.open(pathlib.Path(file.name).as_uri())
        return file.name


def view(run: Source, compare: Sequence[Source] = (), *, height_px: int = 720) -> View:
    """Shows a run: the moving robot, plots and tables, as in the page of `taut report`.

        ran = taut.run(taut.load("experiments/push_20n.yaml"))
        taut.view(ran)                                    # last line of a notebook's cell
        taut.view("runs/push_20n", ["runs/a"]).show()     # in a program

    `run`: a `taut.Run`, or the path of a run's folder or trace. `compare`: at most 7 other runs, drawn as ghosts and as
    further curves. `height_px`: height of the page in the notebook [pixels].

    The page is one file, so a saved notebook keeps it and shows it without a kernel. Requires the command `taut` and
    the viewer's pages, which wheels contain. Raises `RuntimeError`, with the messages of the command, for a run that it
    cannot read.
    """
    if isinstance(compare, (str, os.PathLike, Run)):
        compare = [compare]
    if isinstance(height_px, bool) or not isinstance(height_px, int) or not 100 <= height_px <= 10000:
        raise ValueError(f"height_px: {height_px!r}; expected a whole number, 100 to 10000")
    with tempfile.TemporaryDirectory(prefix="taut_") as scratch:
        words = _command() + ["report", _folder_of(run, "run", pathlib.Path(scratch), 0)]
        for number, other in enumerate(compare):
            words += ["--compare", _folder_of(other, f"compare[{number}]", pathlib.Path(scratch), number + 1)]
        page = pathlib.Path(scratch) / "report.html"
        done = subprocess.run([*words, "--out", str(page)], stdin=subprocess.DEVNULL, capture_output=True, text=True,
                              check=False)
        if done.returncode != 0:
            raise RuntimeError(f"taut.view: {done.stderr.strip()}")
        return View(page.read_text(encoding="utf-8"), height_px)
