// Default plots: tensions of all cables or, if there are too many, of those with the largest tensions, in one large
// plot per group or one small plot per cable; values of a program; quantities of the whole system.
import type { App } from "../app";
import { cableState } from "../frame";
import type { Scene } from "../protocol";
import type { SeriesStore } from "../series";
import { cableGroups } from "./groups";
import type { PlotSpec } from "./layouts";

/** Up to this number, all cables are plotted; otherwise those with the largest tensions. */
const FEW_CABLES = 24;
const LARGEST = 12;
/** Up to this number, plots of groups contain all cables. */
const FEW_LINES = 48;
const LARGEST_LINES = 24;

const SYSTEM: readonly PlotSpec[] = [
  { title: "energy", channels: ["system/kinetic_j", "system/gravity_j", "system/elastic_j"] },
  { title: "contacts", channels: ["system/contact_count"] },
  { title: "real-time factor", channels: ["real_time_factor"] },
];

/** Returns one plot per group of cables. */
function groupPlots(scene: Scene, cables: readonly string[]): PlotSpec[] {
  const shown = new Set(cables);
  const groups = cableGroups(scene.cables.filter(({ name }) => shown.has(name)));
  return groups.map((group) => ({ title: groups.length > 1 ? `tension: ${group.name}` : "tension", channels: group.cables.map((name) => `cable/${name}/tension_n`) }));
}

/** Whether tensions have one plot per cable; compared runs, set points of boards and single cables need it. */
export function needsSmallPlots(scene: Scene): boolean {
  return scene.compared.length > 0 || scene.robot !== undefined || scene.cables.length < 2;
}

export function tensionPlot(cable: string): PlotSpec {
  return { title: cable, channels: [`cable/${cable}/setpoint_n`, `cable/${cable}/tension_n`] };
}

/** Returns a plot of one channel of a program. */
function alone(channel: string): PlotSpec {
  return { title: channel, channels: [channel] };
}

/** Returns plots of six cables each: the number of colors. */
function robotPlots(motors: readonly string[]): PlotSpec[] {
  const halves = [motors.slice(0, 6), motors.slice(6)].filter((list) => list.length > 0);
  const plots = (title: string, channel: string) => halves.map((list, i) =>
    ({ title: `${title}, boards ${3 * i} to ${3 * i + Math.ceil(list.length / 2) - 1}`, channels: list.map((name) => `cable/${name}/${channel}`) }));
  return [...plots("duty", "duty"), ...plots("rest length", "rest_length_m"), { title: "cycle", channels: ["link/cycle_s", "link/lateness_s"] }];
}

/**
 * Computes the default plots. `done` is called at once, or when the largest tensions are known, unless
 * another scene was requested since.
 */
export class DefaultPlots {
  private wanted = 0;

  constructor(
    private readonly app: App,
    private readonly store: SeriesStore,
  ) {}

  /** `small`: one plot per cable. */
  find(scene: Scene, small: boolean, done: (plots: PlotSpec[]) => void): void {
    const asked = ++this.wanted;
    const each = small || needsSmallPlots(scene);
    const all = scene.robot?.motors ?? scene.cables.map(({ name }) => name);
    // a layout derived from these must not contain channels that the run does not have
    const known = ({ title, channels }: PlotSpec) => ({ title, channels: channels.filter((name) => this.store.has(name, 0) || this.store.has(name, 1)) });
    const answer = (cables: readonly string[]) => {
      if (asked !== this.wanted) return;
      const tensions = each ? cables.map(tensionPlot) : groupPlots(scene, cables);
      done([...tensions, ...scene.values.map(alone), ...(scene.robot ? robotPlots(scene.robot.motors) : SYSTEM)].map(known).filter(({ channels }) => channels.length > 0));
    };
    const most = each ? LARGEST : LARGEST_LINES;
    if (all.length <= (each ? FEW_CABLES : FEW_LINES)) answer(all);
    else if (this.app.live) this.ofTheMoment(scene, most, answer);
    else this.ofTheWholeTime(scene, most, answer);
  }

  /** A live run has no complete time span yet: uses the tensions when the page opens. */
  private ofTheMoment(scene: Scene, most: number, answer: (cables: readonly string[]) => void): void {
    let stop = () => {};
    let found = false;
    stop = this.app.frame.watch((frame) => {
      if (found || !frame || frame.run < 0 || frame.cable_count !== scene.cables.length) return;
      found = true;
      queueMicrotask(() => stop());
      answer(largest(scene, most, (_, i) => cableState(frame, i).tension_n));
    });
  }

  private ofTheWholeTime(scene: Scene, count: number, answer: (cables: readonly string[]) => void): void {
    const most = new Map<string, number>();
    for (const { name } of scene.cables) {
      const channel = `cable/${name}/tension_n`;
      if (!this.store.has(channel, 0)) {
        most.set(name, -Infinity);
        continue;
      }
      this.store.want(channel, 0, scene.first_s, scene.duration_s, 2, ({ max }) => {
        most.set(name, Math.max(...max.map((value) => value ?? -Infinity)));
        if (most.size === scene.cables.length) answer(largest(scene, count, (cable) => most.get(cable)!));
      });
    }
  }
}

/** Returns the cables with the largest tensions in the order of the model; of equal ones the first. */
function largest(scene: Scene, count: number, tension_n: (cable: string, i: number) => number): string[] {
  const order = scene.cables.map(({ name }, i) => ({ i, n: tension_n(name, i) }));
  // unknown values sort last, so that the order is unique
  const known = (n: number) => (Number.isNaN(n) ? -Infinity : n);
  order.sort((a, b) => (known(b.n) > known(a.n) ? 1 : known(b.n) < known(a.n) ? -1 : a.i - b.i));
  return order.slice(0, count).map(({ i }) => i).sort((a, b) => a - b).map((i) => scene.cables[i]!.name);
}
