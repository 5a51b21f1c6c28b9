// Statics of a structure as a message source: a scene without a run.
import type { ClientMessage, StaticsPage } from "../protocol";
import { PROTOCOL_VERSION } from "../protocol";
import type { Listener, Source } from "../source";

export class StaticsSource implements Source {
  constructor(private readonly statics: StaticsPage) {}

  start(listener: Listener): void {
    listener.connection("report");
    listener.message({ type: "hello", version: PROTOCOL_VERSION, mode: "replay", title: this.statics.title, client: 1, driver: 1 });
    listener.message({ type: "scene", scene: this.statics.scene });
  }

  send(_message: ClientMessage): boolean {
    return true;
  }
}
