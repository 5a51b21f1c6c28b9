// The server as a source: one WebSocket, opened anew whenever it is lost.
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
    // The token, if the server wants one, is in the page's own address.
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
      // Why a WebSocket does not open, browsers do not say; a plain request gets an answer.
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

/** Does the server not know our token? A new server has new ones. */
async function refused(): Promise<boolean> {
  try {
    return (await fetch(location.href, { method: "HEAD", cache: "no-store" })).status === 403;
  } catch {
    return false;
  }
}
