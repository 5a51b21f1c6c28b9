// MuJoCo in WebAssembly, one thread, on what taut_bench --mjcf and taut_contact_bench --mjcf print: reads
// one of these from standard input and answers in the form in which that program measures.
//
//   node measure.mjs rates REPETITIONS SECONDS    steps a second, as Google Benchmark's list
//   node measure.mjs steps SECONDS                each step of contact-rich scenes
import { readFileSync } from "node:fs";
import { compare, VERSION, World } from "./world.mjs";

/** Processor's time of this process [s]: what others do does not count; threads that compile do. */
function processorTime() {
  const { user, system } = process.cpuUsage();
  return 1e-6 * (user + system);
}

/** What a reading of the clock adds to what lies between two of them [us]. */
function readingCost() {
  let least = Infinity;
  for (let i = 0; i < 10000; ++i) {
    const before = performance.now();
    const took = performance.now() - before;
    least = Math.min(least, took);
  }
  return 1e3 * least;
}

/** Steps a second of the processor's time, over at least so many seconds. */
function rate(world, seconds) {
  let periods = 0;
  let chunk = 1;
  let spent = 0;
  for (const start = processorTime(); spent < seconds; ) {
    const before = spent;
    world.run(chunk);
    periods += chunk;
    spent = processorTime() - start;
    if (spent - before < 0.005) chunk *= 2; // asking for the time costs something, too
  }
  world.complain();
  return (periods * world.controlSteps) / spent;
}

function shuffled(list) {
  const keyed = list.map((item) => ({ item, key: Math.random() }));
  return keyed.sort((a, b) => a.key - b.key).map(({ item }) => item);
}

function rates(cases, repetitions, seconds) {
  const standing = cases.map(({ name, settle_periods, file }) => {
    const apart = compare(file);
    const world = new World(file);
    world.run(settle_periods);
    const { contacts } = world; // now: later ones depend on how far it comes, which is for the clock to say
    rate(world, seconds); // by then its code has been compiled for good
    return { name, world, apart, contacts };
  });
  const list = [];
  for (let i = 0; i < repetitions; ++i) {
    for (const { name, world, apart, contacts } of shuffled(standing)) {
      const one = { name, run_name: name, run_type: "iteration", steps_per_s: rate(world, seconds) };
      list.push({ ...one, contacts, apart_m: apart });
    }
  }
  return list;
}

/** Each step, by the wall's clock, as node has no other as fine, until so many seconds of the processor's
 * time are spent. */
function timed(world, most, seconds, cost) {
  const times = [];
  let spent = 0;
  const start = processorTime();
  // where others work, too, less of the processor's time is spent by then, and there is some left
  const left = () => spent < 1e6 * seconds || (spent = 1e6 * (processorTime() - start)) < 1e6 * seconds;
  for (let i = 0; i < most && left(); ++i) {
    const before = performance.now();
    world.step(1);
    const took = Math.max(0, 1e3 * (performance.now() - before) - cost);
    spent += took;
    times.push(took);
    if (i % world.controlSteps === 0) world.command();
  }
  return summary(times, (1e6 * (processorTime() - start)) / times.length - cost);
}

/** The mean is by the processor's time where that is less: what others do here is not the engine's. */
function summary(times, processor_us) {
  const sorted = Float64Array.from(times).sort();
  const quantile = (share) => sorted[Math.min(sorted.length - 1, Math.floor(share * sorted.length))];
  const wall_us = times.reduce((sum, time) => sum + time, 0) / times.length;
  return {
    steps: times.length,
    time_us: {
      mean: Math.min(wall_us, processor_us), median: quantile(0.5), p99: quantile(0.99), p999: quantile(0.999),
      worst: sorted.at(-1),
    },
  };
}

function steps({ context, runs }, seconds) {
  const cost = readingCost();
  const found = runs.map(({ file, ...about }) => {
    try {
      const apart_m = compare(file);
      const before = new World(file);
      timed(before, about.planned_steps, Math.min(0.3, seconds), cost); // by then its code has been compiled
      before.delete();
      const world = new World(file);
      const summed = timed(world, about.planned_steps, seconds, cost);
      world.complain();
      world.delete();
      return { ...about, ...summed, apart_m };
    } catch (error) {
      return { ...about, error: error.message };
    }
  });
  return { context, runs: found };
}

const [kind, ...numbers] = process.argv.slice(2);
try {
  const found = { rates, steps }[kind](JSON.parse(readFileSync(0, "utf8")), ...numbers.map(Number));
  console.log(JSON.stringify({ version: VERSION, found }));
} catch (error) {
  console.error(error.message);
  process.exitCode = 1;
}
