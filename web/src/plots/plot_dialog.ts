// Dialog for the title, lines and place of one plot.
import { button, el } from "../util";
import { moved, type Plots, renamed, withoutChannel, withoutPlot } from "./arrangement";

export class PlotDialog {
  readonly element = el<HTMLDialogElement>("dialog.plotdialog", { "aria-label": "edit a plot" });

  constructor(
    private readonly plots: () => Plots,
    private readonly change: (plots: Plots) => void,
  ) {}

  open(place: number): void {
    this.show(place);
    if (!this.element.open) this.element.showModal();
  }

  private show(place: number): void {
    const plots = this.plots();
    const plot = plots[place];
    if (!plot) {
      this.element.close();
      return;
    }
    const act = (next: Plots, nextPlace: number) => {
      this.change(next);
      this.show(nextPlace);
    };
    const title = el<HTMLInputElement>("input", { type: "text", value: plot.title, maxlength: 80, "aria-label": "title" });
    title.addEventListener("change", () => title.value.trim() !== "" && act(renamed(this.plots(), place, title.value.trim()), place));
    const earlier = button("earlier", "move the plot one place forward", () => act(moved(this.plots(), place, place - 1), place - 1));
    const later = button("later", "move the plot one place back", () => act(moved(this.plots(), place, place + 1), place + 1));
    earlier.disabled = place === 0;
    later.disabled = place === plots.length - 1;
    const removeAll = () => {
      this.change(withoutPlot(this.plots(), place));
      this.element.close();
    };
    const lines = plot.channels.map((channel) => el("li", {}, el("span", {}, channel), button("remove", `remove ${channel} from the plot`, () => {
      const last = plot.channels.length === 1;
      act(withoutChannel(this.plots(), place, channel), place);
      if (last) this.element.close();
    }, "button.small")));
    this.element.replaceChildren(
      el("label", {}, "title ", title),
      el("ul", {}, ...lines),
      el("div.row", {}, earlier, later, button("remove plot", "remove the plot from the layout", removeAll),
        el("span.spring"), button("close", "close (esc)", () => this.element.close(), "button.primary")));
  }
}
