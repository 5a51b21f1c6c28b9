// Frame: state of the world at one time, from the server or a report. The layout is FRAME of layout.ts.
import { FRAME, VALUES } from "./layout";
import type { Scene } from "./protocol";

type Header = (typeof FRAME.header)[number];
type Section = (typeof FRAME.sections)[number]["name"];

export type Frame = Record<Header, number> & Record<Section, Float64Array>;

/** Decodes a frame; throws if there are too few or too many numbers. */
export function decodeFrame(values: Float64Array): Frame {
  const frame = {} as Frame;
  FRAME.header.forEach((name, place) => (frame[name] = values[place] ?? NaN));
  let place: number = FRAME.header.length;
  for (const section of FRAME.sections) {
    const count = frame[section.count];
    if (!Number.isInteger(count) || count < 0) throw new Error(`frame: ${section.count} is ${count}`);
    const end = place + count * section.fields.length;
    if (end > values.length) throw new Error(`frame: the section ${section.name} extends beyond the end of the frame`);
    frame[section.name] = values.subarray(place, end);
    place = end;
  }
  if (place !== values.length) throw new Error(`the frame has ${values.length - place} numbers too many`);
  return frame;
}

/** Returns the scene's initial state, displayed until the first frame arrives. */
export function frameOfScene(scene: Scene): Frame {
  const frame = {} as Frame;
  for (const name of FRAME.header) frame[name] = 0;
  frame.time_s = frame.now_s = scene.first_s;
  frame.paused = 1;
  frame.run = -1; // belongs to no run
  frame.kinetic_j = frame.gravity_j = frame.elastic_j = NaN;
  frame.body_count = scene.bodies.length;
  frame.cable_count = scene.cables.length;
  frame.value_count = scene.values.length;
  frame.bodies = new Float64Array(scene.bodies.flatMap((body) => [...body.position_m, ...body.orientation]));
  frame.cables = new Float64Array(scene.cables.length * VALUES.cables).fill(NaN);
  frame.contacts = new Float64Array(0);
  frame.pushes = new Float64Array(0);
  frame.values = new Float64Array(scene.values.length).fill(NaN);
  frame.ghost_count = scene.compared.reduce((sum, { bodies }) => sum + bodies.length, 0);
  frame.ghosts = new Float64Array(frame.ghost_count * VALUES.ghosts).fill(NaN);
  frame.bend_count = 0;
  frame.bends = new Float64Array(0);
  frame.span_count = 0;
  frame.spans = new Float64Array(0);
  return frame;
}

export interface CableState {
  tension_n: number;
  length_m: number;
  rest_length_m: number;
  setpoint_n: number;
}

export function cableState(frame: Frame, cable: number): CableState {
  const [tension_n, length_m, rest_length_m, setpoint_n] = frame.cables.subarray(
    cable * VALUES.cables,
    (cable + 1) * VALUES.cables,
  ) as unknown as [number, number, number, number];
  return { tension_n, length_m, rest_length_m, setpoint_n };
}

/** Returns whether a cable is slack: its tension is 0. A cable of unknown tension is not slack. */
export function isSlack(state: CableState): boolean {
  return state.tension_n <= 0;
}
