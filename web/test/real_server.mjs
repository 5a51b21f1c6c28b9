// `taut view` as a child process, one at a time. TAUT_COMMAND: the command.
import { execFileSync, spawn } from "node:child_process";
import { readFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { PAGE } from "./browser.mjs";

export const TAUT = process.env.TAUT_COMMAND;
export const ROOT = fileURLToPath(new URL("../..", import.meta.url));
export const options = { skip: TAUT ? false : "TAUT_COMMAND is not set" };
const env = () => ({ ...process.env, TAUT_WEB: dirname(PAGE) });
let server = null;

/** Runs another taut command to its end. */
export const taut = (...words) => execFileSync(TAUT, words, { cwd: ROOT, env: env() });

/** Starts `taut view` with random tokens; returns its address. */
export const view = (...words) => viewWithToken("", ...words);

export async function viewWithToken(token, ...words) {
  server = spawn(TAUT, ["view", ...words], { cwd: ROOT, env: { ...env(), TAUT_TOKEN: token } });
  let said = "";
  return new Promise((resolve, reject) => {
    const hear = (data) => {
      said += data;
      const address = /http:\/\/\S+/.exec(said)?.[0];
      if (address) resolve(address);
    };
    server.stdout.on("data", hear);
    server.stderr.on("data", hear);
    server.on("exit", () => reject(new Error(`taut view ended: ${said}`)));
  });
}

export async function stop() {
  if (!server) return;
  if (server.exitCode !== null) {
    server = null;
    return;
  }
  const ended = endOf();
  server.kill("SIGINT");
  await ended;
  server = null;
}

/** Waits until the server has ended. */
export function endOf() {
  return new Promise((resolve) => server.on("exit", resolve));
}

/** Returns the server's child processes. */
export const childrenOf = () => readFileSync(`/proc/${server.pid}/task/${server.pid}/children`, "utf8").trim().split(" ").filter((pid) => pid !== "").map(Number);

/** Kills the server, as by a power cut. */
export function kill() {
  server.kill("SIGKILL");
}

/** Reads the rows of a run's trace.csv: value(name, time_s) at a time or the last before it. */
export function csvOf(run) {
  const [head, ...lines] = readFileSync(join(run, "trace.csv"), "utf8").trim().split("\n").map((line) => line.split(","));
  const rows = lines.map((line) => line.map(Number));
  const value = (name, time_s) => rows[rows.findLastIndex((row) => row[0] <= time_s)][head.indexOf(name)];
  return { rows, value, column: (name) => head.indexOf(name), has: (name) => head.includes(name) };
}
