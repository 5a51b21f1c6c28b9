// Simulation core on a worker thread: it advances independently and never blocks the page.
import { type Checked, Core, type Files, type RunState } from "./core";

export type ToWorker =
  | { kind: "load"; core: string; files: Files }
  | { kind: "check"; id: number; path: string; edits: Files }
  | { kind: "open"; id: number; path: string; edits: Files; mark_at_s: number[]; paused: boolean }
  | { kind: "post"; text: string }
  /** The last frame has been drawn: the next may be sent. */
  | { kind: "drawn" };

export type FromWorker =
  | { kind: "loaded" }
  | { kind: "failed"; why: string }
  | { kind: "checked"; id: number; checked: Checked }
  | { kind: "refused"; why: string }
  | { kind: "messages"; messages: unknown[] }
  | { kind: "frame"; frame: ArrayBuffer }
  | { kind: "state"; state: RunState | null };

const STATE_PERIOD_MS = 200;

const worker = self as unknown as { postMessage(message: FromWorker, transfer?: Transferable[]): void; onmessage: unknown };
const say = (message: FromWorker, transfer: Transferable[] = []) => worker.postMessage(message, transfer);
let core: Core | null = null;
let timer = 0;
let frame_is_out = false;
let state_said_ms = -Infinity;
let state_said = "";
// A timer waits for at least 4 ms; a message to the same worker arrives at once, after pending messages.
const again = new MessageChannel();
let comes = false;
again.port1.onmessage = () => {
  comes = false;
  turn();
};

function turn(): void {
  if (!core) return;
  try {
    const wait_ms = core.turn();
    tell(core);
    clearTimeout(timer);
    if (wait_ms >= 1) timer = self.setTimeout(turn, wait_ms);
    else if (!comes) again.port2.postMessage(null);
    comes ||= wait_ms < 1;
  } catch (error) {
    fail(error);
  }
}

function tell(from: Core): void {
  const messages = from.messages();
  if (messages.length > 0) say({ kind: "messages", messages });
  if (!frame_is_out) {
    const frame = from.frame();
    if (frame) {
      frame_is_out = true;
      say({ kind: "frame", frame }, [frame]);
    }
  }
  const now_ms = performance.now();
  if (now_ms - state_said_ms < STATE_PERIOD_MS) return;
  state_said_ms = now_ms;
  const state = from.state();
  const text = JSON.stringify(state);
  if (text !== state_said) say({ kind: "state", state });
  state_said = text;
}

function fail(error: unknown): void {
  core = null;
  say({ kind: "failed", why: error instanceof Error ? error.message : String(error) });
}

async function receive(message: ToWorker): Promise<void> {
  if (message.kind === "load") {
    core = await Core.load(message.core);
    core.give(message.files);
    say({ kind: "loaded" });
    return;
  }
  if (!core) return;
  switch (message.kind) {
    case "check":
      say({ kind: "checked", id: message.id, checked: core.check(message.path, message.edits) });
      return;
    case "open":
      say({ kind: "checked", id: message.id, checked: core.open(message.path, message.edits, message.mark_at_s, message.paused) });
      state_said_ms = -Infinity;
      break;
    case "post": {
      const why = core.post(message.text);
      if (why !== "") say({ kind: "refused", why });
      break;
    }
    case "drawn":
      frame_is_out = false;
      return;
  }
  turn();
}

worker.onmessage = ({ data }: MessageEvent<ToWorker>) => void receive(data).catch(fail);
