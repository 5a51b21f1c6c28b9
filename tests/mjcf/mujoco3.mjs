// Compares models exported by taut with MuJoCo 3 in WebAssembly. Standard input is the output of tests/mjcf/cases.cpp.
// Run by mujoco3_test.py, with the npm package of benchmarks/wasm.
import { readFileSync } from "node:fs";
import { pathToFileURL } from "node:url";

const { default: load } = await import(pathToFileURL(process.argv[2]).href);
const mujoco = await load({ print: (text) => console.error(text), printErr: (text) => console.error(text) });
const SAME = 1e-12;
const MOVED_M = 1e-4; // both with steps of 0.02 ms; integration error of free fall: g t h / 2 = 1e-5

function near(what, ours, theirs, size) {
  if (!(Math.abs(ours - theirs) <= SAME * size)) throw new Error(`${what}: ${theirs} in place of ${ours}`);
}

function worldOf(mjcf) {
  const model = mujoco.MjModel.from_xml_string(mjcf);
  if (!model) throw new Error("MuJoCo does not take it");
  const data = new mujoco.MjData(model);
  mujoco.mj_forward(model, data);
  return { model, data, done: () => (data.delete(), model.delete()) };
}

function tension(model, data, tendon) {
  let sum = 0;
  for (let a = 0; a < model.nu; ++a) if (model.actuator_trnid[2 * a] === tendon) sum -= data.actuator_force[a];
  return sum;
}

function bodies({ model, data }, one) {
  one.masses_kg.forEach((mass, b) => near(`mass ${b}`, mass, model.body_mass[b + 1], mass));
  one.inertias_kg_m2.forEach((want, b) => {
    const r = data.ximat.slice(9 * (b + 1), 9 * (b + 2));
    const j = model.body_inertia.slice(3 * (b + 1), 3 * (b + 2));
    const entry = (x, y) => [0, 1, 2].reduce((sum, a) => sum + r[3 * x + a] * j[a] * r[3 * y + a], 0);
    const have = [entry(0, 0), entry(1, 1), entry(2, 2), entry(0, 1), entry(0, 2), entry(1, 2)];
    have.forEach((x, i) => near(`inertia ${b} ${i}`, want[i], x, want[0] + want[1] + want[2]));
  });
}

for (const one of JSON.parse(readFileSync(0, "utf8"))) {
  try {
    const actuated = worldOf(one.mjcf);
    bodies(actuated, one);
    one.lengths_m.forEach((length, c) => {
      near(`length ${c}`, length, actuated.data.ten_length[c], 1);
      const { model, data } = actuated; // one actuator per cable, in the same order
      near(`tension ${c}`, one.tensions_n[c], tension(model, data, c), model.actuator_gainprm[10 * c]);
    });
    actuated.done();
    const sprung = worldOf(one.spring);
    bodies(sprung, one);
    one.tensions_n.forEach((want, c) => {
      const [k, l] = [sprung.model.tendon_stiffness[c], sprung.data.ten_length[c]];
      const [low, high] = sprung.model.tendon_lengthspring.slice(2 * c, 2 * c + 2);
      if (low !== 0) throw new Error(`cable ${c} pushes below ${low}`);
      near(`spring ${c}`, want, k * Math.max(0, l - high), k);
    });
    sprung.done();
    const free = worldOf(one.free);
    free.model.opt.timestep = one.step_s;
    for (let i = 0; i < one.steps; ++i) mujoco.mj_step(free.model, free.data);
    mujoco.mj_forward(free.model, free.data);
    const apart = Math.max(
      ...one.positions_m.map((p, b) => Math.hypot(...p.map((x, k) => x - free.data.xipos[3 * (b + 1) + k]))),
    );
    free.done();
    if (!(apart <= MOVED_M)) throw new Error(`after ${one.steps * one.step_s} s a body is ${apart} m elsewhere`);
    console.log(`${one.name}: ${apart.toExponential(1)} m apart after ${one.steps * one.step_s} s`);
  } catch (error) {
    console.error(`${one.name}: ${error.message ?? error}`);
    process.exitCode = 1;
  }
}
