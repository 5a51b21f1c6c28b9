// Tests of the page with the real server: displayed values equal taut's simulation and its traces.
// TAUT_COMMAND: the command; without it the tests are skipped.
import assert from "node:assert/strict";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { basename, join } from "node:path";
import { after, afterEach, before, test } from "node:test";
import { closeBrowser, cursorTo, drawn, numbersBeside, openPage, picture, projection, untilTime } from "./browser.mjs";
import { csvOf, options, ROOT, stop, TAUT, taut, view } from "./real_server.mjs";

let folder;

/**
 * Compares all values beside the plots of tensions, and of contacts, at a time with the rows; returns their
 * number.
 */
async function compareNumbers(page, runs, time_s) {
  const shown = await page.evaluate(() => [...document.querySelectorAll('[data-figure^="tension:"]')].map(({ dataset }) => dataset.figure));
  const figures = [...shown, "contacts"];
  let compared = 0;
  for (const [i, { numbers }] of (await numbersBeside(page, figures)).entries()) {
    const figure = figures[i];
    const tension = `cable/${figure.replace("tension:", "")}/tension_n`;
    const wanted = figure === "contacts" ? [...runs.slice(1), runs[0]].map((run) => run.value("system/contact_count", time_s))
      : [...(runs[0].has(tension.replace("tension_n", "setpoint_n")) ? [runs[0].value(tension.replace("tension_n", "setpoint_n"), time_s)] : []),
          ...runs.slice(1).map((run) => run.value(tension, time_s)), runs[0].value(tension, time_s)];
    assert.deepEqual(numbers, wanted.map(asShown), `${figure} at ${time_s} s`);
    compared += numbers.length;
  }
  return compared;
}

/** Rounds to the four digits of a value beside a plot. */
const asShown = (value) => Number(Math.abs(value) < 1e-3 || Math.abs(value) >= 1e5 ? value.toExponential(3) : value.toFixed(Math.min(Math.max(3 - Math.floor(Math.log10(Math.abs(value))), 0), 6)));

before(() => {
  folder = mkdtempSync(join(tmpdir(), "taut-view-"));
  if (!TAUT) return;
  taut("run", "experiments/push_20n.yaml", "--csv", "--quiet", "--out", folder);
});
afterEach(stop);
after(async () => {
  await closeBrowser();
  rmSync(folder, { recursive: true });
});

// A run whose tensions oscillate at the start, so that a mean of rows differs from each of them; its HDF5
// file is displayed, its CSV file is the reference.
test("TheNumbersOfReplayAndReportAreTheRowsOfTheFile", options, async (t) => {
  const run = csvOf(folder);
  const other = join(folder, "other");
  taut("run", "experiments/push_20n.yaml", "--set", "push_n=30", "--duration_s", "20", "--csv", "--quiet", "--out", other);
  const times_s = [0.013, 0.02, 12.345, 19.999];
  const compare = ["--compare", join(other, "trace.h5")];
  const replay = await openPage(await view(join(folder, "trace.h5"), ...compare, "--port", "0"), { width: 1280, height: 1100 });
  const file = join(other, "both.html");
  taut("report", join(folder, "trace.h5"), ...compare, "--out", file);
  const report = await openPage(`file://${file}`, { width: 1200, height: 800 });
  t.after(() => Promise.all([replay, report].map((page) => page.context().close())));
  for (const page of [replay, report]) {
    await page.waitForFunction(() => document.querySelectorAll('[data-figure^="tension:"] .uplot').length === 12);
    assert.deepEqual(await page.locator(".key span").allInnerTexts(), ["set point", "push_20n (other/trace.h5)", "this run"]);
    assert.equal(await compareNumbers(page, [run, csvOf(other)], 0), 12 * 3 + 2, "without a cursor");
    for (const time_s of times_s) {
      await cursorTo(page, time_s);
      await compareNumbers(page, [run, csvOf(other)], time_s);
    }
    assert.match(await page.locator('[data-figure="contacts"] .coarse').innerText(), /^min to max of (up to )?\d+ rows$/);
  }
  await picture(report, "two-runs", { fullPage: true });
});

test("TheNumbersOfALiveRunAreThoseOfTheRun", options, async (t) => {
  const hang = join(folder, "hang");
  taut("run", "experiments/hang.yaml", "--csv", "--quiet", "--out", hang);
  const run = csvOf(hang); // 200 rows per second
  const address = await view("experiments/hang.yaml", "--paused", "--port", "0");
  const page = await openPage(address, { width: 1280, height: 900 });
  t.after(() => page.context().close());
  const step = async (count, time_s) => {
    await page.evaluate((many) => window.taut.app.send({ type: "step", count: many }), count);
    await page.waitForFunction((wanted) => Math.abs(window.taut.app.frame.value.time_s - wanted) < 1e-9, time_s);
  };
  for (let i = 1; i <= 6; ++i) await step(5, 0.005 * i);
  await compareNumbers(page, [run], 0.0300001);
  for (const time_s of [0.0012, 0.0151, 0.0249]) {
    await cursorTo(page, time_s);
    await compareNumbers(page, [run], time_s);
  }
  await step(1000, 1.03);
  // the server has the times without frames, before the page was opened or between frames, with a row per 10
  // ms
  const drawn = () => page.evaluate(() => new Promise((resolve) => window.taut.store.want("cable/cable/tension_n", 0, 0, 1.03, 200, ({ t }) => resolve(t))));
  while ((await drawn()).length < 100) await page.evaluate(() => new Promise((resolve) => requestAnimationFrame(resolve)));
  const times_s = await drawn();
  times_s.forEach((time_s, i) => assert.ok(i === 0 || time_s > times_s[i - 1], "times rise where parts meet"));
  for (const time_s of [0.5099, 1.0201]) {
    await cursorTo(page, time_s);
    await compareNumbers(page, [run], Math.floor(100 * time_s) / 100 + 1e-9);
  }
  const late = await openPage(address, { width: 1280, height: 900 });
  t.after(() => late.context().close());
  for (const time_s of [0.0001, 0.5099, 1.0201]) {
    await cursorTo(late, time_s);
    await compareNumbers(late, [run], Math.floor(100 * time_s) / 100 + 1e-9);
  }
  assert.deepEqual(await late.locator(".key span").allInnerTexts(), ["this run"], "nobody sets a tension here");
  assert.equal(await late.evaluate(() => window.taut.store.has("cable/cable/setpoint_n", 0)), false);
});

/** The same run with all channels, including positions of nodes: one second of it. */
function runWithEverything() {
  const out = join(folder, "everything");
  const text = readFileSync(join(ROOT, "share/experiments/push_20n.yaml"), "utf8")
    .replace(/^record: .*$/m, 'record: {rate_hz: 100, channels: ["*"]}').replace(/\.\.\/models\//g, join(ROOT, "share/models/"));
  const file = join(folder, "everything.yaml");
  writeFileSync(file, text);
  taut("run", file, "--duration_s", "1", "--csv", "--quiet", "--out", out);
  return csvOf(out);
}

/** Adds a channel to a new plot; returns its figure. */
async function plotOf(page, channel) {
  if (await page.locator(".editor").isHidden()) await page.keyboard.press("b");
  await page.getByRole("searchbox").fill(channel);
  await page.locator(`[data-channel="${channel}"] input`).check();
  await page.getByRole("button", { name: "put the chosen channels into a new plot" }).click();
  return page.locator("figure.chart").last().evaluate(({ dataset }) => dataset.figure);
}

async function numberBeside(page, figure) {
  await page.locator(`[data-figure="${figure}"]`).scrollIntoViewIfNeeded();
  return (await numbersBeside(page, [figure]))[0].numbers;
}

test("NodesAndAnyOtherChannelOfAReplayArePlotted", options, async (t) => {
  const page = await openPage(await view(join(folder, "trace.h5"), "--port", "0"), { width: 1280, height: 1000 });
  t.after(() => page.context().close());
  const run = runWithEverything();
  const time_s = 0.37;
  await page.evaluate((wanted) => window.taut.app.seek(wanted), time_s);
  await untilTime(page, time_s, 1e-9);
  for (const channel of ["node/segment_1.tip/position_z_m", "cable/outer_top_1/elastic_n", "body/segment_2/angular_velocity_y_rad_per_s", "system/com_x_m"]) {
    assert.ok(run.has(channel), channel);
    assert.deepEqual(await numberBeside(page, await plotOf(page, channel)), [asShown(run.value(channel, time_s))], channel);
  }
  // a selected node is plotted like a cable or a body
  const node = await page.evaluate(() => {
    const { app } = window.taut;
    app.selection.value = { kind: "node", index: 4 };
    return app.scene.value.nodes[4].name;
  });
  assert.deepEqual(await numberBeside(page, `own:node:${node}:position`), ["x", "y", "z"].map((axis) => asShown(run.value(`node/${node}/position_${axis}_m`, time_s))));
});

test("AnyChannelOfALiveRunIsPlottedFromItsStart", options, async (t) => {
  const page = await openPage(await view("experiments/push_20n.yaml", "--paused", "--port", "0"), { width: 1280, height: 1000, webgl: false });
  t.after(() => page.context().close());
  await page.waitForSelector("figure.chart");
  const run = runWithEverything();
  const step = async (count, time_s) => {
    await page.evaluate((many) => window.taut.app.send({ type: "step", count: many }), count);
    await page.waitForFunction((wanted) => Math.abs(window.taut.app.frame.value.time_s - wanted) < 1e-9, time_s);
  };
  await step(300, 0.3);
  const channels = ["cable/outer_top_1/elastic_n", "node/segment_1.tip/position_z_m", "body/segment_0/velocity_z_m_per_s"];
  const figures = [];
  for (const channel of channels) figures.push(await plotOf(page, channel));
  const compare = async (time_s) => {
    for (const [i, channel] of channels.entries()) {
      await page.locator(`[data-figure="${figures[i]}"]`).scrollIntoViewIfNeeded();
      const wanted = asShown(run.value(channel, time_s + 1e-9));
      await page.waitForFunction(([id, number]) => Number(document.querySelector(`[data-figure="${id}"] .values span`)?.textContent.replace("−", "-")) === number, [figures[i], wanted]);
    }
  };
  await compare(0.3);
  await step(400, 0.7);
  await compare(0.7);
  await cursorTo(page, 0.123);
  await compare(0.12);
  await cursorTo(page, null);
  // the drawn points are all rows of the run
  const drawn = await page.evaluate(([channel]) => new Promise((resolve) => {
    const ask = () => window.taut.store.want(channel, 0, 0, 0.7, 500, ({ t, first }) => (t.length >= 71 ? resolve({ t, first }) : requestAnimationFrame(ask)));
    ask();
  }), channels);
  drawn.t.forEach((time_s, i) => assert.equal(drawn.first[i], run.value(channels[0], time_s + 1e-9), `row at ${time_s} s`));
});

test("OfManyCablesThoseWithTheLargestTensionsArePlotted", options, async (t) => {
  const long = join(folder, "long");
  taut("run", "experiments/sidewinder12.yaml", "--duration_s", "2", "--csv", "--quiet", "--out", long);
  const run = csvOf(long);
  const page = await openPage(await view(join(long, "trace.h5"), "--port", "0"), { width: 1280, height: 1300, webgl: false });
  t.after(() => page.context().close());
  await page.waitForSelector("figure.chart");
  const names = await page.evaluate(() => window.taut.app.scene.value.cables.map(({ name }) => name));
  assert.equal(names.length, 66);
  const most = new Map(names.map((name) => [name, Math.max(...run.rows.map((row) => row[run.column(`cable/${name}/tension_n`)]))]));
  const largest = [...names].sort((a, b) => most.get(b) - most.get(a)).slice(0, 12);
  const wanted = names.filter((name) => largest.includes(name)).map((name) => `tension:${name}`);
  await page.waitForFunction(() => document.querySelectorAll('[data-figure^="tension:"] .uplot').length === 12);
  assert.deepEqual(await page.locator('[data-figure^="tension:"]').evaluateAll((charts) => charts.map(({ dataset }) => dataset.figure)), wanted);
  assert.equal(await page.locator(".remark").innerText(), '12 of 66 cables, those with the largest tensions of the run; for other channels use "edit plots"');
  await cursorTo(page, 1.234);
  await compareNumbers(page, [run], 1.234);
  await picture(page, "many-cables");
});

test("ATraceIsReplayedToThePosesOfTheFile", options, async (t) => {
  const page = await openPage(await view(join(folder, "trace.h5"), "--port", "0"), { width: 1280, height: 760 });
  t.after(() => page.context().close());
  const run = csvOf(folder);
  for (const time_s of [0, 20, 37, 60]) {
    await page.evaluate((wanted) => window.taut.app.seek(wanted), time_s);
    await untilTime(page, time_s, 1e-9);
    const value = (name) => run.value(name, time_s);
    const shown = await page.evaluate(() => window.taut.app.scene.value.bodies.map(({ name }, i) => ({ name, group: window.taut.view.world.bodies.object.children[i] }))
      .map(({ name, group }) => ({ name, p: group.position.toArray(), q: group.quaternion.toArray() })));
    assert.equal(shown.length, 3);
    for (const { name, p, q: [x, y, z, w] } of shown) {
      ["x", "y", "z"].forEach((axis, k) => assert.ok(Math.abs(p[k] - value(`body/${name}/position_${axis}_m`)) < 1e-9));
      Object.entries({ w, x, y, z }).forEach(([axis, part]) => assert.ok(Math.abs(part - value(`body/${name}/orientation_${axis}`)) < 1e-9));
    }
  }
  await page.evaluate(() => window.taut.app.seek(37));
  await untilTime(page, 37, 1e-9);
  await page.waitForFunction(() => document.querySelectorAll('[data-figure^="tension:"] .uplot').length === 12);
  await drawn(page);
  await picture(page, "push-replay");
  assert.deepEqual(page.requests.filter((url) => !["localhost", "127.0.0.1"].includes(new URL(url).hostname) && !/^(data|blob):/.test(url)), []);
  assert.deepEqual(page.complaints, []);
});

// Four runs: one of another robot, one that ends early with another rate, and a measured one without poses.
test("GhostsAndContactForcesAreTheRowsOfTheirFiles", options, async (t) => {
  const experiment = (name, more) => {
    const file = join(folder, `${name}.yaml`);
    writeFileSync(file, `taut: 1\nkind: experiment\nbase: ${join(ROOT, "share", more.base)}\nname: ${name}\nrecord: {rate_hz: ${more.rate_hz}, channels: [\"*\"], contacts: 20}\n`);
    taut("run", file, "--duration_s", String(more.duration_s), "--csv", "--quiet", "--out", join(folder, name));
    return csvOf(join(folder, name));
  };
  const own = experiment("own", { base: "experiments/push_20n.yaml", rate_hz: 100, duration_s: 2 });
  const early = experiment("early", { base: "experiments/push_20n_table1.yaml", rate_hz: 40, duration_s: 1 });
  const hang = experiment("hanging", { base: "experiments/hang.yaml", rate_hz: 200, duration_s: 2 });
  writeFileSync(join(folder, "measured.csv"), "time_s,cable/outer_top_1/tension_n\n0,5\n1,6\n2,7\n");
  const compare = ["--compare", join(folder, "early/trace.h5"), join(folder, "hanging/trace.h5"), "--compare", join(folder, "measured.csv")];
  const file = join(folder, "four.html");
  taut("report", join(folder, "own/trace.h5"), ...compare, "--out", file);
  const pages = [await openPage(await view(join(folder, "own/trace.h5"), ...compare, "--port", "0"), { width: 1280, height: 800 }), await openPage(`file://${file}`, { width: 1200, height: 800 })];
  t.after(() => Promise.all(pages.map((page) => page.context().close())));
  for (const page of pages) {
    assert.deepEqual(await page.locator(".runs .name").allInnerTexts(), ["this run: own (own/trace.h5)", "early (early/trace.h5)", "hanging (hanging/trace.h5)", `${basename(folder)}/measured.csv`]);
    assert.match(await page.locator(".runs li").last().innerText(), /no ghost/);
    for (const time_s of [0, 0.5, 1.5]) {
      await page.evaluate((wanted) => window.taut.app.seek(wanted), time_s);
      await untilTime(page, time_s, 0.05);
      const { shown_s, ghosts, arrows } = await page.evaluate(() => {
        const { world } = window.taut.view;
        const shafts = world.forces.contacts.object.children;
        const length = (mesh, i) => Math.hypot(...mesh.instanceMatrix.array.slice(16 * i + 4, 16 * i + 7));
        return {
          shown_s: window.taut.app.frame.value.time_s,
          ghosts: world.ghosts.ghosts.map(({ object, bodies, groups }) => ({ drawn: object.visible, bodies: bodies.map(({ name }, i) => ({ name, p: groups[i].position.toArray() })) })),
          arrows: Array.from({ length: shafts[0].count }, (_, i) => ((length(shafts[0], i) + length(shafts[1], i)) * world.forces.reference_n) / world.forces.reference_m),
        };
      });
      assert.deepEqual(ghosts.map(({ drawn: seen }) => seen), [time_s < 1.01, true, false]);
      for (const [k, run] of [[0, early], [1, hang]]) {
        if (!ghosts[k].drawn) continue;
        assert.ok(ghosts[k].bodies.length > 0);
        for (const { name, p } of ghosts[k].bodies) {
          ["x", "y", "z"].forEach((axis, i) => assert.equal(p[i], run.value(`body/${name}/position_${axis}_m`, shown_s + 1e-9), `${name} at ${shown_s} s`));
        }
      }
      const forces_n = Array.from({ length: 20 }, (_, slot) => Math.hypot(...["x", "y", "z"].map((axis) => own.value(`contact/${slot}/force_${axis}_n`, shown_s + 1e-9)))).filter((force_n) => force_n > 0);
      assert.equal(arrows.length, forces_n.length, `contacts at ${shown_s} s`);
      arrows.forEach((force_n, i) => assert.ok(Math.abs(force_n - forces_n[i]) < 1e-5 * Math.max(...forces_n)));
      if (time_s > 0) assert.ok(arrows.length >= 3, "it stands on something");
    }
  }
});

test("ANodeIsDraggedAndTheTensionAnswers", options, async (t) => {
  const page = await openPage(await view("models/tetraspine3.yaml", "--settled", "--port", "0"), { wait: true });
  t.after(() => page.context().close());
  const mode = await page.evaluate(() => window.taut.app.hello.value.mode);
  assert.equal(mode, "model");
  // alone and paused it stands still; once resumed it follows the drag
  const tip = await page.evaluate(() => window.taut.app.scene.value.nodes.at(-1).name);
  await page.evaluate((node) => window.taut.app.send({ type: "drag", node, target_m: [1, 1, 1] }), tip);
  await page.getByRole("button", { name: "play or pause" }).click();
  const moved = await page.evaluate(() => [...window.taut.app.frame.value.bodies]);
  await page.waitForFunction((from) => window.taut.app.frame.value.bodies.some((value, k) => k % 7 < 3 && Math.abs(value - from[k]) > 0.1), moved);
  await page.context().close();
  await stop();
  // paused until the drag holds it: the experiment ends, and a slow page may load after its end
  const live = await openPage(await view("experiments/stand_still.yaml", "--paused", "--port", "0"));
  t.after(() => live.context().close());
  const node = await live.evaluate(() => {
    const { scene } = window.taut.app;
    return scene.value.nodes.findIndex(({ name }) => /tip|high|top/.test(name));
  });
  const at = await live.evaluate((index) => window.taut.view.nodeAt(index).toArray(), node);
  const { x, y } = (await projection(live))(at);
  const box = await live.locator(".view").boundingBox();
  const before = await live.evaluate(() => Array.from(window.taut.app.frame.value.cables).filter((_, k) => k % 4 === 0));
  await live.mouse.move(box.x + x, box.y + y);
  await live.mouse.down();
  await live.mouse.move(box.x + x + 50, box.y + y - 60, { steps: 5 });
  await live.evaluate(() => window.taut.app.togglePlay());
  await live.waitForFunction(() => window.taut.app.frame.value.pushes.length > 0);
  const { said, force_n } = await live.evaluate(() => ({
    said: document.querySelector(".grip").textContent, force_n: Math.hypot(...window.taut.app.frame.value.pushes.slice(-3)),
  }));
  assert.match(said, / N$/);
  assert.ok(Math.abs(parseFloat(said) - force_n) <= 0.005 * force_n, `${said}, not ${force_n} N`);
  await live.waitForFunction((old) => Array.from(window.taut.app.frame.value.cables)
    .filter((_, k) => k % 4 === 0).some((tension, i) => Math.abs(tension - old[i]) > 0.5), before);
  await live.mouse.up();
  await live.waitForFunction(() => window.taut.app.frame.value.pushes.length === 0);
  assert.deepEqual(live.complaints, []);
});

test("AReportOpensFromDiskAndAsksNobody", options, async (t) => {
  const file = join(folder, "report.html");
  taut("report", join(folder, "trace.h5"), "--out", file);
  const page = await openPage(`file://${file}`, { width: 1200, height: 800 });
  t.after(() => page.context().close());
  await page.evaluate(() => window.taut.app.seek(37));
  await untilTime(page, 37, 0.05);
  assert.equal(await page.evaluate(() => window.taut.view.world.forces.pushes.object.children[0].count), 3, "the three pushes act");
  const text = await page.locator("main.report").innerText();
  for (const part of ["push_20n", "inner_top_1", "The run is complete, 60 s, without problems."]) assert.ok(text.includes(part), part);
  assert.deepEqual(page.requests.filter((url) => !/^(file|data|blob):/.test(url)), []);
  await drawn(page);
  await picture(page, "push-report", { fullPage: true });
});

// For a robot whose bodies are points, too, the picture shows all of it, and a mode's oscillation is visible.
test("ShapesOfAnAnalysisFillTheViewAndMove", options, async (t) => {
  const shapes = join(folder, "shapes");
  taut("analyze", "models/t3_prism.yaml", "--modes", "1", "--out", shapes);
  const page = await openPage(await view(join(shapes, "mode_1", "trace.h5"), "--port", "0"), { width: 1000, height: 700 });
  t.after(() => page.context().close());
  const seen = async (time_s) => {
    await page.evaluate((at) => window.taut.app.send({ type: "seek", time_s: at }), time_s);
    await untilTime(page, time_s, 0.02);
    await drawn(page);
    const places = await page.evaluate(() => window.taut.app.scene.value.nodes.map((_, i) => window.taut.view.nodeAt(i).toArray()));
    const project = await projection(page);
    return places.map((place) => project(place));
  };
  await page.evaluate(() => window.taut.app.send({ type: "pause" }));
  const { clientWidth: width, clientHeight: height } = await page.evaluate(() => {
    const { clientWidth, clientHeight } = window.taut.view.canvas;
    return { clientWidth, clientHeight };
  });
  const still = await seen(0), to = await seen(0.5), back = await seen(1.5);
  for (const { x, y } of still) assert.ok(x > 0 && x < width && y > 0 && y < height, `${x}, ${y} of ${width}, ${height}`);
  const moved = Math.max(...to.map(({ x, y }, i) => Math.hypot(x - back[i].x, y - back[i].y)));
  assert.ok(moved > 0.04 * width, `${moved} pixels of ${width}`);
});

test("AModelIsAnalyzedDroppedSettledAndPutBack", options, async (t) => {
  const page = await openPage(await view("models/prism3.yaml", "--port", "0"), { groups: true });
  t.after(() => page.context().close());
  await page.waitForFunction(() => document.querySelectorAll(".statics button").length > 0);
  const known = JSON.parse(taut("analyze", "models/prism3.yaml", "--json", "--modes", "3").toString());
  const frequencies = await page.evaluate(() => window.taut.app.tuning.value.statics.modes.slice(0, 3).map(({ frequency_hz }) => frequency_hz));
  const text = JSON.stringify(known);
  for (const frequency_hz of frequencies) assert.ok(text.includes(`"frequency_hz":${frequency_hz}`), `${frequency_hz} Hz is a mode of taut analyze`);
  const height = () => page.evaluate(() => Math.min(...window.taut.app.scene.value.nodes.map((_, i) => window.taut.view.nodeAt(i).z)));
  const before_m = await height();
  await page.getByRole("button", { name: "simulate the robot falling onto the ground" }).click();
  await page.waitForFunction(() => window.taut.app.frame.value.now_s > 0.6);
  assert.ok((await height()) < before_m - 0.05, "it has fallen");
  assert.equal(await page.evaluate(() => window.taut.app.scene.value.terrain.length), 1);
  assert.ok((await page.locator(".plots .grid:visible").count()) > 0, "plots of the fall");
  await page.getByRole("button", { name: "let the robot settle on the ground" }).click();
  await page.waitForFunction(() => window.taut.app.frame.value.now_s === 0 && window.taut.app.scene.value.terrain.length === 1);
  await page.getByRole("button", { name: "return to the described pose, without gravity" }).click();
  await page.waitForFunction(() => window.taut.app.scene.value.terrain.length === 0 && window.taut.app.frame.value.now_s === 0);
  assert.ok(Math.abs((await height()) - before_m) < 1e-9);
});

test("TheNextModeIsThatOfTheSameAnalysis", options, async (t) => {
  const shapes = join(folder, "shapes");
  taut("analyze", "models/prism3.yaml", "--modes", "2", "--out", shapes);
  const page = await openPage(await view(join(shapes, "mode_1", "trace.h5"), "--port", "0"), { groups: true });
  t.after(() => page.context().close());
  const bar = page.locator(".shapebar span");
  const first = await bar.innerText();
  assert.match(first, /^mode 1 of 2 · [\d.]+ Hz · slowed [\d.]+× · amplitude: 8 % of the robot's size$/);
  await page.getByRole("button", { name: "next mode" }).click();
  await page.waitForFunction(() => document.querySelector(".shapebar span").textContent.startsWith("mode 2 of 2"));
  await page.getByRole("button", { name: "next mode" }).click();
  await page.waitForFunction((text) => document.querySelector(".shapebar span").textContent === text, first);
});

test("PushesAndTagsOfTheFilesAreInTheScene", options, async (t) => {
  const page = await openPage(await view("experiments/push_20n.yaml", "--paused", "--port", "0"), { groups: true });
  t.after(() => page.context().close());
  const { actions, tags } = await page.evaluate(() => ({ actions: window.taut.app.scene.value.actions, tags: window.taut.app.scene.value.cables.map((cable) => cable.tags) }));
  assert.ok(actions.length > 0 && actions.every(({ kind, text, from_s, to_s }) => kind === "push" && / N on /.test(text) && from_s < to_s), JSON.stringify(actions));
  assert.ok(tags.every((list) => list.length > 0), JSON.stringify(tags));
});
