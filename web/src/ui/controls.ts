// Live controls: a push, parameters, set points and gains. Each change is sent as a message, which the server
// does not drop; refusals are displayed as errors.
import type { App } from "../app";
import type { Control, Parameter, Vec3 } from "../protocol";
import { button, el, nameAndUnit, number, unitText } from "../util";

export function controls(app: App): HTMLElement {
  const body = el("div");
  const element = el("section.controls", { "aria-label": "live controls" }, body);
  let offered = "";
  app.tuning.watch((scene) => {
    if (!scene) return;
    // a control in use must not be replaced
    const offers = JSON.stringify([scene.parameters, scene.controls, scene.nodes].map((list) => list.map((each) => ("cable" in each ? each.cable : each.name))));
    if (offers === offered && element.contains(document.activeElement)) return;
    offered = offers;
    const owned = (prefix: string) => scene.parameters.filter(({ name }) => name.startsWith(prefix));
    const general = scene.parameters.filter(({ name }) => !/^(body|cable)\//.test(name));
    body.replaceChildren(pushForm(app));
    if (general.length > 0) body.append(group("Parameters", general.map((each) => parameter(app, each, each.name))));
    const one = (kind: "cable" | "body", names: string[], more: (name: string) => HTMLElement[]) => {
      const parts = (name: string) => {
        const prefix = `${kind}/${name}/`;
        return [...more(name), ...owned(prefix).map((each) => parameter(app, each, nameAndUnit(each.name.slice(prefix.length))[0]))];
      };
      if (names.some((name) => parts(name).length > 0)) body.append(group(kind === "cable" ? "Cable" : "Body", [chooser(app, kind, names, parts)]));
    };
    one("cable", scene.cables.map(({ name }) => name), (name) => {
      const control = scene.controls.find(({ cable }) => cable === name);
      return control ? slidersOf(app, control) : [];
    });
    one("body", scene.bodies.map(({ name }) => name), () => []);
  });
  return element;
}

function group(title: string, content: HTMLElement[]): HTMLElement {
  return el("details", { open: true }, el("summary", {}, title), ...content);
}

/** Returns fields for one of many cables or bodies: the one selected in the view, if any. */
function chooser(app: App, kind: "cable" | "body", names: string[], parts: (name: string) => HTMLElement[]): HTMLElement {
  const fields = el("div");
  const choice = el<HTMLSelectElement>("select", { "aria-label": kind }, ...names.map((name) => el("option", {}, name)));
  const show = () => fields.replaceChildren(...parts(choice.value));
  choice.addEventListener("change", show);
  app.selection.watch((selection) => {
    const name = selection?.kind === kind ? names[selection.index] : undefined;
    if (name === undefined || name === choice.value) return;
    choice.value = name;
    show();
  });
  show();
  return el("div", {}, choice, fields);
}

/** Returns a slider with a number field; both show the set value. */
function slider(label: string, unit: string, value: number, min: number, max: number, set: (value: number) => void): HTMLElement {
  const step = (max - min) / 500 || "any";
  const range = el<HTMLInputElement>("input", { type: "range", min, max, step, value, "aria-label": `${label} [${unit}]` });
  const exact = el<HTMLInputElement>("input", { type: "number", min, max, step: "any", value: +value.toPrecision(4), "aria-label": `${label} [${unit}], exact` });
  range.addEventListener("input", () => {
    exact.value = String(+Number(range.value).toPrecision(4));
    set(Number(range.value));
  });
  exact.addEventListener("change", () => {
    if (!exact.reportValidity() || exact.value === "") return;
    range.value = exact.value;
    set(Number(exact.value));
  });
  // no label element: it would include both limits, and both inputs have labels
  return el("div.slider", { title: label }, el("span.name", { "aria-hidden": "true" }, label), el("span.end", {}, number(min)), range, el("span.end", {}, number(max)),
    exact, el("span.unit", {}, unit));
}

function parameter(app: App, known: Parameter, label: string): HTMLElement {
  const { name, unit, min, max, restarts } = known;
  const set = (value: number) => {
    known.value = value;
    app.send({ type: "set_parameter", name, value });
  };
  const made = slider(label, unitText(unit), known.value, min, max, restarts ? () => {} : set);
  made.title = name;
  if (restarts) {
    // only on release: a restart for each pixel would be useless
    made.addEventListener("change", (event) => set(Number((event.target as HTMLInputElement).value)));
    made.append(el("span.restarts", { title: "a change restarts the experiment" }, "↻"));
  }
  return made;
}

function slidersOf(app: App, control: Control): HTMLElement[] {
  const { cable } = control;
  const setpoint = (value: number) => app.send({ type: "set_setpoint", cable, value });
  if (control.kind === "rest_length") {
    const now = control.rest_length_m ?? 0;
    return [slider("rest length", "m", now, 0.2 * now, 2 * now, (value) => {
      control.rest_length_m = value;
      setpoint(value);
    })];
  }
  const gain = (name: "length_offset_m" | "position_gain_n_per_m" | "velocity_gain_n_s_per_m", label: string, unit: string, max: number) =>
    slider(label, unit, control[name] ?? 0, 0, max, (value) => {
      control[name] = value;
      app.send({ type: "set_gain", cable, gain: name, value });
    });
  const room = (value: number | undefined, least: number) => Math.max(3 * (value ?? 0), least);
  return [
    slider("tension T₀", "N", control.tension_offset_n ?? 0, 0, room(control.tension_offset_n, 50), (value) => {
      control.tension_offset_n = value;
      setpoint(value);
    }),
    gain("length_offset_m", "length L₀", "m", room(control.length_offset_m, 0.1)),
    gain("position_gain_n_per_m", "gain K", "N/m", room(control.position_gain_n_per_m, 500)),
    gain("velocity_gain_n_s_per_m", "gain B", "N s/m", room(control.velocity_gain_n_s_per_m, 200)),
  ];
}

const DIRECTIONS: readonly [string, Vec3][] = [
  ["forward +x", [1, 0, 0]], ["back −x", [-1, 0, 0]], ["left +y", [0, 1, 0]], ["right −y", [0, -1, 0]],
  ["up +z", [0, 0, 1]], ["down −z", [0, 0, -1]],
];

function pushForm(app: App): HTMLElement {
  const nodes = app.scene.value?.nodes ?? [];
  const node = el<HTMLSelectElement>("select", { "aria-label": "node to push" }, ...nodes.map(({ name }) => el("option", {}, name)));
  const direction = el<HTMLSelectElement>("select", { "aria-label": "direction" }, ...DIRECTIONS.map(([name], i) => el("option", { value: i }, name)));
  const force = el<HTMLInputElement>("input", { type: "number", value: 20, min: 0, max: 100000, step: "any", "aria-label": "force [N]" });
  const duration = el<HTMLInputElement>("input", { type: "number", value: 0.5, min: 0.001, max: 1000, step: "any", "aria-label": "duration [s]" });
  const push = () => {
    if (!force.reportValidity() || !duration.reportValidity()) return;
    const along = DIRECTIONS[Number(direction.value)]![1];
    const force_n = along.map((part) => part * Number(force.value)) as Vec3;
    if (app.send({ type: "push", node: node.value, force_n, duration_s: Number(duration.value) })) {
      app.notice.value = `pushed ${node.value} with ${number(Number(force.value))} N`;
    }
  };
  app.selection.watch((selection) => {
    if (selection?.kind === "node") node.value = app.scene.value?.nodes[selection.index]?.name ?? node.value;
  });
  return group("Push", [
    el("div.push", {}, node, direction,
      el("label", {}, force, " N"), el("label", {}, duration, " s"),
      button("push", "push the node", push, "button.primary")),
  ]);
}
