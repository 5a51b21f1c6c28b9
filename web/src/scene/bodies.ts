// Rigid bodies: rods, spheres, boxes and hulls; each body is a group with the pose of its frame.
import {
  AxesHelper, BoxGeometry, type BufferGeometry, CapsuleGeometry, Group, type Material, Mesh, MeshStandardMaterial, Quaternion, SphereGeometry, Vector3,
} from "three";
import { ConvexGeometry } from "three/examples/jsm/geometries/ConvexGeometry.js";
import type { Theme } from "../app";
import { type ColourScale, compressionColour, palette } from "../colours";
import type { Frame } from "../frame";
import { VALUES } from "../layout";
import type { Scene, Shape } from "../protocol";
import { type Part, release } from "./part";

const AXIS_Y = new Vector3(0, 1, 0);

export class Bodies implements Part {
  readonly object = new Group();
  readonly meshes: Mesh[] = [];
  private readonly groups: Group[];
  private readonly axes: AxesHelper[];
  /** Place of each rod on its color scale; NaN: none. */
  private shares: ArrayLike<number> = [];
  private scale: ColourScale = compressionColour;
  private marked = -1;
  private theme: Theme = "light";

  constructor(scene: Scene, size_m: number) {
    this.groups = scene.bodies.map((body, index) => {
      const group = new Group();
      for (const shape of body.shapes) group.add(this.mesh(shape, index));
      this.object.add(group);
      return group;
    });
    this.axes = this.groups.map((group) => {
      const axes = new AxesHelper(0.12 * size_m);
      axes.visible = false;
      group.add(axes);
      return axes;
    });
  }

  update(frame: Frame): void {
    this.groups.forEach((group, i) => {
      const b = frame.bodies.subarray(i * VALUES.bodies, (i + 1) * VALUES.bodies);
      group.position.set(b[0]!, b[1]!, b[2]!);
      group.quaternion.set(b[4]!, b[5]!, b[6]!, b[3]!);
    });
  }

  /** Shows a body's axes and highlights it; -1: none. */
  mark(body: number): void {
    this.marked = body;
    this.axes.forEach((axes, i) => (axes.visible = i === body));
    this.paint(this.theme);
  }

  paint(theme: Theme): void {
    this.theme = theme;
    const colours = palette(theme);
    for (const mesh of this.meshes) {
      const material = mesh.material as MeshStandardMaterial;
      const kind = mesh.userData["kind"] as Shape["kind"];
      const body = mesh.userData["body"] as number;
      const share = kind === "rod" ? this.shares[body] : undefined;
      if (body === this.marked) material.color.set(colours.selected);
      else if (share === undefined || Number.isNaN(share)) material.color.set(colours[kind]);
      else material.color.setRGB(...this.scale(share, theme), "srgb");
    }
  }

  /** Colors struts by their places on a color scale. */
  showShares(shares: ArrayLike<number>, scale: ColourScale): void {
    this.shares = shares;
    this.scale = scale;
    this.paint(this.theme);
  }

  dispose(): void {
    release(this.object);
  }

  private mesh(shape: Shape, body: number): Mesh {
    const material = new MeshStandardMaterial({ roughness: 0.55, metalness: 0.1 });
    const mesh = shapeMesh(shape, material);
    mesh.castShadow = true;
    mesh.receiveShadow = true;
    mesh.userData = { body, kind: shape.kind };
    this.meshes.push(mesh);
    return mesh;
  }
}

/** Returns the mesh of a shape in its body's frame. */
export function shapeMesh(shape: Shape, material: Material): Mesh {
  const mesh = new Mesh(geometryOf(shape), material);
  if (shape.kind === "rod") {
    const from = new Vector3(...shape.from_m!);
    const along = new Vector3(...shape.to_m!).sub(from);
    mesh.position.copy(from).addScaledVector(along, 0.5);
    if (along.length() > 0) mesh.quaternion.setFromUnitVectors(AXIS_Y, along.normalize());
  } else if (shape.center_m) {
    mesh.position.set(...shape.center_m);
    if (shape.orientation) {
      const [w, x, y, z] = shape.orientation;
      mesh.quaternion.copy(new Quaternion(x, y, z, w));
    }
  }
  return mesh;
}

function geometryOf(shape: Shape): BufferGeometry {
  switch (shape.kind) {
    case "rod": {
      const length_m = new Vector3(...shape.to_m!).distanceTo(new Vector3(...shape.from_m!));
      return new CapsuleGeometry(shape.radius_m!, length_m, 6, 14);
    }
    case "sphere":
      return new SphereGeometry(shape.radius_m!, 20, 14);
    case "box": {
      const [x, y, z] = shape.half_extents_m!;
      return new BoxGeometry(2 * x, 2 * y, 2 * z);
    }
    case "hull":
      return new ConvexGeometry(shape.corners_m!.map((p) => new Vector3(...p)));
  }
}
