// Where what is seen comes from: a server, or the data inside a report. Both speak the protocol.
import type { Frame } from "./frame";
import type { ClientMessage, ServerMessage } from "./protocol";

export type Connection = "connecting" | "open" | "lost" | "refused" | "report";

export interface Listener {
  connection(state: Connection): void;
  message(message: ServerMessage): void;
  frame(frame: Frame): void;
}

export interface Source {
  start(listener: Listener): void;
  /** False if the message could not be sent, for instance while the connection is lost. */
  send(message: ClientMessage): boolean;
}
