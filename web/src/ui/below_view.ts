// Where there is one column, nothing may cover the robot: what lies over the view elsewhere stands below it.
import { el } from "../util";

const ONE_COLUMN = "(max-width: 900px)"; // as in style.css

/** Puts `parts` into the view, or into the element that comes back, which belongs right below it. */
export function belowView(view: HTMLElement, parts: readonly HTMLElement[]): HTMLElement {
  const below = el("div.below");
  const media = matchMedia(ONE_COLUMN);
  const place = () => (media.matches ? below : view).append(...parts);
  media.addEventListener("change", place);
  place();
  return below;
}
