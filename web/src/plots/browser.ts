// Channel browser: all channels of the run, grouped and searchable; selected channels are added to plots by
// drag and drop or buttons.
import type { App } from "../app";
import { button, el, unitText } from "../util";
import { finder, grouped } from "./channels";

const MOST_ROWS = 200; // maximum number of displayed search results

/** Data type of a drag of channels. */
export const DRAGGED = "application/x-taut-channels";

/** Receiver of the selected channels. */
export interface Destination {
  toNewPlot(channels: readonly string[]): void;
  toPlotsOfTheirOwn(channels: readonly string[]): void;
  toPlot(place: number, channels: readonly string[]): void;
  /** The existing plots, by place. */
  plots(): readonly { place: number; title: string }[];
}

export class ChannelBrowser {
  readonly element: HTMLElement;
  private channels: readonly { name: string; unit: string }[] = [];
  private readonly chosen = new Set<string>();
  private readonly list = el("div.list");
  private readonly found = el("span", { role: "status" });
  private readonly chosenText = el("span.chosen", { role: "status" });
  readonly search = el<HTMLInputElement>("input", {
    type: "search", placeholder: "search: outer tension, node/*_z_m", "aria-label": "search channels: words, * for any text",
    oninput: () => this.showList(),
  });
  private readonly plotList = el<HTMLSelectElement>("select", { "aria-label": "plot to add to" });
  private readonly all = button("choose all", "choose all channels found", () => this.chooseAll(), "button.small");
  private readonly actions: HTMLButtonElement[];

  constructor(
    app: App,
    private readonly destination: Destination,
  ) {
    const act = (label: string, title: string, what: (channels: string[]) => void) =>
      button(label, title, () => {
        what([...this.chosen]);
        this.clear();
      });
    this.actions = [
      act("new plot", "put the chosen channels into a new plot", (names) => destination.toNewPlot(names)),
      act("separate plots", "put each chosen channel into a separate plot", (names) => destination.toPlotsOfTheirOwn(names)),
      act("add to", "add the chosen channels to the plot named next to this button", (names) => destination.toPlot(Number(this.plotList.value), names)),
      button("clear", "deselect all channels", () => this.clear()),
    ];
    const [make, each, add, clear] = this.actions as [HTMLButtonElement, HTMLButtonElement, HTMLButtonElement, HTMLButtonElement];
    this.element = el("section.channels", { "aria-label": "channels" },
      el("div.row", {}, this.search, this.found, this.all),
      this.list,
      el("div.row", {}, this.chosenText, make, each, el("span.pair", {}, add, this.plotList), clear));
    app.scene.watch((scene) => {
      const channels = scene?.channels ?? [];
      if (JSON.stringify(channels) === JSON.stringify(this.channels)) return;
      this.channels = channels;
      const names = new Set(channels.map(({ name }) => name));
      for (const name of this.chosen) if (!names.has(name)) this.chosen.delete(name);
      this.showList();
    });
    this.showChosen();
  }

  /** Updates the display after a change of the plots. */
  showPlots(): void {
    const before = this.plotList.value;
    this.plotList.replaceChildren(...this.destination.plots().map(({ place, title }) => el("option", { value: place }, title)));
    if ([...this.plotList.options].some(({ value }) => value === before)) this.plotList.value = before;
    this.showChosen();
  }

  private get matches(): string[] {
    const finds = finder(this.search.value);
    return this.channels.map(({ name }) => name).filter(finds);
  }

  private chooseAll(): void {
    for (const name of this.matches) this.chosen.add(name);
    this.showList();
  }

  private clear(): void {
    this.chosen.clear();
    this.showList();
  }

  private showList(): void {
    const searching = this.search.value.trim() !== "";
    const names = this.matches;
    this.all.hidden = !searching || names.length === 0;
    this.found.textContent = searching ? `${names.length} of ${this.channels.length} channels` : `${this.channels.length} channels`;
    const more = names.length - MOST_ROWS;
    if (searching) this.list.replaceChildren(...names.slice(0, MOST_ROWS).map((name) => this.row(name)), ...(more > 0 ? [el("p", {}, `and ${more} more: refine the search`)] : []));
    else this.showGroups(names);
    this.showChosen();
  }

  /** Groups are filled when they are opened: a robot may have thousands of channels. */
  private showGroups(names: readonly string[]): void {
    const open = new Set([...this.list.querySelectorAll<HTMLElement>("details[open]")].map(({ dataset }) => dataset["group"]));
    const group = (id: string, label: string, count: number, fill: () => HTMLElement[]): HTMLElement => {
      const content = el("div.group");
      const made = el<HTMLDetailsElement>("details", { "data-group": id }, el("summary", {}, label, el("span.count", {}, ` ${count}`)), content);
      const show = () => made.open && content.childElementCount === 0 && content.append(...fill());
      made.addEventListener("toggle", show);
      made.open = open.has(id);
      show();
      return made;
    };
    const rows = (channels: readonly string[]) => channels.map((name) => this.row(name));
    this.list.replaceChildren(...[...grouped(names)].map(([kind, things]) => {
      const count = [...things.values()].reduce((sum, channels) => sum + channels.length, 0);
      return group(kind, kind, count, () => [...things].flatMap(([thing, channels]) =>
        thing === "" ? rows(channels) : [group(`${kind}/${thing}`, thing, channels.length, () => rows(channels))]));
    }));
  }

  private row(name: string): HTMLElement {
    const unit = unitText(this.channels.find((channel) => channel.name === name)?.unit ?? "1");
    const box = el<HTMLInputElement>("input", { type: "checkbox", checked: this.chosen.has(name), onchange: () => {
      if (box.checked) this.chosen.add(name);
      else this.chosen.delete(name);
      this.showChosen();
    } });
    const row = el("label.channel", { draggable: "true", "data-channel": name, title: `${name}: drag it into a plot, or choose it` }, box, el("span", {}, name), el("span.unit", {}, unit));
    row.addEventListener("dragstart", (event) => {
      // dragging one of several selected channels drags all of them
      const names = this.chosen.has(name) ? [...this.chosen] : [name];
      event.dataTransfer?.setData(DRAGGED, JSON.stringify(names));
      event.dataTransfer?.setData("text/plain", names.join("\n"));
    });
    return row;
  }

  private showChosen(): void {
    const count = this.chosen.size;
    this.chosenText.textContent = count === 0 ? "none chosen" : `${count} chosen`;
    for (const action of this.actions) action.disabled = count === 0;
    this.actions[2]!.disabled = count === 0 || this.plotList.options.length === 0;
    for (const box of this.list.querySelectorAll<HTMLInputElement>(".channel input")) {
      box.checked = this.chosen.has(box.closest<HTMLElement>(".channel")!.dataset["channel"]!);
    }
  }
}

/** Registers a drop target for dragged channels; ignores drags of other data. */
export function dropTarget(element: HTMLElement, drop: (channels: string[]) => void): void {
  element.addEventListener("dragover", (event) => {
    if (!event.dataTransfer?.types.includes(DRAGGED)) return;
    event.preventDefault();
    element.classList.add("over");
  });
  element.addEventListener("dragleave", () => element.classList.remove("over"));
  element.addEventListener("drop", (event) => {
    element.classList.remove("over");
    const carried = event.dataTransfer?.getData(DRAGGED) ?? "";
    if (carried === "") return;
    event.preventDefault();
    drop(JSON.parse(carried) as string[]);
  });
}
