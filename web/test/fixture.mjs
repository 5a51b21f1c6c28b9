// Robot with analytic motion: a prism of three rods and nine cables that turns about the vertical and moves
// along x. Tests know all positions at any time.
import { readFileSync } from "node:fs";

export const DURATION_S = 10;
export const RATE_HZ = 200;
const RADIUS_M = 0.2;
const HEIGHT_M = 0.4;
const LIFT_M = 0.02;
export const TURN_RAD_PER_S = 0.3;
export const SPEED_M_PER_S = 0.05;
export const CABLE_COUNT = 9;
export const SLACK = 8; // this cable is slack

const corner = (i, z) => {
  const angle = (2 * Math.PI * i) / 3;
  return [RADIUS_M * Math.cos(angle), RADIUS_M * Math.sin(angle), z];
};
const low = [0, 1, 2].map((i) => corner(i, LIFT_M));
const high = [0, 1, 2].map((i) => corner(i + 1.25, LIFT_M + HEIGHT_M));
const minus = (a, b) => a.map((value, k) => value - b[k]);
const middle = (a, b) => a.map((value, k) => (value + b[k]) / 2);
const centres = low.map((from, i) => middle(from, high[i]));

export const nodes = [0, 1, 2].flatMap((i) => [
  { name: `rod_${i}.low`, body: i, position_m: minus(low[i], centres[i]) },
  { name: `rod_${i}.high`, body: i, position_m: minus(high[i], centres[i]) },
]);
const end = (i, which) => {
  const { body, position_m } = nodes[2 * i + (which === "high" ? 1 : 0)];
  return { body, position_m };
};
const cable = (name, from, to) => ({ name, attachments: [from, to], stiffness_n_per_m: 300, actuated: true });
const next = (i) => (i + 1) % 3;
export const cables = [
  ...[0, 1, 2].map((i) => cable(`bottom_${i}`, end(i, "low"), end(next(i), "low"))),
  ...[0, 1, 2].map((i) => cable(`top_${i}`, end(i, "high"), end(next(i), "high"))),
  ...[0, 1, 2].map((i) => cable(`side_${i}`, end(i, "high"), end(next(i), "low"))),
];

export const tension_n = (i, time_s) => (i === SLACK ? 0 : 4 * (i + 1) * (1 + 0.2 * Math.sin(time_s)));
export const setpoint_n = (i) => (i === SLACK ? 0 : 4 * (i + 1));

/** Returns the time of the row at a time, or of the last before it. */
export function rowTime(time_s) {
  const near = Math.round(time_s * RATE_HZ);
  return (near / RATE_HZ <= time_s ? near : near - 1) / RATE_HZ;
}

/** Differs from row to row, so that a mean of rows equals none of them. */
export const contactCount = (time_s) => 3 + (Math.round(time_s * RATE_HZ) % 4);

const ends = { tension_n: "N", setpoint_n: "N", length_m: "m", rest_length_m: "m" };
const channels = [
  ...cables.flatMap(({ name }) => Object.entries(ends).map(([key, unit]) => ({ name: `cable/${name}/${key}`, unit }))),
  ...["kinetic_j", "gravity_j", "elastic_j"].map((key) => ({ name: `system/${key}`, unit: "J" })),
  { name: "system/contact_count", unit: "1" },
  ...["x", "y", "z"].map((axis) => ({ name: `system/com_${axis}_m`, unit: "m" })),
  ...[0, 1, 2].flatMap((i) => ["x", "y", "z"].map((axis) => ({ name: `body/rod_${i}/position_${axis}_m`, unit: "m" }))),
];

export const scene = {
  bodies: centres.map((position_m, i) => ({
    name: `rod_${i}`, mass_kg: 0.5, fixed: false, position_m, orientation: [1, 0, 0, 0],
    shapes: [
      { kind: "rod", name: "", from_m: nodes[2 * i].position_m, to_m: nodes[2 * i + 1].position_m, radius_m: 0.008 },
      { kind: "sphere", name: "", center_m: nodes[2 * i].position_m, radius_m: 0.02 },
      { kind: "box", name: "", center_m: nodes[2 * i + 1].position_m, half_extents_m: [0.018, 0.018, 0.018] },
    ],
  })),
  nodes,
  cables,
  joints: [],
  terrain: [
    { kind: "plane", name: "ground", normal: [0, 0, 1], point_m: [0, 0, 0] },
    { kind: "box", name: "step", center_m: [0.9, 0, 0.05], half_extents_m: [0.2, 0.4, 0.05], orientation: [1, 0, 0, 0] },
  ],
  parameters: [], controls: [], values: [], channels,
  phases: [{ name: "before", from_s: 1, to_s: 3 }, { name: "after", from_s: 6, to_s: 9 }],
  first_s: 0, duration_s: DURATION_S, drag_stiffness_n_per_m: 0, compared: [], contact_forces: true,
};

export const liveScene = {
  ...scene, duration_s: 0, drag_stiffness_n_per_m: 200,
  parameters: [
    { name: "friction_scale", value: 1, unit: "1", min: 0, max: 2, restarts: false },
    { name: "push_n", value: 20, unit: "N", min: 0, max: 60, restarts: true },
  ],
  controls: cables.map(({ name }, i) => ({
    cable: name, kind: "impedance", tension_offset_n: setpoint_n(i), length_offset_m: 0.2,
    position_gain_n_per_m: 100, velocity_gain_n_s_per_m: 10,
  })),
};

/** Returns p_WB and q_WB of a body. */
export function pose(body, time_s) {
  const angle = TURN_RAD_PER_S * time_s;
  const [x, y, z] = centres[body];
  return {
    position_m: [x * Math.cos(angle) - y * Math.sin(angle) + SPEED_M_PER_S * time_s, x * Math.sin(angle) + y * Math.cos(angle), z],
    orientation: [Math.cos(angle / 2), 0, 0, Math.sin(angle / 2)],
  };
}

/** Returns p_W of a point of a body; all rotations are about the vertical. */
export function worldPoint(body, [x, y, z], time_s) {
  const { position_m: [px, py, pz] } = pose(body, time_s);
  const angle = TURN_RAD_PER_S * time_s;
  return [px + x * Math.cos(angle) - y * Math.sin(angle), py + x * Math.sin(angle) + y * Math.cos(angle), pz + z];
}

const protocol = JSON.parse(readFileSync(new URL("../protocol/messages.json", import.meta.url), "utf8"));
export const VERSION = protocol.version;

/** Returns a frame as a list of numbers; `more`: header values, contacts, pushes and changed tensions. */
export function frameValues(time_s, more = {}) {
  const contacts = more.contacts ?? [];
  const pushes = more.pushes ?? [];
  const ghosts = more.ghosts ?? [];
  const header = {
    time_s, now_s: time_s, real_time_factor: 1, speed: 1, paused: 0, driver: 1, kinetic_j: 0.1 * time_s, gravity_j: 2, elastic_j: 3,
    run: 0, body_count: 3, cable_count: CABLE_COUNT, contact_count: contactCount(time_s), contact_rows: contacts.length, push_count: pushes.length,
    value_count: 0, ghost_count: ghosts.length, bend_count: 0, span_count: 0,
    ...more.header,
  };
  return [
    ...protocol.frame.header.map(([name]) => header[name]),
    ...[0, 1, 2].flatMap((i) => Object.values(pose(i, time_s)).flat()),
    ...cables.flatMap((_, i) => [more.tension_n?.[i] ?? tension_n(i, time_s), 0.3 + 0.01 * i, 0.25, setpoint_n(i)]),
    ...contacts.flat(), ...pushes.flat(), ...ghosts.flat(),
  ];
}

/** Returns contacts with the weight on the three lower ends. */
export function contactsAt(time_s) {
  return [0, 1, 2].map((i) => [...worldPoint(i, nodes[2 * i].position_m, time_s), 0, 0, 4.905]);
}

function channelValue(name, time_s) {
  const [, cableName, key] = /^cable\/(.*)\/(.*)$/.exec(name) ?? [];
  const i = cables.findIndex((each) => each.name === cableName);
  if (key === "tension_n") return tension_n(i, time_s);
  if (key === "setpoint_n") return setpoint_n(i);
  if (key === "length_m") return 0.3 + 0.01 * i;
  if (key === "rest_length_m") return 0.25;
  const centre = [0, 1, 2].map((body) => pose(body, time_s).position_m);
  const [, body, along] = /^body\/rod_(\d)\/position_([xyz])_m$/.exec(name) ?? [];
  if (body !== undefined) return pose(Number(body), time_s).position_m["xyz".indexOf(along)];
  const axis = { "system/com_x_m": 0, "system/com_y_m": 1, "system/com_z_m": 2 }[name];
  if (axis !== undefined) return centre.reduce((sum, p) => sum + p[axis] / 3, 0);
  return { "system/kinetic_j": 0.1 * time_s, "system/gravity_j": 2, "system/elastic_j": 3, "system/contact_count": contactCount(time_s) }[name] ?? null;
}

/** Answers want_series as the server does: blocks of 1, 2, 4 ... rows. */
export function seriesOf(channel, source, t0, t1, points) {
  const first = Math.max(0, Math.floor(t0 * RATE_HZ) - 1);
  const last = Math.min(DURATION_S * RATE_HZ, Math.ceil(t1 * RATE_HZ) + 1);
  let level = 1;
  while ((last - first + 1) / level > points) level *= 2;
  const series = { channel, source, level, time_s: [], first: [], min: [], max: [] };
  const offset = 1.5 * source; // values of compared runs are larger
  for (let row = first; row <= last; row += level) {
    const values = [];
    for (let k = row; k < Math.min(row + level, last + 1); ++k) values.push(channelValue(channel, k / RATE_HZ) + offset);
    series.time_s.push(row / RATE_HZ);
    series.first.push(values[0]);
    series.min.push(Math.min(...values));
    series.max.push(Math.max(...values));
  }
  return series;
}

const tensions = channels.filter(({ name }) => name.endsWith("/tension_n"));

/** A run without poses. */
export const reference = {
  name: "another prism (runs/trace.h5)", measured: false, channels: tensions,
  first_s: 0, last_s: DURATION_S, bodies: [], cables: [], notice: "no ghost: the trace contains no poses of bodies",
};

/**
 * Offset of each compared run's prism from this run's, by source; the third ends early, the fourth is a
 * single rod.
 */
export const GHOST_OFFSET_M = [0, 0.05, 0.02];
export const EARLY_END_S = 4;
const ghost = (name, more = {}) => ({ ...reference, name, bodies: scene.bodies, cables, notice: undefined, ...more });
export const comparedRuns = [
  ghost("prism (a/trace.h5)"),
  reference,
  ghost("prism (b/trace.h5)", { last_s: EARLY_END_S }),
  ghost("a rod (c/trace.h5)", { bodies: [scene.bodies[0]], cables: [], notice: "the trace is unfinished: its run continues, or was killed" }),
];

/** Returns the poses of the ghosts of compared runs; `runs`: as in a scene. */
export function ghostsAt(runs, time_s) {
  return runs.flatMap(({ bodies, last_s }, k) => bodies.map((_, body) => {
    const { position_m, orientation } = pose(body, time_s);
    if (time_s > last_s + 0.5 / RATE_HZ) return new Array(7).fill(NaN);
    return [...position_m.map((value, axis) => value + (k + 1) * GHOST_OFFSET_M[axis]), ...orientation];
  }));
}

const base64 = (numbers) => Buffer.from(new Float64Array(numbers).buffer).toString("base64");

/** Returns channels in the form of a report: every row, or blocks of `level` rows. */
export function rowsOf(channels, source, level, value = seriesOf) {
  const count = Math.ceil((DURATION_S * RATE_HZ + 1) / level);
  const all = channels.map((name) => value(name, source, 0, DURATION_S, count));
  const numbers = all.flatMap(({ first, min, max }) => (level === 1 ? first : [...first, ...min, ...max]));
  return { source, level, count, channels, base64: base64([...all[0].time_s, ...numbers]) };
}

/** Returns the content of a report; every eighth row has a frame. `level`: rows per block. */
export function report(changes = {}, level = 1) {
  const frames = [];
  const compared = changes.scene?.compared ?? [];
  for (let k = 0; k <= (DURATION_S * RATE_HZ) / 8; ++k) {
    const time_s = (8 * k) / RATE_HZ;
    frames.push(frameValues(time_s, { contacts: contactsAt(time_s), ghosts: ghostsAt(compared, time_s) }));
  }
  const others = compared.map(({ channels: list }, k) => rowsOf(list.map(({ name }) => name), k + 1, level));
  return {
    version: VERSION, title: "turning prism", scene,
    description: "A prism turns about the vertical.", facts: { robot: "prism: 3 bodies, 9 cables, 1.5 kg", time: "10 s in steps of 0.001 s" },
    metadata: { taut_version: "1.2.3", seed: "42", machine: "a machine" },
    inputs: "taut: 1\nname: <b>prism</b>\n",
    summary: {
      experiment: "turning prism", status: "ok", simulated_s: 10, system_max_tension_n: 38.4, phases: scene.phases,
      references: [
        { source: "a book", quantity: "tension", statistic: "max", phase: null, cables: [{ name: "bottom_0", reference_n: 5, ours_n: 4.8 }, { name: "top_1", reference_n: 20, ours_n: null }] },
        { source: "a book", quantity: "elastic", statistic: "mean", phase: "before", cables: [{ name: "top_1", reference_n: 2, ours_n: 4 }] },
      ],
      cables: cables.map(({ name }, i) => ({ name, tension: { max_n: 4.8 * (i + 1), phases: { before: { mean_n: i, min_n: 0, max_n: 9 } } } })),
    },
    comparisons: [],
    rows: [rowsOf(channels.map(({ name }) => name), 0, level), ...others],
    frame_count: frames.length, frame_values: frames[0].length,
    frames_base64: base64(frames.flat()),
    ...changes,
  };
}
