// Made of web/protocol/messages.json by script/protocol. Do not edit.
import type { Robot } from "./robot_structs";
export type * from "./robot_structs";

export type Vec3 = [number, number, number];
/** w, x, y, z */
export type Quat = [number, number, number, number];

/** Part of a body, in the body's frame (origin: centre of mass). */
export interface Shape {
  /** Which of the fields below are there. */
  kind: "rod" | "sphere" | "box" | "hull";
  name: string;
  /** rod: one end of the axis */
  from_m?: Vec3;
  /** rod: the other */
  to_m?: Vec3;
  /** sphere, box */
  center_m?: Vec3;
  /** rod, sphere */
  radius_m?: number;
  /** rod: Euler's load, if its model has a cross section */
  buckling_n?: number;
  /** box: along its axes */
  half_extents_m?: Vec3;
  /** box: q_BodyBox */
  orientation?: Quat;
  /** hull: what it spans */
  corners_m?: Vec3[];
}

export interface Body {
  name: string;
  /** 0 where it is not known */
  mass_kg: number;
  fixed: boolean;
  /** Centre of mass at the start, in W. */
  position_m: Vec3;
  /** At the start; identity as described. */
  orientation: Quat;
  shapes: Shape[];
}

/** A named point of a body, or of the world (body -1). */
export interface Node {
  name: string;
  /** Place in Scene.bodies, or -1. */
  body: number;
  /** In the body's frame; in W if body is -1. */
  position_m: Vec3;
}

export interface Attachment {
  /** Place in Scene.bodies, or -1: the world. */
  body: number;
  /** In the body's frame; in W if body is -1. */
  position_m: Vec3;
  /** The cable goes round it: the place is its middle. */
  wheel?: Wheel;
  /** Friction parts the cable here: true or absent. */
  parts?: boolean;
}

/** A cylinder that a cable goes round, of an attachment's body. */
export interface Wheel {
  /** Unit, in the body's frame. */
  axis: Vec3;
  /** To the cable's middle. */
  radius_m: number;
  /** At the start: about the axis, from the point before to the point behind, with all turns. */
  angle_rad: number;
}

/** Goes through its attachments in order. */
export interface Cable {
  name: string;
  /** Empty where they are not known. */
  attachments: Attachment[];
  /** 0 where it is not known */
  stiffness_n_per_m: number;
  actuated: boolean;
  /** Of its pair in the model, without its name. */
  tags?: string[];
  /** It lies against what it comes to: frames hold its bends, so many at most. */
  most_bends?: number;
  /** Friction parts it: frames hold its spans. True or absent. */
  parted?: boolean;
}

/** Holds a part of one body's motion against another's; a support is a joint with the world. */
export interface Joint {
  name: string;
  /** What it leaves free. */
  kind: "ball" | "hinge" | "weld" | "prismatic" | "cylindrical" | "planar" | "line" | "plane" | "distance";
  /** Place in Scene.bodies, or -1: the world. */
  body_a: number;
  /** Place in Scene.bodies. */
  body_b: number;
  /** Its point of body a, in that body's frame; in W if that is the world. */
  from_m: Vec3;
  /** Its point of body b, in that body's frame. */
  to_m: Vec3;
  /** Unit, in body a's frame. */
  axis: Vec3;
}

export interface Terrain {
  kind: "plane" | "box" | "surface";
  name: string;
  /** plane: unit, out of the solid, in W */
  normal?: Vec3;
  /** plane: a point of its surface, in W */
  point_m?: Vec3;
  /** box, in W */
  center_m?: Vec3;
  /** box: along its axes */
  half_extents_m?: Vec3;
  /** box: q_WBox */
  orientation?: Quat;
  /** surface: x, y and z of each corner, in W. Of a field of more than 250 000 only every second, third, ... */
  corners_m?: (number | null)[];
  /** surface: three corners each */
  triangles?: number[];
}

/** What set_parameter may change. */
export interface Parameter {
  /** friction_scale, body/<name>/mass_kg, push_n ... */
  name: string;
  value: number;
  unit: string;
  min: number;
  max: number;
  /** A parameter of the files: a change starts the experiment anew. */
  restarts: boolean;
}

/** What set_setpoint and set_gain may change of a cable. */
export interface Control {
  cable: string;
  /** What its set point is: tension_offset_n or rest_length_m. */
  kind: "impedance" | "rest_length";
  /** impedance: T0 */
  tension_offset_n?: number;
  /** impedance: L0 */
  length_offset_m?: number;
  /** impedance: K */
  position_gain_n_per_m?: number;
  /** impedance: B */
  velocity_gain_n_s_per_m?: number;
  /** rest_length: the command */
  rest_length_m?: number;
}

export interface Channel {
  /** As in traces: cable/<name>/tension_n. */
  name: string;
  unit: string;
}

/** A push or drag of the experiment. */
export interface Action {
  kind: "push" | "drag";
  /** Name, node and largest force or velocity. */
  text: string;
  from_s: number;
  to_s: number;
}

/** Mode, mechanism or state of self-stress that a trace animates (`taut analyze --out`). */
export interface ShapeInfo {
  kind: "mode" | "mechanism" | "self_stress";
  /** From 1. */
  number: number;
  /** Number of shapes of this kind in the folder. */
  count: number;
  /** Of a mode. */
  frequency_hz?: number;
  /** Of a mode: period in the trace over the natural period. */
  slowdown?: number;
  /** Of a motion: largest displacement in the trace over the robot's size. */
  amplitude?: number;
}

/** Mode shape; the largest translation of any body is 1 m. */
export interface MotionShape {
  kind: "mechanism" | "elastic" | "unstable";
  /** 0 for mechanisms. */
  frequency_hz: number;
  /** Per body. */
  translation_m: Vec3[];
  /** Per body. */
  rotation_rad: Vec3[];
}

/** Statics of a model without gravity, at its equilibrium. */
export interface Statics {
  /** An equilibrium exists near the described pose. */
  found: boolean;
  /** Reason, if none was found; else empty. */
  reason: string;
  self_stress_states: number;
  /** A state of self-stress has all cables in tension. */
  feasible: boolean;
  /** Without rigid motions. */
  mechanisms: number;
  rigid_motions: number;
  /** Per cable, in the equilibrium. */
  cable_tension_n: (number | null)[];
  /** The first modes other than rigid motions, in the order of their frequencies. */
  modes: MotionShape[];
}

/** A named span of the timeline. */
export interface Phase {
  name: string;
  from_s: number;
  to_s: number;
}

/** A run that the run is compared with. */
export interface ComparedRun {
  /** What to call it: what it says of itself, its folder and file, and as much more of its path as tells it from the others. */
  name: string;
  /** It says of itself that it was measured: metadata "measured" (docs/formats/trace.md). */
  measured: boolean;
  /** Its channels. */
  channels: Channel[];
  /** Time of its first row. */
  first_s: number;
  /** Time of its last. */
  last_s: number;
  /** Of its ghost, whose poses are in the section `ghosts` of frames. Empty: it has none. */
  bodies: Body[];
  /** Of its ghost; bodies are places in `bodies`. */
  cables: Cable[];
  /** What is amiss with it, or why it has no ghost, in a sentence. */
  notice?: string;
}

/** A channel over a span of time, at the resolution asked for. Points are blocks of `level` rows; at level 1, first, min and max are the value. A span with no more rows, one beyond each end included, than points were asked for comes at level 1; out of a report, at that of its Rows. */
export interface SeriesData {
  channel: string;
  /** 0: the run; k: the k-th that it is compared with. */
  source: number;
  /** Rows a point. */
  level: number;
  /** Of each block's first row. */
  time_s: (number | null)[];
  /** The value in that row; null: not a number */
  first: (number | null)[];
  /** Of the block; null: not a number */
  min: (number | null)[];
  /** Of the block; null: not a number */
  max: (number | null)[];
}

/** The plotted channels of a trace from its start to its end. */
export interface Rows {
  /** 0: the run; k: the k-th that it is compared with. */
  source: number;
  /** 1: every row is here. More: blocks of so many rows, as in SeriesData. */
  level: number;
  /** Rows or blocks. */
  count: number;
  channels: string[];
  /** Float64, little endian: `count` times [s]; then for each channel `count` values, those of the rows or of the blocks' first rows, and, unless level is 1, as many least and as many greatest values. */
  base64: string;
}

/** What a report holds, in <script type="application/json" id="taut-report">. */
export interface Report {
  /** Of this definition. */
  version: number;
  title: string;
  scene: Scene;
  /** The experiment's, or empty. */
  description: string;
  /** What was run, in words, by what they are about; empty if unknown. */
  facts: Record<string, string>;
  /** Text by key: versions, seed, machine, hash of the inputs. */
  metadata: Record<string, string>;
  /** The experiment and its model as resolved (YAML); empty if unknown. */
  inputs: string;
  /** The content of summary.json, or null. */
  summary: unknown;
  /** For each run that it is compared with the content of `taut compare --json` of that one (a) and the run (b). */
  comparisons: unknown[];
  /** Of the run and of those that it is compared with. */
  rows: Rows[];
  frame_count: number;
  /** Numbers a frame. */
  frame_values: number;
  /** Float64, little endian: frames as defined below, one after the other. Each has as many contacts, pushes, bends and spans as the one with the most; what does not act has no force, and what is no bend or span is of no cable. */
  frames_base64: string;
}

/** What there is to see. Sent after hello, and anew when it changes. */
export interface Scene {
  bodies: Body[];
  nodes: Node[];
  cables: Cable[];
  joints: Joint[];
  terrain: Terrain[];
  /** Empty unless live. */
  parameters: Parameter[];
  /** Empty unless live. */
  controls: Control[];
  /** What want_series may ask for, places of nodes that nobody recorded among them; live, of the run so far. */
  channels: Channel[];
  phases: Phase[];
  /** Pushes and drags of the experiment. */
  actions?: Action[];
  /** Absent unless the trace animates a shape. */
  shape?: ShapeInfo;
  /** Replay: the content of summary.json. */
  summary?: unknown;
  /** Model: result of analyze. */
  statics?: Statics;
  /** Channels that frames hold in `values`, in their order. */
  values: string[];
  /** Time of the first row of a trace; 0 when live. */
  first_s: number;
  /** Time of the last. */
  duration_s: number;
  /** Of the spring that drag pulls with; 0 unless live. */
  drag_stiffness_n_per_m: number;
  /** What to call the run beside those that it is compared with. */
  run_name?: string;
  /** Source k of series is the k-th of them, from 1. Empty unless a replay or report. */
  compared: ComparedRun[];
  /** Where motor boards are driven. */
  robot?: Robot;
  /** Frames hold the forces of contacts, and not their number alone. */
  contact_forces: boolean;
  /** What is amiss with the file, or with what is recorded, in a sentence. */
  notice?: string;
}
