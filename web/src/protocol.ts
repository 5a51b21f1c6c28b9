// Made of web/protocol/messages.json by script/protocol. Do not edit.
//
// What the viewer's server and its pages say to each other. JSON texts, except frames, which are binary. script/protocol makes web/src/structs.ts, web/src/protocol.ts, web/src/layout.ts and apps/viewer/protocol_messages.h of this file. SI units; W is the world frame, z up; quaternions are unit, order w, x, y, z. A field whose name ends with ? may be absent.
import type { RobotStatus, Scene, SeriesData, Vec3 } from "./structs";
export type * from "./structs";

export const PROTOCOL_VERSION = 10;

/** The first message. */
export interface HelloMessage {
  type: "hello";
  /** Of this definition. */
  version: number;
  /** robot: motor boards are driven; its clock is the wall's. program: what somebody's own program shows (taut/page.h); nothing in it can be moved. */
  mode: "live" | "replay" | "model" | "program" | "robot";
  title: string;
  /** Who you are, 1 or more. */
  client: number;
  /** Who drives; 0: nobody. */
  driver: number;
  /** true: your link may watch; what you ask for but series is refused. */
  watch_only?: boolean;
}

export interface SceneMessage {
  type: "scene";
  scene: Scene;
}

/** Answer to want_series. */
export interface SeriesMessage {
  type: "series";
  /** Of the question. */
  id: number;
  series: SeriesData;
}

/** Something happened: a drag, a push, a restart, the end. */
export interface EventMessage {
  type: "event";
  time_s: number;
  text: string;
}

/** Something that you asked for was not done. */
export interface ErrorMessage {
  type: "error";
  text: string;
}

/** Who drives from now on. */
export interface DriverMessage {
  type: "driver";
  /** 0: nobody. */
  id: number;
}

/** How a robot is, some ten times a second. Latest wins, as with frames. */
export interface RobotMessage {
  type: "robot";
  status: RobotStatus;
}

/** What a board said to robot_gain, to everyone. */
export interface GainAnswerMessage {
  type: "gain_answer";
  cable: string;
  gain: string;
  value: number;
  /** It has taken it. */
  good: boolean;
  /** In words. */
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

/** Drive from now on. The first command of anybody does so, too, while nobody drives. */
export interface TakeControlMessage {
  type: "take_control";
}

export interface PauseMessage {
  type: "pause";
}

export interface ResumeMessage {
  type: "resume";
}

/** Pauses and goes on by `count`: rows of a trace, steps of a live run. Below zero: back, in a live run through the rows that it keeps of its past. */
export interface StepMessage {
  type: "step";
  /** 1 if absent; -1000 to 1000. */
  count?: number;
}

/** Back to the start. Of several that wait, one is made. */
export interface ResetMessage {
  type: "reset";
}

/** Simulated seconds a second; 0: as fast as it can. */
export interface SpeedMessage {
  type: "speed";
  /** 0, or 0.001 to 1000. */
  factor: number;
}

/** Replay: goes there. Live: pauses and looks at that moment of the past; nothing is simulated anew, and resume, or a time that is not past, goes back to the present. */
export interface SeekMessage {
  type: "seek";
  time_s: number;
}

/** A spring pulls the node to the target until drop. */
export interface DragMessage {
  type: "drag";
  node: string;
  /** In W. */
  target_m: Vec3;
}

export interface DropMessage {
  type: "drop";
}

/** A force for a while, from now on. */
export interface PushMessage {
  type: "push";
  node: string;
  /** In W. */
  force_n: Vec3;
  /** 0.001 to 1000. */
  duration_s: number;
}

/** One that starts the experiment anew waits for a picture: of several values that come until then, the last one counts. What is refused is answered, and leaves the value before. */
export interface SetParameterMessage {
  type: "set_parameter";
  name: string;
  value: number;
}

export interface SetSetpointMessage {
  type: "set_setpoint";
  cable: string;
  /** Tension offset [N] or rest length [m], by the control's kind. */
  value: number;
}

export interface SetGainMessage {
  type: "set_gain";
  cable: string;
  gain: "length_offset_m" | "position_gain_n_per_m" | "velocity_gain_n_s_per_m";
  value: number;
}

/** Model: simulate it without gravity and ground, dropped onto the ground from a height of half its size, or settled on the ground. */
export interface StartMessage {
  type: "start";
  as: "described" | "dropped" | "settled";
}

/** Model: compute Scene.statics. */
export interface AnalyzeMessage {
  type: "analyze";
}

/** Replay of a shape: show another of the same kind. */
export interface OpenShapeMessage {
  type: "open_shape";
  /** From 1. */
  number: number;
}

/** Robot: emergency stop. Obeyed from every link that may drive, whoever drives. */
export interface StopMessage {
  type: "stop";
}

/** Power in two steps: arm, then hold or impedance, which takes what is measured as its offsets. */
export interface RobotModeMessage {
  type: "robot_mode";
  mode: "off" | "arm" | "hold" | "impedance" | "clear_faults";
}

/** Sent to the motor's board; gain_answer says what it said. */
export interface RobotGainMessage {
  type: "robot_gain";
  cable: string;
  gain: "tension_offset_n" | "length_offset_m" | "position_gain_n_per_m" | "velocity_gain_n_s_per_m";
  value: number;
}

/** Robot: every cycle into a folder, from now on or no longer. */
export interface RecordMessage {
  type: "record";
  on: boolean;
}

/** Anyone may ask, also who may only watch. */
export interface WantSeriesMessage {
  type: "want_series";
  /** Comes back with the answer. */
  id: number;
  channel: string;
  /** 0, the run, if absent; k: the k-th that it is compared with. */
  source?: number;
  /** [s] */
  t0: number;
  /** [s] */
  t1: number;
  /** At most; 2 to 10000. */
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
