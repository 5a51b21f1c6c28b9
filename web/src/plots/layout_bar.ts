// Toolbar of the layouts: selection, saving under a name, export and import of files.
import type { App } from "../app";
import { button, download, el } from "../util";
import { DEFAULT_LAYOUT, layoutFile, type Layouts, type PlotSpec } from "./layouts";

export function layoutBar(app: App, layouts: Layouts, shown: () => readonly PlotSpec[]): HTMLElement {
  const choice = el<HTMLSelectElement>("select", { "aria-label": "layout", onchange: () => layouts.show(choice.value) });
  const name = el<HTMLInputElement>("input", { type: "text", "aria-label": "name of the layout", placeholder: "name", size: 12, maxlength: 60 });
  const save = () => {
    const wanted = name.value.trim();
    if (wanted === "" || wanted === DEFAULT_LAYOUT) {
      app.notice.value = wanted === "" ? "the layout needs a name" : `"${DEFAULT_LAYOUT}" is reserved for the default layout`;
      name.focus();
      return;
    }
    layouts.put(wanted, shown());
    name.value = "";
    app.notice.value = `saved as "${wanted}" in this browser`;
  };
  name.addEventListener("keydown", (event) => event.key === "Enter" && save());
  const remove = button("delete", "delete the displayed layout", () => layouts.remove());
  const file = el<HTMLInputElement>("input", { type: "file", accept: ".json,application/json", hidden: true, "aria-label": "layout file" });
  file.addEventListener("change", async () => {
    const [given] = file.files ?? [];
    if (!given) return;
    app.notice.value = layouts.import(await given.text()) ?? `"${layouts.name.value}" is shown`;
    file.value = ""; // allows selecting the same file again
  });
  const fill = () => {
    choice.replaceChildren(...layouts.names.value.map((each) => el("option", { value: each }, each)));
    choice.value = layouts.name.value;
    remove.disabled = layouts.name.value === DEFAULT_LAYOUT;
  };
  layouts.names.watch(fill);
  layouts.name.watch(fill);
  const write = () => {
    const title = layouts.name.value;
    const fileName = title.replace(/[^\w.-]+/g, "-");
    download(`taut-layout-${fileName}.json`, new Blob([layoutFile(title, shown())], { type: "application/json" }));
  };
  return el("div.row.layouts", {},
    el("label", {}, "layout ", choice), remove,
    el("span.pair", {}, name, button("save as", "save these plots in this browser under the name next to this button", save)),
    button("export", "save this layout as a file (JSON)", write),
    button("import", "open a layout file (JSON)", () => file.click()), file);
}
