// Headless browser for tests: Debian's Chromium, driven by playwright-core, with software rendering. No
// function has a timeout, because slowness of a machine is no error of the page; ctest ends tests that hang.
// Environment: TAUT_PAGE: the built page; TAUT_CHROMIUM; TAUT_PICTURES: folder for screenshots of the tests.
import { existsSync, mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import { inflateSync } from "node:zlib";
import { chromium } from "playwright-core";

export const PAGE = process.env.TAUT_PAGE ?? fileURLToPath(new URL("../dist/index.html", import.meta.url));
const CHROMIUM = process.env.TAUT_CHROMIUM ?? "/usr/bin/chromium";
export const PICTURES = process.env.TAUT_PICTURES ?? join(tmpdir(), "taut-pictures");

const GRAPHICS = ["--use-angle=swiftshader", "--enable-unsafe-swiftshader"];
const NO_GRAPHICS = ["--disable-gpu", "--disable-3d-apis"];
const browsers = new Map();

async function openBrowser(graphics) {
  if (!existsSync(PAGE)) throw new Error(`${PAGE} is not there: build it first (npm run build)`);
  if (!browsers.has(graphics)) {
    browsers.set(graphics, await chromium.launch({
      executablePath: CHROMIUM, timeout: 0, args: [...graphics, "--no-sandbox", "--force-color-profile=srgb"],
    }));
  }
  return browsers.get(graphics);
}

export async function closeBrowser() {
  for (const browser of browsers.values()) await browser.close();
  browsers.clear();
}

/**
 * Opens a page that records its errors and all requested addresses. `groups`: one plot per group of cables,
 * the default of the page; most tests read the values of single cables.
 */
export async function openPage(url, { width = 1000, height = 560, theme = "light", wait = true, scale = 1, webgl = true, touch = false, groups = false, motion = "no-preference" } = {}) {
  const context = await (await openBrowser(webgl ? GRAPHICS : NO_GRAPHICS)).newContext({
    viewport: { width, height }, colorScheme: theme, acceptDownloads: true, deviceScaleFactor: scale, hasTouch: touch,
    reducedMotion: motion,
  });
  if (!groups) await context.addInitScript(() => {
    try {
      if (localStorage.getItem("taut.plots") === null) localStorage.setItem("taut.plots", "small");
    } catch {
      // a page that may not store anything
    }
  });
  context.setDefaultTimeout(0);
  const page = await context.newPage();
  page.complaints = [];
  page.requests = [];
  page.on("pageerror", (error) => page.complaints.push(error.message));
  page.on("console", (message) => message.type() === "error" && page.complaints.push(message.text()));
  page.on("request", (request) => page.requests.push(request.url()));
  page.on("websocket", (socket) => page.requests.push(socket.url()));
  await page.goto(url);
  if (wait && webgl) await ready(page);
  return page;
}

/** Waits until the scene has been drawn. */
export async function ready(page) {
  await page.waitForFunction(() => Number(document.querySelector(".view")?.dataset.drawn ?? 0) > 1 && window.taut?.view.world);
}

/** Waits for a time in the timeline, to a hundredth of a row. */
export async function untilTime(page, time_s, within_s = 1e-4) {
  await page.waitForFunction(([wanted, within]) =>
    Math.abs(Number(document.querySelector(".timeline").dataset.time) - wanted) <= within, [time_s, within_s]);
  await drawn(page);
}

/** Waits until all changes so far are on the screen. */
export async function drawn(page) {
  await page.evaluate(() => new Promise((resolve) => {
    window.taut.view.invalidate();
    requestAnimationFrame(() => requestAnimationFrame(() => requestAnimationFrame(resolve)));
  }));
}

/** Waits for a condition outside the page; prints `what` if that takes long. */
export async function until(condition, what) {
  for (let round = 1; !(await condition()); ++round) {
    if (round % 600 === 0) console.log(`still waiting: ${what}`);
    await new Promise((resolve) => setTimeout(resolve, 50));
  }
}

/**
 * Records all messages at the bottom of the page from now on, including those that disappear: said(pattern)
 * waits for one.
 */
export async function listenToNotices(page) {
  await page.evaluate(() => {
    window.notices = [];
    window.taut.app.notice.watch((text) => text !== null && window.notices.push(text));
  });
  return (pattern) => page.waitForFunction(({ source }) => window.notices.some((text) => new RegExp(source).test(text)), { source: pattern.source });
}

/** Returns texts and numbers beside the visible plots, by figure, once all of them are present. */
export async function numbersBeside(page, figures) {
  const texts = await page.waitForFunction((ids) => {
    const found = ids.map((id) => document.querySelector(`[data-figure="${id}"] .values`));
    if (!found.every((values) => /^[^…]+$/.test(values.textContent))) return null;
    return found.map((values) => ({ text: values.textContent.trim(), numbers: [...values.children].map(({ textContent }) => textContent) }));
  }, figures);
  const numbers = (list) => list.map((text) => Number(text.replace(/−/g, "-")));
  return (await texts.jsonValue()).map((each) => ({ text: each.text, numbers: numbers(each.numbers) }));
}

/** Sets the cursor of all plots to a time. */
export async function cursorTo(page, time_s) {
  await page.evaluate((wanted) => (window.taut.app.cursor_s.value = wanted), time_s);
}

export async function picture(page, name, options = {}) {
  mkdirSync(PICTURES, { recursive: true });
  return page.screenshot({ path: join(PICTURES, `${name}.png`), ...options });
}

/** Writes the page as a report with these data; returns its address on disk. */
export function writeReport(data, folder) {
  const text = JSON.stringify(data).replace(/</g, "\\u003c");
  const html = readFileSync(PAGE, "utf8").replace(/(id="taut-report">)(<\/script>)/, (_, before, after) => before + text + after);
  const path = join(folder, "report.html");
  writeFileSync(path, html);
  return `file://${path}`;
}

/** Returns the picture of the 3D view: colour(x, y) in pixels of the page, from the view's top left. */
export async function viewPixels(page) {
  const box = await page.locator(".view").boundingBox();
  const { width, channels, bytes } = decodePng(await page.screenshot({ clip: box }));
  return {
    width: box.width, height: box.height,
    colour: (x, y) => {
      const at = channels * (Math.round(y) * width + Math.round(x));
      return [...bytes.subarray(at, at + 3)];
    },
  };
}

/** Decodes a PNG of 8 bits per channel, not interlaced, as written by Chromium. */
export function decodePng(file) {
  const width = file.readUInt32BE(16);
  const height = file.readUInt32BE(20);
  const channels = { 2: 3, 6: 4 }[file[25]];
  if (file[24] !== 8 || !channels || file[28] !== 0) throw new Error("a PNG of another kind");
  const parts = [];
  for (let at = 8; at < file.length; at += 12 + file.readUInt32BE(at)) {
    if (file.toString("latin1", at + 4, at + 8) === "IDAT") parts.push(file.subarray(at + 8, at + 8 + file.readUInt32BE(at)));
  }
  const packed = inflateSync(Buffer.concat(parts));
  const row = width * channels;
  const bytes = new Uint8Array(height * row);
  for (let y = 0; y < height; ++y) {
    const filter = packed[y * (row + 1)];
    for (let i = 0; i < row; ++i) {
      const left = i >= channels ? bytes[y * row + i - channels] : 0;
      const up = y > 0 ? bytes[(y - 1) * row + i] : 0;
      const corner = i >= channels && y > 0 ? bytes[(y - 1) * row + i - channels] : 0;
      const nearest = () => {
        const [a, b, c] = [Math.abs(up - corner), Math.abs(left - corner), Math.abs(left + up - 2 * corner)];
        return a <= b && a <= c ? left : b <= c ? up : corner;
      };
      const guess = [() => 0, () => left, () => up, () => (left + up) >> 1, nearest][filter]();
      bytes[y * row + i] = packed[y * (row + 1) + 1 + i] + guess;
    }
  }
  return { width, height, channels, bytes };
}

/** Returns a projection from p_W to pixels, computed independently from the page's camera. */
export async function projection(page) {
  const { eye, target, fov, width, height } = await page.evaluate(() => {
    const { view } = window.taut;
    return {
      eye: view.camera.position.toArray(), target: view.target.toArray(), fov: view.camera.fov,
      width: view.canvas.clientWidth, height: view.canvas.clientHeight,
    };
  });
  const minus = (a, b) => a.map((value, k) => value - b[k]);
  const dot = (a, b) => a.reduce((sum, value, k) => sum + value * b[k], 0);
  const cross = ([a, b, c], [x, y, z]) => [b * z - c * y, c * x - a * z, a * y - b * x];
  const unit = (a) => a.map((value) => value / Math.hypot(...a));
  const ahead = unit(minus(target, eye));
  const right = unit(cross(ahead, [0, 0, 1]));
  const up = cross(right, ahead);
  const scale = height / 2 / Math.tan((fov * Math.PI) / 360);
  const project = (p) => {
    const d = minus(p, eye);
    const depth = dot(d, ahead);
    return { x: width / 2 + (scale * dot(d, right)) / depth, y: height / 2 - (scale * dot(d, up)) / depth, depth };
  };
  return project;
}
