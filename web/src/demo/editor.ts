// Text editor for the files: numbered lines, marks at errors and warnings, and their list.
import { button, counted, download, el } from "../util";
import type { Complaint } from "./core";
import type { Project } from "./project";

export class Editor {
  readonly element: HTMLElement;
  private readonly area: HTMLTextAreaElement;
  private readonly lines = el("div.lines", { "aria-hidden": true });
  private readonly tabs = el("div.tabs", { role: "tablist", "aria-label": "files" });
  private readonly problems = el("ol.problems", { "aria-label": "errors and warnings" });
  private readonly verdict = el("p.verdict", { role: "status" });
  private path = "";

  constructor(private readonly project: Project) {
    this.area = el<HTMLTextAreaElement>("textarea", {
      spellcheck: "false", autocomplete: "off", autocapitalize: "off", wrap: "off", "aria-label": "text of the file",
      oninput: () => this.project.write(this.path, this.area.value),
      onscroll: () => (this.lines.scrollTop = this.area.scrollTop),
      onkeydown: (event: KeyboardEvent) => this.key(event),
    });
    this.element = el("div.editing", {}, this.tabs, el("div.text", {}, this.lines, this.area), this.verdict, this.problems);
    project.files.watch((files) => {
      if (!files.includes(this.path)) this.show(files[0] ?? "");
      this.drawTabs();
    });
    project.path.watch((path) => this.show(path));
    project.version.watch(() => {
      if (this.area.value !== this.project.text(this.path)) this.area.value = this.project.text(this.path);
      this.drawTabs();
      this.drawLines();
    });
    project.found.watch((found) => this.drawFound(found));
    project.good.watch(() => this.drawFound(project.found.value));
  }

  /** Moves the cursor to the position of a diagnostic. */
  go(file: string, line: number, column: number): void {
    if (this.project.text(file) === "") return;
    this.show(file);
    const lines = this.area.value.split("\n");
    const before = lines.slice(0, Math.max(line - 1, 0)).reduce((sum, text) => sum + text.length + 1, 0);
    const at = Math.min(before + Math.max(column - 1, 0), this.area.value.length);
    this.area.focus();
    this.area.setSelectionRange(at, at);
    const height = this.area.scrollHeight / Math.max(lines.length, 1);
    this.area.scrollTop = Math.max(0, (line - 1) * height - this.area.clientHeight / 2);
  }

  /** Downloads the displayed file. */
  save(): void {
    download(this.path.slice(this.path.lastIndexOf("/") + 1), new Blob([this.area.value], { type: "text/yaml" }));
  }

  private show(path: string): void {
    if (path === this.path) return;
    this.path = path;
    this.area.value = this.project.text(path);
    this.area.scrollTop = this.area.scrollLeft = 0;
    this.drawTabs();
    this.drawLines();
  }

  private drawTabs(): void {
    this.tabs.replaceChildren(...this.project.files.value.map((path) => {
      const tab = button(path.slice(path.lastIndexOf("/") + 1), path, () => this.show(path), "button.tab");
      tab.setAttribute("role", "tab");
      tab.setAttribute("aria-selected", String(path === this.path));
      tab.classList.toggle("edited", this.project.isEdited(path));
      tab.classList.toggle("wrong", this.project.found.value.some(({ file, error }) => error && file === path));
      return tab;
    }));
  }

  private drawLines(): void {
    const count = this.area.value.split("\n").length;
    const marks = new Map<number, boolean>();
    for (const { file, line, error } of this.project.found.value) {
      if (file === this.path && line > 0) marks.set(line, error || (marks.get(line) ?? false));
    }
    this.lines.replaceChildren(...Array.from({ length: count }, (_, i) => {
      const wrong = marks.get(i + 1);
      return el(wrong === undefined ? "span" : wrong ? "span.wrong" : "span.doubtful", {}, String(i + 1));
    }));
    this.lines.scrollTop = this.area.scrollTop;
  }

  private drawFound(found: readonly Complaint[]): void {
    const errors = found.filter(({ error }) => error).length;
    const warnings = found.length - errors;
    this.verdict.textContent = errors > 0 ? counted(errors, "error") : warnings > 0 ? counted(warnings, "warning") : "no errors";
    this.verdict.classList.toggle("wrong", errors > 0);
    this.problems.replaceChildren(...found.map(({ file, line, column, error, what, hint }) => {
      const place = [file, ...[line, column].filter((part) => part > 0)].join(":");
      const jump = button(place, "go to this place", () => this.go(file, line, column), "button.place");
      return el(error ? "li.wrong" : "li", {}, ...(place === "" ? [] : [jump, " "]), `${error ? "error" : "warning"}: ${what}`, ...(hint === "" ? [] : [el("span.hint", {}, ` (${hint})`)]));
    }));
    this.drawTabs();
    this.drawLines();
  }

  /** Tab inserts spaces, as required by YAML; after Escape, Tab moves the focus out of the text. */
  private key(event: KeyboardEvent): void {
    if (event.key === "Escape") this.area.dataset["leaves"] = "yes";
    else if (event.key !== "Tab" || this.area.dataset["leaves"]) delete this.area.dataset["leaves"];
    else if (!event.shiftKey) {
      event.preventDefault();
      this.area.setRangeText("  ", this.area.selectionStart, this.area.selectionEnd, "end");
      this.project.write(this.path, this.area.value);
    }
  }
}
