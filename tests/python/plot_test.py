"""Figures of `taut.plot`: size, fonts, formats, errors. Needs matplotlib, but not the compiled module."""

import importlib.util
import json
import math
import pathlib
import re
import struct
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
try:
    from matplotlib.backends.backend_agg import FigureCanvasAgg
except ImportError:
    print("skipped: no matplotlib")
    sys.exit(77)

spec = importlib.util.spec_from_file_location("taut_plot", ROOT / "python/taut/plot.py")
plots = importlib.util.module_from_spec(spec)
spec.loader.exec_module(plots)


class FakeTrace:
    """A trace in memory with the interface of `taut.Trace`."""

    def __init__(self, names, scale=1.0):
        self.time_s = [0.01 * i for i in range(301)]
        self._values = {n: [scale * (k + math.sin(t + k)) for t in self.time_s] for k, n in enumerate(names)}
        self.channels = list(names)
        self.units = {n: "N" if n.endswith("_n") else "m" for n in names}

    def __getitem__(self, name):
        return self._values[name]

    def __contains__(self, name):
        return name in self._values


CABLES = [f"cable/c{i}/tension_n" for i in range(6)]
RUN = FakeTrace(CABLES + ["body/b/position_z_m"])
folder = pathlib.Path(tempfile.mkdtemp(prefix="taut_plot_"))


def raises(part, *args, **more):
    try:
        plots.plot(*args, **more)
    except ValueError as error:
        assert part in str(error), error
        return
    raise AssertionError(f"no error about {part}")


# PDF: exact width, embedded fonts, same bytes for the same data.
pdf = folder / "a.pdf"
figure = plots.plot(RUN, pdf, "cable/*/tension_n", FakeTrace(CABLES, 1.1), width_mm=88, height_mm=60,
                    phases=[("before", 0, 1), ("push", 1, 2), ("after", 2, 3)])
data = pdf.read_bytes()
box = re.search(rb"/MediaBox \[ *0 0 ([\d.]+) ([\d.]+) *\]", data)
assert abs(float(box[1]) - 88 / 25.4 * 72) < 0.1 and abs(float(box[2]) - 60 / 25.4 * 72) < 0.1, box[0]
assert b"/FontFile2" in data and b"/Type3" not in data
plots.plot(RUN, folder / "b.pdf", "cable/*/tension_n", FakeTrace(CABLES, 1.1), width_mm=88, height_mm=60,
           phases=[("before", 0, 1), ("push", 1, 2), ("after", 2, 3)])
assert (folder / "b.pdf").read_bytes() == data
axes = figure.axes[0]
assert axes.get_ylabel() == "tension [N]" and axes.get_xlabel() == "time [s]"
lines = [line for line in axes.lines if line.get_linestyle() == "-"]
dots = [line for line in axes.lines if line.get_marker() == "o"]
assert len(lines) == 6 and len(dots) == 7           # one entry of the legend
assert len({line.get_color() for line in lines}) == 6
assert [text.get_text() for text in axes.get_legend().get_texts()] == [f"c{i}" for i in range(6)] + ["measured"]
assert len(axes.patches) == 2                       # every other phase is shaded
assert {"before", "push", "after"} <= {text.get_text() for text in axes.texts}

# SVG: outlines instead of text, so that no font is needed.
plots.plot(RUN, folder / "a.svg", CABLES[:2])
svg = (folder / "a.svg").read_text()
assert "<text" not in svg and "<path" in svg

# PNG: pixels by width and resolution.
plots.plot([RUN, FakeTrace(CABLES, 0.9)], folder / "a.png", CABLES[:1], width_mm=50.8, height_mm=25.4, dpi=100)
head = (folder / "a.png").read_bytes()[16:24]
assert struct.unpack(">II", head) == (200, 100)

# Small multiples with different units, in a time span.
many = plots.plot(RUN, folder / "m.pdf", ["cable/c?/tension_n", "body/*"], layout="many", from_s=1, to_s=2)
shown = [axes for axes in many.axes if axes.get_visible()]
assert len(shown) == 7
assert shown[6].get_ylabel() == "position z [m]"
assert abs(min(shown[0].lines[0].get_xdata()) - 1) < 1e-9 and abs(max(shown[0].lines[0].get_xdata()) - 2) < 1e-9

# By default, few channels with one unit share an axis.
assert len(plots.plot(RUN, folder / "n.png", "cable/*", dpi=50).axes) == 1
assert len(plots.plot(RUN, folder / "n.png", "*", dpi=50).axes) > 1
assert len(plots.plot(FakeTrace([f"cable/c{i}/tension_n" for i in range(9)]), folder / "n.png", "*", dpi=50).axes) == 9

raises("no channel matches", RUN, pdf, "cable/*/tension")
raises("one axis cannot show the units N, m", RUN, pdf, "*", layout="one")
raises("none of the channels", RUN, pdf, "cable/*", FakeTrace(["c0"]))
raises("25 channels", FakeTrace([f"cable/c{i}/tension_n" for i in range(25)]), pdf, "*")
raises("unknown figure format \".eps\"", RUN, folder / "a.eps", "*")
raises("5 runs", [RUN] * 5, pdf, "cable/*")
raises("unknown layout", RUN, pdf, "cable/*", layout="two")

# Phases of a run's folder.
(folder / "summary.json").write_text(json.dumps({"phases": [{"name": "p", "from_s": 0, "to_s": 1}]}))
assert plots.phases_of(folder) == plots.phases_of(folder / "trace.h5") == [("p", 0, 1)]
assert plots.phases_of(RUN) == []
assert plots.phases_of(folder / "trace_2.h5") == plots.phases_of(folder / "lab.csv") == []
(folder / "summary_2.json").write_text(json.dumps({"phases": [{"name": "q", "from_s": 1, "to_s": 2}]}))
assert plots.phases_of(folder / "trace_2.h5") == [("q", 1, 2)]

# Phases outside the time span do not extend the axis, and the legend stays in the page.
limited = plots.plot(RUN, folder / "n.png", "cable/*", RUN, layout="one", phases=[("a", 0, 1), ("b", 1, 2), ("c", 2, 60)],
                     to_s=2, dpi=50)
assert limited.axes[0].get_xlim()[1] < 2.2, limited.axes[0].get_xlim()
FigureCanvasAgg(limited).draw()
box = limited.axes[0].get_legend().get_window_extent()
assert 0 <= box.x0 and box.x1 <= limited.bbox.x1, (box, limited.bbox)
