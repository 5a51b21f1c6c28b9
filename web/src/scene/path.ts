// The path of the center of mass, and its mark on the ground below.
import { BufferAttribute, BufferGeometry, DynamicDrawUsage, Group, Line, LineBasicMaterial, Mesh, MeshBasicMaterial, SphereGeometry, Vector3 } from "three";
import type { Theme } from "../app";
import { palette } from "../colours";
import type { Frame } from "../frame";
import type { Scene } from "../protocol";
import { lastAtMost } from "../util";
import { type Part, release } from "./part";
import { centreOfMass } from "./poses";

const CAPACITY = 20_000;

export class Path implements Part {
  readonly object = new Group();
  private readonly times_s: number[] = [];
  readonly places: Vector3[] = [];
  private readonly line: Line<BufferGeometry, LineBasicMaterial>;
  private readonly dot: Mesh<SphereGeometry, MeshBasicMaterial>;
  private readonly now = new Vector3();
  private run = -1;

  constructor(private readonly scene: Scene, size_m: number) {
    const geometry = new BufferGeometry();
    const positions = new BufferAttribute(new Float32Array(3 * CAPACITY), 3).setUsage(DynamicDrawUsage);
    geometry.setAttribute("position", positions);
    this.line = new Line(geometry, new LineBasicMaterial({ depthTest: false, transparent: true }));
    this.line.frustumCulled = false;
    this.line.renderOrder = 2;
    this.dot = new Mesh(new SphereGeometry(0.012 * size_m, 16, 12), new MeshBasicMaterial({ depthTest: false, transparent: true }));
    this.dot.renderOrder = 2;
    this.object.add(this.line, this.dot);
  }

  /** Sets the whole path at once, if a trace contains it. */
  set(times_s: readonly number[], places: readonly Vector3[]): void {
    this.times_s.splice(0, Infinity, ...times_s.slice(0, CAPACITY));
    this.places.splice(0, Infinity, ...places.slice(0, CAPACITY));
    this.write(0);
  }

  update(frame: Frame): void {
    const known = centreOfMass(this.scene, frame, this.now);
    this.object.visible = known && this.shown;
    if (!known) return;
    if (frame.run !== this.run) {
      this.run = frame.run;
      this.set([], []);
    }
    this.dot.position.copy(this.now);
    const last_s = this.times_s[this.times_s.length - 1] ?? -Infinity;
    if (frame.time_s > last_s && this.times_s.length < CAPACITY) {
      this.times_s.push(frame.time_s);
      this.places.push(this.now.clone());
      this.write(this.times_s.length - 1);
    }
    this.line.geometry.setDrawRange(0, lastAtMost(this.times_s, frame.time_s) + 1);
  }

  shown = true;

  paint(theme: Theme): void {
    this.line.material.color.set(palette(theme).path);
    this.dot.material.color.set(palette(theme).path);
  }

  dispose(): void {
    release(this.object);
  }

  private write(from: number): void {
    const positions = this.line.geometry.getAttribute("position") as BufferAttribute;
    for (let i = from; i < this.places.length; ++i) this.places[i]!.toArray(positions.array, 3 * i);
    positions.needsUpdate = true;
  }
}
