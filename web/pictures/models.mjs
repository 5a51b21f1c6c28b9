// A picture of each model, as `taut view MODEL` shows it: script/gallery runs this.
//
//   node web/pictures/models.mjs FOLDER MODEL...     writes FOLDER/NAME.png of each NAME.yaml
// Environment: TAUT_COMMAND, and what test/browser.mjs says.
import { spawn } from "node:child_process";
import { basename, dirname, join } from "node:path";
import { closeBrowser, drawn, openPage, PAGE } from "../test/browser.mjs";

/** Starts `taut view` on any port; answers its address and what ends it. */
async function view(model) {
  const server = spawn(process.env.TAUT_COMMAND, ["view", model, "--port", "0"], {
    env: { ...process.env, TAUT_WEB: dirname(PAGE) }, stdio: ["ignore", "pipe", "inherit"],
  });
  const ended = new Promise((resolve) => server.on("exit", resolve));
  const address = await new Promise((resolve, reject) => {
    let said = "";
    server.stdout.on("data", (data) => {
      const found = /http:\/\/\S+/.exec((said += data));
      if (found) resolve(found[0]);
    });
    server.on("exit", () => reject(new Error(`taut view ${model} ended`)));
  });
  return { address, stop: () => (server.kill("SIGINT"), ended) };
}

const [folder, ...models] = process.argv.slice(2);
for (const model of models) {
  const { address, stop } = await view(model);
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
