// Page of a static analysis: load cases with pictures, modes that play, tables.
import "../style.css";
import "./statics.css";
import { App } from "../app";
import type { LoadedCase, StaticsPage } from "../protocol";
import { legend } from "../scene/legend";
import { View } from "../scene/view";
import { belowView } from "../ui/below_view";
import { icon } from "../ui/icons";
import { button, el, number } from "../util";
import { CasePlayer, type Coloring, hasUse } from "./player";
import { StaticsSource } from "./source";
import { resultTable } from "./tables";

/** Displacements are enlarged to this share of the structure's size by default, if they are smaller. */
const VISIBLE = 0.05;
const MOST_EXAGGERATION = 1000;
const DIGITS = 3;
const COLORINGS: Record<Coloring, string> = { utilization: "utilization", force: "axial force" };

export function staticsPage(root: HTMLElement, statics: StaticsPage): void {
  const app = new App(new StaticsSource(statics), null);
  document.body.classList.add("report", "statics");
  document.title = `${statics.title} – taut`;
  const view = new View(app);
  app.start();
  const all = [...statics.cases, ...statics.described];
  const player = new CasePlayer(statics.scene, all[0]!, view);
  player.coloring.value = all.some(hasUse) ? "utilization" : "force";

  const modes = el("div.row.modes", { role: "group", "aria-label": "modes" });
  const results = el("section.results", { "aria-live": "polite" });
  const moves = el("output");
  const slider = el<HTMLInputElement>("input", { type: "range", min: 0, max: Math.log10(MOST_EXAGGERATION), step: 0.05, "aria-label": "exaggeration of displacements" });
  const exaggerate = (factor: number) => {
    player.exaggeration.value = factor;
    slider.value = String(Math.log10(Math.max(factor, 1)));
    moves.textContent = `displacements × ${number(factor, 2)}`;
  };
  const choose = (index: number) => {
    const loaded = all[index]!;
    choice.value = String(index);
    player.show(loaded);
    exaggerate(Math.min(Math.max(1, twoDigits((VISIBLE * (view.world?.size_m ?? 0)) / (player.displacement_m || Infinity))), MOST_EXAGGERATION));
    exaggeration.hidden = player.displacement_m === 0;
    modes.replaceChildren(...(loaded.modes.length > 0 ? [el("span", {}, "modes"), ...modeButtons(loaded, player)] : []));
    results.replaceChildren(el("h2", {}, index < statics.cases.length ? `Load case ${loaded.name}` : `As described: ${loaded.name}`),
      ...(loaded.reason === "" ? [] : [el("p.verdict.bad", { role: "note" }, loaded.reason)]),
      ...loaded.tables.map((table) => resultTable(table)));
  };
  const choice = choiceOf("load case", caseGroups(statics), choose);
  const coloring = el<HTMLSelectElement>("select", { "aria-label": "color of members" }, ...Object.entries(COLORINGS).map(([value, text]) => el("option", { value }, text)));
  coloring.value = player.coloring.value;
  coloring.addEventListener("change", () => (player.coloring.value = coloring.value as Coloring));
  const exaggeration = el("label.row", {}, slider, moves);
  slider.addEventListener("input", () => exaggerate(twoDigits(10 ** Number(slider.value))));
  player.mode.watch((mode) => {
    for (const each of modes.querySelectorAll<HTMLElement>("button")) each.setAttribute("aria-pressed", String(Number(each.dataset["mode"]) === mode));
  });

  const below = belowView(view.element, view.draws ? [legend(app, view)] : []);
  const [verdict = "", ...lines] = statics.summary;
  root.append(
    el("header.top", {}, el("span.brand", {}, "taut"), el("h1", { title: statics.title }, statics.title), el("span.mode", {}, "statics"), el("span.spring"),
      button("print", "print, or save as PDF", () => print()), button(icon("theme"), "dark or light", () => app.toggleTheme())),
    el("main.report", {},
      el("section", {}, el("p.lead", {}, verdict), ...lines.map((line) => el("p.line", {}, line))),
      ...statics.tables.map((table) => el("section", {}, resultTable(table, "h2"))),
      el("section", {}, el("h2", {}, "Picture"),
        el("div.row.choose", {}, el("label.row", {}, "load case ", choice), el("label.row", {}, "color ", coloring), exaggeration), modes,
        el("div.replay", {}, view.element, below),
        el("p.remark", {}, "Translucent: as described. Utilization is the force of a member relative to its limit (buckling, yield or strength); members above 100 % are red, members without a known limit gray. Slack cables are dashed. Tension is positive.")),
      results));
  choose(0);
  printPicture(app, view);
  Object.assign(window, { taut: { app, view, player } });
}

/** Rounds to two digits. */
const twoDigits = (value: number) => Number(value.toPrecision(2));

/** Returns options for the load cases and for the described structure, whose indices follow. */
function caseGroups({ cases, described }: StaticsPage): HTMLElement[] {
  const options = (list: readonly LoadedCase[], first: number) => list.map(({ name }, i) => el("option", { value: first + i }, name));
  if (described.length === 0) return options(cases, 0);
  return [el("optgroup", { label: "load cases" }, ...options(cases, 0)), el("optgroup", { label: "as described, without loads" }, ...options(described, cases.length))];
}

function choiceOf(label: string, options: HTMLElement[], choose: (index: number) => void): HTMLSelectElement {
  const made = el<HTMLSelectElement>("select", { "aria-label": label }, ...options);
  made.addEventListener("change", () => choose(Number(made.value)));
  return made;
}

function modeButtons(loaded: LoadedCase, player: CasePlayer): HTMLElement[] {
  return loaded.modes.map((mode, i) => {
    const text = mode.kind === "mechanism" ? "mechanism" : mode.kind === "unstable" ? "unstable" : `${number(mode.frequency_hz, DIGITS)} Hz`;
    const made = button(`${i + 1}: ${text}`, `play mode ${i + 1}, ${text}`, () => player.play(i), "button.small");
    made.dataset["mode"] = String(i);
    made.setAttribute("aria-pressed", "false");
    return made;
  });
}

/** Replaces the 3-D view by a picture while the page is printed, since browsers print it empty; on white. */
function printPicture(app: App, view: View): void {
  if (!view.draws) return;
  const picture = el<HTMLImageElement>("img.printed", { alt: "the structure under the load case", hidden: true });
  view.element.prepend(picture);
  let theme = app.theme.value;
  addEventListener("beforeprint", () => {
    theme = app.theme.value;
    app.theme.value = "light";
    view.draw();
    picture.src = view.canvas.toDataURL();
    picture.hidden = false;
  });
  addEventListener("afterprint", () => {
    picture.hidden = true;
    app.theme.value = theme;
  });
}
