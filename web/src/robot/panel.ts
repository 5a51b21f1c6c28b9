// Status of boards, motors and link: tables whose layout is constant while their numbers change.
import type { App } from "../app";
import type { BoardStatus, MotorStatus, RobotStatus } from "../protocol";
import { clock, counted, el, number } from "../util";
import { gainEditor } from "./gains";
import { Rising } from "./rising";

type Cell = { text: string; bad?: boolean };

export function robotPanel(app: App): HTMLElement {
  const boards = table(["board", "mode", "ref.", "CRC", "bad", "missed", "stale", "late", "loop [ms]", "winding [°C]", "faults"], [
    "", "mode of the board", "encoders referenced", "messages received with a wrong checksum", "frames that are missing or have a wrong checksum",
    "missed broadcasts", "frames older than the last broadcast", "late ticks of the control loop", "longest recent tick", "computed winding temperatures of the motors", "",
  ]);
  const motors = table(["cable", "T [N]", "target [N]", "rest length [m]", "encoder", "duty", "winding [°C]", "faults"]);
  const link = el("div.linkhealth");
  const health = el("p.health", { role: "status" });
  const rising = new Rising();
  const all = el<HTMLInputElement>("input", { type: "checkbox", onchange: () => app.robot.value && show(app.robot.value) });
  const events = el<HTMLOListElement>("ol.eventlist");
  const element = el("section.robotpanel", { "aria-label": "state of the robot", hidden: true },
    health, group("Boards", boards.element, true, el("label", { title: "show all fault counters, also those that do not increase" }, all, " all counters")), group("Link", link, true),
    group("Motors", motors.element, false), group("Gains", gainEditor(app), false), group("Events", events, true));

  let shownEvents = "";
  app.hello.watch(() => (element.hidden = !app.isRobot));
  const show = (status: RobotStatus) => {
    const names = app.tuning.value?.robot?.motors ?? [];
    const matter = COUNTERS.map(([, count]) => status.boards.map((board, b) => rising.matters(`${b} ${count}`, board[count], status.time_s)).some((each) => each));
    boards.show(status.boards.map((board, b) => boardRow(board, b, status.motors.slice(2 * b, 2 * b + 2), matter)));
    boards.element.classList.toggle("quiet", !all.checked);
    boards.mark(FIRST_COUNTER, matter);
    showHealth(health, status, matter.some((each) => each));
    motors.show(status.motors.map((motor, m) => motorRow(motor, names[m] ?? `motor ${m}`)));
    link.replaceChildren(...linkLines(status, rising, all.checked).map(({ text, bad }) => el(bad ? "span.bad" : "span", {}, text)));
    const text = JSON.stringify(status.events);
    if (text === shownEvents) return;
    shownEvents = text;
    events.replaceChildren(...[...status.events].reverse().map((event) => el("li", {}, el("time", {}, clock(event.time_s, 2)), ` ${event.text}`)));
  };
  app.robot.watch((status) => status && show(status));
  return element;
}

function group(title: string, content: HTMLElement, open: boolean, ...more: HTMLElement[]): HTMLElement {
  return el("details", { open }, el("summary", {}, title), el("div.scrolls", { tabindex: 0, role: "region", "aria-label": title }, content), ...more);
}

/** Columns of counters: heading, field. */
const COUNTERS = [["CRC", "bad_messages"], ["bad", "bad_frames"], ["missed", "missed_broadcasts"], ["stale", "stale_frames"], ["late", "late_ticks"]] as const;
const FIRST_COUNTER = 3;

/** One line: whether the robot is well, in green or red. */
function showHealth(line: HTMLElement, { boards, motors, link, stopping, alarms }: RobotStatus, counts: boolean): void {
  const ill = boards.filter(({ there, well, faults }) => !there || !well || faults !== "").length;
  const faulty = motors.filter(({ faults }) => faults !== "").length;
  const wrong = [
    ...(link.connected ? [] : ["the adapter is disconnected"]), ...(stopping ? ["emergency stop"] : []),
    ...(ill > 0 ? [`${ill} of ${boards.length} boards need attention`] : []), ...(faulty > 0 ? [`${faulty} of ${motors.length} motors have faults`] : []),
    ...(alarms.length > 0 && ill + faulty === 0 && link.connected && !stopping ? [counted(alarms.length, "alarm")] : []),
  ];
  const text = wrong.length > 0 ? wrong.join("; ") : counts ? "healthy, but fault counters increased recently" : `healthy: ${boards.length} boards, ${motors.length} motors`;
  if (line.textContent !== text) line.textContent = text;
  line.dataset["state"] = wrong.length > 0 ? "bad" : counts ? "watch" : "good";
}

function table(heads: readonly string[], titles: readonly string[] = []) {
  const body = el<HTMLTableSectionElement>("tbody");
  const element = el<HTMLTableElement>("table", {}, el("thead", {}, el("tr", {}, ...heads.map((head, i) => el("th", { scope: "col", title: titles[i] ?? "" }, head)))), body);
  const show = (rows: readonly Cell[][]) => {
    while (body.rows.length > rows.length) body.deleteRow(-1);
    rows.forEach((cells, i) => {
      const row = body.rows[i] ?? body.insertRow();
      while (row.cells.length < cells.length) row.insertCell();
      cells.forEach(({ text, bad }, k) => {
        const cell = row.cells[k]!;
        if (cell.textContent !== text) cell.textContent = text;
        cell.classList.toggle("bad", bad === true);
      });
    });
  };
  /** Marks columns that do not matter as idle, counted from `first`: they may be hidden. */
  const mark = (first: number, matter: readonly boolean[]) => {
    for (const row of element.rows) matter.forEach((matters, i) => row.cells[first + i]?.classList.toggle("idle", !matters));
  };
  return { element, show, mark };
}

function boardRow(board: BoardStatus, b: number, motors: readonly MotorStatus[], matter: readonly boolean[]): Cell[] {
  const remarks = [board.faults, board.timeout ? "timed out" : "", board.was_reset ? "restarted" : ""].filter((text) => text !== "");
  return [
    { text: String(b), bad: !board.well },
    { text: board.there ? board.mode : "absent", bad: !board.there || board.mode === "stopped" },
    { text: board.referenced ? "yes" : "no", bad: !board.referenced },
    ...COUNTERS.map(([, field], i) => ({ text: String(board[field]), bad: matter[i]! && board[field] > 0 })),
    { text: (1000 * board.loop_time_s).toFixed(2), bad: board.loop_time_s > 1e-3 },
    { text: motors.map(({ temperature_c }) => temperature_c).join(", ") },
    { text: remarks.join("; ") || "–", bad: board.faults !== "" || board.timeout },
  ];
}

function motorRow(motor: MotorStatus, name: string): Cell[] {
  const setpoint_n = motor.setpoint_n as number | null; // JSON has no NaN
  return [
    { text: name, bad: motor.faults !== "" },
    { text: motor.tension_n.toFixed(1) },
    { text: setpoint_n === null ? "–" : setpoint_n.toFixed(1) },
    { text: motor.rest_length_m.toFixed(4) },
    { text: String(motor.encoder_counts) },
    { text: motor.duty.toFixed(2) },
    { text: String(motor.temperature_c) },
    { text: motor.faults || "–", bad: motor.faults !== "" },
  ];
}

function linkLines({ link, time_s }: RobotStatus, rising: Rising, all: boolean): Cell[] {
  const ms = (duration_s: number) => number(1000 * duration_s, 3);
  const counters = ([["late cycles", link.late_cycles], ["silent transfers", link.silent_transfers], ["unacknowledged broadcasts", link.unheard_broadcasts],
    ["reconnections", link.reconnections]] as const).map(([what, count]) => ({ text: `${count} ${what}`, bad: rising.matters(what, count, time_s) }));
  return [
    { text: link.connected ? "adapter: connected" : "adapter: disconnected", bad: !link.connected },
    { text: `cycle ${ms(link.cycle_s)} ms (mean ${ms(link.mean_cycle_s)}, longest ${ms(link.longest_cycle_s)})` },
    { text: `lateness ${ms(link.lateness_s)} ms (mean ${ms(link.mean_lateness_s)}, longest ${ms(link.longest_lateness_s)})` },
    { text: `${link.cycles} cycles` },
    ...counters.filter(({ bad }) => bad || all),
  ];
}
