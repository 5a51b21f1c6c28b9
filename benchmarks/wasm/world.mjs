// One world of MuJoCo in WebAssembly, driven as benchmarks/peers/mujoco.cpp drives the one that is built in.
import { setFlagsFromString } from "node:v8";
import load from "@mujoco/mujoco";

// V8 compiles at first quickly and later well, beside what is measured; so it compiles well at once.
setFlagsFromString("--no-liftoff");
// MuJoCo says on the console what its warnings count anyway; standard output is for results.
const mujoco = await load({ print: (text) => console.error(text), printErr: (text) => console.error(text) });
export const VERSION = mujoco.mj_versionString();

/** How far the bodies may end from those of the other MuJoCo [m]: rounding, in some 100 steps. */
const SAME_M = 1e-9;

/** In place of the numbers of contacts and constraints that MuJoCo 2 asks for: from them MuJoCo 3 works out
 * more than WebAssembly can address. What is not used is not touched. */
const ROOM = "<size memory='48M'/>";

export class World {
  /** `file`: what taut_bench --mjcf prints of a case. */
  constructor(file, mjcf = file.mjcf) {
    this.model = mujoco.MjModel.from_xml_string(mjcf.replace(/<size [^>]*>/, ROOM));
    if (!this.model) throw new Error(`MuJoCo ${VERSION} does not take the model`);
    this.model.opt.timestep = file.step_s;
    if (this.model.nhfielddata > 0) this.model.hfield_data.set(file.heights);
    this.data = new mujoco.MjData(this.model);
    mujoco.mj_resetDataKeyframe(this.model, this.data, 0);
    this.commands = file.rest_lengths_m;
    this.controlSteps = file.control_steps;
    this.tick = 0;
  }

  step(count) {
    const { model, data } = this;
    for (let i = 0; i < count; ++i) mujoco.mj_step(model, data);
  }

  /** The rest lengths of the next control period. */
  command() {
    // looked up each time: a view of this memory ends where that grows
    if (this.commands.length > 0) this.data.ctrl.set(this.commands[this.tick++ % this.commands.length]);
  }

  run(periods) {
    for (let i = 0; i < periods; ++i) {
      this.command();
      this.step(this.controlSteps);
    }
  }

  /** Ends with an error if a contact had no room or the state went wild since the start. */
  complain() {
    const warnings = this.data.warning; // the data's own: not to be deleted
    for (let kind = 0; kind < warnings.size(); ++kind) {
      const warning = warnings.get(kind);
      const { number, lastinfo } = warning;
      warning.delete();
      if (number > 0) throw new Error(mujoco.mju_warningText(kind, lastinfo));
    }
  }

  get contacts() {
    return this.data.ncon;
  }

  delete() {
    this.data.delete();
    this.model.delete();
  }
}

/** Sees that MuJoCo makes of a case what the other one does: bodies, masses, a motion without contacts.
 * Answers how far bodies end from there [m]; null if there is no other one. */
export function compare(file) {
  const { free } = file;
  const world = new World(file, free.mjcf);
  const real = new World(file);
  try {
    for (const { model } of [world, real]) {
      if (model.nbody !== file.bodies + 1 || model.nv !== 6 * file.bodies) {
        throw new Error(`${model.nbody} bodies with ${model.nv} speeds where ${file.bodies} and the world are free`);
      }
      free.masses_kg?.forEach((mass, body) => {
        const ours = model.body_mass[body + 1];
        if (Math.abs(ours - mass) > 1e-12 * mass) throw new Error(`body ${body} has ${ours} kg in place of ${mass} kg`);
      });
    }
    if (!free.positions_m) return null;
    world.run(free.steps / file.control_steps);
    world.complain();
    const { qpos } = world.data;
    const apart = Math.max(...free.positions_m.map((p, body) => Math.hypot(...p.map((x, k) => x - qpos[7 * body + k]))));
    if (!(apart <= SAME_M)) throw new Error(`after ${free.steps} steps without contacts a body is ${apart} m elsewhere`);
    return apart;
  } finally {
    world.delete();
    real.delete();
  }
}
