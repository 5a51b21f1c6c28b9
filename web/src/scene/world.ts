// All objects of one scene in the 3D view; a new scene creates a new World.
import { Box3, Group, Vector3 } from "three";
import type { Theme } from "../app";
import { cableState, type Frame, frameOfScene } from "../frame";
import type { Scene } from "../protocol";
import { niceAbove } from "../util";
import { Bodies } from "./bodies";
import { spanTensions } from "./cable_path";
import { Cables } from "./cables";
import { Forces } from "./forces";
import { Ghosts } from "./ghosts";
import { Joints } from "./joints";
import type { Part } from "./part";
import { Path } from "./path";
import { worldPoint } from "./poses";
import { Ground } from "./terrain";
import { Wheels } from "./wheels";

export class World {
  readonly object = new Group();
  readonly bodies: Bodies;
  readonly cables: Cables;
  readonly joints: Joints;
  readonly forces: Forces;
  readonly ghosts: Ghosts;
  readonly path: Path;
  readonly ground: Ground;
  /** Of the bodies at the start. */
  readonly bounds = new Box3();
  readonly size_m: number;
  private readonly parts: Part[];

  constructor(readonly scene: Scene) {
    this.bounds = boundsOf(scene);
    this.size_m = Math.max(this.bounds.getSize(new Vector3()).length(), 0.05);
    this.bodies = new Bodies(scene, this.size_m);
    this.cables = new Cables(scene, this.size_m);
    this.joints = new Joints(scene, this.size_m);
    this.forces = new Forces(scene, this.size_m);
    this.ghosts = new Ghosts(scene);
    this.path = new Path(scene, this.size_m);
    this.ground = new Ground(scene, this.size_m);
    this.parts = [this.ground, this.bodies, new Wheels(scene), this.cables, this.joints, this.forces, this.path, this.ghosts];
    this.object.add(...this.parts.map((part) => part.object));
  }

  update(frame: Frame): void {
    let largest_n = this.cables.scale_n;
    for (let i = 0; i < this.scene.cables.length; ++i) {
      for (const tension_n of [cableState(frame, i).tension_n, ...spanTensions(frame, i)]) {
        if (tension_n > largest_n) largest_n = tension_n;
      }
    }
    this.cables.scale_n = niceAbove(largest_n);
    for (const part of this.parts) part.update(frame);
  }

  paint(theme: Theme): void {
    for (const part of this.parts) part.paint(theme);
  }

  dispose(): void {
    for (const part of this.parts) part.dispose();
    this.object.removeFromParent();
  }
}

function boundsOf(scene: Scene): Box3 {
  const bounds = new Box3();
  const world = new Bodies(scene, 1);
  world.update(frameOfScene(scene));
  world.object.updateMatrixWorld(true);
  for (const mesh of world.meshes) bounds.expandByObject(mesh);
  world.dispose();
  const start = frameOfScene(scene);
  for (const node of scene.nodes) { // a body without shapes is located by its nodes
    if (node.body < 0 || scene.bodies[node.body]!.shapes.length > 0) continue;
    bounds.expandByPoint(worldPoint(start, node.body, node.position_m, new Vector3()));
  }
  for (const cable of scene.cables) {
    for (const end of cable.attachments) if (end.body < 0) bounds.expandByPoint(new Vector3(...end.position_m));
  }
  if (bounds.isEmpty()) bounds.set(new Vector3(-0.5, -0.5, 0), new Vector3(0.5, 0.5, 0.5));
  return bounds;
}
