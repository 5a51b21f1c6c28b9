// Tables of results with a button that copies them for spreadsheets.
import type { ResultTable } from "../protocol";
import { button, el, SCROLLS } from "../util";

/** Returns the cells with tabs between columns, as spreadsheets paste them. */
export const tabbed = (rows: readonly (readonly string[])[]) => rows.map((row) => row.join("\t")).join("\n");

export function resultTable({ title, rows }: ResultTable, level: "h2" | "h3" = "h3"): HTMLElement {
  const [head = [], ...body] = rows;
  const copy = button("copy", `the table ${title}, for a spreadsheet`, () => void copyText(tabbed(rows), copy), "button.small");
  return el("div.result", {},
    el(level, {}, title, " ", copy),
    el("div.scroll", SCROLLS, el("table.numbers", { "aria-label": title },
      el("thead", {}, el("tr", {}, ...head.map((text) => el("th", { scope: "col" }, text)))),
      el("tbody", {}, ...body.map(([name, ...cells]) => el("tr", {}, el("th", { scope: "row" }, name!), ...cells.map((text) => el("td", {}, text))))))));
}

async function copyText(text: string, pressed: HTMLButtonElement): Promise<void> {
  const copied = await navigator.clipboard.writeText(text).then(() => true, () => byCommand(text));
  pressed.textContent = copied ? "copied" : "not copied";
  setTimeout(() => (pressed.textContent = "copy"), 2000);
}

/** Copies without permission for the clipboard, as on pages that were opened from disk. */
function byCommand(text: string): boolean {
  const area = el<HTMLTextAreaElement>("textarea", { readonly: true });
  area.value = text;
  document.body.append(area);
  area.select();
  const copied = document.execCommand("copy");
  area.remove();
  return copied;
}
