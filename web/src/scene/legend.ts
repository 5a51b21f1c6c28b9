// Legend of the colors, widths and arrows in the 3D view.
import type { App } from "../app";
import { css, palette, tensionColour } from "../colours";
import { el, number } from "../util";
import { THICKEST_PX, THINNEST_PX } from "./cables";
import type { View } from "./view";

const WIDTH_PX = 168;
const UNRECORDED = "no contact forces in this trace; to record them: “record: {contacts: 20}” in the experiment";

export function legend(app: App, view: View): HTMLElement {
  const scale = el<HTMLCanvasElement>("canvas", { width: 2 * WIDTH_PX, height: 20, "aria-hidden": "true" });
  const marks = el("div.marks");
  const arrows = el("div.row");
  const joints = el("div.row");
  const grid = el("div.row");
  const unrecorded = el("div.unrecorded", {}, UNRECORDED);
  const element = el("div.legend", { role: "note", "aria-label": "legend" },
    el("div.title", {}, "cable tension"), scale, marks,
    el("div.row", {}, el("span.dash"), "slack"), arrows, unrecorded, joints, grid);

  let shown = "";
  const draw = () => {
    const world = view.world;
    if (!world) return;
    const theme = app.theme.value;
    const max_n = world.cables.scale_n;
    const { reference_n, reference_m } = world.forces;
    const key = `${theme} ${max_n} ${reference_n} ${world.size_m} ${world.scene.contact_forces} ${world.scene.joints.length}`;
    if (key === shown) return;
    shown = key;
    const context = scale.getContext("2d")!;
    context.clearRect(0, 0, scale.width, scale.height);
    for (let x = 0; x < scale.width; ++x) {
      const share = x / (scale.width - 1);
      const thick = 2 * (THINNEST_PX + (THICKEST_PX - THINNEST_PX) * share);
      context.fillStyle = css(tensionColour(share, theme));
      context.fillRect(x, scale.height / 2 - thick / 2, 1.5, thick);
    }
    marks.replaceChildren(...[0, 0.5, 1].map((share) => el("span", {}, `${number(share * max_n, 2)} N`)));
    const colours = palette(theme);
    const { contact_forces } = world.scene;
    unrecorded.hidden = contact_forces || app.live;
    arrows.replaceChildren(
      ...(contact_forces ? [sign(colours.contact), "contact"] : []), sign(colours.push), "push",
      el("span.note", {}, `${number(reference_m, 2)} m = ${number(reference_n, 2)} N`));
    joints.replaceChildren(sign(colours.joint, "●"), "joint");
    joints.hidden = world.scene.joints.length === 0;
    grid.textContent = `grid ${number(world.ground.spacing_m, 1)} m, bold ${number(10 * world.ground.spacing_m, 1)} m`;
    grid.hidden = !world.scene.terrain.some((terrain) => terrain.kind === "plane");
    element.dataset["maxN"] = String(max_n);
  };
  view.afterDraw.push(draw); // scales may change without a new frame
  return element;
}

function sign(colour: string, shape = "➔"): HTMLElement {
  const shown = el("span.arrow", {}, shape);
  shown.style.color = colour;
  return shown;
}
