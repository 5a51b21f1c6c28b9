"""Possible causes of differences between emulated boards and the pure simulation, each switched separately."""

import os
import pathlib
import re
import shutil
import subprocess

from validation.runs import ROOT, Problem, replaced

LIMITED, MOTORS = "tetraspine3", "tetraspine3_motors"
# Uses the rate of the cable's length, as the simulation's law does, instead of the rest length's rate. Only for finding
# the cause: its noise causes newtons of set point.
CABLE_RATE = {
    "  motor.rate_m_per_s = motor.counts_per_tick * numbers.speed_per_count_m_per_s;\n": "  (void)numbers;\n",
    "  motor.length_m = control::LengthFromTension(motor.rest_length_m, motor.tension_n, p[kStiffness]);\n":
        "  const float before_m = motor.length_m;\n"
        "  motor.length_m = control::LengthFromTension(motor.rest_length_m, motor.tension_n, p[kStiffness]);\n"
        "  if (before_m > 0.0f) {\n"
        "    control::StepLowPass(motor.rate_m_per_s, (motor.length_m - before_m) * 1000.0f, p[kRateShare]);\n"
        "  }\n",
}


class Cause:
    """One cause: `model` of models/ with `changes` of its text, `keys` of the experiment; on boards `flags` and, if
    `firmware` is not empty, changes of include/taut/board/motor_loop.h."""

    def __init__(self, title, model=LIMITED, changes=None, keys="", flags=(), firmware=None):
        self.title, self.model, self.changes, self.keys = title, model, changes or {}, keys
        self.flags, self.firmware = list(flags), firmware

    def write(self, folder, name):
        """Writes the experiment and its model as files in the folder."""
        folder.mkdir(parents=True, exist_ok=True)
        text = (ROOT / f"share/models/{self.model}.yaml").read_text()
        for old, new in self.changes.items():
            text = replaced(text, old, new)
        if self.model != LIMITED:
            models = os.path.relpath(ROOT / "share/models", folder)
            text = replaced(text, "base: tetraspine3.yaml", f"base: {models}/tetraspine3.yaml")
        (folder / "model.yaml").write_text(text)
        base = os.path.relpath(ROOT / "share/experiments" / f"{name}.yaml", folder)
        path = folder / "experiment.yaml"
        path.write_text(
            f"taut: 1\nkind: experiment\nbase: {base}\nname: {name}_cause\nmodel: model.yaml\n{self.keys}")
        return path


def ohms(part, inertia=1.0):
    """Divides all resistances between supply and rotor by `part`, multiplies the rotor's inertia by `inertia`."""
    return {"supply: battery": f"supply: battery\n    resistance_ohm: 19.8 / {part}\n"
                               f"    driver_resistance_ohm: 0.45 / {part}\n    rotor_inertia_kg_m2: 5.6e-8 * {inertia}",
            "supply_resistance_ohm: 0.3": f"supply_resistance_ohm: 0.3 / {part}"}


SPEED = "max_speed_m_per_s: 0.07"
NO_FRICTION = {"static_friction_torque_n_m: 0.00012": "static_friction_torque_n_m: 0\n    friction_torque_n_m: 0"}
NO_GEAR_LOSS = {"gear_efficiency: 0.66": "gear_efficiency: 1"}
LIGHT = {"supply: battery": "supply: battery\n    rotor_inertia_kg_m2: 5.6e-10"}
TWICE = {"supply_voltage_v: 12": "supply_voltage_v: 24"}
# Titles that other code looks up.
LOSS_ALONE = "unchanged resistances, no friction, no gear loss, rotors / 100: loss of speed under load alone"
STIFF = "resistances / 100"
STIFF_PID = "resistances / 100, PID three times"
STRONG_P = "P ten times as strong"
STRONG_PID = ["force_p_per_n=0.18", "force_i_per_n_s=1.8"]

SENSITIVITY = (
    Cause("start displaced by up to 1 um", keys="start_noise: {position_m: 0.000001}\n"),
    Cause("start displaced by up to 1 mm", keys="start_noise: {position_m: 0.001}\n"),
    Cause("half the step", keys="step_s: 0.0005\n"),
    Cause("friction + 1 %", keys="scale: [{friction: 1.01}]\n"),
    Cause("masses + 1 %", keys="scale: [{mass: 1.01}]\n"),
    Cause("stiffness of cables + 1 %", keys="scale: [{stiffness: 1.01}]\n"),
    Cause("speed of winding + 1 %", changes={SPEED: "max_speed_m_per_s: 0.0707"}),
)
ADDED = (
    Cause("load cells in counts", keys="sensors: {load_cell: {counts: {}}}\n"),
    Cause("load cells in counts, with noise of 0.7 counts",
          keys="sensors: {load_cell: {counts: {noise_counts: 0.7}}}\n"),
    Cause("encoders in counts", keys="sensors: {encoder: {quantum_m: 1.34e-5}}\n"),
    Cause("load cells that measure the damper forces, too", keys="sensors: {load_cell: {}}\n"),
    Cause("length and rate from rest length and tension", keys="sensors: {length: from_tension}\n"),
    Cause("all of these, nothing filtered",
          keys="sensors: {load_cell: {counts: {noise_counts: 0.7}}, encoder: {quantum_m: 1.34e-5}, "
               "length: from_tension}\n"),
    Cause("winding acceleration limited to 8.3 m/s^2", changes={SPEED: SPEED + ", max_acceleration_m_per_s2: 8.3"}),
    Cause("speed of winding - 10 %", changes={SPEED: "max_speed_m_per_s: 0.063"}),
    Cause("no limit of speed", changes={SPEED + ", ": ""}),
)
MOTORS_CHANGED = (
    Cause("unchanged", MOTORS),
    Cause("gears without loss", MOTORS, NO_GEAR_LOSS),
    Cause("motors without friction", MOTORS, NO_FRICTION),
    Cause("rotor inertia / 100", MOTORS, LIGHT),
    Cause("supply without resistance", MOTORS, {"supply_resistance_ohm: 0.3": "supply_resistance_ohm: 0"}),
    Cause("windings whose resistance does not rise with heat", MOTORS,
          {"supply: battery": "supply: battery\n    resistance_rise_per_k: 0"}),
    Cause("servo ten times as stiff", MOTORS, {"servo_gain_per_m: 4000": "servo_gain_per_m: 40000"}),
    Cause("24 V", MOTORS, TWICE),
    Cause("24 V and half the spool: same speed without load", MOTORS,
          {**TWICE, "* gear_ratio\n": "* gear_ratio / 2\n"}),
    *(Cause(f"resistances / {part}, rotors x {part}: same time constant", MOTORS, ohms(part, part))
      for part in (2, 4, 10, 100)),
    Cause(STIFF, MOTORS, ohms(100)),
    Cause("resistances / 100, no friction, no gear loss", MOTORS, {**ohms(100), **NO_FRICTION, **NO_GEAR_LOSS}),
    Cause(LOSS_ALONE, MOTORS, {**ohms(1, 0.01), **NO_FRICTION, **NO_GEAR_LOSS}),
)


def on_boards(title, changes=None, board=(), flags=(), firmware=None):
    return Cause(title, MOTORS, changes, "", [*(["--board", *board] if board else []), *flags], firmware)


ON_BOARDS = (  # the first is the reference for the others
    on_boards("unchanged"),
    on_boards("load cells without noise", flags=["--noise_counts", "0"]),
    on_boards("load cells not filtered", board=["tension_filter_share=1"]),
    on_boards("rate of the encoder not filtered", board=["rate_filter_share=1"]),
    on_boards("PID three times as strong", board=STRONG_PID),
    on_boards(STRONG_P, board=["force_p_per_n=0.6"]),
    on_boards("motors and gears without friction", {**NO_FRICTION, **NO_GEAR_LOSS}),
    on_boards("supply of 24 V", TWICE),
    on_boards("USB without delay", flags=["--usb_latency_s", "0"]),
    on_boards(STIFF, ohms(100)),
    on_boards("rate of the cable in the law", firmware=CABLE_RATE),
)
TOGETHER = (
    on_boards(STIFF_PID, ohms(100), STRONG_PID),
    on_boards("resistances / 100, rate of the cable", ohms(100), firmware=CABLE_RATE),
    on_boards("resistances / 100, PID three times, rate of the cable", ohms(100), STRONG_PID, firmware=CABLE_RATE),
    on_boards("P ten times, rate of the cable", board=["force_p_per_n=0.6"], firmware=CABLE_RATE),
    on_boards("resistances / 100, P ten times without I, rate of the cable filtered longer (0.03), no noise",
              ohms(100), ["force_p_per_n=0.6", "force_i_per_n_s=0", "rate_filter_share=0.03"],
              ["--noise_counts", "0"], CABLE_RATE),
)


def build_firmware(folder, changes):
    """Builds the boards' program with changes of its motor loop, with the flags of apps/firmware/CMakeLists.txt."""
    shutil.rmtree(folder, ignore_errors=True)
    for part in ("include/taut/board", "include/taut/control", "apps/firmware"):
        shutil.copytree(ROOT / part, folder / part)
    loop = folder / "include/taut/board/motor_loop.h"
    text = loop.read_text()
    for old, new in changes.items():
        text = replaced(text, old, new)
    loop.write_text(text)
    flags = re.search(r"set\(TAUT_AVR_FLAGS ([^)]*)\)", (ROOT / "apps/firmware/CMakeLists.txt").read_text())[1].split()
    flags = [flag for flag in flags if not flag.startswith("-I")]
    elf = folder / "taut_board.elf"
    sources = sorted(map(str, pathlib.Path(folder, "apps/firmware").glob("*.cpp")))
    try:
        done = subprocess.run(["avr-g++", *flags, f"-I{folder}/include", f"-I{folder}", *sources, "-o", elf],
                              capture_output=True, text=True)
    except FileNotFoundError:
        raise Problem("there is no avr-g++ (Debian: gcc-avr, avr-libc)") from None
    if done.returncode != 0:
        raise Problem(f"avr-g++ {folder}\n{done.stderr}")
    return elf
