// Layout of a page: 3D view, plots at its side, timeline below, and overlays.
import "uplot/dist/uPlot.min.css";
import "./style.css";
import "./robot/robot.css";
import "./runs.css";
import type { App } from "./app";
import { PlotPanel } from "./plots/panel";
import { reportPage } from "./report/page";
import { legend } from "./scene/legend";
import { foresee } from "./scene/foresee";
import { runsList } from "./scene/runs_list";
import { View } from "./scene/view";
import { viewTools } from "./scene/view_tools";
import { alarms, poseNote, robotBar } from "./robot/bar";
import { robotPanel } from "./robot/panel";
import { giveRunColours } from "./runs";
import { SeriesStore } from "./series";
import { belowView } from "./ui/below_view";
import { controls } from "./ui/controls";
import { gifMaker } from "./ui/gif";
import { failurePage, header, notices } from "./ui/header";
import { headline } from "./ui/headline";
import { Help } from "./ui/help";
import { inspector } from "./ui/inspector";
import { keysOf, listenToKeys } from "./ui/keyboard";
import { modelPanel } from "./ui/model_panel";
import { recorder } from "./ui/record";
import { ModePlayer, shapeBar } from "./ui/shape_bar";
import { timeline } from "./ui/timeline";
import { videoMakers } from "./ui/video";
import { button, el } from "./util";

/** Additional parts of some pages. */
export interface More {
  /** Element to the left of the view. */
  beside?: HTMLElement;
  /** Buttons at the top, before the common ones. */
  buttons?: HTMLElement[];
  /** Advice if there is nothing to display. */
  advice?: string;
}

/** Fills the page and starts the app's source. */
export function buildPage(root: HTMLElement, app: App, more: More = {}): void {
  const { report } = app;
  app.theme.watch(giveRunColours);
  const store = new SeriesStore(app);
  const view = new View(app);
  const plots = new PlotPanel(app, store);
  const help = new Help();
  foresee(app, store, view);

  const drawer = controls(app);
  drawer.hidden = true;
  const toggleControls = () => {
    if (app.movable && !app.watches) drawer.hidden = !drawer.hidden;
  };
  const controlsButton = button("controls", "live controls (C)", toggleControls);
  app.hello.watch(() => (controlsButton.hidden = !app.movable || app.watches));
  const keys = keysOf(app, view, { help: () => help.toggle(), controls: toggleControls, editor: () => plots.toggleEditor(), search: () => plots.searchChannels() });
  help.fill(keys);
  listenToKeys(app, keys);

  view.element.append(runsList(app, view), ...(view.draws ? [viewTools(app, view)] : []));
  const below = belowView(view.element, [poseNote(app, view.element), ...(view.draws ? [legend(app, view)] : []), inspector(app)]);
  const numbers = headline(app, store);
  const player = new ModePlayer(app, view);
  view.element.append(shapeBar(app, player));
  plots.element.prepend(robotPanel(app), drawer, ...(report ? [] : [modelPanel(app, player, plots.element, more.beside === undefined)]));
  const top = header(app, () => help.toggle(), [...(more.buttons ?? []), controlsButton, recorder(app, view), gifMaker(app, store, view), ...videoMakers(app, store, view)]);
  const overlays = [help.element, notices(app), failurePage(app, more.advice)];
  if (report) reportPage(root, report, { top, numbers, view, plots, timeline: timeline(app), overlays });
  else {
    plots.element.prepend(numbers);
    root.append(top, alarms(app), el("main.split", {}, ...(more.beside ? [more.beside] : []), view.element, plots.element), timeline(app), robotBar(app), ...overlays);
  }
  view.element.after(below);
  Object.assign(window, { taut: { app, view, store } });
  app.start();
}

/** Shows the reason in place of a page that could not be built. */
export function sayWhyNot(root: HTMLElement, error: unknown): void {
  const reason = error instanceof Error ? error.message : String(error);
  root.replaceChildren(el("main.failure", { role: "alert" }, el("h1", {}, "This page cannot be shown"), el("pre", {}, reason)));
}
