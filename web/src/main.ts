// Entry point of the page: live view, replay or report, depending on embedded data.
import { App } from "./app";
import { ReportSource } from "./embedded";
import { ServerSource } from "./live";
import { buildPage, sayWhyNot } from "./page";
import { type Report, PROTOCOL_VERSION } from "./protocol";

/** Returns the embedded report; null: none, so there is a server. */
function embeddedReport(): Report | null {
  const text = document.getElementById("taut-report")?.textContent?.trim() ?? "";
  if (text === "") return null;
  const report = JSON.parse(text) as Report;
  if (report.version !== PROTOCOL_VERSION) {
    throw new Error(`the data have version ${report.version}, this page reads version ${PROTOCOL_VERSION}`);
  }
  return report;
}

const root = document.getElementById("app")!;
try {
  const report = embeddedReport();
  buildPage(root, new App(report ? new ReportSource(report) : new ServerSource(), report));
} catch (error) {
  sayWhyNot(root, error);
}
