"""Figures of traces for papers, drawn with matplotlib.

    from taut.plot import plot
    plot("runs/push_20n", "push.pdf", ["cable/outer_*/tension_n"], width_mm=88)

or in a terminal:

    taut plot runs/drop --with lab.csv --channels 'cable/*/tension_n' --out drop.pdf

The command `taut plot` contains the text of this file, which therefore imports nothing of taut until it reads a trace.
Matplotlib draws and writes PDF, SVG and PNG. It embeds fonts, and most users of Python already have it; a separate PDF
writer would have to subset fonts. Matplotlib is optional: `pip install matplotlib`.
"""

import fnmatch
import json
import math
import os
import pathlib
import sys

MM_PER_INCH = 25.4
# Okabe and Ito's eight colors, which remain distinct with color vision deficiencies.
COLORS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000", "#f0e442")
STYLES = ("-", "--", ":", "-.")   # line styles of the runs
PHASE = "#e9edf1"                 # background of every other phase
MOST_CHANNELS = 24
NO_MATPLOTLIB = 4   # exit status of `main`


def _read(run):
    """Returns the trace of a path, a folder or a `Run`; returns a trace unchanged."""
    if isinstance(run, (str, os.PathLike)):
        from taut import read_trace
        return read_trace(os.fspath(run))
    return run.trace if hasattr(run, "trace") else run


def _name(run, number):
    if isinstance(run, (str, os.PathLike)):
        path = pathlib.Path(run)
        return path.parent.name if path.stem == "trace" and path.parent.name else path.stem
    return f"run {number + 1}"


def phases_of(run):
    """Returns the phases (name, from_s, to_s) of a run's folder; none for a file without a summary."""
    if not isinstance(run, (str, os.PathLike)):
        return []
    path = pathlib.Path(run)
    # A live run writes trace_2.h5 and summary_2.json after a reset.
    name = "summary.json" if path.is_dir() else path.stem.split(".")[0].replace("trace", "summary") + ".json"
    summary = (path if path.is_dir() else path.parent) / name
    if not summary.name.startswith("summary") or not summary.exists():
        return []
    phases = json.loads(summary.read_text(encoding="utf-8")).get("phases", [])
    return [(p["name"], p["from_s"], p["to_s"]) for p in phases]


def _matching(trace, patterns):
    found = []
    for pattern in patterns:
        names = [n for n in trace.channels if fnmatch.fnmatchcase(n, pattern)]
        if not names:
            raise ValueError(f"no channel matches \"{pattern}\" (the trace has {', '.join(trace.channels[:4])}, ...)")
        found += [n for n in names if n not in found]
    return found


def _short(names):
    """Returns the parts of the names that differ, such as cable names."""
    parts = [name.split("/") for name in names]
    if len(names) < 2 or len({len(p) for p in parts}) > 1:
        return list(names)
    differing = [i for i in range(len(parts[0])) if len({p[i] for p in parts}) > 1]
    return ["/".join(p[i] for i in differing) for p in parts]


def _quantity(name, unit):
    word = name.rsplit("/", 1)[-1]
    for end in ("_" + unit.replace("/", "_per_").lower(), "_" + unit.lower()):
        word = word[:-len(end)] if unit and word.lower().endswith(end) else word
    return word.replace("_", " ") + (f" [{unit}]" if unit not in ("", "1") else "")


def _clipped(phases, from_s, to_s):
    """Returns the parts of the phases within a time span."""
    parts = [(name, begin if from_s is None else max(begin, from_s), end if to_s is None else min(end, to_s))
             for name, begin, end in phases]
    return [part for part in parts if part[1] < part[2]]


def _shade(axes, phases, named):
    for i, (name, from_s, to_s) in enumerate(phases):
        if i % 2 == 0:
            axes.axvspan(from_s, to_s, color=PHASE, linewidth=0, zorder=0)
        if named:
            axes.annotate(name, (0.5 * (from_s + to_s), 1), xycoords=("data", "axes fraction"), xytext=(0, 2),
                          textcoords="offset points", ha="center", va="bottom", fontsize="small", annotation_clip=True)


def _legend(axes, width_mm, height_mm, entries):
    """Adds a legend below axes of this height in a figure of this width, where it hides no data."""
    ticks_and_label_mm, column_mm = 10, 35
    axes.legend(loc="upper left", bbox_to_anchor=(0, -ticks_and_label_mm / height_mm), frameon=False, fontsize="small",
                ncols=max(1, min(4, int(width_mm / column_mm), entries)), borderaxespad=0, handlelength=1.5, columnspacing=1)


def _window(trace, name, from_s, to_s):
    """Returns times and values of a channel within a time span."""
    rows = [(t, x) for t, x in zip(trace.time_s, trace[name])
            if (from_s is None or t >= from_s) and (to_s is None or t <= to_s)]
    return [t for t, _ in rows], [x for _, x in rows]


def _draw(axes, name, color, traces, measured, labels, label, span):
    for trace, style, run in zip(traces, STYLES, labels):
        if name in trace:
            text = label if len(traces) == 1 else f"{label} {run}".strip()
            axes.plot(*_window(trace, name, *span), style, color=color, linewidth=1, label=text)
    if measured is not None and name in measured:
        axes.plot(*_window(measured, name, *span), "o", color=color, markersize=2, alpha=0.6, markeredgewidth=0)


def plot(runs, out, channels, measured=None, *, width_mm=88, height_mm=None, layout=None, labels=None, phases=None,
         from_s=None, to_s=None, dpi=300):
    """Draws channels of runs over time and writes the figure.

    `runs`: a path, a folder of a run, a `taut.Run` or a `taut.Trace`, or a list of at most four. `out`: file with the
    extension .pdf, .svg or .png. `channels`: patterns such as "cable/*/tension_n". `measured`: trace or path, drawn as
    dots over the lines. `layout`: "one" axis for all channels, which must have one unit, or "many": one small plot per
    channel; default: "one" for at most eight channels with one unit. `phases`: list of (name, from_s, to_s) to shade;
    default: the phases in the first run's folder. Returns the matplotlib figure. Raises ValueError for channels that do
    not exist and ImportError without matplotlib."""
    runs = list(runs) if isinstance(runs, (list, tuple)) else [runs]
    suffix = pathlib.Path(out).suffix.lower()
    if suffix not in (".pdf", ".svg", ".png"):
        raise ValueError(f"unknown figure format \"{suffix}\" (expected .pdf, .svg or .png)")
    if not 1 <= len(runs) <= len(STYLES):
        raise ValueError(f"{len(runs)} runs (expected 1 to {len(STYLES)})")
    if layout not in (None, "one", "many"):
        raise ValueError(f"unknown layout \"{layout}\" (expected one or many)")
    phases = phases_of(runs[0]) if phases is None else phases
    labels = labels or [_name(run, i) for i, run in enumerate(runs)]
    traces = [_read(run) for run in runs]
    measured = None if measured is None else _read(measured)
    names = _matching(traces[0], [channels] if isinstance(channels, str) else channels)
    units = {name: traces[0].units[name] for name in names}
    if layout == "one" and len(set(units.values())) > 1:
        raise ValueError(f"one axis cannot show the units {', '.join(sorted(set(units.values())))}: use layout=\"many\"")
    if len(names) > MOST_CHANNELS:
        raise ValueError(f"{len(names)} channels (expected at most {MOST_CHANNELS})")
    if measured is not None and not any(name in measured for name in names):
        raise ValueError("the measurement has none of the channels (its channels must have taut's names)")
    return _write(out, suffix, traces, measured, units, layout, labels, phases, (from_s, to_s), width_mm, height_mm, dpi)


def _write(out, suffix, traces, measured, units, layout, labels, phases, span, width_mm, height_mm, dpi):
    """Draws a figure and writes it to `out`, a path or a stream of bytes. `units`: units of the channels to draw, by
    name. Returns the figure."""
    try:
        import matplotlib
        from matplotlib.figure import Figure
    except ImportError as error:
        raise ImportError("plots need matplotlib: pip install matplotlib, or apt install python3-matplotlib") from error

    names = list(units)
    phases = _clipped(phases, *span)
    layout = layout or ("one" if len(names) <= len(COLORS) and len(set(units.values())) == 1 else "many")
    columns = 1 if layout == "one" else min(3, math.ceil(math.sqrt(len(names))))
    lines = 1 if layout == "one" else math.ceil(len(names) / columns)
    height_mm = height_mm or (0.65 * width_mm if layout == "one" else max(0.65 * width_mm, 32 * lines))
    # Type 42 embeds whole glyphs as TrueType in PDF; "path" draws the text of SVG as outlines.
    with matplotlib.rc_context({"pdf.fonttype": 42, "svg.fonttype": "path", "svg.hashsalt": "taut", "font.size": 8,
                                "axes.spines.top": False, "axes.spines.right": False}):
        figure = Figure(figsize=(width_mm / MM_PER_INCH, height_mm / MM_PER_INCH), layout="constrained")
        grid = figure.subplots(lines, columns, sharex=True, squeeze=False)
        if layout == "one":
            axes = grid[0][0]
            for i, (name, label) in enumerate(zip(names, _short(names))):
                _draw(axes, name, COLORS[i % len(COLORS)], traces, measured, labels, label if len(names) > 1 else "", span)
            axes.set(xlabel="time [s]", ylabel=_quantity(names[0], units[names[0]]))
            entries = len(names) * len(traces)
            if measured is not None:
                axes.plot([], [], "o", color="0.3", markersize=2, label="measured")
            if entries > 1 or measured is not None:
                _legend(axes, width_mm, 0.7 * height_mm, entries + (measured is not None))
            _shade(axes, phases, True)
        else:
            flat = [axes for line in grid for axes in line]
            for i, (name, label) in enumerate(zip(names, _short(names))):
                _draw(flat[i], name, COLORS[0], traces, measured, labels, "", span)
                flat[i].set_title(label, fontsize="small")
                flat[i].set_ylabel(_quantity(name, units[name]), fontsize="small")
                _shade(flat[i], phases, False)
            for axes in flat[len(names):]:
                axes.set_visible(False)
            for axes in flat[max(0, len(names) - columns):len(names)]:
                axes.set_xlabel("time [s]")
                axes.tick_params(labelbottom=True)
            lowest = flat[columns * (lines - 1)]
            if measured is not None:
                lowest.plot([], [], "o", color="0.3", markersize=2, label="measured")
            if len(traces) > 1 or measured is not None:
                _legend(lowest, width_mm, 0.5 * height_mm / lines, len(traces) + (measured is not None))
        # Without a date, the same data give the same bytes.
        figure.savefig(out, format=suffix[1:], dpi=dpi, metadata={".pdf": {"CreationDate": None}, ".svg": {"Date": None}}.get(suffix))
    return figure


class _SentTrace:
    """The drawn channels of a trace, as `taut plot` sends them. null: missing value."""

    def __init__(self, sent):
        self.time_s = sent["time_s"]
        self._values = {name: [math.nan if x is None else x for x in row] for name, row in sent["values"].items()}

    def __getitem__(self, name):
        return self._values[name]

    def __contains__(self, name):
        return name in self._values


def main():
    """Draws the figure of `taut plot`, which has checked its arguments and read the traces: reads them as JSON from
    standard input and writes the figure to standard output. Returns the exit status."""
    asked = json.load(sys.stdin)
    paths = asked["paths"]
    labels = [_name(path, i) for i, path in enumerate(paths)]
    measured = _SentTrace(asked["measured"]) if asked["measured"] else None
    try:
        _write(sys.stdout.buffer, asked["format"], [_SentTrace(sent) for sent in asked["runs"]], measured, dict(asked["units"]),
               asked["layout"] or None, labels, phases_of(paths[0]), (asked["from_s"], asked["to_s"]),
               asked["width_mm"], asked["height_mm"], asked["dpi"])
    except ImportError:
        return NO_MATPLOTLIB
    return 0


if __name__ == "__main__":
    sys.exit(main())
