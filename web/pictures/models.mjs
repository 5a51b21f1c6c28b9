// A picture of each model, as `taut view MODEL` shows it: script/gallery runs this.
//
//   node web/pictures/models.mjs FOLDER MODEL...     writes FOLDER/NAME.png of each NAME.yaml
// Environment: TAUT_COMMAND, and what test/browser.mjs says.
import { basename, join } from "node:path";
import { closeBrowser, drawn, openPage } from "../test/browser.mjs";
import { stop, view } from "../test/real_server.mjs";

const [folder, ...models] = process.argv.slice(2);
for (const model of models) {
  const address = await view("--port", "0", model);
  const page = await openPage(address, { width: 1400, height: 520 });
  // Only the robot on its ground: what lies over the scene is for those who can click it.
  await page.addStyleTag({ content: ".view > :not(canvas) { visibility: hidden !important; }" });
  await page.keyboard.press("f");
  await drawn(page);
  await page.locator(".view canvas").first().screenshot({ path: join(folder, `${basename(model, ".yaml")}.png`) });
  await page.context().close();
  await stop();
}
await closeBrowser();
