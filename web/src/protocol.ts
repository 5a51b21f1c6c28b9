// Generated from web/protocol/messages.json by script/protocol. Do not edit.
//
// Messages between the viewer's server and its pages: JSON texts, except frames, which are binary. From this file, script/protocol generates web/src/structs.ts, web/src/robot_structs.ts, web/src/protocol.ts, web/src/layout.ts and apps/viewer/protocol_messages.h. SI units; W is the world frame, z up; quaternions are unit, order w, x, y, z. A field whose name ends with ? may be absent.
import type { RobotStatus, Scene, SeriesData, Vec3 } from "./structs";
export type * from "./structs";

export const PROTOCOL_VERSION = 10;

/** The first message. */
export interface HelloMessage {
  type: "hello";
  /** Version of this protocol. */
  version: number;
  /** robot: motor boards in real time. program: states from a user's program (taut/page.h), which users cannot drag. */
  mode: "live" | "replay" | "model" | "program" | "robot";
  title: string;
  /** Number of this client, from 1. */
  client: number;
  /** Number of the driving client; 0: none. */
  driver: number;
  /** True: the link permits watching only; every message except want_series is refused. */
  watch_only?: boolean;
}

export interface SceneMessage {
  type: "scene";
  scene: Scene;
}

/** Answer to want_series. */
export interface SeriesMessage {
  type: "series";
  /** Number of the request. */
  id: number;
  series: SeriesData;
}

/** Event of the run: a drag, a push, a restart, the end. */
export interface EventMessage {
  type: "event";
  time_s: number;
  text: string;
}

/** A request of this client was refused or failed. */
export interface ErrorMessage {
  type: "error";
  text: string;
}

/** The driving client has changed. */
export interface DriverMessage {
  type: "driver";
  /** Number of the client; 0: none. */
  id: number;
}

/** Status of a robot, about ten times per second. Only the newest is sent, as with frames. */
export interface RobotMessage {
  type: "robot";
  status: RobotStatus;
}

/** A board's reply to robot_gain, sent to all clients. */
export interface GainAnswerMessage {
  type: "gain_answer";
  cable: string;
  gain: string;
  value: number;
  /** The board has accepted the value. */
  good: boolean;
  /** Description of the result. */
  text: string;
}

export type ServerMessage =
  | HelloMessage
  | SceneMessage
  | SeriesMessage
  | EventMessage
  | ErrorMessage
  | DriverMessage
  | RobotMessage
  | GainAnswerMessage;

/** Makes this client the driver. If no client drives, the first client that sends a command becomes the driver. */
export interface TakeControlMessage {
  type: "take_control";
}

export interface PauseMessage {
  type: "pause";
}

export interface ResumeMessage {
  type: "resume";
}

/** Pauses and advances by `count` rows of a trace or steps of a live run. A negative count steps back; in a live run, through the stored past rows. */
export interface StepMessage {
  type: "step";
  /** Number of rows or steps, -1000 to 1000; 1 if absent. */
  count?: number;
}

/** Returns to the start. Several pending resets cause a single one. */
export interface ResetMessage {
  type: "reset";
}

/** Simulated seconds per second; 0: as fast as possible. */
export interface SpeedMessage {
  type: "speed";
  /** Speed factor: 0, or 0.001 to 1000. */
  factor: number;
}

/** Replay: displays this time. Live: pauses and displays this past time without simulating it again; resume, or a later time than the present, returns to the present. */
export interface SeekMessage {
  type: "seek";
  time_s: number;
}

/** Pulls the node to the target with a spring, until drop. */
export interface DragMessage {
  type: "drag";
  node: string;
  /** Target position, in W. */
  target_m: Vec3;
}

export interface DropMessage {
  type: "drop";
}

/** Applies a force for a given duration. */
export interface PushMessage {
  type: "push";
  node: string;
  /** Force, in W. */
  force_n: Vec3;
  /** Duration of the push, 0.001 to 1000. */
  duration_s: number;
}

/** Sets a parameter. A restart waits until a frame has been displayed; of several values until then, the last one counts. A refused value causes an error and leaves the previous value. */
export interface SetParameterMessage {
  type: "set_parameter";
  name: string;
  value: number;
}

export interface SetSetpointMessage {
  type: "set_setpoint";
  cable: string;
  /** Tension offset [N] or rest length [m], depending on the control's kind. */
  value: number;
}

export interface SetGainMessage {
  type: "set_gain";
  cable: string;
  gain: "length_offset_m" | "position_gain_n_per_m" | "velocity_gain_n_s_per_m";
  value: number;
}

/** Model: simulates the robot without gravity and ground, dropped onto the ground from a height of half its size, or settled on the ground. */
export interface StartMessage {
  type: "start";
  as: "described" | "dropped" | "settled";
}

/** Model: computes Scene.statics. */
export interface AnalyzeMessage {
  type: "analyze";
}

/** Replay of a shape: displays another shape of the same kind. */
export interface OpenShapeMessage {
  type: "open_shape";
  /** Number of the shape, from 1. */
  number: number;
}

/** Robot: emergency stop. Accepted from every client whose link permits driving, even if another one drives. */
export interface StopMessage {
  type: "stop";
}

/** Powers the motors in two steps: arm, then hold or impedance. The measured values become the offsets of impedance control. */
export interface RobotModeMessage {
  type: "robot_mode";
  mode: "off" | "arm" | "hold" | "impedance" | "clear_faults";
}

/** Sets a gain on the motor's board; gain_answer contains the board's reply. */
export interface RobotGainMessage {
  type: "robot_gain";
  cable: string;
  gain: "tension_offset_n" | "length_offset_m" | "position_gain_n_per_m" | "velocity_gain_n_s_per_m";
  value: number;
}

/** Robot: starts or ends recording all cycles to a folder. */
export interface RecordMessage {
  type: "record";
  on: boolean;
}

/** Requests a channel over a time span; permitted for clients that may only watch, too. */
export interface WantSeriesMessage {
  type: "want_series";
  /** Number of the request, returned in the reply. */
  id: number;
  channel: string;
  /** Run: 0 (default) for the displayed run, k for the k-th compared run. */
  source?: number;
  /** Start of the time span [s]. */
  t0: number;
  /** End of the time span [s]. */
  t1: number;
  /** Maximum number of points, 2 to 10000. */
  points: number;
}

export type ClientMessage =
  | TakeControlMessage
  | PauseMessage
  | ResumeMessage
  | StepMessage
  | ResetMessage
  | SpeedMessage
  | SeekMessage
  | DragMessage
  | DropMessage
  | PushMessage
  | SetParameterMessage
  | SetSetpointMessage
  | SetGainMessage
  | StartMessage
  | AnalyzeMessage
  | OpenShapeMessage
  | StopMessage
  | RobotModeMessage
  | RobotGainMessage
  | RecordMessage
  | WantSeriesMessage;
