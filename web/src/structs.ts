// Generated from web/protocol/messages.json by script/protocol. Do not edit.
import type { Robot } from "./robot_structs";
export type * from "./robot_structs";

export type Vec3 = [number, number, number];
/** w, x, y, z */
export type Quat = [number, number, number, number];

/** Shape of a body, in the body's frame (origin: center of mass). */
export interface Shape {
  /** Determines which of the fields below exist. */
  kind: "rod" | "sphere" | "box" | "hull";
  name: string;
  /** rod: one end of the axis */
  from_m?: Vec3;
  /** rod: other end of the axis */
  to_m?: Vec3;
  /** sphere, box */
  center_m?: Vec3;
  /** rod, sphere */
  radius_m?: number;
  /** rod: Euler load, if the model defines the cross section */
  buckling_n?: number;
  /** box: along its axes */
  half_extents_m?: Vec3;
  /** box: q_BodyBox */
  orientation?: Quat;
  /** hull: its corners */
  corners_m?: Vec3[];
}

export interface Body {
  name: string;
  /** 0: unknown */
  mass_kg: number;
  fixed: boolean;
  /** Center of mass at the start, in W. */
  position_m: Vec3;
  /** At the start; identity in the described pose. */
  orientation: Quat;
  shapes: Shape[];
}

/** A named point of a body, or of the world (body -1). */
export interface Node {
  name: string;
  /** Index in Scene.bodies; -1: the world. */
  body: number;
  /** In the body's frame; in W if body is -1. */
  position_m: Vec3;
}

export interface Attachment {
  /** Index in Scene.bodies; -1: the world. */
  body: number;
  /** In the body's frame; in W if body is -1. */
  position_m: Vec3;
  /** Wheel around which the cable runs; its center is the attachment. */
  wheel?: Wheel;
  /** True: friction makes the tension differ on both sides. Otherwise absent. */
  parts?: boolean;
}

/** Wheel around which a cable runs, fixed to the attachment's body. */
export interface Wheel {
  /** Unit vector in the body's frame. */
  axis: Vec3;
  /** From the axis to the cable's center line. */
  radius_m: number;
  /** At the start, about the axis, from the previous to the next point of the cable, with all turns. */
  angle_rad: number;
}

/** Cable through its attachments, in order. */
export interface Cable {
  name: string;
  /** Empty: unknown. */
  attachments: Attachment[];
  /** 0: unknown */
  stiffness_n_per_m: number;
  actuated: boolean;
  /** Tags of its pair in the model, without its name. */
  tags?: string[];
  /** For a wrapped cable, whose bends are in frames: their maximum number. */
  most_bends?: number;
  /** True: friction divides it into spans, whose tensions are in frames. Otherwise absent. */
  parted?: boolean;
}

/** Constraint on the motion of body b relative to body a; a support is a joint with the world. */
export interface Joint {
  name: string;
  /** Type of the joint; determines the free motions. */
  kind: "ball" | "hinge" | "weld" | "prismatic" | "cylindrical" | "planar" | "line" | "plane" | "distance";
  /** Index in Scene.bodies; -1: the world. */
  body_a: number;
  /** Index in Scene.bodies. */
  body_b: number;
  /** Point of the joint on body a, in that body's frame; in W for the world. */
  from_m: Vec3;
  /** Point of the joint on body b, in that body's frame. */
  to_m: Vec3;
  /** Unit vector in body a's frame. */
  axis: Vec3;
}

export interface Terrain {
  kind: "plane" | "box" | "surface";
  name: string;
  /** plane: unit normal out of the solid, in W */
  normal?: Vec3;
  /** plane: a point of its surface, in W */
  point_m?: Vec3;
  /** box, in W */
  center_m?: Vec3;
  /** box: along its axes */
  half_extents_m?: Vec3;
  /** box: q_WBox */
  orientation?: Quat;
  /** surface: x, y and z of each corner, in W. Large height fields are thinned to at most 250 000 corners. */
  corners_m?: (number | null)[];
  /** surface: three corners each */
  triangles?: number[];
}

/** Parameter that set_parameter changes. */
export interface Parameter {
  /** friction_scale, body/<name>/mass_kg, push_n ... */
  name: string;
  value: number;
  unit: string;
  min: number;
  max: number;
  /** True for a parameter of the files: a change restarts the experiment. */
  restarts: boolean;
}

/** Set point and gains of a cable, for set_setpoint and set_gain. */
export interface Control {
  cable: string;
  /** Determines the set point: tension_offset_n or rest_length_m. */
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

/** Run with which the displayed run is compared. */
export interface ComparedRun {
  /** Distinct name: the name in its metadata, its folder and file, and further components of its path if needed. */
  name: string;
  /** Its metadata mark it as a measurement (key "measured", docs/formats/trace.md). */
  measured: boolean;
  /** Channels of the run. */
  channels: Channel[];
  /** Time of its first row. */
  first_s: number;
  /** Time of its last row. */
  last_s: number;
  /** Bodies of its ghost, whose poses are in the section `ghosts` of frames. Empty: no ghost. */
  bodies: Body[];
  /** Cables of its ghost; their body numbers are indices in `bodies`. */
  cables: Cable[];
  /** Sentence about a defect of the trace, or the reason why it has no ghost. */
  notice?: string;
}

/** A channel over a time span, in blocks of `level` rows; at level 1, first, min and max are the value. The level is 1 if the span's rows, with one beyond each end, do not exceed the requested points. In a report it is the level of its Rows. */
export interface SeriesData {
  channel: string;
  /** 0: the displayed run; k: the k-th compared run. */
  source: number;
  /** Rows per block. */
  level: number;
  /** Times of the blocks' first rows. */
  time_s: (number | null)[];
  /** Values in the blocks' first rows; null: not a number */
  first: (number | null)[];
  /** Minima of the blocks; null: not a number */
  min: (number | null)[];
  /** Maxima of the blocks; null: not a number */
  max: (number | null)[];
}

/** The plotted channels of a trace from its start to its end. */
export interface Rows {
  /** 0: the displayed run; k: the k-th compared run. */
  source: number;
  /** 1: all rows. Larger: blocks of this number of rows, as in SeriesData. */
  level: number;
  /** Number of rows or blocks. */
  count: number;
  channels: string[];
  /** Float64, little endian: `count` times [s], then for each channel `count` values of the rows or of the blocks' first rows. Unless level is 1, `count` minima and `count` maxima follow. */
  base64: string;
}

/** Data of a report, in <script type="application/json" id="taut-report">. */
export interface Report {
  /** Version of this protocol. */
  version: number;
  title: string;
  scene: Scene;
  /** Description of the experiment; may be empty. */
  description: string;
  /** Texts about the experiment by topic; empty if unknown. */
  facts: Record<string, string>;
  /** Text by key: versions, seed, machine, hash of the inputs. */
  metadata: Record<string, string>;
  /** The experiment and its model as resolved (YAML); empty if unknown. */
  inputs: string;
  /** The content of summary.json, or null. */
  summary: unknown;
  /** For each compared run, the output of `taut compare --json` for it (a) and the displayed run (b). */
  comparisons: unknown[];
  /** Rows of the displayed run and of the compared runs. */
  rows: Rows[];
  frame_count: number;
  /** Numbers per frame. */
  frame_values: number;
  /** Float64, little endian: consecutive frames as defined below. All have as many contacts, pushes, bends and spans as the frame with the most; added contacts and pushes have no force, added bends and spans have cable -1. */
  frames_base64: string;
}

/** Displayed objects. Sent after hello, and again after each change. */
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
  /** Channels that want_series can request, including node positions derived from poses; in a live run, up to the present. */
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
  /** Channels in the section `values` of frames, in order. */
  values: string[];
  /** Time of the first row of a trace; 0 in a live run. */
  first_s: number;
  /** Time of the last row. */
  duration_s: number;
  /** Stiffness of the spring of drag; 0 unless live. */
  drag_stiffness_n_per_m: number;
  /** Name of the displayed run among the compared runs. */
  run_name?: string;
  /** Series with source k belong to the k-th of these runs, counted from 1. Empty except in replays and reports. */
  compared: ComparedRun[];
  /** Present if motor boards are driven. */
  robot?: Robot;
  /** Frames contain the forces of contacts, not only their number. */
  contact_forces: boolean;
  /** Sentence about a defect of the file or of the recording. */
  notice?: string;
}
