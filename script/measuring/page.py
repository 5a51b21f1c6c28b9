"""Tables of docs/performance.md from a list of results."""

import pathlib
import statistics
import textwrap

from measuring import contacts, hills, joints, wasm
from measuring.table_text import NOTHING, SETTINGS, number
from measuring.results import Results, mark, shared
from validation.runs import Problem, fill, table

TEMPLATE = pathlib.Path(__file__).with_name("performance.md.in")
ROBOTS = ("tetraspine3", "tetraspine12", "six_strut")
STAGES = ("start", "kinematics", "cables", "kick", "collide", "solve", "integrate", "judge")


def counted(count, noun):
    return f"{count} {noun}" + ("" if count == 1 else "s")


def one_world(items):
    """Formats the steps per second of one world, and taut's ratio to them."""
    results = Results(items)
    rows = []
    for (engine, setting), name in SETTINGS.items():
        row = [name]
        for robot in ROBOTS:
            item = results.one(kind="one", engine=engine, setting=setting, robot=robot)
            ours = results.rate(kind="one", engine="taut", robot=robot)
            times = f" ({number(ours / item['steps_per_s'], 2)}x)" if item and ours and engine != "taut" else ""
            row.append(number(item["steps_per_s"]) + mark(item) + times if item else NOTHING)
        rows.append(row)
    return table(["engine", *ROBOTS], rows)


def mujocos(items):
    """Formats the ratio of the speed of MuJoCo in WebAssembly to the native MuJoCo."""
    results = Results(items)
    rows = []
    for setting, name in {"euler_pyramidal": "pyramidal cones", "euler_elliptic": "elliptic cones"}.items():
        rates = [(results.rate(kind="one", engine=wasm.ENGINE, setting=setting, robot=robot),
                  results.rate(kind="one", engine="mujoco", setting=setting, robot=robot)) for robot in ROBOTS]
        rows.append([name, *(f"{number(new / old, 2)}x" if new and old else NOTHING for new, old in rates)])
    return table(["MuJoCo 3 (WebAssembly) over MuJoCo", *ROBOTS], rows)


def which_mujoco(items):
    version = items[0]["machine"].get("mujoco_wasm", wasm.ABSENT)
    words = "Debian's MuJoCo is from 2022. "
    if version == wasm.ABSENT:
        words += "MuJoCo 3 was not measured in this run, which requires node and npm's `@mujoco/mujoco`."
    else:
        words += (f"MuJoCo 3 in the tables is npm's `@mujoco/mujoco` {version}: WebAssembly, one thread. MuJoCo 3 loads the same "
                  "MJCF file as Debian's MuJoCo, except for a bound on memory, with the same solver, number of iterations and "
                  "tolerance; other settings have the defaults of each version. ")
        apart = [item["apart_m"] for item in items if "apart_m" in item]
        words += ("A model is measured only if both versions have the same bodies and masses, and positions within 1e-9 m after "
                  f"100 steps without contacts. The largest distance was {max(apart):.1e} m."
                  if apart else "There was no other one in this run to compare with.")
    return textwrap.fill(words, 110, break_on_hyphens=False)


def batches(items):
    results = Results(items)
    rows = []
    for worlds, lanes, threads in sorted({(i["worlds"], i["lanes"], i["threads"]) for i in results.of(kind="batch")},
                                         key=lambda key: (key[2], key[1])):
        row = [str(worlds), str(lanes), str(threads)]
        for robot in ROBOTS:
            item = results.one(kind="batch", robot=robot, worlds=worlds, lanes=lanes, threads=threads)
            one = results.rate(kind="one", engine="taut", robot=robot)
            times = f" ({number(item['steps_per_s'] / one, 2)}x)" if item and one else ""
            row.append(number(item["steps_per_s"]) + mark(item) + times if item else NOTHING)
        rows.append(row)
    return table(["worlds", "lanes", "threads", *ROBOTS], rows)


def against_batches(items):
    """Compares the widest batch on one core with one world of each peer."""
    results = Results(items)
    rows = []
    for (engine, setting), name in SETTINGS.items():
        if engine == "taut":
            continue
        row = [name]
        for robot in ROBOTS:
            rate = results.rate(kind="one", engine=engine, setting=setting, robot=robot)
            ours = [item["steps_per_s"] for item in results.of(kind="batch", robot=robot, threads=1)]
            row.append(f"{number(max(ours) / rate, 2)}x" if rate and ours else NOTHING)
        rows.append(row)
    return table(["engine", *ROBOTS], rows)


def stages(items):
    found = Results(items).of(kind="stages")
    found.sort(key=lambda item: (ROBOTS.index(item["robot"]), item["lanes"]))
    head = ["stage", *(f"{item['robot']}, {item['lanes']} lane{'s' * (item['lanes'] > 1)}" for item in found)]
    rows = [[name, *(number(item["stages_ns"][name], 2) for item in found)] for name in STAGES]
    rows.append(["sum", *(number(sum(item["stages_ns"].values())) for item in found)])
    return table(head, rows)


def memory(items):
    results = Results(items)
    rows = []
    for lanes in sorted({item["lanes"] for item in results.of(kind="batch")}):
        cells = []
        for robot in ROBOTS:
            found = results.of(kind="batch", robot=robot, lanes=lanes, threads=1)
            cells.append(number(found[0]["bytes_per_world"] / 1000) if found else NOTHING)
        rows.append([str(lanes), *cells])
    return table(["lanes", *ROBOTS], rows)


def growth(items, kind):
    """Formats the time per step [us] against the number at the end of the robot's name."""
    results = Results(items)
    columns = []
    for (engine, setting), name in SETTINGS.items():
        lanes = sorted({item["lanes"] for item in results.of(kind=kind, engine=engine, setting=setting)})
        columns += [(engine, setting, lane, f"{name}, {lane} lanes" if lane > 1 else name) for lane in lanes]
    robots = sorted({item["robot"] for item in results.of(kind=kind)}, key=lambda name: int(name.split("_")[-1]))
    rows = []
    for robot in robots:
        row = [robot.split("_")[-1]]
        for engine, setting, lane, _ in columns:
            found = results.one(kind=kind, engine=engine, setting=setting, lanes=lane, robot=robot)
            row.append(number(1e6 / found["steps_per_s"]) + mark(found) if found else NOTHING)
        rows.append(row)
    return table([kind, *(column[3] for column in columns)], rows)


def spread(items):
    """Returns the spread of a benchmark's repetitions, in per cent of their median."""
    worst = max(items, key=lambda item: item["spread"])
    name = SETTINGS[worst["engine"], worst["setting"]]
    return {"spread": number(100 * statistics.median(item["spread"] for item in items), 2),
            "worst": number(100 * worst["spread"], 2),
            "worst_name": f"{name}, {worst['robot']}, {counted(worst['worlds'], 'world')}, {counted(worst['lanes'], 'lane')}"}


def company(machine):
    if not shared(machine):
        return ""
    return "\nOther programs ran on the machine at the same time, so rows for several threads are unreliable."


def text(items):
    machine = items[0]["machine"]
    if any(item["machine"] != machine for item in items):
        raise Problem("these results are of several machines or versions")
    scenes = contacts.section(items)
    items = [item for item in items if item["kind"] != contacts.KIND]
    if not items:
        raise Problem("these results are of contact-rich scenes alone; the page needs all others, too")
    values = {"one": one_world(items), "mujocos": mujocos(items), "which_mujoco": which_mujoco(items), "batches": batches(items), "against": against_batches(items),
              "stages": stages(items), "memory": memory(items), "hills": hills.section(items), "joints": joints.section(items), "segments": growth(items, "segments"),
              "contacts": growth(items, "contacts"), "contact_scenes": scenes,
              **spread(items),
              "repetitions": str(min(item["repetitions"] for item in items)),
              "load": f"{machine['load'][0]:.1f}", "company": company(machine), "tolerance": machine["tolerance_m_per_s"], "linear_solves": machine["max_linear_solves"],
              **{key: str(machine[key]) for key in ("processor", "cores", "commit", "mujoco", "bullet", "ode")}}
    return fill(TEMPLATE.read_text(), values)
