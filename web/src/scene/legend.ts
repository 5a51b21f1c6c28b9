// Legend of the colors, widths and arrows in the 3D view.
import type { App } from "../app";
import { compressionColour, css, palette, strainColour, tensionColour } from "../colours";
import { signed } from "../runs";
import { el, number } from "../util";
import type { View } from "./view";

const WIDTH_PX = 168;
const HEIGHT_PX = { thin: 3, thick: 10 };
const UNRECORDED = "no contact forces in this trace; to record them: “record: {contacts: 20}” in the experiment";

export function legend(app: App, view: View): HTMLElement {
  const tension = bar();
  const compression = bar();
  const slack = el("div.row", {}, el("span.dash"), "slack");
  const arrows = el("div.row");
  const centre = el("div.row");
  const joints = el("div.row");
  const grid = el("div.row");
  const unrecorded = el("div.unrecorded", {}, UNRECORDED);
  const element = el("div.legend", { role: "note", "aria-label": "legend" },
    tension.element, slack, compression.element, arrows, unrecorded, centre, joints, grid);

  let shown = "";
  const draw = () => {
    const world = view.world;
    if (!world) return;
    const theme = app.theme.value;
    const max_n = world.cables.scale_n;
    const { reference_n, reference_m } = world.forces;
    const strain = world.cables.strainFrom_m !== null;
    const key = `${theme} ${max_n} ${world.colours?.title} ${world.colours?.marks} ${strain} ${world.cables.largestStrain} ${world.compressionScale_n} ${world.usesBuckling} ${reference_n} ${world.size_m} ${world.scene.contact_forces} ${world.scene.joints.length}`;
    if (key === shown) return;
    shown = key;
    const results = world.colours;
    if (results) {
      const { title, scale, ends: [from, to], marks } = results;
      tension.draw(title, (share) => css(scale(from + share * (to - from), theme)), marks);
    } else if (strain) tension.draw("strain of cables", (share) => css(strainColour(2 * share - 1, theme)), [-1, 0, 1].map((share) => `${signed(number(100 * share * world.cables.largestStrain, 2))} %`));
    else tension.draw("cable tension", (share) => css(tensionColour(share, theme)), [0, 0.5, 1].map((share) => `${number(share * max_n, 2)} N`), true);
    slack.hidden = strain;
    compression.element.hidden = strain || results !== null || !world.compression.hasStruts;
    const end = (share: number) => (world.usesBuckling ? `${100 * share} %` : `${number(share * world.compressionScale_n, 2)} N`);
    compression.draw(world.usesBuckling ? "strut compression / Euler load" : "strut compression", (share) => css(compressionColour(share, theme)), [0, 0.5, 1].map(end));
    const colours = palette(theme);
    const { contact_forces } = world.scene;
    unrecorded.hidden = contact_forces || app.live || strain;
    arrows.hidden = strain;
    arrows.replaceChildren(
      ...(contact_forces ? [sign(colours.contact), results ? "reaction" : "contact"] : []), sign(colours.push), results ? "load" : "push",
      el("span.note", {}, `${number(reference_m, 2)} m = ${number(reference_n, 2)} N`));
    centre.replaceChildren(sign(colours.path, "●"), "center of mass and its path");
    centre.hidden = !world.path.object.visible;
    joints.replaceChildren(sign(colours.joint, "●"), "joint");
    joints.hidden = world.scene.joints.length === 0;
    grid.textContent = `grid ${number(world.ground.spacing_m, 1)} m, bold ${number(10 * world.ground.spacing_m, 1)} m`;
    grid.hidden = !world.scene.terrain.some((terrain) => terrain.kind === "plane");
    element.dataset["maxN"] = String(max_n);
  };
  view.afterDraw.push(draw); // scales may change without a new frame
  return element;
}

/** A color scale with a title and numbers below it. */
function bar() {
  const title = el("div.title");
  const scale = el<HTMLCanvasElement>("canvas", { width: 2 * WIDTH_PX, height: 2 * HEIGHT_PX.thick, "aria-hidden": "true" });
  const marks = el("div.marks");
  const draw = (text: string, colour: (share: number) => string, numbers: readonly string[], wedge = false) => {
    title.textContent = text;
    const context = scale.getContext("2d")!;
    context.clearRect(0, 0, scale.width, scale.height);
    for (let x = 0; x < scale.width; ++x) {
      const share = x / (scale.width - 1);
      const high = 2 * (wedge ? HEIGHT_PX.thin + (HEIGHT_PX.thick - HEIGHT_PX.thin) * share : HEIGHT_PX.thick);
      context.fillStyle = colour(share);
      context.fillRect(x, scale.height / 2 - high / 2, 1.5, high);
    }
    marks.replaceChildren(...numbers.map((each) => el("span", {}, each)));
  };
  return { element: el("div.scale", {}, title, scale, marks), draw };
}

function sign(colour: string, shape = "➔"): HTMLElement {
  const shown = el("span.arrow", {}, shape);
  shown.style.color = colour;
  return shown;
}
