// Contact forces, and active pushes and drags, as arrows at one scale.
import { Group, Vector3 } from "three";
import type { Theme } from "../app";
import { palette } from "../colours";
import type { Frame } from "../frame";
import { VALUES } from "../layout";
import type { Scene } from "../protocol";
import { niceAbove } from "../util";
import { Arrows } from "./arrows";
import type { Part } from "./part";
import { worldPoint } from "./poses";

export class Forces implements Part {
  readonly object = new Group();
  readonly contacts: Arrows;
  readonly pushes: Arrows;
  /** The force whose arrow has the length `reference_m`; grows with the displayed forces. */
  reference_n = 10;
  readonly reference_m: number;
  private readonly point = new Vector3();
  private readonly force = new Vector3();

  constructor(private readonly scene: Scene, size_m: number) {
    this.reference_m = niceAbove(0.2 * size_m);
    this.contacts = new Arrows(0.005 * size_m);
    this.pushes = new Arrows(0.008 * size_m);
    this.object.add(this.contacts.object, this.pushes.object);
  }

  update(frame: Frame): void {
    this.fit(frame);
    const m_per_n = this.reference_m / this.reference_n;
    this.contacts.begin();
    for (let at = 0; at < frame.contacts.length; at += VALUES.contacts) {
      const [x, y, z, fx, fy, fz] = frame.contacts.subarray(at, at + VALUES.contacts);
      this.contacts.add(this.point.set(x!, y!, z!), this.force.set(fx!, fy!, fz!).multiplyScalar(m_per_n));
    }
    this.contacts.end();
    this.pushes.begin();
    for (let at = 0; at < frame.pushes.length; at += VALUES.pushes) {
      const [index, fx, fy, fz] = frame.pushes.subarray(at, at + VALUES.pushes);
      const node = this.scene.nodes[index!];
      if (!node) continue;
      worldPoint(frame, node.body, node.position_m, this.point);
      this.pushes.add(this.point, this.force.set(fx!, fy!, fz!).multiplyScalar(m_per_n), true);
    }
    this.pushes.end();
  }

  paint(theme: Theme): void {
    this.contacts.material.color.set(palette(theme).contact);
    this.pushes.material.color.set(palette(theme).push);
  }

  dispose(): void {
    this.contacts.dispose();
    this.pushes.dispose();
  }

  /** Updates the scale from pushes and steady contacts; an impact must not make all later arrows tiny. */
  private fit(frame: Frame): void {
    let largest_n = 0;
    for (let at = 0; at < frame.pushes.length; at += VALUES.pushes) {
      largest_n = Math.max(largest_n, Math.hypot(...frame.pushes.subarray(at + 1, at + VALUES.pushes)));
    }
    const mass_kg = this.scene.bodies.reduce((sum, body) => sum + (body.fixed ? 0 : body.mass_kg), 0);
    largest_n = Math.max(largest_n, 0.5 * 9.81 * mass_kg);
    if (largest_n > this.reference_n || this.reference_n > 20 * largest_n) this.reference_n = niceAbove(largest_n);
  }
}
