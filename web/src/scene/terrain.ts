// Terrain: planes with a grid in meters, boxes, triangles, and the axes of the world.
import {
  BoxGeometry, BufferAttribute, BufferGeometry, CanvasTexture, Color, DoubleSide, EdgesGeometry, Group, LineBasicMaterial, LineSegments, Mesh,
  MeshStandardMaterial, Plane, PlaneGeometry, Quaternion, Sprite, SpriteMaterial, Vector3,
} from "three";
import type { Theme } from "../app";
import { palette } from "../colours";
import type { Frame } from "../frame";
import type { Scene } from "../protocol";
import { type Part, release } from "./part";

const EXTENT_M = 60; // half size of a plane
const LABELS = 3; // number of labels along either axis, in each direction
const SEEN_THROUGH = 0.35; // opacity of a floor that hides the robot: its lines still show its position

export class Ground implements Part {
  readonly object = new Group();
  /** Distance of the fine lines; every tenth is bold. */
  readonly spacing_m: number;
  private readonly planes: { material: MeshStandardMaterial; uniforms: GridUniforms; surface: Plane }[] = [];
  private readonly boxes: MeshStandardMaterial[] = [];
  private readonly edges: LineBasicMaterial[] = [];
  private readonly labels = new Group();

  constructor(scene: Scene, private readonly size_m: number) {
    this.spacing_m = size_m > 20 ? 1 : size_m < 0.15 ? 0.01 : 0.1;
    for (const terrain of scene.terrain) {
      if (terrain.kind === "plane") this.addPlane(new Vector3(...terrain.normal!), new Vector3(...terrain.point_m!));
      else if (terrain.kind === "surface") this.addSurface(terrain.corners_m! as number[], terrain.triangles!);
      else this.addBox(terrain.center_m!, terrain.half_extents_m!, terrain.orientation ?? [1, 0, 0, 0]);
    }
    this.object.add(this.labels);
  }

  update(_frame: Frame): void {}

  /** Makes the floor transparent for a camera below it. */
  seenFrom(eye: Vector3): void {
    for (const { material, surface } of this.planes) {
      const below = surface.distanceToPoint(eye) < 0;
      if (material.transparent === below) continue;
      material.transparent = below;
      material.opacity = below ? SEEN_THROUGH : 1;
      material.depthWrite = !below;
      material.needsUpdate = true;
    }
  }

  paint(theme: Theme): void {
    const colours = palette(theme);
    for (const { material, uniforms } of this.planes) {
      material.color.set(colours.ground);
      uniforms.minorColour.value.set(colours.gridMinor);
      uniforms.majorColour.value.set(colours.gridMajor);
      uniforms.farColour.value.set(colours.horizon);
    }
    for (const material of this.boxes) material.color.set(colours.box);
    for (const material of this.edges) material.color.set(colours.gridMajor);
    this.label(colours.text);
  }

  dispose(): void {
    release(this.object);
  }

  private addPlane(normal: Vector3, point: Vector3): void {
    const material = new MeshStandardMaterial({ roughness: 0.95, metalness: 0, side: DoubleSide });
    const uniforms = drawGrid(material, this.spacing_m, 6 * this.size_m + 4);
    const mesh = new Mesh(new PlaneGeometry(2 * EXTENT_M, 2 * EXTENT_M), material);
    mesh.quaternion.setFromUnitVectors(new Vector3(0, 0, 1), normal);
    mesh.position.copy(point);
    mesh.receiveShadow = true;
    this.planes.push({ material, uniforms, surface: new Plane().setFromNormalAndCoplanarPoint(normal, point) });
    this.object.add(mesh);
  }

  private addSurface(corners: number[], triangles: number[]): void {
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(new Float32Array(corners), 3));
    geometry.setIndex(triangles);
    geometry.computeVertexNormals();
    const material = new MeshStandardMaterial({ roughness: 0.95, flatShading: true, side: DoubleSide });
    const mesh = new Mesh(geometry, material);
    mesh.receiveShadow = true;
    this.boxes.push(material);
    this.object.add(mesh);
  }

  private addBox(center: number[], half: number[], [w, x, y, z]: number[]): void {
    const geometry = new BoxGeometry(2 * half[0]!, 2 * half[1]!, 2 * half[2]!);
    const material = new MeshStandardMaterial({ roughness: 0.9 });
    const line = new LineBasicMaterial();
    const mesh = new Mesh(geometry, material);
    mesh.add(new LineSegments(new EdgesGeometry(geometry), line));
    mesh.position.set(center[0]!, center[1]!, center[2]!);
    mesh.quaternion.copy(new Quaternion(x!, y!, z!, w!));
    mesh.castShadow = mesh.receiveShadow = true;
    this.boxes.push(material);
    this.edges.push(line);
    this.object.add(mesh);
  }

  /** Labels the bold lines with meters along x and y. */
  private label(colour: string): void {
    for (const child of [...this.labels.children]) release(child);
    if (this.planes.length === 0) return;
    const step_m = 10 * this.spacing_m;
    const height_m = 0.35 * this.spacing_m * Math.max(1, this.size_m);
    for (let i = -LABELS; i <= LABELS; ++i) {
      const text = `${+(i * step_m).toFixed(3)}`;
      const offset_m = 0.5 * this.spacing_m;
      this.labels.add(sprite(i === 0 ? "0" : `${text} m`, colour, height_m, [i * step_m, -offset_m, 0.01]));
      if (i !== 0) this.labels.add(sprite(`${text} m`, colour, height_m, [-offset_m, i * step_m, 0.01]));
    }
  }
}

interface GridUniforms {
  spacing: { value: number };
  reach: { value: number };
  minorColour: { value: Color };
  majorColour: { value: Color };
  farColour: { value: Color };
}

/** Draws lines at multiples of the spacing, one pixel wide at any distance, that fade far away. */
function drawGrid(material: MeshStandardMaterial, spacing_m: number, reach_m: number): GridUniforms {
  const uniforms: GridUniforms = {
    spacing: { value: spacing_m }, reach: { value: reach_m },
    minorColour: { value: new Color() }, majorColour: { value: new Color() }, farColour: { value: new Color() },
  };
  material.onBeforeCompile = (shader) => {
    Object.assign(shader.uniforms, uniforms);
    shader.vertexShader = shader.vertexShader
      .replace("#include <common>", "#include <common>\nvarying vec2 gridPoint;")
      .replace("#include <begin_vertex>", "#include <begin_vertex>\ngridPoint = (modelMatrix * vec4(position, 1.0)).xy;");
    shader.fragmentShader = shader.fragmentShader
      .replace("#include <common>", `#include <common>
        varying vec2 gridPoint;
        uniform float spacing, reach;
        uniform vec3 minorColour, majorColour, farColour;
        float gridLine(vec2 p, float width) {
          vec2 perPixel = fwidth(p);
          vec2 away = abs(fract(p - 0.5) - 0.5) / perPixel;
          float line = 1.0 - min(min(away.x, away.y) / width, 1.0);
          return line * (1.0 - smoothstep(0.15, 0.5, max(perPixel.x, perPixel.y)));
        }`)
      .replace("#include <color_fragment>", `#include <color_fragment>
        diffuseColor.rgb = mix(diffuseColor.rgb, minorColour, gridLine(gridPoint / spacing, 1.2));
        diffuseColor.rgb = mix(diffuseColor.rgb, majorColour, gridLine(gridPoint / (10.0 * spacing), 1.5));`)
      .replace("#include <opaque_fragment>", `#include <opaque_fragment>
        gl_FragColor.rgb = mix(gl_FragColor.rgb, farColour, smoothstep(0.35 * reach, reach, length(gridPoint - cameraPosition.xy)));`);
  };
  return uniforms;
}

export function sprite(text: string, colour: string, height_m: number, place: [number, number, number]): Sprite {
  const canvas = document.createElement("canvas");
  const context = canvas.getContext("2d")!;
  const font = "500 44px system-ui, 'DejaVu Sans', sans-serif";
  context.font = font;
  canvas.width = Math.ceil(context.measureText(text).width) + 8;
  canvas.height = 56;
  context.font = font;
  context.fillStyle = colour;
  context.textBaseline = "middle";
  context.fillText(text, 4, 30);
  const material = new SpriteMaterial({ map: new CanvasTexture(canvas), transparent: true, depthWrite: false, opacity: 0.75 });
  const made = new Sprite(material);
  made.scale.set((height_m * canvas.width) / canvas.height, height_m, 1);
  made.position.set(...place);
  return made;
}
