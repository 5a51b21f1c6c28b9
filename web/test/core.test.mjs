// Tests that the WebAssembly core and the taut command yield the same bits and the same diagnostics.
// TAUT_COMMAND: the command; TAUT_WASM: the build folder of script/wasm.
import assert from "node:assert/strict";
import { execFileSync, spawnSync } from "node:child_process";
import { mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { after, before, test } from "node:test";
import { gzipSync } from "node:zlib";
import { CORE, goOn, loadCore, options, runTo, shipped } from "./core.mjs";

const TAUT = process.env.TAUT_COMMAND;
const AT_S = 1;
let core, folder;
before(async () => {
  if (options.skip) return;
  core = await loadCore();
  folder = mkdtempSync(join(tmpdir(), "taut-wasm-"));
  put(shipped);
});
after(() => folder && rmSync(folder, { recursive: true }));

function put(files) {
  for (const [path, text] of Object.entries(files)) {
    mkdirSync(dirname(join(folder, path)), { recursive: true });
    writeFileSync(join(folder, path), text);
  }
}

/** Returns the command's result for a file in `folder`. */
function native(path, duration_s, ...more) {
  const words = ["run", path, "--duration_s", String(duration_s), "--json", "--quiet", "--out", join(folder, "runs/run"), ...more];
  const { simulated_s, state_hash } = JSON.parse(execFileSync(TAUT, words, { cwd: folder, maxBuffer: 1 << 26 }));
  return { time_s: simulated_s, hash: state_hash };
}

test("EveryExperimentHasTheHashOfTheCommand", options, () => {
  const paths = Object.keys(shipped).filter((path) => path.startsWith("experiments/"));
  assert.ok(paths.length > 50);
  for (const path of paths) assert.deepEqual(runTo(core, path, [AT_S]).marks, [native(path, AT_S)], path);
});

test("EveryModelHasTheHashOfTheCommand", options, () => {
  const models = Object.keys(shipped).filter((path) => /^models\/.*yaml$/.test(path));
  assert.ok(models.length > 15);
  for (const model of models) {
    // in place of a shipped file: a page has no other files
    const text = `taut: 1\nkind: experiment\nname: it_falls\nmodel: ../${model}\nduration_s: 5\n`;
    const path = "experiments/hang.yaml";
    put({ [path]: text });
    assert.deepEqual(runTo(core, path, [AT_S], { [path]: text }).marks, [native(path, AT_S)], model);
    put({ [path]: shipped[path] });
  }
});

test("AnExperimentEndsWithTheHashOfTheCommandAndGoesOn", options, () => {
  const path = "experiments/drop_six_strut.yaml";
  const [end] = [native(path, 3)];
  const state = runTo(core, path, [AT_S, 3]);
  assert.deepEqual(state.marks, [native(path, AT_S), end]);
  assert.equal(state.path, path);
  assert.equal(state.touched, false);
  assert.deepEqual(state.set, {});
});

test("AParameterThatIsSetIsThatOfTheCommand", options, () => {
  const path = "experiments/push_20n.yaml";
  runTo(core, path, [AT_S]);
  core.post('{"type": "set_parameter", "name": "push_n", "value": 31.5}');
  core.turn();
  while (core.state().time_s !== 0) core.turn(); // it restarts
  goOn(core, 1);
  const state = core.state();
  assert.deepEqual(state.set, { push_n: "31.5" });
  assert.equal(state.touched, false);
  assert.deepEqual(state.marks, [native(path, AT_S, "--set", "push_n=31.5")]);
});

test("WhoTouchesARunIsTold", options, () => {
  const touches = {
    drag: { type: "drag", node: "segment_0.apex", target_m: [0, 0, 2] },
    push: { type: "push", node: "segment_0.apex", force_n: [0, 0, 5], duration_s: 0.1 },
    parameter: { type: "set_parameter", name: "friction_scale", value: 0.5 },
    gain: { type: "set_gain", cable: "outer_top_1", gain: "position_gain_n_per_m", value: 80 },
  };
  const path = "experiments/push_20n.yaml";
  core.open(path, {}, [AT_S], true);
  core.turn();
  const scene = core.messages().find(({ type }) => type === "scene").scene;
  touches.drag.node = touches.push.node = scene.nodes[0].name;
  touches.gain.cable = scene.controls[0].cable;
  const untouched = native(path, AT_S).hash;
  for (const [what, message] of Object.entries(touches)) {
    core.open(path, {}, [AT_S], true);
    assert.equal(core.post(JSON.stringify(message)), "", what);
    core.turn();
    assert.equal(core.state().touched, true, what);
    goOn(core, 1);
    assert.notEqual(core.state().marks[0].hash, untouched, what);
    core.post('{"type": "reset"}');
    core.turn();
    while (core.state().time_s !== 0) core.turn();
    assert.equal(core.state().touched, false, `after ${what}`);
    goOn(core, 1);
    assert.equal(core.state().marks[0].hash, untouched, `after ${what}`);
  }
});

/** Errors by the file that contains them. */
const mistakes = {
  "an unknown key": ["models/prism3.yaml", (text) => `${text}\nradius: 3\n`],
  "no YAML": ["models/prism3.yaml", (text) => text.replace("nodes:", "nodes: [")],
  "a number that is a word": ["experiments/hang.yaml", (text) => text.replace(/duration_s: .*/, "duration_s: long")],
  "a negative length": ["experiments/hang.yaml", (text) => text.replace(/duration_s: .*/, "duration_s: -1")],
  "a number out of range": ["experiments/hang.yaml", (text) => text.replace(/duration_s: .*/, "duration_s: 1e999")],
  "a formula without an end": ["experiments/push_20n.yaml", (text) => text.replace(/duration_s: .*/, "duration_s: 2 * (3 + ")],
  "a model that is not there": ["experiments/push_20n.yaml", (text) => text.replace(/model: .*/, "model: ../models/tetraspin3.yaml")],
  "an empty file": ["experiments/push_20n.yaml", () => ""],
  "no text at all": ["experiments/push_20n.yaml", () => "\0\x01\xff"],
  "many at once": ["experiments/push_20n.yaml", (text) => text.replace(/duration_s: .*/, "duration_s: x\nseeed: 3").replace("name:", "nam:")],
  "two keys of one name": ["experiments/hang.yaml", (text) => `${text}\nduration_s: 3\n`],
  "another kind": ["experiments/hang.yaml", (text) => text.replace("kind: experiment", "kind: robot")],
};
for (const [what, [path, spoil]] of Object.entries(mistakes)) {
  test(`ComplaintsAreThoseOfTheCommand: ${what}`, options, () => {
    const text = spoil(shipped[path]);
    assert.notEqual(text, shipped[path]);
    put({ [path]: text });
    const run = spawnSync(TAUT, ["check", path], { cwd: folder, encoding: "utf8" });
    put({ [path]: shipped[path] });
    assert.equal(run.status, 3, run.stdout);
    const { good, found } = core.check(path, { [path]: text });
    const lines = found.map((each) => {
      const place = [each.file, ...[each.line, each.column].filter((part) => part > 0)].join(":");
      return `${place === "" ? "" : `${place}: `}${each.error ? "error" : "warning"}: ${each.what}${each.hint === "" ? "" : ` (${each.hint})`}`;
    });
    assert.equal(good, false);
    assert.deepEqual(lines, run.stderr.trimEnd().split("\n"));
  });
}

test("WhatABrowserHasNotIsRefusedWithAWayOut", options, () => {
  const path = "experiments/hills.yaml";
  const refused = {
    'file: "hills.png", height_range_m: [0, 1]': /^images of heights cannot be read in a browser$/,
    'file: "hills.h5:/z"': /^tables in HDF5 cannot be read in a browser$/,
  };
  for (const [from, what] of Object.entries(refused)) {
    const text = shipped[path].replace(/height_field:\n( {6}.*\n)+/, `height_field: {${from}, cell_m: 0.1}\n`);
    const { good, found } = core.check(path, { [path]: text, "experiments/hills.png": "x", "experiments/hills.h5": "x" });
    assert.equal(good, false);
    assert.ok(found.some((each) => what.test(each.what) && /the command-line program taut/.test(each.hint)), JSON.stringify(found));
  }
});

test("AWrongFileLeavesWhatRunsAndALookDisturbsNothing", options, () => {
  const path = "experiments/hang.yaml";
  runTo(core, path, [0.5]);
  const before = core.state();
  const wrong = { [path]: "taut: 1\n" };
  assert.equal(core.check(path, wrong).good, false);
  assert.equal(core.open(path, wrong, [], true).good, false);
  core.turn();
  assert.deepEqual(core.state(), before);
  // no error remains after a correction
  assert.equal(core.check(path, {}).good, true);
  assert.deepEqual(runTo(core, path, [0.5]).marks, [native(path, 0.5)]);
});

test("AModelAloneStandsUntilItIsPulled", options, () => {
  const opened = core.open("models/tetraspine3.yaml", {}, [], false);
  assert.equal(opened.kind, "model");
  assert.deepEqual(opened.files, ["models/tetraspine3.yaml"]);
  core.turn();
  const messages = core.messages();
  assert.equal(messages[0].type, "hello");
  assert.equal(messages[0].mode, "model");
  assert.equal(core.state().time_s, 0);
});

test("WhatIsNoMessageIsRefused", options, () => {
  for (const text of ["", "x", "{}", '{"type": "drag"}', '{"type": "set_parameter", "name": 3, "value": 1}']) {
    assert.notEqual(core.post(text), "", text);
  }
  core.open("experiments/hang.yaml", {}, [], true);
  core.turn();
  core.messages();
  core.post('{"type": "drag", "node": "nobody", "target_m": [0, 0, 0]}');
  core.turn();
  assert.ok(core.messages().some(({ type, text }) => type === "error" && /no node "nobody"/.test(text)));
});

// The goal of 450 kB is not reached (docs/browser.md); this test prevents growth.
test("ItIsNoLargerThanItWas", options, () => {
  const packed = ["taut_core.wasm", "taut_core.mjs"].map((name) => gzipSync(readFileSync(join(CORE, name)), { level: 9 }).length);
  assert.ok(packed[0] + packed[1] <= 640_000, `${packed} bytes, compressed`);
});
