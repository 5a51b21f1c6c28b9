// Something in the 3-D view that follows the frames.
import type { Object3D } from "three";
import type { Theme } from "../app";
import type { Frame } from "../frame";

export interface Part {
  readonly object: Object3D;
  update(frame: Frame): void;
  paint(theme: Theme): void;
  dispose(): void;
}

/** Frees what the graphics card holds for an object and its children. */
export function release(object: Object3D): void {
  object.traverse((child) => {
    const owner = child as Object3D & { geometry?: { dispose(): void }; material?: unknown };
    owner.geometry?.dispose();
    const materials = Array.isArray(owner.material) ? owner.material : [owner.material];
    for (const material of materials) (material as { dispose?(): void } | undefined)?.dispose?.();
  });
  object.removeFromParent();
}
