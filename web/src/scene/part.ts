// Interface of objects in the 3D view that follow the frames.
import type { Object3D } from "three";
import type { Theme } from "../app";
import type { Frame } from "../frame";

export interface Part {
  readonly object: Object3D;
  update(frame: Frame): void;
  paint(theme: Theme): void;
  dispose(): void;
}

/** Frees the graphics memory of an object and its children. */
export function release(object: Object3D): void {
  object.traverse((child) => {
    const owner = child as Object3D & { geometry?: { dispose(): void }; material?: unknown };
    owner.geometry?.dispose();
    const materials = Array.isArray(owner.material) ? owner.material : [owner.material];
    for (const material of materials) (material as { dispose?(): void } | undefined)?.dispose?.();
  });
  object.removeFromParent();
}
