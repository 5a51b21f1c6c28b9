// Browser demo: models and experiments without installation and without a computing server.
import "./demo.css";
import { App } from "../app";
import { buildPage, sayWhyNot } from "../page";
import { button, el } from "../util";
import { bitsPanel, type Hashes } from "./bits";
import type { Files } from "./core";
import { Editor } from "./editor";
import { fragmentOf, sharedBy } from "./link";
import { Project } from "./project";
import { WorkerSource } from "./source";

const START = "experiments/push_20n.yaml";
/** Delay from the last key to the check of a text. */
const REST_MS = 250;

interface Shipped {
  files: Files;
  hashes: Hashes;
}

async function start(root: HTMLElement): Promise<void> {
  const here = new URL(".", location.href);
  const answer = await fetch(new URL("files.json", here));
  if (!answer.ok) throw new Error(`files.json: ${answer.status} ${answer.statusText}`);
  const { files, hashes } = (await answer.json()) as Shipped;
  const source = new WorkerSource(new URL("taut_core.mjs", here).href, files);
  const app = new App(source, null);
  source.failure.watch((why) => (app.failure.value = why && `The simulator has stopped: ${why}`));
  const project = new Project(files);
  const editor = new Editor(project);

  const run = async (paused = false): Promise<boolean> => {
    const { path, edits } = { path: project.path.value, edits: { ...project.edits } };
    app.events.value = [];
    const checked = await source.open(path, edits, (hashes[path] ?? []).map(({ time_s }) => time_s), paused);
    if (path !== project.path.value) return checked.good; // the user has selected another file in the meantime
    project.learn(checked);
    if (checked.good) project.ran = Object.keys(edits).length > 0;
    runButton.classList.toggle("primary", !checked.good);
    return checked.good;
  };
  const choose = async (path: string, edits: Files = {}) => {
    project.choose({ path, edits });
    choice.value = path;
    note.textContent = aboutOf(project.text(path));
    // files that cannot run are displayed nevertheless
    if (!(await run())) app.notice.value = "this text cannot run: see the errors below it";
  };

  const choice = el<HTMLSelectElement>("select", { "aria-label": "model or experiment", onchange: () => void follow(choice.value) },
    ...["experiments", "models"].map((folder) => el("optgroup", { label: folder },
      ...Object.keys(files).filter((path) => path.startsWith(`${folder}/`) && path.endsWith(".yaml")).sort().map((path) => el("option", { value: path }, path.slice(folder.length + 1, -5))))));
  const note = el("p.about");
  const runButton = button("run", "run this text from the start (Ctrl+Enter)", () => void run());
  const undo = button("undo", "restore the shipped texts", () => void choose(project.path.value));
  const share = button("share", "copy a link to this text with your changes", () => void copyLink());
  const save = button("download", "save this text as a file", () => editor.save());
  const beside = el("aside.demo", { "aria-label": "model" },
    el("div.bar", {}, choice, runButton, undo, share, save), note, editor.element, bitsPanel(source, project, hashes));
  const toggle = button("text", "show or hide the text of the file", () => {
    beside.hidden = !beside.hidden;
    dispatchEvent(new Event("resize"));
  });
  const small = matchMedia("(max-width: 900px)");
  beside.hidden = small.matches;

  async function copyLink(): Promise<void> {
    try {
      const fragment = await fragmentOf({ path: project.path.value, edits: project.edits });
      history.replaceState(null, "", fragment);
      await navigator.clipboard?.writeText(location.href);
      app.notice.value = navigator.clipboard ? "the link is copied, and in the address bar" : "the link is in the address bar";
    } catch (error) {
      app.notice.value = wordsOf(error);
    }
  }

  let timer = 0;
  project.version.watch(() => {
    undo.hidden = !project.edited;
    clearTimeout(timer);
    if (project.path.value === "") return;
    timer = window.setTimeout(async () => {
      const version = project.version.value;
      const checked = await source.check(project.path.value, { ...project.edits });
      if (version !== project.version.value) return;
      project.learn(checked);
      runButton.classList.toggle("primary", true);
    }, REST_MS);
  });
  /** The address contains the displayed file, so that back and forward work. */
  const follow = async (path: string) => {
    history.pushState(null, "", `#${path}`);
    await choose(path);
  };
  const fromAddress = async () => {
    const shared = await sharedBy(location.hash, files);
    await choose(shared?.path ?? START, shared?.edits);
  };
  /** Handles an invalid link: displays a default file with a permanent message above its text. */
  const insteadOf = async (error: unknown) => {
    await choose(START);
    note.textContent = `The link could not be opened: ${wordsOf(error)}`;
  };
  addEventListener("popstate", () => void fromAddress().catch(insteadOf));
  document.addEventListener("keydown", (event) => {
    if (event.key !== "Enter" || !(event.ctrlKey || event.metaKey)) return;
    event.preventDefault();
    void run();
  });

  buildPage(root, app, { beside, buttons: [toggle], advice: "Reload the page. If this does not help, use a browser of 2023 or later." });
  Object.assign(window, { demo: { project, source, editor } });
  await fromAddress().catch(insteadOf);
}

const wordsOf = (error: unknown) => (error instanceof Error ? error.message : String(error));

/** Returns the description in a file. */
function aboutOf(text: string): string {
  return /^description:\s*["']?(.*?)["']?\s*$/m.exec(text)?.[1] ?? "";
}

const root = document.getElementById("app")!;
start(root).catch((error) => sayWhyNot(root, error));
