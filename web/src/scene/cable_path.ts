// Path of a cable: over the bends in a frame, or around wheels by the shortest path (docs/theory/cables.md,
// section 4). The number of turns around a wheel follows from the cable's length.
import { Quaternion, Vector3 } from "three";
import type { Frame } from "../frame";
import { VALUES } from "../layout";
import type { Attachment, Cable, Wheel } from "../protocol";
import { type Poses, worldPoint } from "./poses";

/** Number of segments of a drawn arc. */
export const ARC_PARTS = 24;
const TURN = 2 * Math.PI;
const MOST_ROUNDS = 200;
/** Relative tolerance of the length. */
const SAME = 1e-9;

interface Laid {
  wheel: Wheel;
  center: Vector3;
  axis: Vector3;
  angle: number;
  theta: number;
  arrives: Vector3;
  leaves: Vector3;
}

/** Returns the number of points of a path, or its maximum. */
export function pointCount({ attachments, most_bends = 0 }: Cable): number {
  return attachments.reduce((sum, { wheel }) => sum + (wheel ? ARC_PARTS + 1 : 1), most_bends);
}

/**
 * Writes the path in W to `out`, which has pointCount() entries; a cable with bends uses as many as needed.
 * `number`: the cable's number among bends; `length_m`: its known length, or NaN.
 */
export function layCable(frame: Frame, poses: Poses, cable: Cable, number: number, length_m: number, out: Vector3[]): void {
  if (cable.most_bends === undefined) return layOnWheels(poses, cable.attachments, length_m, out);
  const ends = cable.attachments.map((at) => worldPoint(poses, at.body, at.position_m, new Vector3()));
  out.splice(0, out.length, ...ends.slice(0, 1), ...bendsOf(frame, number).slice(0, cable.most_bends), ...ends.slice(1));
}

/** Returns the bends of a wrapped cable, from its first end on. */
function bendsOf({ bends }: Frame, cable: number): Vector3[] {
  const places: Vector3[] = [];
  for (let at = 0; at < bends.length; at += VALUES.bends) {
    if (bends[at] === cable) places.push(new Vector3(bends[at + 1], bends[at + 2], bends[at + 3]));
  }
  return places;
}

/** Returns the tensions of a cable's spans, from its first end on; empty without friction [N]. */
export function spanTensions({ spans }: Frame, cable: number): number[] {
  const tensions: number[] = [];
  for (let at = 0; at < spans.length; at += VALUES.spans) if (spans[at] === cable) tensions.push(spans[at + 1]!);
  return tensions;
}

/** Returns, for each segment of a path with this number of points, the index of its span. */
export function spansOfParts(cable: Cable, points: number): number[] {
  if (cable.most_bends !== undefined) return Array.from({ length: points - 1 }, (_, k) => k);
  const parts: number[] = [];
  let span = 0;
  cable.attachments.forEach(({ wheel, parts: friction }, i) => {
    if (i > 0) parts.push(span);
    for (let k = 0; wheel && k < ARC_PARTS; ++k) parts.push(friction && k >= ARC_PARTS / 2 ? span + 1 : span);
    if (friction) ++span;
  });
  return parts;
}

function layOnWheels(poses: Poses, attachments: readonly Attachment[], length_m: number, out: readonly Vector3[]): void {
  const places = attachments.map((at) => worldPoint(poses, at.body, at.position_m, new Vector3()));
  const wheels = attachments.map((at, i) => (at.wheel ? laid(poses, at, places[i]!) : null));
  let length = lay(places, wheels);
  if (Number.isFinite(length_m)) length = agree(places, wheels, length, length_m);
  let at = 0;
  attachments.forEach((_, i) => {
    const wheel = wheels[i];
    if (!wheel) return void out[at++]!.copy(places[i]!);
    for (let k = 0; k <= ARC_PARTS; ++k) pointOnArc(wheel, k / ARC_PARTS, out[at++]!);
  });
}

function laid(poses: Poses, { body, position_m, wheel }: Attachment, center: Vector3): Laid {
  const [x, y, z] = position_m;
  const [ax, ay, az] = wheel!.axis;
  const axis = worldPoint(poses, body, [x + ax, y + ay, z + az], new Vector3()).sub(center).normalize();
  return { wheel: wheel!, center, axis, angle: wheel!.angle_rad, theta: 0, arrives: new Vector3(), leaves: new Vector3() };
}

/**
 * Computes the path around all wheels with their present angles, or angles that differ by whole turns.
 * Returns the length.
 */
function lay(places: readonly Vector3[], wheels: readonly (Laid | null)[]): number {
  const before = wheels.map((wheel) => wheel?.angle ?? 0);
  for (const wheel of wheels) if (wheel) wheel.theta = 0;
  for (let round = 0, moved = Infinity; round < MOST_ROUNDS && moved > 1e-12; ++round) {
    moved = 0;
    wheels.forEach((wheel, i) => {
      if (wheel) moved = Math.max(moved, layOn(wheel, before[i]!, next(places, wheels, i, -1), next(places, wheels, i, 1)));
    });
  }
  let length = 0;
  let from = places[0]!;
  wheels.forEach((wheel, i) => {
    if (i === 0) return;
    if (!wheel) {
      length += from.distanceTo(places[i]!);
      from = places[i]!;
    } else if (wheel.theta > 0) {
      const rise = wheel.leaves.clone().sub(wheel.arrives).dot(wheel.axis);
      length += from.distanceTo(wheel.arrives) + Math.hypot(wheel.wheel.radius_m * wheel.theta, rise);
      from = wheel.leaves;
    }
  });
  wheels.forEach((wheel, i) => {
    if (!wheel || wheel.theta > 0) return;
    const middle = next(places, wheels, i, -1).clone().add(next(places, wheels, i, 1)).multiplyScalar(0.5);
    wheel.arrives.copy(middle);
    wheel.leaves.copy(middle);
  });
  return length;
}

/** Returns the previous (-1) or next (1) point of the path, skipping wheels that the cable does not touch. */
function next(places: readonly Vector3[], wheels: readonly (Laid | null)[], i: number, way: -1 | 1): Vector3 {
  for (let k = i + way; ; k += way) {
    const wheel = wheels[k];
    if (!wheel) return places[k]!;
    if (wheel.theta > 0) return way < 0 ? wheel.leaves : wheel.arrives;
  }
}

/** Updates the tangent points at a wheel. Returns the change [m]. */
function layOn(on: Laid, before: number, p: Vector3, q: Vector3): number {
  const { center, axis } = on;
  const R = on.wheel.radius_m;
  const rp = p.clone().sub(center);
  const rq = q.clone().sub(center);
  const zp = rp.dot(axis);
  const zq = rq.dot(axis);
  rp.addScaledVector(axis, -zp);
  rq.addScaledVector(axis, -zq);
  const acrossP = axis.clone().cross(rp);
  const acrossQ = axis.clone().cross(rq);
  const principal = Math.atan2(acrossP.dot(rq), rp.dot(rq));
  on.angle = principal + TURN * Math.round((before - principal) / TURN);
  const lp = Math.sqrt(Math.max(rp.lengthSq() - R * R, 0));
  const lq = Math.sqrt(Math.max(rq.lengthSq() - R * R, 0));
  const was = on.theta;
  on.theta = Math.abs(on.angle) - Math.atan2(lp, R) - Math.atan2(lq, R);
  if (!(on.theta > 0)) return was > 0 ? Infinity : 0;
  const side = on.angle < 0 ? -1 : 1;
  const rise = (zq - zp) / (lp + R * on.theta + lq);
  const tangent = (r: Vector3, across: Vector3, l: number, z: number) =>
    center.clone().addScaledVector(axis, z).addScaledVector(r, (R * R) / r.lengthSq()).addScaledVector(across, (R * l) / r.lengthSq());
  const a = tangent(rp, acrossP, side * lp, zp + rise * lp);
  const b = tangent(rq, acrossQ, -side * lq, zq - rise * lq);
  const moved = was > 0 ? Math.max(a.distanceTo(on.arrives), b.distanceTo(on.leaves)) : Infinity;
  on.arrives.copy(a);
  on.leaves.copy(b);
  return moved;
}

/** Adds turns around the wheels, one wheel at a time, until the path has the given length. */
function agree(places: readonly Vector3[], wheels: readonly (Laid | null)[], length: number, said: number): number {
  const off = (l: number) => Math.abs(l - said);
  let best = length;
  for (const wheel of wheels) {
    if (!wheel || off(best) <= SAME * said) continue;
    const start = wheels.map((each) => each?.angle ?? 0);
    const turns = Math.max(Math.round(off(best) / (TURN * wheel.wheel.radius_m)), 1);
    const kept = { length: best, angles: start };
    for (const by of [-turns - 1, -turns, -turns + 1, turns - 1, turns, turns + 1]) {
      wheels.forEach((each, i) => {
        if (each) each.angle = start[i]! + (each === wheel ? TURN * by : 0);
      });
      const now = lay(places, wheels);
      if (off(now) < off(kept.length)) {
        kept.length = now;
        kept.angles = wheels.map((each) => each?.angle ?? 0);
      }
    }
    wheels.forEach((each, i) => {
      if (each) each.angle = kept.angles[i]!;
    });
    best = lay(places, wheels);
  }
  return best;
}

function pointOnArc(on: Laid, share: number, out: Vector3): void {
  out.copy(on.arrives);
  if (!(on.theta > 0)) return;
  const rise = on.leaves.clone().sub(on.arrives).dot(on.axis);
  const turned = new Quaternion().setFromAxisAngle(on.axis, (on.angle < 0 ? -1 : 1) * share * on.theta);
  out.sub(on.center).applyQuaternion(turned).add(on.center).addScaledVector(on.axis, share * rise);
}
