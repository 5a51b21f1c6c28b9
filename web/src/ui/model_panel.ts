// A model without a run: members by tag, prestress, self-stress, first modes, and buttons that start a run.
import type { App } from "../app";
import { cableState, type Frame } from "../frame";
import { cableGroups } from "../plots/groups";
import type { Scene, Statics } from "../protocol";
import { rodOf } from "../report/limits";
import { Compression } from "../scene/compression";
import { button, counted, el, number, SCROLLS } from "../util";
import type { ModePlayer } from "./shape_bar";

/** Larger models are analyzed on request only, because that can take seconds. */
const FEW_CABLES = 150;
const DIGITS = 3;

/** `analyzes`: the source computes statics; taut in the browser does not. */
export function modelPanel(app: App, player: ModePlayer, plots: HTMLElement, analyzes: boolean): HTMLElement {
  const members = el("div.scroll", SCROLLS);
  const statics = el("div.statics");
  const start = (as: "described" | "dropped" | "settled") => () => app.send({ type: "start", as });
  const analyze = button("analyze", "compute self-stress, mechanisms and modes", () => app.send({ type: "analyze" }));
  const actions = el("div.row", { role: "group", "aria-label": "start a run" },
    button("drop it", "simulate the robot falling onto the ground", start("dropped"), "button.primary"),
    button("settle", "let the robot settle on the ground", start("settled")), analyze,
    button("as described", "return to the described pose, without gravity", start("described")));
  const element = el("section.model", { "aria-label": "the model", hidden: true }, el("h2", {}, "Model"), actions, members, statics);
  analyze.hidden = !analyzes;
  let asked: Scene | null = null;
  let drawn: { scene: Scene; run: number } | null = null;

  const isModel = () => app.hello.value?.mode === "model";
  const rests = (frame: Frame | null) => frame === null || (frame.paused !== 0 && frame.now_s === 0);
  const draw = () => {
    const { value: scene } = app.scene;
    const { value: frame } = app.frame;
    element.hidden = !isModel() || scene === null;
    plots.classList.toggle("resting", isModel() && rests(frame));
    if (element.hidden || !scene || !frame || frame.run < 0 || !rests(frame)) return;
    if (drawn?.scene !== scene || drawn.run !== frame.run) {
      drawn = { scene, run: frame.run };
      members.replaceChildren(memberTable(scene, frame));
    }
    if (!analyzes || asked !== null || scene.cables.length > FEW_CABLES || !app.drives) return;
    asked = scene;
    app.send({ type: "analyze" });
  };
  app.hello.watch(draw);
  app.scene.watch(draw);
  app.frame.watch(draw);
  app.tuning.watch((scene) => {
    if (!scene?.statics) statics.replaceChildren();
    else statics.replaceChildren(...staticsOf(scene.statics, player));
  });
  player.playing.watch((playing) => {
    for (const each of statics.querySelectorAll<HTMLElement>("button[data-mode]")) each.setAttribute("aria-pressed", String(Number(each.dataset["mode"]) === playing));
  });
  return element;
}

/** Formats the range of finite values, rounded: equal values of a computed prestress differ in their last bits. */
function range(values: readonly number[], digits = DIGITS): string {
  const known = values.filter(Number.isFinite).map((value) => Number(value.toPrecision(digits)));
  if (known.length === 0) return "–";
  const [least, most] = [Math.min(...known), Math.max(...known)].map((value) => number(value, digits)) as [string, string];
  return least === most ? least : `${least} to ${most}`;
}

function memberTable(scene: Scene, frame: Frame): HTMLElement {
  const index = new Map(scene.cables.map(({ name }, i) => [name, i]));
  const cables = cableGroups(scene.cables).map(({ name, cables: names }) => {
    const places = names.map((each) => index.get(each)!);
    const states = places.map((i) => cableState(frame, i));
    return [["cable", "cables"].includes(name) ? "cables" : `cables: ${name}`, String(names.length), range(states.map(({ tension_n }) => tension_n)),
      range(states.map(({ length_m }) => length_m)), range(places.map((i) => scene.cables[i]!.stiffness_n_per_m || NaN))];
  });
  const compression = new Compression(scene);
  compression.update(frame);
  const struts = scene.bodies.flatMap((body, i) => {
    const rod = rodOf(body);
    return rod ? [{ force_n: -(compression.force_n[i] ?? NaN), length_m: Math.hypot(...rod.to_m!.map((x, k) => x - rod.from_m![k]!)) }] : [];
  });
  const others = scene.bodies.length - struts.length;
  const rows = [...cables,
    ...(struts.length > 0 ? [["struts", String(struts.length), range(struts.map(({ force_n }) => force_n)), range(struts.map(({ length_m }) => length_m)), "–"]] : []),
    ...(others > 0 ? [[struts.length > 0 ? "other bodies" : "bodies", String(others), "–", "–", "–"]] : [])];
  const head = ["members", "number", "force [N]", "length [m]", "stiffness [N/m]"];
  return el("table.numbers", {}, el("caption", {}, "Members and prestress (tension is positive)"),
    el("thead", {}, el("tr", {}, ...head.map((text) => el("th", { scope: "col" }, text)))),
    el("tbody", {}, ...rows.map(([name, ...cells]) => el("tr", {}, el("th", { scope: "row" }, name!), ...cells.map((text) => el("td", {}, text))))));
}

function staticsOf(statics: Statics, player: ModePlayer): HTMLElement[] {
  const stress = statics.self_stress_states === 0 ? "none in this pose"
    : statics.feasible ? "a state puts all cables in tension" : "no state puts all cables in tension";
  const facts = el("dl.headline", {}, ...[
    [counted(statics.self_stress_states, "state"), "self-stress", stress],
    [String(statics.mechanisms), statics.mechanisms === 1 ? "mechanism" : "mechanisms", "infinitesimal"],
    [String(statics.rigid_motions), statics.rigid_motions === 1 ? "rigid motion" : "rigid motions", statics.rigid_motions === 0 ? "supported" : "free in the world"],
  ].map(([value, label, detail]) => el("div", {}, el("dt", {}, label!), el("dd", {}, el("b", {}, value!), detail!))));
  if (!statics.found) return [facts, el("p.remark", { role: "note" }, `No equilibrium near this pose: ${statics.reason}`)];
  const modes = statics.modes.map((mode, i) => {
    const label = mode.kind === "mechanism" ? "mechanism" : `${number(mode.frequency_hz, DIGITS)} Hz${mode.kind === "unstable" ? ", unstable" : ""}`;
    const made = button(`${i + 1}: ${label}`, `play mode ${i + 1}, ${label}`, () => (player.playing.value === i ? player.stop() : player.play(i)), "button.small");
    made.dataset["mode"] = String(i);
    made.setAttribute("aria-pressed", "false");
    return made;
  });
  return [facts, el("h3", {}, "First modes"), modes.length > 0 ? el("div.row", {}, ...modes) : el("p.remark", {}, statics.reason || "No modes other than rigid motions.")];
}
