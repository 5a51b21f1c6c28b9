// Translucent structure in its described pose, with lines for cables and bars, shown with a mode or a displacement.
import { BufferGeometry, Group, LineBasicMaterial, LineSegments, MeshLambertMaterial, Vector3 } from "three";
import type { Theme } from "../app";
import { palette } from "../colours";
import { frameOfScene } from "../frame";
import type { Scene } from "../protocol";
import { shapeMesh } from "./bodies";
import { type Part, release } from "./part";
import { worldPoint } from "./poses";

const OPACITY = 0.22;
const LINE_OPACITY = 0.45;

export class RestForm implements Part {
  readonly object = new Group();
  private readonly skin = new MeshLambertMaterial({ transparent: true, opacity: OPACITY, depthWrite: false });
  private readonly ink = new LineBasicMaterial({ transparent: true, opacity: LINE_OPACITY, depthWrite: false });

  constructor(scene: Scene) {
    this.object.visible = false;
    for (const body of scene.bodies) {
      const group = new Group();
      for (const shape of body.shapes) group.add(shapeMesh(shape, this.skin));
      group.position.set(...body.position_m);
      const [w, x, y, z] = body.orientation;
      group.quaternion.set(x, y, z, w);
      this.object.add(group);
    }
    const lines = new LineSegments(new BufferGeometry().setFromPoints(axesOf(scene)), this.ink);
    lines.frustumCulled = false; // it may be empty
    this.object.add(lines);
  }

  update(): void {}

  paint(theme: Theme): void {
    for (const material of [this.skin, this.ink]) material.color.set(palette(theme).slack);
  }

  dispose(): void {
    release(this.object);
  }
}

/** Returns pairs of points: the straight parts of cables, and the bars. */
function axesOf(scene: Scene): Vector3[] {
  const frame = frameOfScene(scene);
  const point = (body: number, position_m: readonly number[]) => worldPoint(frame, body, position_m as [number, number, number], new Vector3());
  const cables = scene.cables.flatMap(({ attachments }) => attachments.slice(1).flatMap((to, k) => [attachments[k]!, to].map(({ body, position_m }) => point(body, position_m))));
  const bars = scene.joints.filter(({ kind }) => kind === "distance").flatMap(({ body_a, from_m, body_b, to_m }) => [point(body_a, from_m), point(body_b, to_m)]);
  return [...cables, ...bars];
}
