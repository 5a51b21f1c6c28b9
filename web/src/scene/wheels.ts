// Wheels that guide cables: transparent flat discs, a little smaller than the radius of the cable's center
// line.
import { CylinderGeometry, DoubleSide, Group, Mesh, MeshLambertMaterial, Vector3 } from "three";
import type { Theme } from "../app";
import { palette } from "../colours";
import type { Frame } from "../frame";
import type { Attachment, Scene, Wheel } from "../protocol";
import { type Part, release } from "./part";
import { worldPoint } from "./poses";

const SHARE = 0.97;
const THICKNESS = 0.25; // thickness of a disc, relative to its radius
const Y = new Vector3(0, 1, 0); // axis of three.js's cylinders

export class Wheels implements Part {
  readonly object = new Group();
  private readonly discs: { at: Attachment; wheel: Wheel; mesh: Mesh }[] = [];
  private readonly skin = new MeshLambertMaterial({ transparent: true, opacity: 0.5, side: DoubleSide });
  private readonly center = new Vector3();
  private readonly tip = new Vector3();

  constructor(scene: Scene) {
    for (const at of scene.cables.flatMap(({ attachments }) => attachments)) {
      const wheel = at.wheel;
      if (!wheel) continue;
      const radius = SHARE * wheel.radius_m;
      const mesh = new Mesh(new CylinderGeometry(radius, radius, THICKNESS * radius, 48), this.skin);
      this.discs.push({ at, wheel, mesh });
      this.object.add(mesh);
    }
  }

  update(frame: Frame): void {
    for (const { at, wheel, mesh } of this.discs) {
      const [x, y, z] = at.position_m;
      worldPoint(frame, at.body, at.position_m, this.center);
      worldPoint(frame, at.body, [x + wheel.axis[0], y + wheel.axis[1], z + wheel.axis[2]], this.tip);
      mesh.position.copy(this.center);
      mesh.quaternion.setFromUnitVectors(Y, this.tip.sub(this.center).normalize());
    }
  }

  paint(theme: Theme): void {
    this.skin.color.set(palette(theme).slack);
  }

  dispose(): void {
    release(this.object);
  }
}
