// Generated from web/protocol/messages.json by script/protocol. Do not edit.

/** A gain of impedance control that may change while a motor runs. */
export interface RobotGain {
  /** Name as in docs/hardware/parameters.md; ends in the unit. */
  key: string;
  min: number;
  max: number;
}

/** Robot driven by motor boards. */
export interface Robot {
  /** Serial port of the adapter. */
  port: string;
  /** Cable of each motor, in order. Board b has the motors 2 b and 2 b + 1. */
  motors: string[];
  /** Gains of each motor. */
  gains: RobotGain[];
  /** True: poses of bodies are the true poses of a virtual robot. False: poses are as in the model, because a real robot does not measure them. */
  true_pose: boolean;
  /** An experiment drives the robot: robot_mode accepts only `off`. */
  experiment: boolean;
  /** The message record is accepted. */
  may_record: boolean;
}

export interface BoardStatus {
  /** The board answers. */
  there: boolean;
  /** The board answers and has no fault, timeout or stop. */
  well: boolean;
  /** Mode of the board: off, hold, impedance, stopped ... */
  mode: string;
  /** The references of the board's encoders are set. */
  referenced: boolean;
  /** The board received no broadcast in time. */
  timeout: boolean;
  /** The board has restarted since faults were last cleared. */
  was_reset: boolean;
  /** Faults of the board and its motors as text; empty: none. */
  faults: string;
  /** Messages that the board received with a wrong checksum; modulo 256. */
  bad_messages: number;
  /** Frames of the board that had a wrong checksum or were missing. */
  bad_frames: number;
  /** Broadcasts that the board missed; modulo 256. */
  missed_broadcasts: number;
  /** Frames that do not reflect the preceding broadcast. */
  stale_frames: number;
  /** Late ticks of the control loop; modulo 256. */
  late_ticks: number;
  /** Restarts of a hung bus; modulo 256. */
  bus_recoveries: number;
  /** Duration of the longest recent tick. */
  loop_time_s: number;
}

export interface MotorStatus {
  tension_n: number;
  /** Set point of the tension; null: none. */
  setpoint_n: number;
  /** Rest length, measured by the encoder. */
  rest_length_m: number;
  /** Encoder counts from the reference. */
  encoder_counts: number;
  /** Duty cycle, -1 to 1; positive winds in. */
  duty: number;
  /** Temperature of the winding, computed by a model. */
  temperature_c: number;
  /** Faults as text; empty: none. */
  faults: string;
  /** Gains read from the board; null: not read yet. */
  gains: (number | null)[];
}

/** Communication between computer and boards. */
export interface LinkStatus {
  /** Whether the adapter is connected. */
  connected: boolean;
  cycles: number;
  /** Cycles that had not ended when the next was due. */
  late_cycles: number;
  /** Transfers without a reply from the adapter. */
  silent_transfers: number;
  /** Broadcasts that no board acknowledged. */
  unheard_broadcasts: number;
  reconnections: number;
  cycle_s: number;
  mean_cycle_s: number;
  longest_cycle_s: number;
  /** Delay of the cycle's start. */
  lateness_s: number;
  mean_lateness_s: number;
  longest_lateness_s: number;
}

export interface RobotEvent {
  time_s: number;
  text: string;
}

/** Status of a robot. */
export interface RobotStatus {
  /** Time of this status. */
  time_s: number;
  /** ready: armed, so that the next command may power the motors. */
  stage: "unconfigured" | "inactive" | "ready" | "active";
  /** Commanded mode of the boards. */
  commanded: string;
  /** An emergency stop was requested and faults have not been cleared since. */
  stopping: boolean;
  /** All present problems as text. */
  alarms: string[];
  boards: BoardStatus[];
  motors: MotorStatus[];
  link: LinkStatus;
  /** Folder to which all cycles are recorded; empty: none. */
  recording: string;
  /** Recent events, oldest first. */
  events: RobotEvent[];
}
