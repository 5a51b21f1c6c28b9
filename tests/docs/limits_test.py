"""Checks docs/limits.md: the tests in its tables exist, and its numbers equal the constants of the code."""

import re

from attacks_test import names
from page import ROOT, Page, refuse

# First words of a row: the file, and the constant that equals the first number of the row
CONSTANTS = {
    "YAML file": ("src/description/yaml/yaml_tree.h", "kMaxFileBytes"),
    "nodes of a YAML file": ("src/description/yaml/yaml_tree.h", "kMaxYamlNodes"),
    "nesting of YAML": ("src/description/yaml/yaml_tree.h", "kMaxYamlDepth"),
    "name": ("src/description/yaml/reader.h", "kMaxNameLength"),
    "expression": ("src/description/yaml/expression.cpp", "kMaxLength"),
    "nesting of an expression": ("src/description/yaml/expression.cpp", "kMaxNesting"),
    "mapping file": ("src/compare/mapping.cpp", "kMaxBytes"),
    "nodes of a model": ("src/description/model/model_text.h", "kMaxModelNodes"),
    "node references of": ("src/description/model/model_text.h", "kMaxModelEnds"),
    "copies of a placement": ("src/description/model/model_text.h", "kMaxCopies"),
    "builders": ("src/description/model/model_text.h", "kMaxBuilders"),
    "tags of": ("src/description/model/model_text.h", "kMaxTags"),
    "pairs of shapes of": ("src/sim/compile/model_check.h", "kMaxMovingShapePairs"),
    "pairs of a moving": ("src/sim/compile/model_check.h", "kMaxShapePairs"),
    "pairs of cables": ("src/sim/compile/model_check.h", "kMaxCouplings"),
    "corners of a `convex`": ("include/taut/model_def.h", "kMostCorners"),
    "corners of an object": ("include/taut/model_def.h", "kMostCorners"),
    "objects in": ("src/description/model/model_convex.cpp", "kMostParts"),
    "spans of a cable": ("include/taut/model_def.h", "kMostSpans"),
    "edges and rods": ("include/taut/model_def.h", "kMostBends"),
    "hidden neurons": ("include/taut/gait.h", "kMostHidden"),
    "oscillators": ("src/description/gait/gait_couplings.cpp", "kMaxOscillators"),
    "directions held": ("include/taut/statics.h", "kMostHeldDirections"),
    "planes of": ("src/sim/data/view.h", "kMaxPlanes"),
    "boxes of": ("src/description/experiment/terrain_boxes.h", "kMostBoxes"),
    "mesh file": ("src/description/assets/mesh_file.cpp", "kMostMeshBytes"),
    "height file": ("src/description/assets/height_csv.cpp", "kMostTableBytes"),
    "heights of all height fields": ("src/description/experiment/ground_keys.h", "kMostHeights"),
    "heights of all packed files": ("src/trace/unpack_limit.h", "kAlwaysUnpackedBytes"),
    "corners of a height formula": ("src/description/experiment/ground.cpp", "kMostByFormula"),
    "operations and operands": ("src/description/experiment/ground.cpp", "kMostSteps"),
    "entries of a mesh's search grid": ("src/sim/geometry/surface_build.cpp", "kEntriesPerTriangle"),
    "MJCF file": ("src/mjcf/xml.cpp", "kMostBytes"),
    "elements and comments": ("src/mjcf/xml.cpp", "kMostElements"),
    "attributes of": ("src/mjcf/xml.cpp", "kMostAttributes"),
    "files of": ("src/mjcf/xml.cpp", "kMostFiles"),
    "nesting of groups in an HDF5 trace": ("src/trace/hdf5_links.cpp", "kMostGroups"),
    "nesting of MJCF elements, with": ("src/mjcf/xml.cpp", "kDeepest"),
    "geoms of": ("src/mjcf/read_bodies.cpp", "kMostGeoms"),
    "nodes of an NTRT structure": ("src/import_ntrt/ntrt_structure.h", "kMostItems"),
    "pairs of an NTRT structure": ("src/import_ntrt/ntrt_structure.h", "kMostItems"),
    "substructures of": ("src/import_ntrt/read.cpp", "kMostStructures"),
    "NTRT files": ("src/import_ntrt/read.cpp", "kDeepest"),
    "line of": ("src/trace/csv_lines.cpp", "kMaxLineBytes"),
    "errors reported": ("src/trace/csv_reader.cpp", "kMaxErrors"),
    "packed trace": ("src/trace/unpack_limit.h", "kAlwaysUnpackedBytes"),
    "text of an attribute": ("src/trace/hdf5_file.cpp", "kMaxTextBytes"),
    "times in": ("src/export/convert_trace.cpp", "kMostSeconds"),
    "parameters of": ("src/description/study/study_vary.cpp", "kMostParameters"),
    "delay of a sensor": ("src/description/experiment/experiment_sensors.cpp", "kLongest"),
    "delay of actions": ("src/description/experiment/environment.cpp", "kMostPeriods"),
    "worlds of": ("python/core/worlds.h", "kMost"),
    "threads in": ("python/core/text.cpp", "kMost"),
    "pages open at once": ("apps/viewer/server.cpp", "kMaxClients"),
    "pages open at once that only": ("apps/viewer/server.cpp", "kMaxWatchers"),
    "unfinished HTTP requests": ("apps/viewer/server.h", "max_http"),
    "header of": ("apps/viewer/http_sockets.cpp", "kMaxHeaderBytes"),
    "message to": ("apps/viewer/command.h", "kMaxMessageBytes"),
    "messages that a page": ("apps/viewer/server.h", "max_unread_bytes"),
    "commands of all pages": ("apps/viewer/session.cpp", "kMaxWaiting"),
    "requests for plots": ("apps/viewer/session.cpp", "kMaxSeriesWaiting"),
    "commands to a robot": ("apps/viewer/robot_session.cpp", "kMaxCommands"),
    "runs compared": ("apps/viewer/command.h", "kMaxComparedRuns"),
    "parts of": ("apps/viewer/recording.h", "kMaxParts"),
    "history of": ("apps/viewer/history.h", "kMaxBytes"),
    "numbers in a report": ("apps/viewer/report.h", "kMaxReportNumbers"),
    "frames of the animation": ("apps/viewer/report_page.cpp", "kMaxFrames"),
    "corners drawn": ("apps/viewer/scene.cpp", "kMostCorners"),
    "address of a share link": ("web/src/demo/link.ts", "MOST_CHARACTERS"),
    "text of a message": ("src/base/diagnostics.cpp", "kMostBytes"),
    "names in": ("src/base/diagnostics.cpp", "kMostNamed"),
    "linear systems": ("include/taut/world_batch.h", "max_linear_solves"),
    "load cases and combinations": ("src/description/experiment/load_combinations.h", "kMostCases"),
    "forces, settlements and": ("src/description/experiment/load_combinations.h", "kMostLoads"),
    "loads of all": ("src/description/experiment/load_combinations.h", "kMostExamined"),
    "numeric values in": ("src/trace/mcap_trace.cpp", "kMostMcapValues"),
    "name of a channel in": ("src/trace/mcap_reader.h", "kMostMcapNameBytes"),
    "fields and elements of": ("src/trace/ros2_message.cpp", "kFreeSteps"),
    "angles in": ("src/math/elementary.h", "kMaxAngle"),
}
# Rows without a constant: ranges of keys, and the limit of a library
WITHOUT = ("columns, and rows", "nesting of MJCF elements of one file", "starts of", "times of a trace", "step", "duration")
UNITS = {"MB": 1e6, "KiB": 1 << 10, "MiB": 1 << 20, "GiB": 1 << 30}


def key_of(what, keys):
    """Returns the longest key with which a row begins."""
    found = [key for key in keys if what == key or (what.startswith(key) and not what[len(key)].isalnum())]
    return max(found, key=len, default=None)


def value_of(path, constant):
    found = re.search(rf"\b{constant} = ([^;,]+?)[;,]", (ROOT / path).read_text())
    if not found:
        return None
    text = re.sub(r"std::\w+\{(\d+)\}", r"\1", found[1]).replace("'", "").replace("_", "")
    return float(eval(re.sub(r"\b(\d+)u\b", r"\1", text), {"__builtins__": {}}))  # sums and shifts of numbers


def number_of(cell):
    number, unit = re.match(r"([\d,.]+(?:e\d+)?) ?(\w*)", cell).groups()
    return float(number.replace(",", "")) * UNITS.get(unit, 1)


def main():
    there, wrong, used = names(), [], set()
    rows = [(line, [cell.strip() for cell in text.strip("| ").split(" | ")]) for line, text in Page(ROOT / "docs/limits.md").prose
            if text.startswith("| ") and not text.startswith("| item |")]
    for line, cells in rows:
        what, limit, tests = cells[0], cells[1], re.findall(r"`([A-Z]\w+\.\w+)`", cells[-1])
        at = f"docs/limits.md:{line}: {what}"
        wrong += [f"{at}: there is no test {name}" for name in tests if name not in there]
        if not tests:
            wrong.append(f"{at}: no test holds it")
        if key_of(what, WITHOUT):
            continue
        key = key_of(what, CONSTANTS)
        if key is None:
            wrong.append(f"{at}: no constant of it is known here")
            continue
        used.add(key)
        path, constant = CONSTANTS[key]
        value = value_of(path, constant)
        if value is None:
            wrong.append(f"{at}: {path} has no constant {constant}")
        elif number_of(limit) != value:
            wrong.append(f"{at}: {limit} on the page, {value:g} in {path}")
    wrong += [f"docs/limits.md: no row begins with {key}" for key in CONSTANTS if key not in used]
    assert len(rows) > 60, f"{len(rows)} rows"
    refuse(wrong)


if __name__ == "__main__":
    main()
