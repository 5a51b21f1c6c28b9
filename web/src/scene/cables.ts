// Cables: lines whose thickness and color show the tension; slack ones are dashed and gray. Widths are in meters,
// relative to the thinnest strut, so that a cable never looks thicker than a strut at any distance.
import { Color, Group, type InstancedInterleavedBuffer, type PerspectiveCamera, Vector2, Vector3 } from "three";
import { Line2 } from "three/examples/jsm/lines/Line2.js";
import { LineGeometry } from "three/examples/jsm/lines/LineGeometry.js";
import { LineMaterial } from "three/examples/jsm/lines/LineMaterial.js";
import type { Theme } from "../app";
import { type ColourScale, palette, strainColour, tensionColour, useColour } from "../colours";
import { cableState, type Frame, isSlack } from "../frame";
import type { Cable, Scene } from "../protocol";
import { layCable, pointCount, spansOfParts, spanTensions } from "./cable_path";
import { type Part, release } from "./part";
import { thinnestStrut } from "./strut_width";

/** Widths of cables without tension and at the end of the scale, relative to the diameter of the thinnest strut. */
const THINNEST = 0.14;
const THICKEST = 0.5;
/** Limit of the width relative to a strut's diameter, if the minimum in pixels is larger. */
const MOST = 0.85;
const FLOOR_PX = 1.25;
const MARKED_PX = 2;

export class Cables implements Part {
  readonly object = new Group();
  /** Points of each cable in W, as last drawn. */
  readonly points: Vector3[][];
  scale_n = 1;
  /** Unstrained lengths of the cables. If set, colors show strain, relative to the largest. */
  strainFrom_m: readonly number[] | null = null;
  largestStrain = 0;
  /** Place of each cable on a color scale, shown instead of tension; NaN: none. null: tension. */
  shares: ArrayLike<number> | null = null;
  scale: ColourScale = useColour;
  private readonly lines: (Line2 | null)[];
  private strains: readonly number[] = [];
  private readonly diameter_m: number;
  private readonly widths_m: number[];
  private marked = -1;
  private theme: Theme = "light";
  private frame: Frame | null = null;

  constructor(private readonly scene: Scene, size_m: number) {
    this.points = scene.cables.map((cable) => Array.from({ length: pointCount(cable) }, () => new Vector3()));
    this.lines = scene.cables.map((cable) => this.line(cable, size_m));
    this.diameter_m = thinnestStrut(scene, size_m);
    this.widths_m = scene.cables.map(() => 0);
  }

  /** Returns the lengths of the drawn paths [m]. */
  lengths(): number[] {
    return this.points.map((points) => points.reduce((sum, point, k) => sum + (k > 0 ? point.distanceTo(points[k - 1]!) : 0), 0));
  }

  /** Converts the widths to pixels at the cables' distances from the camera. */
  seenFrom(camera: PerspectiveCamera, height_px: number): void {
    const focal_px = height_px / 2 / Math.tan((camera.fov * Math.PI) / 360);
    const ahead = camera.getWorldDirection(new Vector3());
    const middle = new Vector3();
    this.lines.forEach((line, i) => {
      const points = this.points[i]!;
      if (!line || points.length < 2) return;
      const depth_m = middle.copy(points[0]!).add(points[points.length - 1]!).multiplyScalar(0.5).sub(camera.position).dot(ahead);
      const px_per_m = focal_px / Math.max(depth_m, 1e-6);
      const wanted_px = Math.max(FLOOR_PX, this.widths_m[i]! * px_per_m);
      line.material.linewidth = Math.min(wanted_px, Math.max(MOST * this.diameter_m * px_per_m, 0.5)) + (i === this.marked ? MARKED_PX : 0);
    });
  }

  update(frame: Frame): void {
    this.frame = frame;
    this.scene.cables.forEach((cable, i) => {
      const line = this.lines[i];
      if (!line) return;
      const points = this.points[i]!;
      layCable(frame, frame, cable, i, cableState(frame, i).length_m, points);
      moveLine(line, points);
    });
    if (this.strainFrom_m) {
      this.strains = this.lengths().map((length_m, i) => length_m / this.strainFrom_m![i]! - 1);
      this.largestStrain = this.strains.reduce((most, strain) => (Math.abs(strain) > most ? Math.abs(strain) : most), this.largestStrain);
    }
    this.lines.forEach((_, i) => this.colour(i));
  }

  mark(cable: number): void {
    this.marked = cable;
    this.lines.forEach((_, i) => this.colour(i));
  }

  resize(width_px: number, height_px: number): void {
    for (const line of this.lines) line?.material.resolution.copy(new Vector2(width_px, height_px));
  }

  paint(theme: Theme): void {
    this.theme = theme;
    this.lines.forEach((_, i) => this.colour(i));
  }

  dispose(): void {
    release(this.object);
  }

  private colour(i: number): void {
    const line = this.lines[i];
    if (!line || !this.frame) return;
    const state = cableState(this.frame, i);
    const spans = spanTensions(this.frame, i);
    if (spans.length > 0) state.tension_n = Math.max(...spans);
    const share = this.share(state.tension_n);
    const slack = isSlack(state);
    const material = line.material;
    if (material.dashed !== slack) {
      material.dashed = slack;
      material.needsUpdate = true;
    }
    if (slack) line.computeLineDistances();
    this.widths_m[i] = this.diameter_m * (slack ? THINNEST : THINNEST + (THICKEST - THINNEST) * Math.min(Math.max(share, 0), 1));
    if (i === this.marked) {
      material.color.set(palette(this.theme).selected);
    } else if (this.strainFrom_m) {
      material.color.setRGB(...strainColour((this.strains[i] ?? 0) / (this.largestStrain || 1), this.theme), "srgb");
    } else if (slack || (this.shares && Number.isNaN(this.shares[i]))) {
      material.color.set(palette(this.theme).slack);
    } else if (this.shares) {
      material.color.setRGB(...this.scale(this.shares[i]!, this.theme), "srgb");
    } else {
      material.color.copy(this.tensionColour(share));
    }
    if (!this.scene.cables[i]!.parted) return;
    const one = material.color.clone();
    const plain = slack || this.shares !== null || i === this.marked || spans.length < 2;
    const colours = spans.map((tension_n) => (plain ? one : this.tensionColour(this.share(tension_n))));
    const points = this.points[i]!.length;
    paintParts(line, spansOfParts(this.scene.cables[i]!, points).map((span) => colours[span] ?? one));
    material.color.set("white"); // multiplied by the colors of the segments
  }

  private share(tension_n: number): number {
    return Number.isFinite(tension_n) ? tension_n / this.scale_n : 0;
  }

  private tensionColour(share: number): Color {
    return new Color().setRGB(...tensionColour(share, this.theme), "srgb");
  }

  private line(cable: Cable, size_m: number): Line2 | null {
    if (cable.attachments.length < 2) return null;
    const geometry = new LineGeometry();
    geometry.setPositions(new Float32Array(3 * pointCount(cable)));
    if (cable.parted) geometry.setColors(new Float32Array(3 * pointCount(cable)));
    const vertexColors = cable.parted === true;
    const material = new LineMaterial({ dashSize: 0.02 * size_m, gapSize: 0.015 * size_m, vertexColors, transparent: true });
    const line = new Line2(geometry, material);
    line.renderOrder = 1; // above coinciding cables of ghosts, which are transparent, too
    line.frustumCulled = false; // its bounds are computed only at the start
    this.object.add(line);
    return line;
  }
}

/** Sets a color for each straight segment. */
function paintParts(line: Line2, colours: readonly Color[]): void {
  const start = line.geometry.getAttribute("instanceColorStart") as unknown as { data: InstancedInterleavedBuffer };
  colours.forEach((colour, k) => {
    colour.toArray(start.data.array, 6 * k);
    colour.toArray(start.data.array, 6 * k + 3);
  });
  start.data.needsUpdate = true;
}

/** Writes into the line's buffer; setPositions would create a new one each frame. */
function moveLine(line: Line2, points: readonly Vector3[]): void {
  const start = line.geometry.getAttribute("instanceStart") as unknown as { data: InstancedInterleavedBuffer };
  const buffer = start.data;
  for (let k = 0; k + 1 < points.length; ++k) {
    points[k]!.toArray(buffer.array, 6 * k);
    points[k + 1]!.toArray(buffer.array, 6 * k + 3);
  }
  buffer.needsUpdate = true;
  line.geometry.instanceCount = points.length - 1; // the buffer may have space for more bends
}
