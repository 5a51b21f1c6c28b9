// Translucent robot in its described pose, shown while a mode is animated.
import { Group, MeshLambertMaterial } from "three";
import type { Theme } from "../app";
import { palette } from "../colours";
import type { Scene } from "../protocol";
import { shapeMesh } from "./bodies";
import { type Part, release } from "./part";

const OPACITY = 0.22;

export class RestForm implements Part {
  readonly object = new Group();
  private readonly skin = new MeshLambertMaterial({ transparent: true, opacity: OPACITY, depthWrite: false });

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
  }

  update(): void {}

  paint(theme: Theme): void {
    this.skin.color.set(palette(theme).slack);
  }

  dispose(): void {
    release(this.object);
  }
}
