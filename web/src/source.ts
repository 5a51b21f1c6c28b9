// Interface of message sources: a server, or the data inside a report, with the same protocol.
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
  /** Returns false if the message could not be sent, for example while the connection is lost. */
  send(message: ClientMessage): boolean;
}
