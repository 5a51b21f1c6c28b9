// Compression in the middle of struts, from the tensions of the cables at their ends (docs/theory/loads.md,
// eq. 4, without contacts and rotation).
import { Vector3 } from "three";
import { cableState, type Frame } from "../frame";
import type { Scene, Vec3 } from "../protocol";
import { bucklingLoad, rodOf } from "../report/limits";
import { worldPoint } from "./poses";

interface Strut {
  body: number;
  from_m: Vec3;
  to_m: Vec3;
}
/** A cable's attachment to a strut. */
interface Pull {
  strut: number;
  cable: number;
  attachment: number;
  /** 1: at the upper half of the strut, -1: at the lower. */
  side: 1 | -1;
}

export class Compression {
  /** Compression of each body [N]; NaN: not a strut, or the tensions are unknown. */
  readonly force_n: Float64Array;
  /** Euler's load of each body [N]; NaN: unknown. */
  readonly buckling_n: readonly number[];
  private readonly struts: readonly Strut[];
  private readonly pulls: readonly Pull[];

  constructor(private readonly scene: Scene) {
    this.force_n = new Float64Array(scene.bodies.length).fill(NaN);
    this.buckling_n = scene.bodies.map(bucklingLoad);
    this.struts = scene.bodies.flatMap((body, index) => {
      const rod = rodOf(body);
      return rod ? [{ body: index, from_m: rod.from_m!, to_m: rod.to_m! }] : [];
    });
    const strutOf = new Map(this.struts.map(({ body }, strut) => [body, strut]));
    this.pulls = scene.cables.flatMap(({ attachments }, cable) => attachments.flatMap(({ body, position_m }, attachment) => {
      const strut = strutOf.get(body);
      if (strut === undefined) return [];
      const { from_m, to_m } = this.struts[strut]!;
      const [from, to, at] = [from_m, to_m, position_m].map((p) => new Vector3(...p)) as [Vector3, Vector3, Vector3];
      const side = at.distanceTo(to) < at.distanceTo(from) ? 1 : -1;
      return [{ strut, cable, attachment, side } as Pull];
    }));
  }

  get hasStruts(): boolean {
    return this.pulls.length > 0;
  }

  update(frame: Frame): void {
    const axes = this.struts.map(({ body, from_m, to_m }) => {
      this.force_n[body] = 0;
      return worldPoint(frame, body, to_m, new Vector3()).sub(worldPoint(frame, body, from_m, new Vector3())).normalize();
    });
    const [at, next] = [new Vector3(), new Vector3()];
    const pulled = new Set<number>();
    for (const { strut, cable, attachment, side } of this.pulls) {
      const { body } = this.struts[strut]!;
      const { attachments } = this.scene.cables[cable]!;
      const { tension_n } = cableState(frame, cable);
      const place = attachments[attachment]!;
      worldPoint(frame, place.body, place.position_m, at);
      pulled.add(body);
      for (const neighbor of [attachments[attachment - 1], attachments[attachment + 1]]) {
        if (!neighbor || neighbor.body === body) continue;
        worldPoint(frame, neighbor.body, neighbor.position_m, next).sub(at).normalize();
        this.force_n[body]! -= 0.5 * side * tension_n * next.dot(axes[strut]!);
      }
    }
    for (const { body } of this.struts) if (!pulled.has(body)) this.force_n[body] = NaN;
  }
}
