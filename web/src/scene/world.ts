// All objects of one scene in the 3D view; a new scene creates a new World.
import { Box3, Group, Vector3 } from "three";
import type { Theme } from "../app";
import { type ColourScale, compressionColour } from "../colours";
import { cableState, type Frame, frameOfScene } from "../frame";
import type { Scene } from "../protocol";
import { niceAbove } from "../util";
import { Bodies } from "./bodies";
import { spanTensions } from "./cable_path";
import { Cables } from "./cables";
import { Compression } from "./compression";
import { Forces } from "./forces";
import { Ghosts } from "./ghosts";
import { Joints } from "./joints";
import type { Part } from "./part";
import { Path } from "./path";
import { RestForm } from "./rest_form";
import { worldPoint } from "./poses";
import { Ground } from "./terrain";
import { Wheels } from "./wheels";

/** Places of members on a color scale; NaN: none. */
export interface MemberColours {
  cables: ArrayLike<number>;
  bodies: ArrayLike<number>;
  joints: ArrayLike<number>;
  scale: ColourScale;
  /** Heading of the scale in the legend. */
  title: string;
  /** Places of the ends of the scale, and the numbers below both ends and the middle. */
  ends: readonly [number, number];
  marks: readonly string[];
}

export class World {
  readonly object = new Group();
  readonly bodies: Bodies;
  readonly cables: Cables;
  readonly joints: Joints;
  readonly forces: Forces;
  readonly ghosts: Ghosts;
  readonly path: Path;
  private readonly rest: RestForm;
  readonly ground: Ground;
  readonly compression: Compression;
  /** Results of an analysis that colors show; null: tension and compression. */
  colours: MemberColours | null = null;
  /** End of the scale of compression [N] for struts without a known Euler load. */
  compressionScale_n = 0;
  /** Bounding box of the bodies at the start. */
  readonly bounds = new Box3();
  readonly size_m: number;
  private readonly parts: Part[];

  constructor(readonly scene: Scene) {
    this.bounds = boundsOf(scene);
    this.size_m = Math.max(this.bounds.getSize(new Vector3()).length(), 0.05);
    this.bodies = new Bodies(scene, this.size_m);
    this.compression = new Compression(scene);
    this.cables = new Cables(scene, this.size_m);
    this.joints = new Joints(scene, this.size_m);
    this.forces = new Forces(scene, this.size_m);
    this.ghosts = new Ghosts(scene);
    this.path = new Path(scene, this.size_m);
    this.rest = new RestForm(scene);
    this.ground = new Ground(scene, this.size_m);
    this.parts = [this.ground, this.bodies, new Wheels(scene), this.cables, this.joints, this.forces, this.path, this.ghosts, this.rest];
    this.object.add(...this.parts.map((part) => part.object));
    if (scene.shape && scene.shape.kind !== "self_stress") this.showShape(true);
  }

  /** Colors cables by strain from the described pose, which is shown as a ghost; or by tension. */
  showShape(on: boolean): void {
    this.cables.strainFrom_m = null;
    this.cables.largestStrain = 0;
    this.rest.object.visible = on;
    if (!on) return;
    this.cables.update(frameOfScene(this.scene));
    this.cables.strainFrom_m = this.cables.lengths();
    this.bodies.showShares([], compressionColour);
  }

  /** Shows the described pose, translucent. */
  showRest(on: boolean): void {
    this.rest.object.visible = on;
  }

  /** Colors members by results of an analysis instead of tension and compression. */
  showColours(colours: MemberColours): void {
    this.colours = colours;
    this.path.shown = false; // nothing travels
    this.cables.shares = colours.cables;
    this.cables.scale = colours.scale;
    this.joints.showShares(colours.joints, colours.scale);
    this.bodies.showShares(colours.bodies, colours.scale);
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
    if (this.compression.hasStruts && !this.cables.strainFrom_m && !this.colours) this.showCompression(frame);
  }

  /** Whether colors show compression as a share of Euler's load. */
  get usesBuckling(): boolean {
    const { buckling_n, force_n } = this.compression;
    return force_n.some((force, body) => !Number.isNaN(force) && buckling_n[body]! > 0);
  }

  private showCompression(frame: Frame): void {
    this.compression.update(frame);
    const { force_n, buckling_n } = this.compression;
    const { usesBuckling } = this;
    const most_n = force_n.reduce((most, force) => (force > most ? force : most), 0);
    this.compressionScale_n = niceAbove(Math.max(most_n, this.compressionScale_n));
    this.bodies.showShares(force_n.map((force, body) => (usesBuckling ? force / (buckling_n[body] ?? NaN) : force / this.compressionScale_n)), compressionColour);
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
