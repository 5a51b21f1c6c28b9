// Picture of the browser demo for docs/images/; run by script/pictures if script/wasm has built the demo.
//
//   node web/pictures/demo.mjs FOLDER     writes to FOLDER
import { join } from "node:path";
import { closeBrowser, drawn, openPage } from "../test/browser.mjs";
import { WASM } from "../test/core.mjs";
import { serve } from "../test/static_server.mjs";

const [folder] = process.argv.slice(2);
const server = await serve(join(WASM, "site"));
const page = await openPage(`${server.url}#experiments/drop_six_strut.yaml`, { width: 1280, height: 800 });
await page.selectOption(".timeline select", "0");
await page.waitForFunction(() => document.querySelectorAll(".bits .same").length === 2);
await page.locator("label", { hasText: "whole run" }).click();
await page.keyboard.press("f");
await drawn(page);
await page.waitForFunction(() => ![...document.querySelectorAll(".values")].some((each) => each.textContent.includes("…")));
await page.screenshot({ path: join(folder, "browser_demo.png") });
await closeBrowser();
await server.close();
