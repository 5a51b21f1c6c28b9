// Help dialog for keys and mouse.
import { button, el } from "../util";
import type { Key } from "./keyboard";

const MOUSE: readonly [string, string][] = [
  ["drag", "turn the view"],
  ["right drag, or shift and drag", "move the view"],
  ["wheel", "zoom"],
  ["click", "numbers and plots of a cable or body"],
  ["drag a node", "pull it with a spring (live)"],
  ["drag in a plot", "zoom into that time range; double click: whole range"],
  ["click in a plot", "go to that time"],
];

export class Help {
  readonly element = el<HTMLDialogElement>("dialog.help", { "aria-label": "help" });

  fill(keys: readonly Key[]): void {
    const rows = (list: readonly (readonly [string, string])[]) =>
      el("table", {}, ...list.map(([what, does]) => el("tr", {}, el("th", { scope: "row" }, what), el("td", {}, does))));
    this.element.replaceChildren(
      button("close", "close this help (esc)", () => this.toggle()),
      el("h2", {}, "Keys"), rows(keys.map((key) => [key.shown, key.does] as const)),
      el("h2", {}, "Mouse"), rows(MOUSE));
  }

  toggle(): void {
    if (this.element.open) this.element.close();
    else this.element.showModal();
  }
}
