// Header: title, mode, driver, state of the connection.
import type { App } from "../app";
import { icon } from "./icons";
import { button, el, foldButton } from "../util";

const NOTICE_MS = 6000;

export function header(app: App, help: () => void, toggles: HTMLElement[]): HTMLElement {
  const title = el("h1");
  const mode = el("span.mode");
  const link = el("span.link", { role: "status" });
  const driver = el("span.driver");
  const take = button("take control", "take control; all others can only watch", () => app.send({ type: "take_control" }));
  const theme = button(icon("theme"), "dark or light (T)", () => app.toggleTheme());
  // on phones these are behind one button, so that the header has one row
  const extras = el("span.extras", {}, ...toggles, theme);
  const more = foldButton("more buttons", "button.more", () => element);
  const element: HTMLElement = el("header.top", {}, el("span.brand", {}, "taut"), title, mode, link, driver, take,
    el("span.spring"), extras, more, button("?", "help (?)", help));

  app.hello.watch((hello) => {
    title.textContent = title.title = hello?.title ?? "";
    document.title = hello?.title ? `${hello.title} – taut` : "taut";
    mode.textContent = app.report ? "report" : (hello?.mode ?? "");
    element.dataset["mode"] = mode.textContent;
  });
  app.link.watch((state) => {
    link.textContent = { connecting: "connecting …", open: "", lost: "connection lost, trying again …", refused: "the server was restarted: open the address that it printed", report: "" }[state];
    link.dataset["state"] = state;
  });
  const drives = () => {
    const several = !app.report && app.hello.value !== null && app.driver.value !== 0;
    driver.textContent = several ? (app.drives ? "you drive" : `viewer ${app.driver.value} drives, you watch`) : app.watches ? "you watch" : "";
    driver.classList.toggle("other", !app.drives);
    take.hidden = app.drives || app.watches;
  };
  app.driver.watch(drives);
  app.hello.watch(drives);
  return element;
}

/** Returns a line at the bottom that disappears after a while. */
export function notices(app: App): HTMLElement {
  const text = el("span");
  const element = el("div.notice", { role: "alert" }, text, button("×", "close", () => (app.notice.value = null), "button.small"));
  let timer = 0;
  app.notice.watch((notice) => {
    element.hidden = notice === null;
    text.textContent = notice ?? "";
    clearTimeout(timer);
    const lasting = notice !== null && notice === app.scene.value?.notice;
    if (notice !== null && !lasting) timer = window.setTimeout(() => (app.notice.value = null), NOTICE_MS);
  });
  return element;
}

/** Returns the page for failures, if there is nothing to display. */
export function failurePage(app: App, advice = "The terminal of taut may show more messages."): HTMLElement {
  const text = el("pre");
  const element = el("main.failure", { role: "alert" }, el("h1", {}, "There is nothing to show"), text,
    el("p", {}, advice));
  app.failure.watch((failure) => {
    element.hidden = failure === null;
    text.textContent = failure ?? "";
    document.body.classList.toggle("failed", failure !== null);
  });
  return element;
}
