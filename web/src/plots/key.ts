// Which colour is what in the tension plots; a line is named only where there is one.
import type { App } from "../app";
import { palette } from "../colours";
import { el } from "../util";

export function key(app: App): HTMLElement {
  const element = el("span.key", { "aria-label": "lines" });
  const draw = () => {
    const scene = app.scene.value;
    const colours = palette(app.theme.value);
    const entries: [string, string][] = [[colours.setpoint, "set point"]];
    if (scene?.reference && scene.reference.channels.length > 0) entries.push([colours.measured, `measured (${scene.reference.name})`]);
    entries.push([colours.simulated, "simulated"]);
    element.replaceChildren(...entries.map(([colour, text]) => {
      const dash = el("i");
      dash.style.background = colour;
      return el("span", {}, dash, text);
    }));
  };
  app.scene.watch(draw);
  app.theme.watch(draw);
  return element;
}
