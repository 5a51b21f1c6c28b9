// State of the demo: the displayed file, and edits of it and of the files that it reads.
import { Signal } from "../util";
import type { Checked, Complaint, Files } from "./core";
import type { Shared } from "./link";

export class Project {
  readonly path = new Signal<string>("");
  /** Files of the project, the main file first. */
  readonly files = new Signal<readonly string[]>([]);
  readonly found = new Signal<readonly Complaint[]>([]);
  readonly good = new Signal<boolean>(true);
  /** Increases with every change of a text. */
  readonly version = new Signal<number>(0);
  edits: Files = {};
  /** Whether the displayed run began from changed files. */
  ran = false;

  constructor(readonly shipped: Files) {}

  text(path: string): string {
    return this.edits[path] ?? this.shipped[path] ?? "";
  }

  get edited(): boolean {
    return Object.keys(this.edits).length > 0;
  }

  isEdited(path: string): boolean {
    return this.edits[path] !== undefined;
  }

  write(path: string, text: string): void {
    if (text === this.shipped[path]) delete this.edits[path];
    else this.edits[path] = text;
    this.version.value += 1;
  }

  /** Selects another file, or reloads the same one. */
  choose({ path, edits }: Shared): void {
    this.edits = { ...edits };
    this.files.value = [path];
    this.found.value = [];
    this.path.value = path;
    this.version.value += 1;
  }

  learn(checked: Checked): void {
    this.found.value = checked.found;
    this.good.value = checked.good;
    // with errors the list of files read is incomplete: the previous files stay visible
    const files = checked.files.filter((file) => this.shipped[file] !== undefined || this.isEdited(file));
    const more = checked.found.map(({ file }) => file).filter((file) => file !== "" && this.text(file) !== "");
    const known = files.length > 0 ? files : this.files.value;
    const all = [...new Set([this.path.value, ...known, ...more])];
    if (all.join("\n") !== this.files.value.join("\n")) this.files.value = all;
  }
}
