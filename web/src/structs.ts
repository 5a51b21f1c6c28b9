// Generated from web/protocol/messages.json by script/protocol. Do not edit.
import type { Robot } from "./robot_structs";
export type * from "./robot_structs";

export type Vec3 = [number, number, number];
/** Unit quaternion: w, x, y, z. */
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
  /** sphere, box: center */
  center_m?: Vec3;
  /** rod, sphere: radius */
  radius_m?: number;
  /** rod: Euler load, if the model defines the cross section */
  buckling_n?: number;
  /** box: half extents along the box's axes */
  half_extents_m?: Vec3;
  /** box: rotation from the box's axes to the body's (q_BodyBox) */
  orientation?: Quat;
  /** hull: corners */
  corners_m?: Vec3[];
}

export interface Body {
  name: string;
  /** Mass; 0: unknown. */
  mass_kg: number;
  fixed: boolean;
  /** Center of mass at the start, in W. */
  position_m: Vec3;
  /** Orientation at the start; identity in the described pose. */
  orientation: Quat;
  shapes: Shape[];
}

/** A named point of a body, or of the world (body -1). */
export interface Node {
  name: string;
  /** Index in Scene.bodies; -1: the world. */
  body: number;
  /** Position in the body's frame; in W if body is -1. */
  position_m: Vec3;
}

export interface Attachment {
  /** Index in Scene.bodies; -1: the world. */
  body: number;
  /** Position in the body's frame; in W if body is -1. */
  position_m: Vec3;
  /** Wheel around which the cable runs; its center is the attachment. */
  wheel?: Wheel;
  /** True: friction makes the tension differ on both sides. Otherwise absent. */
  parts?: boolean;
}

/** Wheel around which a cable runs, fixed to the attachment's body. */
export interface Wheel {
  /** Unit vector of the axis, in the body's frame. */
  axis: Vec3;
  /** Distance from the axis to the cable's center line. */
  radius_m: number;
  /** Angle of wrap at the start, about the axis, from the previous to the next point of the cable, with all turns. */
  angle_rad: number;
}

/** Cable through its attachments, in order. */
export interface Cable {
  name: string;
  /** Attachments in order; empty: unknown. */
  attachments: Attachment[];
  /** Stiffness; 0: unknown. */
  stiffness_n_per_m: number;
  actuated: boolean;
  /** Tags of the cable's pair in the model, without the pair's name. */
  tags?: string[];
  /** Maximum number of bends of a wrapped cable; frames contain the bends. */
  most_bends?: number;
  /** True: friction divides the cable into spans; frames contain their tensions. Otherwise absent. */
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
  /** Unit vector of the joint's axis, in body a's frame. */
  axis: Vec3;
}

export interface Terrain {
  kind: "plane" | "box" | "surface";
  name: string;
  /** plane: unit normal out of the solid, in W */
  normal?: Vec3;
  /** plane: a point of the surface, in W */
  point_m?: Vec3;
  /** box: center, in W */
  center_m?: Vec3;
  /** box: half extents along the box's axes */
  half_extents_m?: Vec3;
  /** box: rotation from the box's axes to W (q_WBox) */
  orientation?: Quat;
  /** surface: x, y and z of each corner, in W. Large height fields are thinned to at most 250 000 corners. */
  corners_m?: (number | null)[];
  /** surface: three corners each */
  triangles?: number[];
}

/** Parameter that set_parameter changes. */
export interface Parameter {
  /** Name, such as friction_scale, body/<name>/mass_kg or push_n. */
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
  /** impedance: tension offset T0 */
  tension_offset_n?: number;
  /** impedance: length offset L0 */
  length_offset_m?: number;
  /** impedance: position gain K */
  position_gain_n_per_m?: number;
  /** impedance: velocity gain B */
  velocity_gain_n_s_per_m?: number;
  /** rest_length: commanded rest length */
  rest_length_m?: number;
}

export interface Channel {
  /** Name as in traces: cable/<name>/tension_n. */
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
  /** Number of the shape, from 1. */
  number: number;
  /** Number of shapes of this kind in the folder. */
  count: number;
  /** Of a mode: natural frequency. */
  frequency_hz?: number;
  /** Of a mode: period in the trace, divided by the natural period. */
  slowdown?: number;
  /** Of a motion: largest displacement in the trace, divided by the robot's size. */
  amplitude?: number;
}

/** Mode shape; the largest translation of any body is 1 m. */
export interface MotionShape {
  kind: "mechanism" | "elastic" | "unstable";
  /** Natural frequency; 0 for mechanisms. */
  frequency_hz: number;
  /** Translation of each body's center of mass. */
  translation_m: Vec3[];
  /** Rotation vector of each body. */
  rotation_rad: Vec3[];
}

/** Statics of a model without gravity, at its equilibrium. */
export interface Statics {
  /** An equilibrium exists near the described pose. */
  found: boolean;
  /** Reason if no equilibrium was found; otherwise empty. */
  reason: string;
  self_stress_states: number;
  /** A state of self-stress has all cables in tension. */
  feasible: boolean;
  /** Number of mechanisms, without rigid motions. */
  mechanisms: number;
  rigid_motions: number;
  /** Tension of each cable in the equilibrium. */
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
  /** Distinct name: the name in the run's metadata, its folder and file, and further components of the path if needed. */
  name: string;
  /** The run's metadata mark the run as a measurement (key "measured", docs/formats/trace.md). */
  measured: boolean;
  /** Channels of the run. */
  channels: Channel[];
  /** Time of the run's first row. */
  first_s: number;
  /** Time of the run's last row. */
  last_s: number;
  /** Bodies of the run's ghost; the section `ghosts` of frames contains their poses. Empty: no ghost. */
  bodies: Body[];
  /** Cables of the run's ghost; their body numbers are indices in `bodies`. */
  cables: Cable[];
  /** Sentence about a defect of the trace, or the reason why the run has no ghost. */
  notice?: string;
}

/** A channel over a time span, in blocks of `level` rows; at level 1, first, min and max are the value. The level is 1 if the span's rows, with one beyond each end, do not exceed the requested points. In a report, it is the level of the report's Rows. */
export interface SeriesData {
  channel: string;
  /** Run: 0 for the displayed run, k for the k-th compared run. */
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
  /** Run: 0 for the displayed run, k for the k-th compared run. */
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
  /** For each compared run, the output of `taut compare --json` for the compared run (a) and the displayed run (b). */
  comparisons: unknown[];
  /** Rows of the displayed run and of the compared runs. */
  rows: Rows[];
  frame_count: number;
  /** Count of numbers in a frame. */
  frame_values: number;
  /** Float64, little endian: consecutive frames as defined below. All have as many contacts, pushes, bends and spans as the frame with the most; added contacts and pushes have no force, added bends and spans have cable -1. */
  frames_base64: string;
}

/** Table of results. */
export interface ResultTable {
  title: string;
  /** Cells, row by row; the first row is the header. */
  rows: string[][];
}

/** A load case of a static analysis, or a state of the described structure. */
export interface LoadedCase {
  name: string;
  /** Reason for the lack of an equilibrium; empty if there is one. */
  reason: string;
  /** Displacement from the described pose; absent without an equilibrium. */
  displacement?: MotionShape;
  /** Section `cables` of frames, for each cable; null: unknown. */
  cables: (number | null)[];
  /** Section `pushes` of frames, for each loaded node. */
  loads: (number | null)[];
  /** Section `contacts` of frames, for each reaction of a support. */
  reactions: (number | null)[];
  /** Axial force per body, for rods, tension positive; null: unknown. */
  body_force_n: (number | null)[];
  /** Axial force per joint, for bars. */
  joint_force_n: (number | null)[];
  /** Utilization per cable: force relative to its limit, the reciprocal of the safety factor; null: unknown. */
  cable_use: (number | null)[];
  /** Utilization per body, for rods. */
  body_use: (number | null)[];
  /** Utilization per joint, for bars. */
  joint_use: (number | null)[];
  /** Modes other than rigid motions about the equilibrium, in the order of their frequencies. */
  modes: MotionShape[];
  tables: ResultTable[];
}

/** Data of a page of `taut analyze`, in <script type="application/json" id="taut-report">. */
export interface StaticsPage {
  /** Version of this protocol. */
  version: number;
  title: string;
  /** The structure as described. */
  scene: Scene;
  /** Lines of the summary. */
  summary: string[];
  /** Tables of all load cases. */
  tables: ResultTable[];
  cases: LoadedCase[];
  /** Mechanisms of the described pose, and its states of self-stress, scaled to a largest force density of 1 N/m. */
  described: LoadedCase[];
}

/** Displayed objects. Sent after hello, and again after each change. */
export interface Scene {
  bodies: Body[];
  nodes: Node[];
  cables: Cable[];
  joints: Joint[];
  terrain: Terrain[];
  /** Parameters of a live run; otherwise empty. */
  parameters: Parameter[];
  /** Controls of a live run; otherwise empty. */
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
  /** Stiffness of the spring that drags a node; 0 unless live. */
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
