// Forces as arrows to scale: one draw call for all shafts, one for all heads.
import {
  ConeGeometry, CylinderGeometry, Group, InstancedMesh, Matrix4, MeshStandardMaterial, Quaternion, Vector3,
} from "three";
import { release } from "./part";

const CAPACITY = 512;
const AXIS_Y = new Vector3(0, 1, 0);

export class Arrows {
  readonly object = new Group();
  readonly material = new MeshStandardMaterial({ roughness: 0.6, depthTest: false, transparent: true });
  private readonly shafts: InstancedMesh;
  private readonly heads: InstancedMesh;
  private count = 0;
  private readonly matrix = new Matrix4();
  private readonly rotation = new Quaternion();
  private readonly along = new Vector3();
  private readonly place = new Vector3();
  private readonly stretch = new Vector3();

  constructor(private readonly radius_m: number) {
    const shaft = new CylinderGeometry(1, 1, 1, 12).translate(0, 0.5, 0);
    const head = new ConeGeometry(1, 1, 16).translate(0, 0.5, 0);
    this.shafts = new InstancedMesh(shaft, this.material, CAPACITY);
    this.heads = new InstancedMesh(head, this.material, CAPACITY);
    for (const mesh of [this.shafts, this.heads]) {
      mesh.frustumCulled = false;
      mesh.count = 0;
      mesh.renderOrder = 1; // in front of everything: points of application are often inside a body
      this.object.add(mesh);
    }
  }

  begin(): void {
    this.count = 0;
  }

  /** Adds an arrow that begins at `tail`, or that ends there if `ends` is set. */
  add(tail: Vector3, vector_m: Vector3, ends = false): void {
    const length_m = vector_m.length();
    if (!(length_m > 0) || this.count >= CAPACITY) return;
    this.along.copy(vector_m).divideScalar(length_m);
    this.rotation.setFromUnitVectors(AXIS_Y, this.along);
    this.place.copy(tail);
    if (ends) this.place.sub(vector_m);
    const head_m = Math.min(6 * this.radius_m, 0.5 * length_m);
    this.stretch.set(this.radius_m, length_m - head_m, this.radius_m);
    this.shafts.setMatrixAt(this.count, this.matrix.compose(this.place, this.rotation, this.stretch));
    this.place.addScaledVector(this.along, length_m - head_m);
    this.stretch.set(0.4 * head_m, head_m, 0.4 * head_m);
    this.heads.setMatrixAt(this.count, this.matrix.compose(this.place, this.rotation, this.stretch));
    ++this.count;
  }

  end(): void {
    for (const mesh of [this.shafts, this.heads]) {
      mesh.count = this.count;
      mesh.instanceMatrix.needsUpdate = true;
    }
  }

  dispose(): void {
    release(this.object);
  }
}
