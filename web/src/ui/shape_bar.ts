// Animation of modes: computed on the page for a model, replayed in a loop for a trace. A bar shows number and
// frequency and selects the next mode. With reduced motion, nothing moves until the user starts it.
import type { App } from "../app";
import type { MotionShape, Scene, ShapeInfo } from "../protocol";
import { largestDisplacement, swung } from "../scene/swing";
import type { View } from "../scene/view";
import { button, el, number, Signal } from "../util";

const PERIOD_S = 2;
/** Largest displacement relative to the robot's size, as in `taut analyze --out`. */
const AMPLITUDE = 0.08;
const END = 1e-6;

const reducedMotion = () => matchMedia("(prefers-reduced-motion: reduce)").matches;

/** Returns the share of its amplitude, -1 to 1, at which an oscillation is shown now. */
export function amplitudeNow(started_ms: number): number {
  return reducedMotion() ? 1 : Math.sin((2 * Math.PI * (performance.now() - started_ms)) / 1000 / PERIOD_S);
}

/** Returns the factor on a mode shape with the shown amplitude. */
export function modeAmplitude(scene: Scene, shape: MotionShape, size_m: number): number {
  return (AMPLITUDE * size_m) / (largestDisplacement(scene, shape) || 1);
}

/** Describes a shape: number, frequency, and how its motion differs from the real one. */
export function shapeText({ kind, number: place, count, frequency_hz, slowdown, amplitude }: ShapeInfo): string {
  return [`${kind.replace("_", "-")} ${place} of ${count}`,
    ...(frequency_hz ? [`${number(frequency_hz, 3)} Hz`] : []),
    ...(slowdown ? [slowdown >= 1 ? `slowed ${number(slowdown, 2)}×` : `sped up ${number(1 / slowdown, 2)}×`] : []),
    ...(amplitude ? [`amplitude: ${number(100 * amplitude, 2)} % of the robot's size`] : [])].join(" · ");
}

/** The mode of the model that is animated at present; null: none. */
export class ModePlayer {
  readonly playing = new Signal<number | null>(null);
  private started_ms = 0;

  constructor(private readonly app: App, private readonly view: View) {
    app.scene.watch(() => this.stop());
    app.frame.watch((frame) => {
      if (frame && frame.paused === 0 && app.movable) this.stop(); // the simulation continues
    });
  }

  get modes(): readonly MotionShape[] {
    return this.app.tuning.value?.statics?.modes ?? [];
  }

  play(mode: number): void {
    if (!this.modes[mode]) return;
    const starts = this.playing.value === null;
    this.playing.value = mode;
    this.started_ms = performance.now();
    this.view.world?.showShape(true);
    if (starts) this.swing();
  }

  stop(): void {
    if (this.playing.value === null) return;
    this.playing.value = null;
    this.view.override = null;
    this.view.world?.showShape(false);
    if (this.app.frame.value) this.view.world?.update(this.app.frame.value);
    this.view.invalidate();
  }

  private swing(): void {
    const { value: scene } = this.app.scene;
    const shape = this.playing.value === null ? undefined : this.modes[this.playing.value];
    const { world } = this.view;
    if (!scene || !shape || !world) return;
    this.view.override = swung(scene, shape, amplitudeNow(this.started_ms) * modeAmplitude(scene, shape, world.size_m));
    world.update(this.view.override);
    this.view.invalidate();
    requestAnimationFrame(() => this.swing());
  }

  /** Describes the mode that is animated. */
  info(): ShapeInfo | null {
    const place = this.playing.value;
    if (place === null) return null;
    const { frequency_hz } = this.modes[place]!;
    const known = frequency_hz > 0 ? { frequency_hz, slowdown: frequency_hz * PERIOD_S } : {};
    return { kind: "mode", number: place + 1, count: this.modes.length, amplitude: AMPLITUDE, ...known };
  }
}

/** Replays the motion of a shape in a loop, unless the user pauses it. */
function replayShapes(app: App): void {
  let begun: Scene | null = null;
  app.frame.watch((frame) => {
    const { value: scene } = app.scene;
    if (!frame || !scene?.shape || scene.shape.kind === "self_stress" || frame.run < 0 || reducedMotion() || !app.drives) return;
    const ended = frame.paused !== 0 && frame.time_s >= scene.duration_s - END;
    if (begun === scene && !ended) return;
    begun = scene;
    queueMicrotask(() => app.send({ type: "resume" }));
  });
}

export function shapeBar(app: App, player: ModePlayer): HTMLElement {
  const text = el("span", { role: "status" });
  const go = (by: number) => {
    const { value: playing } = player.playing;
    const shape = app.scene.value?.shape;
    if (playing !== null) player.play((playing + by + player.modes.length) % player.modes.length);
    else if (shape) app.send({ type: "open_shape", number: ((shape.number - 1 + by + shape.count) % shape.count) + 1 });
  };
  const back = button("‹", "previous mode", () => go(-1), "button.small");
  const next = button("›", "next mode", () => go(1), "button.small");
  const close = button("×", "stop the mode", () => player.stop(), "button.small");
  const element = el("div.shapebar", { role: "group", "aria-label": "mode", hidden: true }, back, text, next, close);
  const draw = () => {
    const local = player.info();
    const info = local ?? app.scene.value?.shape ?? null;
    element.hidden = info === null;
    if (!info) return;
    text.textContent = shapeText(info);
    close.hidden = local === null;
    back.hidden = next.hidden = info.count < 2 || (local === null && app.report !== null);
  };
  app.scene.watch(draw);
  player.playing.watch(draw);
  replayShapes(app);
  return element;
}
