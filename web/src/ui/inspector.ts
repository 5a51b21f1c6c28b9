// Inspector: values of the selected cable, body or node.
import { type App, nameOf, type Selection } from "../app";
import { cableState, type Frame, isSlack } from "../frame";
import { VALUES } from "../layout";
import type { Scene } from "../protocol";
import { worldPoint } from "../scene/poses";
import { button, el, number } from "../util";
import { Vector3 } from "three";

type Row = [string, string];

export function inspector(app: App): HTMLElement {
  const title = el("span.name");
  const table = el<HTMLTableElement>("table");
  const element = el("aside.inspector", { "aria-label": "numbers of the selection" },
    el("header", {}, title, button("×", "close (esc)", () => (app.selection.value = null), "button.small")), table);
  const draw = () => {
    const { value: selection } = app.selection;
    const { value: scene } = app.scene;
    const { value: frame } = app.frame;
    element.hidden = selection === null;
    if (!selection || !scene || !frame) return;
    title.textContent = `${selection.kind} ${nameOf(scene, selection)}`;
    const rows = rowsOf(scene, frame, selection);
    while (table.rows.length > rows.length) table.deleteRow(-1);
    rows.forEach(([what, value], i) => {
      const row = table.rows[i] ?? table.insertRow();
      if (row.cells.length === 0) row.append(el("th", { scope: "row" }), el("td"));
      row.cells[0]!.textContent = what;
      row.cells[1]!.textContent = value;
    });
  };
  app.selection.watch(draw);
  app.frame.watch(draw);
  return element;
}

function rowsOf(scene: Scene, frame: Frame, { kind, index }: Selection): Row[] {
  const vector = (values: ArrayLike<number>): string => Array.from(values, (value) => value.toFixed(4).replace("-", "−")).join(", ");
  if (kind === "cable") {
    const cable = scene.cables[index]!;
    const state = cableState(frame, index);
    const ends = cable.attachments.map(({ body }) => (body < 0 ? "world" : scene.bodies[body]!.name));
    return [
      ["tension", `${number(state.tension_n, 4)} N${isSlack(state) ? " (slack)" : ""}`],
      ...(Number.isNaN(state.setpoint_n) ? [] : [["set point", `${number(state.setpoint_n, 4)} N`] as Row]),
      ["length", `${number(state.length_m, 5)} m`],
      ["rest length", `${number(state.rest_length_m, 5)} m`],
      ["stretch", `${number(1000 * (state.length_m - state.rest_length_m), 4)} mm`],
      ["stiffness", cable.stiffness_n_per_m > 0 ? `${number(cable.stiffness_n_per_m, 4)} N/m` : "–"],
      ["between", ends.join(" → ")],
      ["motor", cable.actuated ? "yes" : "no"],
    ];
  }
  if (kind === "body") {
    const body = scene.bodies[index]!;
    const values = frame.bodies.subarray(index * VALUES.bodies, (index + 1) * VALUES.bodies);
    return [
      ["mass", body.mass_kg > 0 ? `${number(body.mass_kg, 4)} kg` : "–"],
      ["center of mass", `${vector(values.subarray(0, 3))} m`],
      ["orientation w, x, y, z", vector(values.subarray(3))],
      ["shapes", String(body.shapes.length)],
      ...(body.fixed ? [["fixed", "yes"] as Row] : []),
    ];
  }
  const owner = (place: number): string => (place < 0 ? "world" : scene.bodies[place]!.name);
  if (kind === "joint") {
    const joint = scene.joints[index]!;
    return [
      ["kind", joint.kind],
      ["between", `${owner(joint.body_a)} → ${owner(joint.body_b)}`],
      ["position", `${vector(worldPoint(frame, joint.body_b, joint.to_m, new Vector3()).toArray())} m`],
    ];
  }
  const node = scene.nodes[index]!;
  return [
    ["position", `${vector(worldPoint(frame, node.body, node.position_m, new Vector3()).toArray())} m`],
    ["body", owner(node.body)],
  ];
}
