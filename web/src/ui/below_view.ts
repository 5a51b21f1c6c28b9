// Placement of the overlays: on the view, or below it in a one-column layout, so that they do not cover the
// robot.
import { el } from "../util";

const ONE_COLUMN = "(max-width: 900px)"; // same width as in style.css

/** Puts `parts` into the view, or into the returned element, which belongs directly below it. */
export function belowView(view: HTMLElement, parts: readonly HTMLElement[]): HTMLElement {
  const below = el("div.below");
  const media = matchMedia(ONE_COLUMN);
  const place = () => (media.matches ? below : view).append(...parts);
  media.addEventListener("change", place);
  place();
  return below;
}
