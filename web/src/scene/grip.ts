// Dragging a node with the mouse: the target moves in the plane through the node that faces the camera; the
// server pulls the node there with a spring. A label at the cursor shows the force.
import { BufferAttribute, BufferGeometry, Group, Line, LineDashedMaterial, Mesh, MeshBasicMaterial, Plane, Raycaster, SphereGeometry, Vector2, Vector3 } from "three";
import type { App, Theme } from "../app";
import { palette } from "../colours";
import { VALUES } from "../layout";
import type { Vec3 } from "../protocol";
import { el, number } from "../util";
import type { View } from "./view";

const BESIDE_PX = 16; // offset of the label from the cursor

export class Grip {
  readonly object = new Group();
  readonly label = el("output.grip", { hidden: true, "aria-label": "force of the hand" });
  private node = -1;
  private readonly plane = new Plane();
  private readonly target = new Vector3();
  private readonly ray = new Raycaster();
  private waiting = false;
  private readonly line: Line<BufferGeometry, LineDashedMaterial>;
  private readonly ball: Mesh<SphereGeometry, MeshBasicMaterial>;

  constructor(
    private readonly app: App,
    private readonly view: View,
  ) {
    const geometry = new BufferGeometry().setAttribute("position", new BufferAttribute(new Float32Array(6), 3));
    this.line = new Line(geometry, new LineDashedMaterial({ dashSize: 0.01, gapSize: 0.008, depthTest: false }));
    this.line.frustumCulled = false;
    this.ball = new Mesh(new SphereGeometry(1, 16, 12), new MeshBasicMaterial({ depthTest: false }));
    this.object.add(this.line, this.ball);
    this.object.visible = false;
    this.object.renderOrder = 3;
  }

  get held(): boolean {
    return this.node >= 0;
  }

  take(node: number, event: PointerEvent): void {
    const place = this.view.nodeAt(node);
    if (!place) return;
    this.node = node;
    this.target.copy(place);
    this.plane.setFromNormalAndCoplanarPoint(this.view.camera.getWorldDirection(new Vector3()), place);
    this.view.enableOrbit(false);
    this.view.canvas.setPointerCapture(event.pointerId);
    this.ball.scale.setScalar(0.012 * (this.view.world?.size_m ?? 1));
  }

  move(x_px: number, y_px: number): void {
    const { width_px, height_px } = this.view.viewport;
    this.ray.setFromCamera(new Vector2((2 * x_px) / width_px - 1, 1 - (2 * y_px) / height_px), this.view.camera);
    if (!this.ray.ray.intersectPlane(this.plane, this.target)) return;
    this.object.visible = true;
    this.draw();
    if (this.waiting) return;
    // the mouse may report far more often than the screen is updated
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      const name = this.app.scene.value?.nodes[this.node]?.name;
      if (name) this.app.send({ type: "drag", node: name, target_m: this.target.toArray() as Vec3 });
    });
  }

  /** Releases the node. Returns whether a node was held and had been moved. */
  drop(): boolean {
    if (!this.held) return false;
    const moved = this.object.visible;
    this.node = -1;
    this.object.visible = false;
    this.label.hidden = true;
    this.view.enableOrbit(true);
    this.view.invalidate();
    if (moved) this.app.send({ type: "drop" });
    return moved;
  }

  update(): void {
    if (this.object.visible) this.draw();
  }

  /**
   * Returns the force of the drag in the displayed frame [N]; NaN before it acts: a paused run has not
   * applied it yet.
   */
  private force(): number {
    const frame = this.app.frame.value;
    if (!frame) return NaN;
    // events of the experiment may push the same node; the drag is the last entry
    const [node, ...force_n] = frame.pushes.slice(-VALUES.pushes);
    return node === this.node ? Math.hypot(...force_n) : NaN;
  }

  private say(): void {
    const force_n = this.force();
    const { paused } = this.app.frame.value ?? { paused: 1 };
    this.label.hidden = false;
    this.label.textContent = Number.isNaN(force_n) ? (paused ? "pulls when running" : "0 N") : `${number(force_n, 3)} N`;
    const { x, y } = this.view.toScreen(this.target);
    const { width_px, height_px } = this.view.viewport;
    const left = Math.min(Math.max(x + BESIDE_PX, 4), width_px - this.label.offsetWidth - 4);
    const top = Math.min(Math.max(y + BESIDE_PX, 4), height_px - this.label.offsetHeight - 4);
    this.label.style.transform = `translate(${left}px, ${top}px)`;
  }

  paint(theme: Theme): void {
    this.line.material.color.set(palette(theme).push);
    this.ball.material.color.set(palette(theme).push);
  }

  private draw(): void {
    const place = this.view.nodeAt(this.node);
    if (!place) return;
    const positions = this.line.geometry.getAttribute("position") as BufferAttribute;
    place.toArray(positions.array, 0);
    this.target.toArray(positions.array, 3);
    positions.needsUpdate = true;
    this.line.computeLineDistances();
    this.ball.position.copy(this.target);
    this.say();
    this.view.invalidate();
  }
}
