// Display of the state hash next to the hash of the taut command: bit-identical or not.
import { button, el, number } from "../util";
import type { Mark, RunState } from "./core";
import type { Project } from "./project";
import type { WorkerSource } from "./source";

/** State hashes of `taut run` for a shipped file at some times, ascending. */
export type Hashes = Record<string, Mark[]>;

export function bitsPanel(source: WorkerSource, project: Project, hashes: Hashes): HTMLElement {
  const table = el("table");
  const why = el("p.why");
  const command = el("code");
  const copy = button("copy", "copy the command", () => void navigator.clipboard?.writeText(command.textContent ?? ""), "button.small");
  const element = el("section.bits", { "aria-label": "bitwise comparison" }, el("h2", {}, "Bitwise comparison with taut run"), table, why, el("p.command", {}, command, " ", copy));
  let said = "";
  const show = (state: RunState | null) => {
    const expected = state && isAsShipped(state, project) ? (hashes[state.path] ?? []) : [];
    const found = expected.map((mark, i) => ({ mark, ours: state!.marks[i]?.hash ?? null }));
    const model = state?.path.startsWith("models/") ?? false;
    const now = JSON.stringify([state, found, project.ran]);
    if (now === said) return;
    said = now;
    element.hidden = state === null;
    if (!state) return;
    table.replaceChildren(
      el("tr", {}, el("th", {}, "time"), el("th", {}, "this page"), ...(expected.length > 0 ? [el("th", {}, "taut run"), el("th")] : [])),
      ...found.map(({ mark, ours }) => el("tr", {}, el("td", {}, seconds(mark.time_s)), el("td.hash", {}, ours ?? "…"), el("td.hash", {}, mark.hash), verdict(ours, mark.hash))),
      el("tr", {}, el("td", {}, seconds(state.time_s)), el("td.hash", {}, state.hash), ...(expected.length > 0 ? [el("td"), el("td")] : [])));
    why.textContent = model ? "No command runs a model, so there is no hash to compare with."
      : state.touched ? "You have pulled or pushed the robot or changed parameters; no command can repeat this. Reset to compare."
      : project.ran ? "Download the changed files and replace the shipped ones; then this command prints the hash in the last row of the table:"
      : "This command prints, on your machine, the hash in the last row of the table:";
    command.textContent = `taut run ${state.path}${Object.entries(state.set).map(([name, value]) => ` --set ${name}=${value}`).join("")} --duration_s ${Number(state.time_s.toFixed(9))} --json | grep state_hash`;
    command.parentElement!.hidden = model || state.touched || state.time_s === 0;
  };
  source.state.watch(show);
  return element;
}

/** Returns whether the run uses the shipped files unchanged, without changed parameters and without drags. */
function isAsShipped(state: RunState, project: Project): boolean {
  return !state.touched && Object.keys(state.set).length === 0 && !project.ran;
}

function verdict(ours: string | null, theirs: string): HTMLElement {
  if (ours === null) return el("td", {}, "");
  return ours === theirs ? el("td.same", {}, "✓ same") : el("td.other", { role: "alert" }, "✗ different");
}

const seconds = (time_s: number) => `${number(time_s, 5)} s`;
