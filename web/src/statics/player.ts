// Picture of a load case: the displaced structure over the described one, or a mode that oscillates about it.
import { forceColour, useColour } from "../colours";
import { frameOfScene, type Frame } from "../frame";
import { VALUES } from "../layout";
import type { Body, LoadedCase, Scene } from "../protocol";
import { largestDisplacement, swung } from "../scene/swing";
import type { View } from "../scene/view";
import type { MemberColours } from "../scene/world";
import { amplitudeNow, modeAmplitude } from "../ui/shape_bar";
import { niceAbove, number, Signal } from "../util";

/** Quantity that the colors of members show. */
export type Coloring = "utilization" | "force";

/** JSON has no NaN. */
const numbers = (list: readonly (number | null)[]) => Float64Array.from(list, (value) => value ?? NaN);

/** Returns whether the limit of any member is known. */
export const hasUse = ({ cable_use, body_use, joint_use }: LoadedCase) => [cable_use, body_use, joint_use].some((uses) => uses.some((use) => use !== null));

const forceText = (force_n: number) => (force_n < 1e4 ? `${number(force_n, 2)} N` : `${number(force_n / 1000, 2)} kN`);

/** Returns the colors of the members under a load case. */
export function coloursOf(loaded: LoadedCase, coloring: Coloring): MemberColours {
  if (coloring === "utilization") {
    const [cables, bodies, joints] = [loaded.cable_use, loaded.body_use, loaded.joint_use].map(numbers) as [Float64Array, Float64Array, Float64Array];
    return { cables, bodies, joints, scale: useColour, title: "utilization", ends: [0, 1], marks: ["0", "50 %", "100 %"] };
  }
  const tensions = numbers(loaded.cables).filter((_, i) => i % VALUES.cables === 0);
  const forces = [tensions, numbers(loaded.body_force_n), numbers(loaded.joint_force_n)];
  const most_n = niceAbove(forces.reduce((most, list) => list.reduce((a, force) => (Math.abs(force) > a ? Math.abs(force) : a), most), 0) || 1);
  const [cables, bodies, joints] = forces.map((list) => list.map((force) => force / most_n)) as [Float64Array, Float64Array, Float64Array];
  const text = forceText(most_n);
  return { cables, bodies, joints, scale: forceColour, title: "axial force", ends: [-1, 1], marks: [`−${text}`, "0", `+${text}`] };
}

export class CasePlayer {
  /** Index of the mode that oscillates; null: none. */
  readonly mode = new Signal<number | null>(null);
  readonly exaggeration = new Signal(1);
  readonly coloring = new Signal<Coloring>("force");
  private started_ms = 0;

  constructor(private readonly scene: Scene, private loaded: LoadedCase, private readonly view: View) {
    for (const signal of [this.exaggeration, this.coloring]) signal.watch(() => this.draw());
  }

  show(loaded: LoadedCase): void {
    this.mode.value = null;
    this.loaded = loaded;
    this.draw();
  }

  /** Starts a mode; stops it if it oscillates already. */
  play(mode: number): void {
    const starts = this.mode.value === null;
    this.mode.value = this.mode.value === mode ? null : mode;
    this.started_ms = performance.now();
    if (this.mode.value === null) this.draw();
    else if (starts) this.swing();
  }

  /** Largest displacement of the load case [m]. */
  get displacement_m(): number {
    return this.loaded.displacement ? largestDisplacement(this.scene, this.loaded.displacement) : 0;
  }

  draw(): void {
    const { world } = this.view;
    if (!world) return;
    world.showRest(this.displacement_m > 0 || this.mode.value !== null);
    world.showColours(coloursOf(this.loaded, this.coloring.value));
    this.put(this.displaced());
  }

  private put(frame: Frame): void {
    this.view.override = frame;
    this.view.world?.update(frame);
    this.view.invalidate();
  }

  /** Returns the displaced structure with its loads and reactions. */
  private displaced(): Frame {
    const { displacement, loads, reactions, cables } = this.loaded;
    const frame = displacement ? swung(this.scene, displacement, this.exaggeration.value) : frameOfScene(this.scene);
    frame.cables = numbers(cables);
    frame.pushes = numbers(loads);
    frame.push_count = loads.length / VALUES.pushes;
    frame.contacts = numbers(reactions);
    frame.contact_rows = frame.contact_count = reactions.length / VALUES.contacts;
    return frame;
  }

  private swing(): void {
    const { world } = this.view;
    const shape = this.mode.value === null ? undefined : this.loaded.modes[this.mode.value];
    if (!world || !shape) return;
    world.showRest(true);
    const about = this.displaced();
    const there = { ...this.scene, bodies: this.scene.bodies.map((body, i) => moved(body, about, i)) };
    const frame = swung(there, shape, amplitudeNow(this.started_ms) * modeAmplitude(there, shape, world.size_m));
    frame.cables = about.cables;
    this.put(frame);
    requestAnimationFrame(() => this.swing());
  }
}

/** Returns a body in its pose of a frame. */
function moved(body: Body, { bodies }: Frame, index: number): Body {
  const at = (k: number) => bodies[index * VALUES.bodies + k]!;
  return { ...body, position_m: [at(0), at(1), at(2)], orientation: [at(3), at(4), at(5), at(6)] };
}
