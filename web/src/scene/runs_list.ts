// List of the runs in the 3D view: name and color, a switch for the ghost, and its distance from this run's
// robot.
import { Vector3 } from "three";
import type { App } from "../app";
import type { Frame } from "../frame";
import type { ComparedRun, Scene } from "../protocol";
import { runName, swatch, thisRunName } from "../runs";
import { el, number } from "../util";
import type { Ghost } from "./ghosts";
import { centreOfMass } from "./poses";
import type { View } from "./view";

const NARROW = "(max-width: 900px)"; // where the list would cover the robot

export function runsList(app: App, view: View): HTMLElement {
  const count = el("summary");
  const list = el("ul");
  const element = el<HTMLDetailsElement>("details.runs", { "aria-label": "runs" }, count, list);
  element.open = !matchMedia(NARROW).matches;
  let rows: RunRow[] = [];

  app.scene.watch((scene) => {
    element.hidden = scene === null || scene.compared.length === 0;
    if (!scene || scene.compared.length === 0) return;
    rows = scene.compared.map((run, k) => new RunRow(run, k, view));
    count.textContent = `${rows.length + 1} runs`;
    list.replaceChildren(el("li", {}, el("span.own", {}, swatch(0), el("span.name", {}, thisRunName(scene)))), ...rows.map((row) => row.element));
  });
  const draw = () => {
    const { value: scene } = app.scene;
    const { value: frame } = app.frame;
    if (scene && frame) for (const row of rows) row.show(scene, frame);
  };
  app.scene.watch(draw);
  app.frame.watch(draw);
  return element;
}

/** Shows all ghosts, or, if all are visible, hides them. */
export function toggleGhosts(view: View): void {
  const switches = [...view.element.querySelectorAll<HTMLInputElement>(".runs input:not(:disabled)")];
  const on = switches.some(({ checked }) => !checked);
  for (const each of switches) {
    each.checked = on;
    each.dispatchEvent(new Event("change"));
  }
}

class RunRow {
  readonly element: HTMLElement;
  private readonly away = el("span.away");

  constructor(private readonly run: ComparedRun, private readonly place: number, private readonly view: View) {
    const has = run.bodies.length > 0;
    const ghost = el<HTMLInputElement>("input", {
      type: "checkbox", checked: has, disabled: !has, "aria-label": `ghost of ${run.name}`,
      onchange: () => {
        if (this.ghost) this.ghost.shown = ghost.checked;
        view.invalidate();
      },
    });
    const label = el("label", { title: has ? "show or hide its ghost" : (run.notice ?? "") }, ghost, swatch(place + 1), el("span.name", {}, runName(run)));
    this.element = el("li", {}, label, this.away);
    if (run.notice !== undefined) this.element.append(el("span.note", {}, run.notice));
  }

  private get ghost(): Ghost | undefined {
    return this.view.world?.ghosts.ghosts[this.place];
  }

  /** Displays the distance between the centers of mass, or why it is unknown. */
  show(scene: Scene, frame: Frame): void {
    const { ghost, run } = this;
    if (!ghost || run.bodies.length === 0) return;
    const [own, other] = [new Vector3(), new Vector3()];
    if (!ghost.present) {
      this.away.textContent = frame.time_s < run.first_s ? `begins at ${number(run.first_s, 4)} s` : `ended at ${number(run.last_s, 4)} s`;
    } else if (centreOfMass(scene, frame, own) && centreOfMass(ghost, ghost.poses, other)) {
      this.away.textContent = `${number(1000 * own.distanceTo(other), 3)} mm away`;
      this.away.title = `distance between the centers of mass: ${own.distanceTo(other)} m`;
    } else {
      this.away.textContent = "";
    }
  }
}
