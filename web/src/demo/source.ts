// Simulation core in a worker as a message source with the server's protocol.
import { decodeFrame } from "../frame";
import type { ClientMessage, ServerMessage } from "../protocol";
import type { Listener, Source } from "../source";
import { Signal } from "../util";
import type { Checked, Files, RunState } from "./core";
import type { FromWorker, ToWorker } from "./worker";

export class WorkerSource implements Source {
  /** State of the displayed run. */
  readonly state = new Signal<RunState | null>(null);
  readonly failure = new Signal<string | null>(null);
  readonly ready: Promise<void>;
  private readonly worker = new Worker(new URL("./worker.ts", import.meta.url), { type: "module" });
  private readonly asked = new Map<number, (checked: Checked) => void>();
  private listener: Listener | null = null;
  private next = 1;
  private loaded = false;
  private isReady: () => void = () => {};

  constructor(core: string, files: Files) {
    this.ready = new Promise((resolve) => (this.isReady = resolve));
    this.worker.onmessage = ({ data }: MessageEvent<FromWorker>) => this.receive(data);
    this.worker.onerror = (event) => this.fail(event.message || "the worker could not be started");
    this.tell({ kind: "load", core, files });
  }

  start(listener: Listener): void {
    this.listener = listener;
    listener.connection(this.loaded ? "open" : "connecting");
  }

  send(message: ClientMessage): boolean {
    if (!this.loaded) return false;
    this.tell({ kind: "post", text: JSON.stringify(message) });
    return true;
  }

  check(path: string, edits: Files): Promise<Checked> {
    return this.ask((id) => ({ kind: "check", id, path, edits }));
  }

  /** Runs a file from its start. If it has errors, the previous run continues. */
  open(path: string, edits: Files, mark_at_s: number[], paused: boolean): Promise<Checked> {
    return this.ask((id) => ({ kind: "open", id, path, edits, mark_at_s, paused }));
  }

  private async ask(question: (id: number) => ToWorker): Promise<Checked> {
    await this.ready;
    const id = this.next++;
    const answer = new Promise<Checked>((resolve) => this.asked.set(id, resolve));
    this.tell(question(id));
    return answer;
  }

  private tell(message: ToWorker): void {
    this.worker.postMessage(message);
  }

  private fail(why: string): void {
    this.loaded = false;
    this.failure.value = why;
    this.listener?.connection("lost");
  }

  private receive(message: FromWorker): void {
    switch (message.kind) {
      case "loaded":
        this.loaded = true;
        this.isReady();
        this.listener?.connection("open");
        break;
      case "failed":
        this.fail(message.why);
        break;
      case "checked":
        this.asked.get(message.id)?.(message.checked);
        this.asked.delete(message.id);
        break;
      case "refused":
        this.listener?.message({ type: "error", text: message.why });
        break;
      case "messages":
        for (const each of message.messages) this.listener?.message(each as ServerMessage);
        break;
      case "frame":
        this.listener?.frame(decodeFrame(new Float64Array(message.frame)));
        // The next frame follows once this one is displayed; a hidden page draws nothing, and advances
        // slowly.
        this.afterDrawing(() => this.tell({ kind: "drawn" }));
        break;
      case "state":
        this.state.value = message.state;
        break;
    }
  }

  private afterDrawing(then: () => void): void {
    if (document.hidden) setTimeout(then, 100);
    else requestAnimationFrame(then);
  }
}
