// Joints: a small mark for each kind, between the two connected points; supports have a foot. Distance joints (bars)
// are struts: tubes, with a line inside that remains visible at any distance.
import {
  BoxGeometry, BufferAttribute, BufferGeometry, Color, CylinderGeometry, Group, InstancedMesh, LatheGeometry, LineBasicMaterial,
  LineSegments, Matrix4, Mesh, MeshStandardMaterial, Quaternion, SphereGeometry, Vector2, Vector3,
} from "three";
import type { Theme } from "../app";
import { type ColourScale, palette, useColour } from "../colours";
import { type Frame, frameOfScene } from "../frame";
import { VALUES } from "../layout";
import type { Joint, Scene, Shape, Vec3 } from "../protocol";
import { type Part, release } from "./part";
import { worldPoint } from "./poses";
import { thinnestStrut } from "./strut_width";

const SHARE = 0.014; // radius of a mark, relative to the robot's size, unless a rod there is thicker
const BEYOND = 1.6; // how far a mark protrudes from its surroundings, as a factor
const LARGEST = 0.05; // limit for a mark in a box, relative to the robot's size
const AXIS_Y = new Vector3(0, 1, 0);

/** Parts of a mark. Lengths are in radii of the mark, y is the joint's axis. */
interface Look {
  /** Part that moves with body a, or spans from a's point to b's. */
  rail?: BufferGeometry;
  /** Length of the rail beyond the slide; absent: constant length. */
  over?: number;
  /** Part at b's point that turns with b; for a hinge or a ball, any orientation suffices. */
  bead?: BufferGeometry;
}

const LOOKS: Record<Joint["kind"], () => Look> = {
  ball: () => ({ bead: new SphereGeometry(1, 20, 14) }),
  hinge: () => ({ rail: new CylinderGeometry(0.75, 0.75, 3.2, 20) }),
  weld: () => ({ bead: new BoxGeometry(1.7, 1.7, 1.7) }),
  prismatic: () => ({ rail: new BoxGeometry(0.6, 1, 0.6), over: 6, bead: new BoxGeometry(1.5, 1.5, 1.5) }),
  cylindrical: () => ({ rail: new CylinderGeometry(0.4, 0.4, 1, 14), over: 6, bead: new CylinderGeometry(0.9, 0.9, 1.8, 20) }),
  line: () => ({ rail: new CylinderGeometry(0.25, 0.25, 1, 14), over: 6, bead: new SphereGeometry(1, 20, 14) }),
  planar: () => ({ rail: new BoxGeometry(6, 0.25, 6), bead: new BoxGeometry(1.5, 1.5, 1.5) }),
  plane: () => ({ rail: new CylinderGeometry(3.4, 3.4, 0.25, 28), bead: new SphereGeometry(1, 20, 14) }),
  distance: () => ({}),
};

/**
 * Returns a plate, visible even if the joint is on the ground, and a part that widens away from the body:
 * downward or upward.
 */
function footGeometry(hangs: boolean): BufferGeometry {
  const profile: [number, number][] = [[0, 0.15], [2.2, 0.15], [2.2, -0.15], [0.8, -0.15], [2, -3], [0, -3]];
  return new LatheGeometry(profile.map(([r, z]) => new Vector2(r, z)).reverse(), 24).rotateX(hangs ? -Math.PI / 2 : Math.PI / 2);
}

export class Joints implements Part {
  readonly object = new Group();
  /** Marks by joint; a distance joint has none. */
  readonly marks: readonly Mark[];
  /** Meshes that the mouse can hit. */
  readonly meshes: Mesh[];
  /** The points of each joint in W, as last drawn. */
  readonly points: readonly [Vector3, Vector3][];
  /** Indices of the distance joints. */
  readonly distances: readonly number[];
  /** A tube of diameter and length 1 m for each distance joint. */
  readonly tubes: InstancedMesh<CylinderGeometry, MeshStandardMaterial>;
  private readonly diameter_m: number;
  private readonly lines: LineSegments<BufferGeometry, LineBasicMaterial>;
  private marked = -1;
  /** Place of each bar on its color scale; NaN: none. */
  private shares: ArrayLike<number> = [];
  private scale: ColourScale = useColour;
  private theme: Theme = "light";

  constructor(private readonly scene: Scene, size_m: number) {
    this.points = scene.joints.map(() => [new Vector3(), new Vector3()]);
    this.marks = scene.joints.map((joint, i) => new Mark(joint, i, radiusOf(joint, scene, size_m), hangs(joint, scene)));
    for (const { object } of this.marks) this.object.add(object);
    this.meshes = this.marks.flatMap(({ meshes }) => meshes);
    this.distances = scene.joints.flatMap(({ kind }, i) => (kind === "distance" ? [i] : []));
    const geometry = new BufferGeometry().setAttribute("position", new BufferAttribute(new Float32Array(6 * this.distances.length), 3));
    this.lines = new LineSegments(geometry, new LineBasicMaterial());
    this.lines.frustumCulled = false; // its bounds are computed only at the start
    this.lines.visible = this.distances.length > 0;
    this.object.add(this.lines);
    this.diameter_m = thinnestStrut(scene, size_m);
    this.tubes = new InstancedMesh(new CylinderGeometry(0.5, 0.5, 1, 12), new MeshStandardMaterial({ roughness: 0.5, metalness: 0 }), this.distances.length);
    this.tubes.castShadow = true;
    this.tubes.frustumCulled = false;
    this.tubes.visible = this.distances.length > 0;
    this.object.add(this.tubes);
  }

  update(frame: Frame): void {
    this.scene.joints.forEach((joint, i) => {
      const [a, b] = this.points[i]!;
      worldPoint(frame, joint.body_a, joint.from_m, a);
      worldPoint(frame, joint.body_b, joint.to_m, b);
      this.marks[i]!.move(a, b, turnOf(frame, joint.body_a), turnOf(frame, joint.body_b));
    });
    const positions = this.lines.geometry.getAttribute("position") as BufferAttribute;
    this.distances.forEach((joint, k) => this.points[joint]!.forEach((point, end) => point.toArray(positions.array, 6 * k + 3 * end)));
    positions.needsUpdate = true;
    const [along, turn, size, place] = [new Vector3(), new Quaternion(), new Vector3(), new Matrix4()];
    this.distances.forEach((joint, k) => {
      const [a, b] = this.points[joint]!;
      const length_m = along.copy(b).sub(a).length();
      turn.setFromUnitVectors(AXIS_Y, length_m > 0 ? along.divideScalar(length_m) : AXIS_Y);
      size.set(this.diameter_m, length_m, this.diameter_m);
      this.tubes.setMatrixAt(k, place.compose(along.copy(a).add(b).multiplyScalar(0.5), turn, size));
    });
    this.tubes.instanceMatrix.needsUpdate = true;
  }

  /** Colors bars by their places on a color scale. */
  showShares(shares: ArrayLike<number>, scale: ColourScale): void {
    this.shares = shares;
    this.scale = scale;
    this.paint(this.theme);
  }

  /** Highlights a joint; -1: none. */
  mark(joint: number): void {
    this.marked = joint;
    this.paint(this.theme);
  }

  paint(theme: Theme): void {
    this.theme = theme;
    const { joint, selected, box, rod } = palette(theme);
    this.marks.forEach(({ material, ground }, i) => {
      material.color.set(i === this.marked ? selected : joint);
      ground.color.set(i === this.marked ? selected : box);
    });
    this.lines.material.color.set(this.distances.includes(this.marked) ? selected : rod);
    this.distances.forEach((index, k) => {
      const share = this.shares[index] ?? NaN;
      const plain = index === this.marked || Number.isNaN(share);
      this.tubes.setColorAt(k, plain ? new Color(index === this.marked ? selected : rod) : new Color().setRGB(...this.scale(share, theme), "srgb"));
    });
    if (this.tubes.instanceColor) this.tubes.instanceColor.needsUpdate = true;
  }

  dispose(): void {
    release(this.object);
  }
}

/** The mark of one joint. */
export class Mark {
  readonly object = new Group();
  readonly material = new MeshStandardMaterial({ roughness: 0.5, metalness: 0 });
  readonly ground = new MeshStandardMaterial({ roughness: 0.9, flatShading: true });
  readonly meshes: Mesh[] = [];
  readonly rail: Mesh | null;
  readonly bead: Mesh | null;
  /** Foot of a support. */
  readonly foot: Mesh | null;
  private readonly over: number | undefined;
  /** Rotation from y to the axis, in a's frame. */
  private readonly along: Quaternion;
  private readonly axis = new Vector3();

  constructor(joint: Joint, index: number, private readonly radius_m: number, hangs: boolean) {
    const { rail, over, bead } = LOOKS[joint.kind]();
    const mesh = (geometry: BufferGeometry | undefined, material = this.material) => {
      if (!geometry) return null;
      const made = new Mesh(geometry, material);
      made.castShadow = true;
      made.userData["joint"] = index;
      this.meshes.push(made);
      this.object.add(made);
      return made;
    };
    this.along = new Quaternion().setFromUnitVectors(AXIS_Y, new Vector3(...joint.axis).normalize());
    this.over = over;
    this.rail = mesh(rail);
    this.bead = mesh(bead);
    this.foot = mesh(joint.body_a < 0 ? footGeometry(hangs) : undefined, this.ground);
  }

  /** Sets the points and rotations of the two bodies. */
  move(a: Vector3, b: Vector3, turn_a: Quaternion, turn_b: Quaternion): void {
    const r = this.radius_m;
    if (this.rail) {
      this.rail.quaternion.multiplyQuaternions(turn_a, this.along);
      this.rail.position.copy(a);
      this.rail.scale.setScalar(r);
      if (this.over !== undefined) {
        this.axis.copy(AXIS_Y).applyQuaternion(this.rail.quaternion);
        const slide_m = this.axis.dot(b) - this.axis.dot(a);
        this.rail.position.addScaledVector(this.axis, 0.5 * slide_m);
        this.rail.scale.y = Math.abs(slide_m) + this.over * r;
      }
    }
    if (this.bead) {
      this.bead.quaternion.multiplyQuaternions(turn_b, this.along);
      this.bead.position.copy(b);
      this.bead.scale.setScalar(r);
    }
    this.foot?.position.copy(a);
    this.foot?.scale.setScalar(r);
  }
}

function turnOf(frame: Frame, body: number): Quaternion {
  if (body < 0) return new Quaternion();
  const [w, x, y, z] = frame.bodies.subarray(body * VALUES.bodies + 3, (body + 1) * VALUES.bodies);
  return new Quaternion(x, y, z, w);
}

/** Returns whether the body is below the support at the start. */
function hangs({ body_b, to_m }: Joint, scene: Scene): boolean {
  return worldPoint(frameOfScene(scene), body_b, to_m, new Vector3()).z > (scene.bodies[body_b]?.position_m[2] ?? 0);
}

/** Returns a radius large enough to protrude from the surrounding shapes. */
function radiusOf(joint: Joint, scene: Scene, size_m: number): number {
  let radius_m = SHARE * size_m;
  for (const [body, point_m] of [[joint.body_a, joint.from_m], [joint.body_b, joint.to_m]] as const) {
    for (const shape of scene.bodies[body]?.shapes ?? []) {
      const around_m = thicknessAround(shape, point_m);
      radius_m = Math.max(radius_m, BEYOND * (shape.kind === "box" ? Math.min(around_m, LARGEST * size_m) : around_m));
    }
  }
  return radius_m;
}

/** Returns half the thickness of a shape that contains a point of its body; 0 outside of it. */
function thicknessAround(shape: Shape, point_m: Vec3): number {
  const point = new Vector3(...point_m);
  if (shape.kind === "rod") {
    const from = new Vector3(...shape.from_m!);
    const along = new Vector3(...shape.to_m!).sub(from);
    const part = along.lengthSq() > 0 ? point.clone().sub(from).dot(along) / along.lengthSq() : 0;
    const away_m = from.addScaledVector(along, Math.min(Math.max(part, 0), 1)).distanceTo(point);
    return away_m <= shape.radius_m! ? shape.radius_m! : 0;
  }
  point.sub(new Vector3(...shape.center_m!));
  if (shape.kind === "sphere") return point.length() <= shape.radius_m! ? shape.radius_m! : 0;
  const [w, x, y, z] = shape.orientation ?? [1, 0, 0, 0];
  point.applyQuaternion(new Quaternion(x, y, z, w).invert());
  const half = shape.half_extents_m!;
  return point.toArray().every((value, k) => Math.abs(value) <= half[k]!) ? Math.min(...half) : 0;
}
