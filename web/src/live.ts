// Server as a message source: one WebSocket, reopened whenever the connection is lost.
import { decodeFrame } from "./frame";
import type { ClientMessage, ServerMessage } from "./protocol";
import type { Listener, Source } from "./source";

const FIRST_RETRY_MS = 250;
const LAST_RETRY_MS = 2000;

export class ServerSource implements Source {
  private socket: WebSocket | null = null;
  private listener: Listener | null = null;
  private retry_ms = FIRST_RETRY_MS;

  start(listener: Listener): void {
    this.listener = listener;
    this.open();
  }

  send(message: ClientMessage): boolean {
    if (this.socket?.readyState !== WebSocket.OPEN) return false;
    this.socket.send(JSON.stringify(message));
    return true;
  }

  private open(): void {
    // The token, if the server requires one, is in the page's address.
    const address = new URL(`ws${location.search}`, location.href);
    address.protocol = location.protocol === "https:" ? "wss:" : "ws:";
    address.hash = "";
    const socket = new WebSocket(address);
    socket.binaryType = "arraybuffer";
    this.socket = socket;
    let opened = false;
    socket.onopen = () => {
      opened = true;
      this.retry_ms = FIRST_RETRY_MS;
      this.listener?.connection("open");
    };
    socket.onmessage = (event: MessageEvent<string | ArrayBuffer>) => this.receive(event.data);
    socket.onclose = async () => {
      // Browsers do not report why a WebSocket fails to open; a plain request gets an answer.
      const state = !opened && (await refused()) ? "refused" : "lost";
      this.listener?.connection(state);
      setTimeout(() => this.open(), this.retry_ms);
      this.retry_ms = Math.min(2 * this.retry_ms, LAST_RETRY_MS);
    };
  }

  private receive(data: string | ArrayBuffer): void {
    if (typeof data === "string") this.listener?.message(JSON.parse(data) as ServerMessage);
    else this.listener?.frame(decodeFrame(new Float64Array(data)));
  }
}

/** Returns whether the server rejects the token. A restarted server has new tokens. */
async function refused(): Promise<boolean> {
  try {
    return (await fetch(location.href, { method: "HEAD", cache: "no-store" })).status === 403;
  } catch {
    return false;
  }
}
