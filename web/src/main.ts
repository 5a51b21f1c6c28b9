// Entry point of the page: live view, replay, report or statics, depending on embedded data.
import { App } from "./app";
import { ReportSource } from "./embedded";
import { ServerSource } from "./live";
import { buildPage, sayWhyNot } from "./page";
import { type Report, type StaticsPage, PROTOCOL_VERSION } from "./protocol";
import { staticsPage } from "./statics/page";

/** Returns the embedded data; null: none, so there is a server. */
function embedded(): Report | StaticsPage | null {
  const text = document.getElementById("taut-report")?.textContent?.trim() ?? "";
  if (text === "") return null;
  const data = JSON.parse(text) as Report | StaticsPage;
  if (data.version !== PROTOCOL_VERSION) {
    throw new Error(`the data have version ${data.version}, this page reads version ${PROTOCOL_VERSION}`);
  }
  return data;
}

const root = document.getElementById("app")!;
try {
  const data = embedded();
  if (data && "cases" in data) staticsPage(root, data);
  else buildPage(root, new App(data ? new ReportSource(data) : new ServerSource(), data));
} catch (error) {
  sayWhyNot(root, error);
}
