// Pointers on the picture: turn, shift and zoom the camera, choose and pull bodies.
import * as three from "three";
import { type Hit, castRay } from "../../web/src/queries.js";
import type { Mode } from "./mode.js";
import type { Picture } from "./picture.js";

const REACH = 500; // m
const CLICK = 4; // px that a click may move

export class Hand {
  private readonly fingers = new Map<number, { x: number; y: number }>();
  private pulling: three.Plane | null = null;
  private moved = 0;

  constructor(private readonly picture: Picture, private readonly mode: () => Mode | null) {
    const { canvas } = picture;
    canvas.onpointerdown = (event) => this.down(event);
    canvas.onpointermove = (event) => this.move(event);
    canvas.onpointerup = canvas.onpointercancel = (event) => this.up(event);
    canvas.oncontextmenu = (event) => event.preventDefault();
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      picture.zoom(Math.exp(event.deltaY * 0.001));
    }, { passive: false });
  }

  /** The body under a point of the canvas. */
  hitAt(x: number, y: number): { hit: Hit | null; part: number } {
    const mode = this.mode();
    if (!mode) return { hit: null, part: 0 };
    const parts = mode.dioramas.length;
    const part = Math.min(Math.floor((x / this.picture.canvas.clientWidth) * parts), parts - 1);
    const ray = this.picture.ray(x, y, parts);
    const way = ray.direction.clone().multiplyScalar(REACH).toArray();
    return { hit: castRay(mode.dioramas[part]!.stage.world, ray.origin.toArray(), way), part };
  }

  private down(event: PointerEvent): void {
    const { canvas } = this.picture;
    canvas.setPointerCapture(event.pointerId);
    canvas.focus({ preventScroll: true });
    this.fingers.set(event.pointerId, { x: event.offsetX, y: event.offsetY });
    this.moved = 0;
    if (this.fingers.size > 1) return this.letGo();
    if (event.button !== 0 || event.shiftKey) return;
    const { hit } = this.hitAt(event.offsetX, event.offsetY);
    if (!hit || !this.mode()?.grab?.(hit)) return;
    const facing = this.picture.camera.getWorldDirection(new three.Vector3());
    this.pulling = new three.Plane().setFromNormalAndCoplanarPoint(facing, new three.Vector3(...hit.point));
  }

  private move(event: PointerEvent): void {
    const finger = this.fingers.get(event.pointerId);
    if (!finger) return;
    const [dx, dy] = [event.offsetX - finger.x, event.offsetY - finger.y];
    this.moved += Math.abs(dx) + Math.abs(dy);
    const apart = this.spread();
    Object.assign(finger, { x: event.offsetX, y: event.offsetY });
    if (this.fingers.size === 2) {
      this.picture.zoom(apart / Math.max(this.spread(), 1));
      this.picture.pan(dx / 2, dy / 2);
    } else if (this.pulling) {
      const ray = this.picture.ray(event.offsetX, event.offsetY, this.mode()?.dioramas.length);
      const to = ray.intersectPlane(this.pulling, new three.Vector3());
      if (to) this.mode()?.drag?.(to);
    } else if (event.buttons & 6 || event.shiftKey) {
      this.picture.pan(dx, dy);
    } else {
      this.picture.orbit(dx, dy);
    }
  }

  private up(event: PointerEvent): void {
    const known = this.fingers.delete(event.pointerId);
    this.letGo();
    if (!known || this.moved > CLICK || event.button !== 0) return;
    const { hit, part } = this.hitAt(event.offsetX, event.offsetY);
    this.mode()?.choose(hit, part);
  }

  private letGo(): void {
    if (this.pulling) this.mode()?.release?.();
    this.pulling = null;
  }

  private spread(): number {
    const [a, b] = [...this.fingers.values()];
    return a && b ? Math.hypot(a.x - b.x, a.y - b.y) : 1;
  }
}
