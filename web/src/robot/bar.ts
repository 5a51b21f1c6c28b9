// Power controls of a robot, always visible: emergency stop, power in two steps, off. They replace the
// timeline, because a robot has no past to return to.
import type { App } from "../app";
import type { RobotStatus } from "../protocol";
import { button, clock, el } from "../util";

type Mode = "off" | "arm" | "hold" | "impedance" | "clear_faults";

export function stop(app: App): void {
  if (app.watches) app.notice.value = "this address is for watching only: it cannot stop the robot";
  else if (!app.send({ type: "stop" })) app.notice.value = "NOT CONNECTED: the stop was not sent. Press Ctrl-C in the terminal, or cut the motors' supply.";
}

export function robotBar(app: App): HTMLElement {
  const mode = (name: Mode, label: string, title: string, spec = "button") =>
    button(label, title, () => app.send({ type: "robot_mode", mode: name }), spec);
  const stopButton = button("STOP", "emergency stop: all motors off, until faults are cleared (space)", () => stop(app), "button.stop");
  const off = mode("off", "off", "motors off: they coast");
  const arm = mode("arm", "1 arm", "first step: prepare the boards, nothing moves yet");
  const hold = mode("hold", "2 hold", "second step: turn the motors on and hold their positions");
  const impedance = mode("impedance", "3 run", "third step: impedance control around the measured tensions and lengths; an armed robot holds first");
  const steps = [arm, hold, impedance];
  const stepper = el("ol.stepper", { "aria-label": "power-up steps" }, ...steps.map((step) => el("li", {}, step)));
  const clear = mode("clear_faults", "clear faults", "clear latched faults, time-outs and emergency stops; motors are turned off unless they hold");
  const record = button("record cycles", "start or end recording every cycle to a folder", () => app.send({ type: "record", on: app.robot.value?.recording === "" }));
  const state = el("span.state", { role: "status" });
  const time = el("span.time");
  const element = el("footer.robotbar", { "aria-label": "the robot" }, stopButton,
    el("div.modes", {}, state, stepper, off, clear, record, time));

  const draw = () => {
    const status = app.robot.value;
    element.hidden = !app.isRobot;
    if (!app.isRobot) return;
    const info = app.tuning.value?.robot;
    const mayDrive = app.drives && app.link.value === "open" && status !== null;
    const stage = status?.stage ?? "unconfigured";
    state.textContent = status ? stateText(status) : "…";
    state.dataset["state"] = status?.stopping ? "stopped" : stage;
    stopButton.disabled = app.watches;
    arm.disabled = !mayDrive || stage !== "inactive" || info?.experiment === true || status!.alarms.length > 0;
    for (const each of [hold, impedance]) each.disabled = !mayDrive || !["ready", "active"].includes(stage) || info?.experiment === true;
    off.disabled = !mayDrive || !["ready", "active"].includes(stage);
    clear.disabled = !mayDrive || info?.experiment === true;
    for (const each of [arm, hold, impedance, clear]) each.hidden = app.watches || info?.experiment === true;
    off.hidden = app.watches;
    const reached = status === null || status.stopping ? 0 : stepReached(status);
    stepper.hidden = app.watches || info?.experiment === true;
    steps.forEach((step, i) => {
      step.parentElement!.classList.toggle("done", i + 1 < reached);
      step.parentElement!.classList.toggle("current", i + 1 === reached);
      if (i + 1 === reached) step.setAttribute("aria-current", "step");
      else step.removeAttribute("aria-current");
    });
    arm.classList.toggle("primary", !arm.disabled);
    for (const each of [hold, impedance]) each.classList.toggle("primary", stage === "ready" && !each.disabled);
    record.hidden = app.watches || info?.may_record !== true;
    record.disabled = !mayDrive;
    const records = (status?.recording ?? "") !== "";
    record.textContent = records ? "end recording" : "record cycles";
    record.classList.toggle("recording", records);
    time.textContent = `${records ? `→ ${status!.recording}  ` : ""}${clock(status?.time_s ?? 0, 1)}`;
  };
  for (const signal of [app.robot, app.hello, app.driver, app.link, app.tuning]) signal.watch(draw);

  // Handles space first: otherwise space would press the last used button again.
  const typed = (event: KeyboardEvent) => {
    const target = event.target as HTMLElement;
    return app.isRobot && event.key === " " && !target.closest("input[type=search], input[type=text], textarea");
  };
  document.addEventListener("keydown", (event) => {
    if (!typed(event)) return;
    event.preventDefault();
    event.stopPropagation();
    if (!event.repeat) stop(app);
  }, { capture: true });
  document.addEventListener("keyup", (event) => {
    if (!typed(event)) return;
    event.preventDefault(); // Firefox presses buttons on keyup
    event.stopPropagation();
  }, { capture: true });
  return element;
}

/** Returns the power-up step that the robot is in: 0 off, 1 armed, 2 hold, 3 any other control. */
function stepReached({ stage, commanded }: RobotStatus): number {
  return stage === "ready" ? 1 : stage !== "active" ? 0 : commanded === "hold" ? 2 : 3;
}

function stateText({ stage, commanded, stopping }: RobotStatus): string {
  if (stopping) return "stopped";
  return { unconfigured: "not set up", inactive: "motors off", ready: "armed", active: commanded }[stage];
}

/** All alarms, in red, above everything. */
export function alarms(app: App): HTMLElement {
  const list = el("ul");
  const element = el("div.alarms", { role: "alert", hidden: true }, list);
  let shown = "";
  const draw = () => {
    const status = app.robot.value;
    const all = app.isRobot && status ? [...(app.link.value === "lost" ? ["no connection to taut: the displayed data are old, and commands cannot be sent"] : []), ...status.alarms] : [];
    // ignores changing times within a text, so that screen readers do not repeat it
    const text = all.join("\n").replace(/[\d.]+ s$/gm, "");
    element.hidden = all.length === 0;
    if (text === shown && list.childElementCount === all.length) return;
    shown = text;
    list.replaceChildren(...all.map((each) => el("li", {}, each)));
  };
  app.robot.watch(draw);
  app.link.watch(draw);
  return element;
}

/** Returns a note about the source of the displayed pose. */
export function poseNote(app: App, view: HTMLElement): HTMLElement {
  const element = el("div.posenote", { role: "note", hidden: true });
  app.tuning.watch((scene) => {
    const robot = scene?.robot;
    element.hidden = robot === undefined;
    view.classList.toggle("described", robot !== undefined && !robot.true_pose);
    element.textContent = robot?.true_pose ? "true pose of the virtual robot" : "described pose, not measured";
  });
  return element;
}
