// Types for the used part of gifenc, which contains no types.
declare module "gifenc" {
  export type GifPalette = number[][];
  export interface GifEncoder {
    writeFrame(indices: Uint8Array, width: number, height: number, options?: { palette?: GifPalette; delay?: number }): void;
    finish(): void;
    bytes(): Uint8Array<ArrayBuffer>;
  }
  export function GIFEncoder(): GifEncoder;
  export function quantize(rgba: Uint8ClampedArray, colours: number): GifPalette;
  export function applyPalette(rgba: Uint8ClampedArray, palette: GifPalette): Uint8Array;
}
