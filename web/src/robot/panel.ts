// Status of boards, motors and link: tables whose layout is constant while their numbers change.
import type { App } from "../app";
import type { BoardStatus, MotorStatus, RobotStatus } from "../protocol";
import { clock, el, number } from "../util";
import { gainEditor } from "./gains";

type Cell = { text: string; bad?: boolean };

export function robotPanel(app: App): HTMLElement {
  const boards = table(["board", "mode", "ref.", "CRC", "bad", "missed", "stale", "late", "loop [ms]", "winding [°C]", "faults"], [
    "", "mode of the board", "encoders referenced", "messages received with a wrong checksum", "frames that are missing or have a wrong checksum",
    "missed broadcasts", "frames older than the last broadcast", "late ticks of the control loop", "longest recent tick", "computed winding temperatures of the motors", "",
  ]);
  const motors = table(["cable", "T [N]", "target [N]", "rest length [m]", "encoder", "duty", "winding [°C]", "faults"]);
  const link = el("div.linkhealth");
  const events = el<HTMLOListElement>("ol.eventlist");
  const element = el("section.robotpanel", { "aria-label": "state of the robot", hidden: true },
    group("Boards", boards.element, true), group("Link", link, true),
    group("Motors", motors.element, false), group("Gains", gainEditor(app), false), group("Events", events, true));

  let shownEvents = "";
  app.hello.watch(() => (element.hidden = !app.isRobot));
  app.robot.watch((status) => {
    if (!status) return;
    const names = app.tuning.value?.robot?.motors ?? [];
    boards.show(status.boards.map((board, b) => boardRow(board, b, status.motors.slice(2 * b, 2 * b + 2))));
    motors.show(status.motors.map((motor, m) => motorRow(motor, names[m] ?? `motor ${m}`)));
    link.replaceChildren(...linkLines(status).map(({ text, bad }) => el(bad ? "span.bad" : "span", {}, text)));
    const text = JSON.stringify(status.events);
    if (text === shownEvents) return;
    shownEvents = text;
    events.replaceChildren(...[...status.events].reverse().map((event) => el("li", {}, el("time", {}, clock(event.time_s, 2)), ` ${event.text}`)));
  });
  return element;
}

function group(title: string, content: HTMLElement, open: boolean): HTMLElement {
  return el("details", { open }, el("summary", {}, title), el("div.scrolls", {}, content));
}

function table(heads: readonly string[], titles: readonly string[] = []) {
  const body = el<HTMLTableSectionElement>("tbody");
  const element = el("table", {}, el("thead", {}, el("tr", {}, ...heads.map((head, i) => el("th", { scope: "col", title: titles[i] ?? "" }, head)))), body);
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
  return { element, show };
}

const count = (value: number): Cell => ({ text: String(value), bad: value > 0 });

function boardRow(board: BoardStatus, b: number, motors: readonly MotorStatus[]): Cell[] {
  const remarks = [board.faults, board.timeout ? "timed out" : "", board.was_reset ? "restarted" : ""].filter((text) => text !== "");
  return [
    { text: String(b), bad: !board.well },
    { text: board.there ? board.mode : "absent", bad: !board.there || board.mode === "stopped" },
    { text: board.referenced ? "yes" : "no", bad: !board.referenced },
    count(board.bad_messages), count(board.bad_frames), count(board.missed_broadcasts), count(board.stale_frames), count(board.late_ticks),
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

function linkLines({ link }: RobotStatus): Cell[] {
  const ms = (time_s: number) => number(1000 * time_s, 3);
  return [
    { text: link.connected ? "adapter: connected" : "adapter: disconnected", bad: !link.connected },
    { text: `cycle ${ms(link.cycle_s)} ms (mean ${ms(link.mean_cycle_s)}, longest ${ms(link.longest_cycle_s)})` },
    { text: `lateness ${ms(link.lateness_s)} ms (mean ${ms(link.mean_lateness_s)}, longest ${ms(link.longest_lateness_s)})` },
    { text: `${link.cycles} cycles` },
    { text: `${link.late_cycles} late cycles`, bad: link.late_cycles > 0 },
    { text: `${link.silent_transfers} silent transfers`, bad: link.silent_transfers > 0 },
    { text: `${link.unheard_broadcasts} unacknowledged broadcasts`, bad: link.unheard_broadcasts > 0 },
    ...(link.reconnections > 0 ? [{ text: `${link.reconnections} reconnections`, bad: true }] : []),
  ];
}
