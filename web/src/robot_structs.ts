// Made of web/protocol/messages.json by script/protocol. Do not edit.

/** A gain of impedance control that may change while a motor runs. */
export interface RobotGain {
  /** As in docs/hardware/parameters.md; ends in its unit. */
  key: string;
  min: number;
  max: number;
}

/** A robot that motor boards move. */
export interface Robot {
  /** Of the adapter. */
  port: string;
  /** The cable of each motor, in their order. Board b has 2 b and 2 b + 1. */
  motors: string[];
  /** Of each motor. */
  gains: RobotGain[];
  /** Bodies are where the virtual robot says that they are; else as the model describes them, because nobody measures it. */
  true_pose: boolean;
  /** An experiment drives it: robot_mode takes `off` alone. */
  experiment: boolean;
  /** record is obeyed. */
  may_record: boolean;
}

export interface BoardStatus {
  /** It answers. */
  there: boolean;
  /** It is there, without faults, time-out and stop. */
  well: boolean;
  /** off, hold, impedance, stopped ... */
  mode: string;
  /** Its encoders know where they are. */
  referenced: boolean;
  /** It heard no broadcast in time. */
  timeout: boolean;
  /** It began anew since faults were cleared last. */
  was_reset: boolean;
  /** In words, of its motors, too; empty: none. */
  faults: string;
  /** That came to it with a wrong checksum; modulo 256. */
  bad_messages: number;
  /** That came from it with a wrong checksum, or not at all. */
  bad_frames: number;
  /** Modulo 256. */
  missed_broadcasts: number;
  /** That did not know the broadcast before them. */
  stale_frames: number;
  /** Of its loop; modulo 256. */
  late_ticks: number;
  /** Modulo 256. */
  bus_recoveries: number;
  /** Its longest tick of late. */
  loop_time_s: number;
}

export interface MotorStatus {
  tension_n: number;
  /** null: it has none */
  setpoint_n: number;
  /** By the encoder. */
  rest_length_m: number;
  /** From the reference. */
  encoder_counts: number;
  /** -1 to 1; winding in positive. */
  duty: number;
  /** Of the winding, computed. */
  temperature_c: number;
  /** In words; empty: none. */
  faults: string;
  /** As the board has said; null: not yet. */
  gains: (number | null)[];
}

/** Between computer and boards. */
export interface LinkStatus {
  /** To the adapter. */
  connected: boolean;
  cycles: number;
  /** That had not ended when the next was due. */
  late_cycles: number;
  /** Without a reply from the adapter. */
  silent_transfers: number;
  /** That nobody acknowledged. */
  unheard_broadcasts: number;
  reconnections: number;
  cycle_s: number;
  mean_cycle_s: number;
  longest_cycle_s: number;
  /** Of the beginning. */
  lateness_s: number;
  mean_lateness_s: number;
  longest_lateness_s: number;
}

export interface RobotEvent {
  time_s: number;
  text: string;
}

/** How it is. */
export interface RobotStatus {
  /** Of what is said here. */
  time_s: number;
  /** ready: armed, the next command may give power. */
  stage: "unconfigured" | "inactive" | "ready" | "active";
  /** The mode that the boards are told. */
  commanded: string;
  /** An emergency stop, until faults are cleared. */
  stopping: boolean;
  /** All that is wrong, in words. */
  alarms: string[];
  boards: BoardStatus[];
  motors: MotorStatus[];
  link: LinkStatus;
  /** The folder that every cycle goes to; empty: none. */
  recording: string;
  /** The last ones, oldest first. */
  events: RobotEvent[];
}
