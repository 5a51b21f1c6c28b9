// Utilization of struts: largest compression divided by the Euler load.
import type { Body, Scene, Shape } from "../protocol";

export interface StrutUse {
  name: string;
  axial_least_n?: number;
}

/** Returns the rod of a strut, a body with one rod; undefined for other bodies. */
export function rodOf(body: Body): Shape | undefined {
  const rods = body.shapes.filter(({ kind }) => kind === "rod");
  return rods.length === 1 ? rods[0] : undefined;
}

/** Returns Euler's load of a strut; NaN if unknown. */
export function bucklingLoad(body: Body): number {
  return rodOf(body)?.buckling_n ?? NaN;
}

/** Returns the strut with the largest compression relative to its Euler load; undefined: no load is known. */
export function largestUse(scene: Scene, struts: readonly StrutUse[]): { name: string; share: number } | undefined {
  const uses = struts.flatMap(({ name, axial_least_n }) => {
    const body = scene.bodies.find((each) => each.name === name);
    const share = body ? -(axial_least_n ?? NaN) / bucklingLoad(body) : NaN;
    return share > 0 ? [{ name, share }] : [];
  });
  return uses.sort((a, b) => b.share - a.share)[0];
}
