// The 3D view: camera, light, mouse; draws only after changes.
import {
  AmbientLight, Box3, Color, DirectionalLight, PCFSoftShadowMap, PerspectiveCamera, Scene as ThreeScene, Vector3,
  WebGLRenderer, HemisphereLight,
} from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { type App, nameOf } from "../app";
import { palette } from "../colours";
import type { Frame } from "../frame";
import { el, Signal } from "../util";
import { Grip } from "./grip";
import { nodeUnder, pick, project, type Viewport } from "./pick";
import { centreOfMass, worldPoint } from "./poses";
import { World } from "./world";

const FILLED = 0.76; // largest part of half the view that the robot occupies
const MOST_SIZES = 8; // longest path that is shown as a whole, in robot sizes; longer ones are followed
const FREE = 0.3; // displacement of the robot before the camera follows, in robot sizes
const CLICK_PX = 4; // a press that moves less is a click
const NO_PICTURE = "No 3-D view: this browser has no WebGL, or it is switched off.";

export class View {
  readonly element = el("div.view");
  /** null: no WebGL in this browser; everything else works as usual. */
  readonly renderer: WebGLRenderer | null;
  readonly canvas: HTMLCanvasElement;
  readonly camera = new PerspectiveCamera(40, 1, 0.01, 500);
  world: World | null = null;
  /** Displayed instead of the app's frame: a mode of the model. */
  override: Frame | null = null;
  readonly following = new Signal(true);
  readonly frames = { drawn: 0 };
  /** Called after each picture, for elements that describe this picture. */
  readonly afterDraw: (() => void)[] = [];
  private readonly stage = new ThreeScene();
  private readonly sun = new DirectionalLight(0xffffff, 2.2);
  private readonly controls: OrbitControls;
  private readonly tip = el("div.tip", { role: "tooltip" });
  private readonly grip: Grip;
  private dirty = true;
  private filmSize: { width: number; height: number } | null = null;
  /** Height of the view in pixels of the page. */
  private height_px = 1;
  /** Center of mass now, and the position that the camera has followed. */
  private readonly followed = new Vector3();
  private readonly anchor = new Vector3();
  private pressed: { x: number; y: number } | null = null;

  constructor(private readonly app: App) {
    this.renderer = makeRenderer();
    this.canvas = this.renderer?.domElement ?? document.createElement("canvas");
    const { canvas } = this;
    canvas.tabIndex = 0;
    canvas.setAttribute("aria-label", "3-D view of the robot");
    if (this.renderer) this.element.append(canvas, this.tip);
    else this.element.append(el("p.instead", { role: "note" }, NO_PICTURE));
    this.camera.up.set(0, 0, 1);
    this.sun.castShadow = true;
    const corner = this.renderer && drawsBySoftware(this.renderer) ? 1024 : 2048;
    this.sun.shadow.mapSize.set(corner, corner);
    this.stage.add(this.sun, this.sun.target, new AmbientLight(0xffffff, 0.35), new HemisphereLight(0xffffff, 0x8899aa, 1.1));
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener("change", () => this.invalidate());
    this.grip = new Grip(app, this);
    this.stage.add(this.grip.object);
    this.element.append(this.grip.label);
    this.listen(canvas);
    this.watch();
    requestAnimationFrame(() => this.loop());
  }

  /** Whether pictures are drawn. */
  get draws(): boolean {
    return this.renderer !== null;
  }

  get viewport(): Viewport {
    return { camera: this.camera, width_px: this.canvas.clientWidth, height_px: this.canvas.clientHeight };
  }

  /** The point that the camera looks at and orbits around. */
  get target(): Vector3 {
    return this.controls.target;
  }

  invalidate(): void {
    this.dirty = true;
  }

  /** Projects a point in W to the screen, in pixels from the view's top left. */
  toScreen(point: Vector3): Vector3 {
    this.camera.updateMatrixWorld();
    return project(point, this.viewport, new Vector3());
  }

  enableOrbit(on: boolean): void {
    this.controls.enabled = on;
  }

  /** Shows the whole robot at its present position, from the camera's side. */
  fit(fromFront = false): void {
    const world = this.world;
    if (!world) return;
    const centre = world.bounds.getCenter(new Vector3());
    const frame = this.app.frame.value;
    const now = new Vector3();
    const shift = new Vector3();
    if (frame && centreOfMass(world.scene, frame, now)) shift.set(now.x - centre.x, now.y - centre.y, 0);
    const box = world.bounds.clone().translate(shift);
    this.fitBox(box, fromFront);
    this.anchor.copy(box.getCenter(new Vector3()));
  }

  /** Shows the robot at all places of its path. Returns false, without effect, if the path is too long for that. */
  fitPath(fromFront = false): boolean {
    const world = this.world;
    const places = world?.path.places ?? [];
    if (!world || places.length === 0) return false;
    const box = new Box3();
    for (const place of places) box.expandByPoint(place);
    if (box.getSize(new Vector3()).length() > MOST_SIZES * world.size_m) return false;
    const half = world.bounds.getSize(new Vector3()).multiplyScalar(0.5);
    box.min.sub(half);
    box.max.add(half);
    this.fitBox(box, fromFront);
    return true;
  }

  private fitBox(box: Box3, fromFront: boolean): void {
    const world = this.world!;
    const centre = box.getCenter(new Vector3());
    const direction = fromFront ? new Vector3(0.55, -1, 0.5) : this.camera.position.clone().sub(this.controls.target);
    const corners = cornersOf(box);
    this.controls.target.copy(centre);
    direction.normalize();
    let distance_m = 2 * Math.max(world.size_m, box.getSize(new Vector3()).length());
    // nearer parts look larger, so the distance is found by iteration
    for (let round = 0; round < 6; ++round) {
      this.camera.position.copy(centre).addScaledVector(direction, distance_m);
      this.camera.lookAt(centre);
      this.camera.updateMatrixWorld();
      const reach = corners.map((corner) => corner.clone().project(this.camera));
      distance_m *= Math.max(...reach.map(({ x, y }) => Math.max(Math.abs(x), Math.abs(y)))) / FILLED;
      distance_m = Math.max(distance_m, world.size_m); // all moving bodies may be points
    }
    this.controls.minDistance = 0.05 * world.size_m;
    this.controls.maxDistance = 60 * world.size_m;
    this.controls.update();
    this.invalidate();
  }

  private watch(): void {
    this.app.scene.watch((scene) => {
      const first = this.world === null;
      const count = this.world?.scene.bodies.length;
      this.world?.dispose();
      this.world = scene ? new World(scene) : null;
      if (!this.world) return;
      this.stage.add(this.world.object);
      this.world.paint(this.app.theme.value);
      this.resize();
      if (first || count !== scene?.bodies.length) this.fit(first);
      const frame = this.app.frame.value;
      if (frame && frame.body_count === this.world.scene.bodies.length) this.world.update(frame);
    });
    this.app.frame.watch((frame) => {
      if (!frame || !this.world || this.override) return;
      this.world.update(frame);
      this.grip.update();
      this.followCentre();
      this.invalidate();
    });
    this.app.theme.watch((theme) => {
      this.stage.background = new Color(palette(theme).horizon);
      this.world?.paint(theme);
      this.grip.paint(theme);
      this.invalidate();
    });
    const mark = () => {
      const shown = this.app.selection.value ?? this.app.hover.value;
      this.world?.cables.mark(shown?.kind === "cable" ? shown.index : -1);
      const node = shown?.kind === "node" ? this.app.scene.value?.nodes[shown.index] : undefined;
      this.world?.joints.mark(shown?.kind === "joint" ? shown.index : -1);
      this.world?.bodies.mark(shown?.kind === "body" ? shown.index : (node?.body ?? -1));
      this.invalidate();
    };
    this.app.selection.watch(mark);
    this.app.hover.watch(mark);
    this.following.watch((on) => on && this.centre());
    new ResizeObserver(() => this.resize()).observe(this.element);
  }

  /** Sets the size of pictures for a film; null: the size on the screen. */
  setFilmSize(size: { width: number; height: number } | null): void {
    this.filmSize = size;
    this.renderer?.setPixelRatio(size ? 1 : screenRatio());
    this.resize();
  }

  private resize(): void {
    const { clientWidth, clientHeight } = this.element;
    const { width, height } = this.filmSize ?? { width: clientWidth, height: clientHeight };
    if (width === 0 || height === 0) return;
    this.renderer?.setSize(width, height, this.filmSize === null);
    this.height_px = height;
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.world?.cables.resize(width, height);
    this.invalidate();
  }

  /** Moves the camera when the robot leaves its range; small motions stay visible. */
  private followCentre(): void {
    const world = this.world;
    const frame = this.app.frame.value;
    const now = new Vector3();
    if (!world || !frame || !centreOfMass(world.scene, frame, now)) return;
    this.followed.copy(now);
    const away = now.sub(this.anchor).setZ(0);
    const free_m = FREE * world.size_m;
    if (!this.following.value || away.length() <= free_m) return;
    away.multiplyScalar(1 - free_m / away.length());
    this.anchor.add(away);
    this.controls.target.add(away);
    this.camera.position.add(away);
  }

  /** Moves the camera so that it looks at the robot. */
  private centre(): void {
    const frame = this.app.frame.value;
    const now = new Vector3();
    if (!this.world || !frame || !centreOfMass(this.world.scene, frame, now)) return;
    this.anchor.copy(now);
    const away = now.sub(this.controls.target);
    this.controls.target.add(away);
    this.camera.position.add(away);
    this.invalidate();
  }

  private loop(): void {
    requestAnimationFrame(() => this.loop());
    this.controls.update();
    if (this.dirty) this.draw();
  }

  /** Draws at once; the canvas can be copied until control returns to the browser. */
  draw(): void {
    this.dirty = false;
    if (!this.renderer) return;
    this.aimSun();
    this.world?.ground.seenFrom(this.camera.position);
    this.world?.cables.seenFrom(this.camera, this.height_px);
    this.renderer.render(this.stage, this.camera);
    ++this.frames.drawn;
    this.element.dataset["drawn"] = String(this.frames.drawn);
    for (const call of this.afterDraw) call();
  }

  /** Keeps the shadow's box around the robot, so that shadow edges stay sharp everywhere. */
  private aimSun(): void {
    const reach_m = this.world ? 0.9 * this.world.size_m : 1;
    const at = this.sun.target.position.copy(this.followed.lengthSq() > 0 ? this.followed : this.controls.target);
    this.sun.position.copy(at).add(new Vector3(-0.5, -0.6, 1.6).multiplyScalar(2 * reach_m));
    const box = this.sun.shadow.camera;
    box.left = box.bottom = -reach_m;
    box.right = box.top = reach_m;
    box.near = 0.1 * reach_m;
    box.far = 8 * reach_m;
    box.updateProjectionMatrix();
    this.sun.shadow.normalBias = 0.004 * reach_m;
  }

  private at(event: PointerEvent): { x: number; y: number } {
    const box = this.canvas.getBoundingClientRect();
    return { x: event.clientX - box.left, y: event.clientY - box.top };
  }

  private pickAt(x: number, y: number) {
    const frame = this.app.frame.value;
    if (!this.world || !frame) return null;
    return pick(x, y, this.viewport, frame, this.world);
  }

  /** Returns the node at this position, even inside a joint's mark; -1: none. */
  private nodeUnder(x: number, y: number): number {
    const frame = this.app.frame.value;
    return this.world && frame ? nodeUnder(x, y, this.viewport, this.world.scene, frame) : -1;
  }

  private listen(canvas: HTMLCanvasElement): void {
    // Before the orbit controls: a press on a draggable node does not orbit.
    canvas.addEventListener("pointerdown", (event) => {
      const { x, y } = this.at(event);
      this.pressed = { x, y };
      const node = event.button === 0 && this.app.movable ? this.nodeUnder(x, y) : -1;
      if (node >= 0) this.grip.take(node, event);
    }, { capture: true });
    canvas.addEventListener("pointermove", (event) => {
      const { x, y } = this.at(event);
      if (this.grip.held) this.grip.move(x, y);
      else if (event.buttons === 0) this.hover(x, y);
    });
    canvas.addEventListener("pointerup", (event) => {
      const { x, y } = this.at(event);
      const held = this.grip.drop();
      const still = this.pressed && Math.hypot(x - this.pressed.x, y - this.pressed.y) < CLICK_PX;
      if (event.button === 0 && still) this.app.selection.value = this.pickAt(x, y);
      else if (held) this.hover(x, y);
    });
    canvas.addEventListener("pointerleave", () => {
      this.app.hover.value = null;
      this.tip.hidden = true;
    });
    canvas.addEventListener("dblclick", () => this.fit());
  }

  private hover(x: number, y: number): void {
    const under = this.pickAt(x, y);
    const before = this.app.hover.value;
    if (under?.kind !== before?.kind || under?.index !== before?.index) this.app.hover.value = under;
    this.tip.hidden = under === null;
    const node = under?.kind === "joint" ? this.nodeUnder(x, y) : under?.kind === "node" ? under.index : -1;
    this.canvas.style.cursor = under ? (node >= 0 && this.app.movable ? "grab" : "pointer") : "";
    if (!under || !this.world) return;
    const scene = this.world.scene;
    this.tip.textContent = `${under.kind} ${nameOf(scene, under)}`;
    if (under.kind === "joint" && node >= 0) this.tip.textContent += `, node ${nameOf(scene, { kind: "node", index: node })}`;
    const left = Math.min(x + 14, this.canvas.clientWidth - this.tip.offsetWidth - 4);
    this.tip.style.transform = `translate(${left}px, ${Math.max(y - 28, 4)}px)`;
  }

  /** Returns the present position of a node in W. */
  nodeAt(index: number): Vector3 | null {
    const node = this.world?.scene.nodes[index];
    const frame = this.app.frame.value;
    return node && frame ? worldPoint(frame, node.body, node.position_m, new Vector3()) : null;
  }
}

const screenRatio = () => Math.min(devicePixelRatio, 2);

/** Whether the processor draws instead of a graphics card, as on many remote desktops. */
function drawsBySoftware(renderer: WebGLRenderer): boolean {
  const gl = renderer.getContext();
  const names = gl.getExtension("WEBGL_debug_renderer_info");
  const name: unknown = names && gl.getParameter(names.UNMASKED_RENDERER_WEBGL);
  return typeof name === "string" && /swiftshader|llvmpipe|softpipe|basic render/i.test(name);
}

/**
 * Returns null without WebGL; three.js also logs this to the console. Without smoothed edges, and with a coarser
 * shadow, pictures by software take half the time.
 */
function makeRenderer(): WebGLRenderer | null {
  try {
    let renderer = new WebGLRenderer({ antialias: true, preserveDrawingBuffer: false });
    if (drawsBySoftware(renderer)) {
      renderer.dispose();
      renderer.forceContextLoss();
      renderer = new WebGLRenderer({ antialias: false, preserveDrawingBuffer: false });
    }
    renderer.shadowMap.enabled = true;
    renderer.shadowMap.type = PCFSoftShadowMap;
    renderer.setPixelRatio(screenRatio());
    return renderer;
  } catch {
    return null;
  }
}

function cornersOf({ min, max }: Box3): Vector3[] {
  return [min.x, max.x].flatMap((x) => [min.y, max.y].flatMap((y) => [min.z, max.z].map((z) => new Vector3(x, y, z))));
}
