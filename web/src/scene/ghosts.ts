// Robots of the compared runs: translucent, in the color of their run, with their pose at the displayed time.
import {
  BufferAttribute, BufferGeometry, Group, LineBasicMaterial, LineSegments, MeshLambertMaterial, Vector3,
} from "three";
import type { Theme } from "../app";
import type { Frame } from "../frame";
import { VALUES } from "../layout";
import type { Body, Cable, ComparedRun, Scene } from "../protocol";
import { runColourIn } from "../runs";
import { shapeMesh } from "./bodies";
import { type Part, release } from "./part";
import { layCable, pointCount } from "./cable_path";
import type { Poses } from "./poses";

const BODY_OPACITY = 0.4;
const CABLE_OPACITY = 0.7;

export class Ghosts implements Part {
  readonly object = new Group();
  /** Ghosts by run, from 0; empty for a run without poses. */
  readonly ghosts: readonly Ghost[];

  constructor(scene: Scene) {
    let from = 0;
    let cables = scene.cables.length;
    this.ghosts = scene.compared.map((run, k) => {
      const ghost = new Ghost(run, k + 1, from, cables);
      from += run.bodies.length;
      cables += run.cables.length;
      this.object.add(ghost.object);
      return ghost;
    });
  }

  update(frame: Frame): void {
    for (const ghost of this.ghosts) ghost.update(frame);
  }

  paint(theme: Theme): void {
    for (const ghost of this.ghosts) ghost.paint(theme);
  }

  dispose(): void {
    release(this.object);
  }
}

export class Ghost {
  readonly object = new Group();
  readonly bodies: readonly Body[];
  /** Whether the run has a row at the displayed time. */
  present = false;
  poses: Poses = { bodies: new Float64Array(0) };
  private wanted = true;
  private readonly groups: readonly Group[];
  private readonly skin = new MeshLambertMaterial({
    transparent: true, opacity: BODY_OPACITY, depthWrite: false,
    polygonOffset: true, polygonOffsetFactor: 4, polygonOffsetUnits: 4, // where both coincide, this run's robot is in front
  });
  private readonly thread = new LineBasicMaterial({ transparent: true, opacity: CABLE_OPACITY });
  private readonly lines: LineSegments<BufferGeometry, LineBasicMaterial>;
  private readonly cables: readonly Cable[];

  /** `from`, `from_cable`: the indices of its first body and cable in frames. */
  constructor(run: ComparedRun, private readonly number: number, private readonly from: number, private readonly from_cable: number) {
    this.bodies = run.bodies;
    this.cables = run.cables;
    this.groups = run.bodies.map((body) => {
      const group = new Group();
      for (const shape of body.shapes) group.add(shapeMesh(shape, this.skin));
      this.object.add(group);
      return group;
    });
    const parts = run.cables.reduce((sum, cable) => sum + Math.max(pointCount(cable) - 1, 0), 0);
    const geometry = new BufferGeometry().setAttribute("position", new BufferAttribute(new Float32Array(6 * parts), 3));
    this.lines = new LineSegments(geometry, this.thread);
    this.lines.frustumCulled = false; // its bounds are computed only at the start
    this.object.add(this.lines);
  }

  get shown(): boolean {
    return this.wanted;
  }

  set shown(wanted: boolean) {
    this.wanted = wanted;
    this.object.visible = this.wanted && this.present;
  }

  update(frame: Frame): void {
    const size = VALUES.ghosts;
    const bodies = frame.ghosts.subarray(this.from * size, (this.from + this.groups.length) * size);
    this.poses = { bodies };
    this.present = bodies.length > 0 && !Number.isNaN(bodies[0]!);
    this.shown = this.wanted;
    if (!this.present) return;
    this.groups.forEach((group, i) => {
      const b = bodies.subarray(i * size, (i + 1) * size);
      group.position.set(b[0]!, b[1]!, b[2]!);
      group.quaternion.set(b[4]!, b[5]!, b[6]!, b[3]!);
    });
    this.moveCables(frame);
  }

  paint(theme: Theme): void {
    this.skin.color.set(runColourIn(theme, this.number));
    this.thread.color.set(runColourIn(theme, this.number));
  }

  private moveCables(frame: Frame): void {
    const positions = this.lines.geometry.getAttribute("position") as BufferAttribute;
    let at = 0;
    this.cables.forEach((cable, i) => {
      if (cable.attachments.length < 2) return;
      const points = Array.from({ length: pointCount(cable) }, () => new Vector3());
      layCable(frame, this.poses, cable, this.from_cable + i, NaN, points); // frames lack the lengths of ghosts' cables
      points.forEach((point, k) => {
        if (k > 0) at = write(point, positions, at);
        if (k + 1 < points.length) at = write(point, positions, at);
      });
    });
    this.lines.geometry.setDrawRange(0, at);
    positions.needsUpdate = true;
  }
}

function write(point: Vector3, positions: BufferAttribute, at: number): number {
  positions.setXYZ(at, point.x, point.y, point.z);
  return at + 1;
}
