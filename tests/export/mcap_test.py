"""MCAP files of `taut trace convert`, read by @mcap/core and compared with the HDF5 file

Usage: mcap_test.py TEST TAUT. TEST is the name of a function of this file; status 77: a required program is missing.
"""

import shutil
import subprocess
import time
import zlib

import command as run

try:
    import h5py
    import numpy as np
except ImportError:
    run.skip("there is no h5py (apt-get install python3-h5py)")

ROOT = run.ROOT
NEEDS = ["@mcap/core"]


def record(taut, folder, name="push_20n_motors", duration_s=0.6):
    """Makes a short run of an experiment."""
    experiment = ROOT / "share/experiments" / f"{name}.yaml"
    run.taut(taut, folder, "run", experiment, "--duration_s", duration_s, "--csv", "--quiet", "--out", "run")
    return folder / "run"


def convert(taut, folder, what, *words):
    run.taut(taut, folder, "trace", "convert", what, "--out", "out.mcap", "--quiet", *words)
    return run.node("read_mcap.mjs", folder / "out.mcap", needs=NEEDS)


def trace_of(path):
    """Returns the times and the columns by name."""
    columns = {}
    with h5py.File(path) as file:
        file.visititems(lambda name, item: columns.__setitem__(name, item[:]) if isinstance(item, h5py.Dataset) else None)
        attributes = dict(file.attrs)
    return columns.pop("time_s"), columns, attributes


def ns(time_s):
    return int(round(time_s * 1e9))


def by_topic(messages):
    topics = {}
    for message in messages:
        topics.setdefault(message["topic"], []).append(message)
    return topics


def check_numbers(seen, time_s, columns):
    topics = by_topic(seen["indexed"])
    for name, values in columns.items():
        group, *path = name.split("/")
        messages = topics["/" + group]
        assert len(messages) == len(time_s), (name, len(messages))
        for message, t, value in zip(messages, time_s, values):
            assert int(message["log_time"]) == ns(t) and message["publish_time"] == message["log_time"]
            found = message["data"]
            for part in path[:-1]:
                found = found.get(part, {})
            found = found.get(path[-1])
            # Equal to the bit; JSON cannot represent values that are not finite.
            assert found == value if np.isfinite(value) else found is None, (name, t, found, value)
    return topics


def EveryNumberComesBack(taut, folder):
    """200 and more channels, of motors and of contacts, whose slots are empty at times"""
    (folder / "contacts.yaml").write_text(
        f"taut: 1\nkind: experiment\nname: contacts\nbase: {ROOT}/share/experiments/drop_six_strut.yaml\n"
        "record: {rate_hz: 100, contacts: 6}\n"
    )
    for name in ("push_20n_motors", folder / "contacts"):
        folder_of_run = record(taut, folder, name)
        time_s, columns, attributes = trace_of(folder_of_run / "trace.h5")
        seen = convert(taut, folder, folder_of_run)
        topics = check_numbers(seen, time_s, columns)
        assert len(columns) > 200
        if name != "push_20n_motors":
            slots = [v for n, v in columns.items() if n.startswith("contact/")]
            assert np.isnan(slots).any() and np.isfinite(slots).any()
        units = {c["topic"]: c for c in seen["channels"]}
        for topic, messages in topics.items():
            assert [m["sequence"] for m in messages] == list(range(len(messages))), topic
            assert units[topic]["encoding"] == "json" and units[topic]["schema_encoding"] == "jsonschema"
        cable = units["/cable"]["json_schema"]["properties"]
        for of_cable in cable.values():
            assert of_cable["properties"]["tension_n"] == {"type": "number", "description": "N"}
        [own] = seen["metadata"]
        assert own["name"] == "taut"
        for key in ("run", "experiment", "seed", "taut_version"):
            value = attributes[key]
            assert own[key] == (value.decode() if isinstance(value, bytes) else str(value)), key


def TheIndexLeadsToEveryMessage(taut, folder):
    folder_of_run = record(taut, folder, "push_20n_motors", 2)
    seen = convert(taut, folder, folder_of_run)
    time_s, _, _ = trace_of(folder_of_run / "trace.h5")
    assert seen["done"]
    # Reading by the index and reading from start to end give the same messages.
    assert seen["indexed"] == seen["streamed"]
    assert seen["header"]["profile"] == "" and seen["header"]["library"].startswith("taut ")
    statistics = seen["statistics"]
    assert int(statistics["messageCount"]) == len(seen["indexed"])
    assert statistics["channelCount"] == statistics["schemaCount"] == len(seen["channels"])
    assert statistics["metadataCount"] == 1 and statistics["chunkCount"] == len(seen["chunks"]) >= 2
    counts = {topic: len(messages) for topic, messages in by_topic(seen["indexed"]).items()}
    assert sorted(map(int, statistics["channelMessageCounts"].values())) == sorted(counts.values())
    assert int(statistics["messageStartTime"]) == ns(time_s[0])
    assert int(statistics["messageEndTime"]) == ns(time_s[-1])
    records = seen["records"]
    assert records["DataEnd"] == records["Header"] == records["Footer"] == records["Statistics"] == 1
    assert records["SummaryOffset"] == 5 and records["MetadataIndex"] == records["Metadata"] == 1
    # Fields that @mcap/core does not check: the checksum of the data and the offsets of the summary's groups
    data = (folder / "out.mcap").read_bytes()
    start, end = int(seen["footer"]["summaryStart"]), int(seen["footer"]["summaryOffsetStart"])
    assert data[start - 13] == 0x0F and seen["data_crc"] == zlib.crc32(data[: start - 13])
    assert seen["footer"]["summaryCrc"] == zlib.crc32(data[start:-12])
    at = start
    for opcode, group_start, length in seen["offsets"]:
        assert int(group_start) == at and data[at] == opcode, (at, opcode, group_start)
        at += int(length)
    assert at == end
    # A time range returns the messages of that range only.
    low, high = ns(time_s[20]), ns(time_s[40])
    part = run.node("read_mcap.mjs", folder / "out.mcap", low, high, needs=NEEDS)["indexed"]
    assert part == [m for m in seen["indexed"] if low <= int(m["log_time"]) <= high]
    assert 0 < len(part) < len(seen["indexed"])
    # A changed byte is detected.
    damaged = bytearray((folder / "out.mcap").read_bytes())
    damaged[len(damaged) // 2] ^= 1
    (folder / "damaged.mcap").write_bytes(damaged)
    done = subprocess.run(["node", run.NODE_TESTS / "read_mcap.mjs", folder / "damaged.mcap"], capture_output=True, text=True)
    assert done.returncode != 0 and "crc" in done.stderr.lower(), done.stderr


def turned(q, v):
    w, x, y, z = q["w"], q["x"], q["y"], q["z"]
    u, v = np.array([x, y, z]), np.array(v)
    t = 2 * np.cross(u, v)
    return v + w * t + np.cross(u, t)


def vector(v):
    return np.array([v["x"], v["y"], v["z"]])


def ATraceThatBeginsBeforeZeroBeginsAtZero(taut, folder):
    (folder / "early.csv").write_text("time_s,depth_m,a/b_n,a/c_n\n-2.5,1,nan,3\n-2.25,4,5,-inf\n1e3,7,8,9\n")
    seen = convert(taut, folder, "early.csv")
    topics = by_topic(seen["indexed"])
    assert [int(m["log_time"]) for m in topics["/a"]] == [0, 250_000_000, 1_002_500_000_000]
    assert [m["data"] for m in topics["/a"]] == [{"c_n": 3}, {"b_n": 5}, {"b_n": 8, "c_n": 9}]
    assert [m["data"] for m in topics["/values"]] == [{"depth_m": 1}, {"depth_m": 4}, {"depth_m": 7}]
    assert set(topics) == {"/a", "/values"}
    assert int(seen["statistics"]["messageEndTime"]) == 1_002_500_000_000


def FramesAndCablesAreWhereTheRobotIs(taut, folder):
    folder_of_run = record(taut, folder, "drop_six_strut")
    time_s, columns, _ = trace_of(folder_of_run / "trace.h5")
    topics = by_topic(convert(taut, folder, folder_of_run)["indexed"])
    [shapes] = topics["/scene/robot"]
    entities = {e["id"]: e for e in shapes["data"]["entities"]}
    bodies = sorted({name.split("/")[1] for name in columns if name.startswith("body/")})
    assert sorted(entities) == bodies and len(bodies) == 6
    row = len(time_s) // 2
    frames = {f["child_frame_id"]: f for f in topics["/tf"][row]["data"]["transforms"]}
    assert sorted(frames) == bodies
    [lines] = topics["/scene/cables"][row]["data"]["entities"]
    [line] = lines["lines"]
    points = [vector(p) for p in line["points"]]
    assert len(points) == 48 and line["type"] == 2
    # Slack cables are gray: their red and blue differ less than in the blue of the taut cables.
    slack = [values[row] <= 0 for name, values in columns.items() if name.endswith("/tension_n")]
    grey = [abs(c["r"] - c["b"]) < 0.1 for c in line["colors"]]
    assert grey[::2] == grey[1::2] == slack, (grey, slack)
    ends = []
    for name, frame in frames.items():
        assert frame["parent_frame_id"] == "world"
        assert frame["timestamp"] == {"sec": ns(time_s[row]) // 10**9, "nsec": ns(time_s[row]) % 10**9}
        for axis in "xyz":
            assert frame["translation"][axis] == columns[f"body/{name}/position_{axis}_m"][row]
            assert frame["rotation"][axis] == columns[f"body/{name}/orientation_{axis}"][row]
        entity = entities[name]
        assert entity["frame_id"] == name and entity["frame_locked"]
        [rod] = entity["cylinders"]
        # The cylinder's axis is its local z axis, between the balls at its ends.
        along = turned(rod["pose"]["orientation"], [0, 0, 0.5 * rod["size"]["z"]])
        middle = vector(rod["pose"]["position"])
        balls = [vector(ball["pose"]["position"]) for ball in entity["spheres"]]
        assert np.allclose(sorted(map(tuple, balls)), sorted([tuple(middle - along), tuple(middle + along)]), atol=1e-12)
        ends += [vector(frame["translation"]) + turned(frame["rotation"], ball) for ball in balls]
    # Every cable's line begins and ends at ends of rods and has the recorded length.
    for point in points:
        assert min(np.linalg.norm(point - end) for end in ends) < 1e-9
    lengths = sorted(np.linalg.norm(b - a) for a, b in zip(points[::2], points[1::2]))
    recorded = sorted(values[row] for name, values in columns.items() if name.endswith("/length_m"))
    assert np.allclose(lengths, recorded, rtol=0, atol=1e-9)
    # A trace without its run has frames and no shapes.
    shutil.copy(folder_of_run / "trace.h5", folder / "alone.h5")
    alone = by_topic(convert(taut, folder, "alone.h5")["indexed"])
    assert "/tf" in alone and not any(topic.startswith("/scene") for topic in alone), list(alone)


def fits(value, schema, where="message"):
    """Returns whether a message has exactly the fields of a schema, with their types."""
    kind = schema.get("type")
    if kind == "object":
        properties = schema.get("properties", {})
        assert isinstance(value, dict), where
        assert not properties or set(value) == set(properties), (where, set(value) ^ set(properties))
        for key, inner in properties.items():
            fits(value[key], inner, f"{where}.{key}")
    elif kind == "array":
        for item in value:
            fits(item, schema["items"], where + "[]")
    elif kind in ("number", "integer"):
        assert isinstance(value, (int, float) if kind == "number" else int), (where, value)
    elif kind == "string":
        assert isinstance(value, str), where
    elif kind == "boolean":
        assert isinstance(value, bool), where


def MessagesAreThoseThatFoxgloveKnows(taut, folder):
    """Checks messages against the schemas that Foxglove publishes."""
    folder_of_run = record(taut, folder, "drop_six_strut")
    seen = convert(taut, folder, folder_of_run)
    schemas = run.node("foxglove_schemas.mjs", "FrameTransforms", "SceneUpdate", needs=["@foxglove/schemas"])
    kinds = {c["topic"]: c["schema"] for c in seen["channels"]}
    looked = 0
    for message in seen["indexed"]:
        kind = kinds[message["topic"]]
        own = next(c["json_schema"] for c in seen["channels"] if c["topic"] == message["topic"])
        if kind.startswith("foxglove."):
            fits(message["data"], schemas[kind.removeprefix("foxglove.")])
            looked += 1
        fits(message["data"], own)
    assert looked > 100


def CsvIsThatOfTheRun(taut, folder):
    folder_of_run = record(taut, folder)
    run.taut(taut, folder, "trace", "convert", "run", "--out", "out.csv")
    assert (folder / "out.csv").read_bytes() == (folder_of_run / "trace.csv").read_bytes()
    # CSV input gives the same file.
    run.taut(taut, folder, "trace", "convert", "run/trace.csv", "--out", "again.csv")
    assert (folder / "again.csv").read_bytes() == (folder / "out.csv").read_bytes()


def SomeChannelsAndSomeRows(taut, folder):
    folder_of_run = record(taut, folder)
    time_s, columns, _ = trace_of(folder_of_run / "trace.h5")
    seen = convert(taut, folder, "run", "--channels", "cable/*/tension_n", "--channels", "system/*_j", "--period_s", "0.05")
    topics = by_topic(seen["indexed"])
    assert set(topics) == {"/cable", "/system"}
    every = round(0.05 / (time_s[1] - time_s[0]))
    wanted = {n: v[::every] for n, v in columns.items() if n.endswith("/tension_n") and n.startswith("cable/") or n.startswith("system/") and n.endswith("_j")}
    assert len(wanted) > 3
    check_numbers(seen, time_s[::every], wanted)
    names = [f"cable/{cable}/{q}" for cable, fields in topics["/cable"][0]["data"].items() for q in fields]
    assert sorted(names) == sorted(n for n in wanted if n.startswith("cable/"))
    run.taut(taut, folder, "trace", "convert", "run", "--out", "few.csv", "--channels", "system/com_*", "--period_s", "0.1")
    lines = (folder / "few.csv").read_text().splitlines()
    assert lines[0] == "time_s,system/com_x_m,system/com_y_m,system/com_z_m"
    assert [float(line.split(",")[0]) for line in lines[1:]] == [t for t in time_s if abs(t / 0.1 - round(t / 0.1)) < 1e-6]


def rows_of(path):
    """Returns the number of rows of a trace that is being written."""
    try:
        with h5py.File(path, "r", libver="latest", swmr=True) as file:
            return file["time_s"].shape[0]
    except (OSError, KeyError):  # not yet begun
        return 0


def AnUnfinishedTraceIsConverted(taut, folder):
    """A trace whose writer was killed is converted, with a warning that it is unfinished."""
    experiment = ROOT / "share/experiments" / "drop_six_strut.yaml"
    going = subprocess.Popen([taut, "run", experiment, "--duration_s", "1e6", "--quiet", "--out", "run"], cwd=folder)
    # Channels are flushed one after another. Once a later flush has begun, 200 rows of all channels are in the file.
    flushed = 0
    while flushed < 200 or rows_of(folder / "run" / "trace.h5") == flushed:
        assert going.poll() is None
        if flushed < 200:
            flushed = rows_of(folder / "run" / "trace.h5")
        time.sleep(0.05)
    going.kill()
    going.wait()
    done = subprocess.run([taut, "trace", "convert", "run", "--out", "out.mcap", "--period_s", "0.1"], cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0 and "the trace is unfinished" in done.stderr, done.stderr
    seen = run.node("read_mcap.mjs", folder / "out.mcap", needs=NEEDS)
    assert seen["done"] and len(by_topic(seen["indexed"])["/tf"]) > 2


def NothingHalfWrittenStays(taut, folder):
    record(taut, folder)
    for name in ("out.mcap", "out.csv"):
        (folder / name).write_text("before")
        # A limit on the size of files acts like a full disk.
        done = subprocess.run(["bash", "-c", f"ulimit -f 64; exec {taut} trace convert run --out {name}"], cwd=folder, capture_output=True, text=True)
        assert done.returncode == 1 and "cannot write" in done.stderr, (name, done.returncode, done.stderr)
        assert (folder / name).read_text() == "before"
        assert not list(folder.glob("*.part")), list(folder.iterdir())


def WhatIsWrongIsSaid(taut, folder):
    record(taut, folder)
    assert "unknown format" in run.taut(taut, folder, "trace", "convert", "run", "--out", "x.h5", status=2)
    assert "--out" in run.taut(taut, folder, "trace", "convert", "run", status=2)
    assert "cannot open" in run.taut(taut, folder, "trace", "convert", "no.h5", "--out", "x.csv", status=3)
    assert "no channel of the trace matches" in run.taut(taut, folder, "trace", "convert", "run", "--channels", "cables/*", "--out", "x.csv", status=3)
    run.taut(taut, folder, "trace", "convert", "run", "--period_s=-1", "--out", "x.csv", status=2)
    run.taut(taut, folder, "trace", "convert", "run", "--period_s=nan", "--out", "x.csv", status=2)
    run.taut(taut, folder, "trace", "convert", "run", "--out", "no/x.mcap", status=1)
    (folder / "empty").mkdir()
    run.taut(taut, folder, "trace", "convert", "empty", "--out", "x.csv", status=3)
    (folder / "bad.h5").write_text("not a trace")
    run.taut(taut, folder, "trace", "convert", "bad.h5", "--out", "x.mcap", status=3)
    inputs = folder / "run" / "inputs.yaml"
    inputs.write_text(inputs.read_text().splitlines()[0] + "\ntaut: 1\nkind: experience\n")
    assert "inputs.yaml" in run.taut(taut, folder, "trace", "convert", "run", "--out", "x.mcap", status=3)
    assert not list(folder.glob("x.*")), list(folder.iterdir())


if __name__ == "__main__":
    run.main(globals())
