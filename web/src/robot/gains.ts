// Four gains of one cable or of all: number fields, sent on request, with the board's replies.
import type { App } from "../app";
import type { RobotGainMessage } from "../protocol";
import { button, el, nameAndUnit, number } from "../util";

const ALL = "all cables";

export function gainEditor(app: App): HTMLElement {
  const choice = el<HTMLSelectElement>("select", { "aria-label": "cable of the gains" });
  const answer = el("div.answer", { role: "status" });
  const rows = el("div.gainrows");
  const element = el("div.gains", {}, choice, rows, answer);
  const inputs = new Map<string, HTMLInputElement>();
  let waiting = 0;
  let refused: string[] = [];

  const cables = () => (choice.value === ALL ? app.tuning.value?.robot?.motors ?? [] : [choice.value]);
  const send = (gain: RobotGainMessage["gain"], input: HTMLInputElement) => {
    if (input.value === "" || !input.reportValidity()) return;
    const sent = cables().filter((cable) => app.send({ type: "robot_gain", cable, gain, value: Number(input.value) }));
    waiting = sent.length;
    refused = [];
    answer.textContent = waiting > 0 ? "sent …" : "";
    answer.classList.remove("bad");
  };
  /** Shows the boards' values, except in fields that are being edited. */
  const fill = (anew: boolean) => {
    const { robot } = app.tuning.value ?? {};
    const status = app.robot.value;
    if (!robot || !status) return;
    robot.gains.forEach(({ key }, g) => {
      const input = inputs.get(key)!;
      if (!anew && (document.activeElement === input || input.value !== "")) return;
      const values = cables().map((cable) => status.motors[robot.motors.indexOf(cable)]?.gains[g] ?? null);
      const same = values.every((value) => value !== null && value === values[0]);
      input.value = same && values.length > 0 ? String(+values[0]!.toPrecision(6)) : "";
      input.placeholder = same ? "" : values.includes(null) ? "unknown" : "different";
    });
  };

  let offered = "";
  app.tuning.watch((scene) => {
    const robot = scene?.robot;
    if (!robot || JSON.stringify([robot.motors, robot.gains]) === offered) return;
    offered = JSON.stringify([robot.motors, robot.gains]);
    choice.replaceChildren(...[...robot.motors, ALL].map((name) => el("option", {}, name)));
    rows.replaceChildren(...robot.gains.map(({ key, min, max }) => {
      const [name, unit] = nameAndUnit(key);
      const input = el<HTMLInputElement>("input", { type: "number", min, max, step: "any", "aria-label": `${name} [${unit}]` });
      const set = () => send(key as RobotGainMessage["gain"], input);
      input.addEventListener("keydown", (event) => event.key === "Enter" && set());
      inputs.set(key, input);
      return el("div.gainrow", {}, el("span.name", {}, name), input, el("span.unit", {}, unit), button("set", `send ${name} to the board`, set),
        el("span.end", {}, `${number(min)} to ${number(max)}`));
    }));
    fill(true);
  });
  choice.addEventListener("change", () => fill(true));
  app.robot.watch(() => fill(false));
  app.selection.watch((selection) => {
    const name = selection?.kind === "cable" ? app.scene.value?.cables[selection.index]?.name : undefined;
    if (name === undefined || !app.tuning.value?.robot?.motors.includes(name)) return;
    choice.value = name;
    fill(true);
  });
  app.gainAnswer.watch((said) => {
    if (!said) return;
    const what = `${said.cable}: ${nameAndUnit(said.gain)[0]} ${number(said.value, 4)}`;
    if (!said.good) refused.push(`${what}: ${said.text}`);
    if (waiting > 0) --waiting;
    answer.classList.toggle("bad", refused.length > 0);
    answer.textContent = refused.length > 0 ? refused.join("; ") : waiting > 0 ? `waiting for ${waiting} boards …` : `${what}: accepted by the board`;
  });
  return element;
}
