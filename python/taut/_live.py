"""`sim.show()` and `batch.show()`: the viewer's page of a world, live while the program steps it."""

import os
import pathlib
import sys
import webbrowser
from typing import TYPE_CHECKING, Any, Optional

from taut import _core

if TYPE_CHECKING:
    from taut._simulation import Simulation


def _web_folder() -> str:
    """Returns the folder of the viewer's pages: $TAUT_WEB, in the package (wheels), in share/taut of the prefix, or in
    the build folder."""
    package = pathlib.Path(_core.__file__).resolve().parent
    given = os.environ.get("TAUT_WEB")
    folders = [pathlib.Path(given)] if given else [
        folder / web for folder in (package, *package.parents) for web in ("share/taut/web", "web")]
    for folder in folders:
        if (folder / "index.html").is_file():
            return str(folder)
    raise FileNotFoundError(
        f"show() needs the viewer's pages, which are missing: no share/taut/web/index.html in {package} or above it. "
        "Install a wheel that contains them, or build them (apt-get install nodejs npm, then script/build) and set "
        "TAUT_WEB to their folder")


def _notebook() -> Optional[Any]:
    """Returns the module IPython.display in a notebook, otherwise nothing."""
    ipython = sys.modules.get("IPython")
    shell = ipython.get_ipython() if ipython is not None else None
    if getattr(shell, "kernel", None) is None:
        return None
    import IPython.display
    return IPython.display


class LiveView:
    """Live page of a world, made by `Simulation.show` or `Batch.show`. A `with` block closes it at its end."""

    def __init__(self, view: "_core.LiveView") -> None:
        self._view = view

    @property
    def url(self) -> str:
        """Address of the page with a secret token, for browsers on this machine."""
        return self._view.url

    @property
    def closed(self) -> bool:
        """Whether the server has ended."""
        return self._view.closed

    def close(self) -> None:
        """Ends the server. Open pages keep the last picture; the simulation remains usable."""
        self._view.close()

    def __enter__(self) -> "LiveView":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"<taut.LiveView: {'closed' if self.closed else self.url}>"


def _opened(view: "_core.LiveView", browser: Optional[bool], height_px: int) -> LiveView:
    live = LiveView(view)
    display = _notebook() if browser is None else None
    if display is not None:
        display.display(display.IFrame(live.url, "100%", height_px))
    elif browser is not False and not webbrowser.open(live.url):
        print(f"no browser can be opened here; the page is {live.url}")
    return live


def _checked(browser: Optional[bool], height_px: int) -> None:
    if browser is not None and not isinstance(browser, bool):
        raise TypeError(f"browser: {browser!r}; expected True, False or None")
    if isinstance(height_px, bool) or not isinstance(height_px, int) or not 100 <= height_px <= 10000:
        raise ValueError(f"height_px: {height_px!r}; expected a whole number, 100 to 10000")


def show_simulation(sim: "Simulation", world: int = 0, *, browser: Optional[bool] = None, port: int = 0,
                    height_px: int = 720) -> LiveView:
    """Shows a world live in the viewer, while the program steps it.

        sim = taut.Simulation("experiments/roll_six_strut.yaml")
        view = sim.show()
        for _ in range(600):
            sim.run_until(sim.time_s()[0] + 1 / 60)
            time.sleep(1 / 60)

    In a notebook, the page appears below the cell; otherwise a browser opens. `browser` True opens a browser in a
    notebook, too; False opens nothing, and you open `view.url`. `port`: port on this machine; 0: a free one.
    `height_px`: height in a notebook [pixels].

    Returns at once. The page gets at most 60 states per second of wall time; the program waits neither for the page nor
    for the wall clock, and its results remain bit-identical. A pause in the page only holds the picture: scrub to
    earlier states, and press play to follow again. The server accepts only connections of this machine, with the secret
    token in `view.url`. It ends with `view.close()`, with the program, or once neither the simulation nor the view
    exists. A second call for the same world returns the same page. Raises FileNotFoundError if the viewer's pages are
    not installed.
    """
    _checked(browser, height_px)
    return _opened(_core.show_simulation(sim, world, _web_folder(), port), browser, height_px)


def show_batch(batch: "_core.Batch", world: int = 0, *, browser: Optional[bool] = None, port: int = 0,
               height_px: int = 720) -> LiveView:
    """Shows a world live in the viewer, while the program steps the batch; see `Simulation.show`."""
    _checked(browser, height_px)
    return _opened(_core.show_batch(batch, world, _web_folder(), port), browser, height_px)
