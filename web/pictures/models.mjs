// Pictures of models, as displayed by `taut view MODEL`; run by script/gallery.
//
//   node web/pictures/models.mjs FOLDER MODEL...     writes FOLDER/NAME.png of each NAME.yaml
// Environment: TAUT_COMMAND, and the variables of test/browser.mjs.
import { basename, join } from "node:path";
import { closeBrowser, drawn, openPage } from "../test/browser.mjs";
import { stop, view } from "../test/real_server.mjs";

const [folder, ...models] = process.argv.slice(2);
for (const model of models) {
  const address = await view("--port", "0", model);
  const page = await openPage(address, { width: 1400, height: 520 });
  // Shows only the robot on its ground: overlays are useless in a picture.
  await page.addStyleTag({ content: ".view > :not(canvas) { visibility: hidden !important; }" });
  await page.keyboard.press("f");
  await drawn(page);
  await page.locator(".view canvas").first().screenshot({ path: join(folder, `${basename(model, ".yaml")}.png`) });
  await page.context().close();
  await stop();
}
await closeBrowser();
