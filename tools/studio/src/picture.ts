// The picture: a renderer, a camera, and one diorama or two beside each other.
import * as three from "three";
import { Bodies, type Painter } from "./bodies.js";
import { Drawn, STRIDE, State } from "./engine.js";
import { FIXED } from "./paint.js";
import { OVERLAYS, Overlays, type Pin } from "./overlays.js";
import { SOFTWARE } from "./software.js";
import type { Stage } from "./stage.js";
import { Thrift } from "./thrift.js";

const LISTS: Record<string, number> = { contacts: Drawn.contacts, joints: Drawn.joints, bounds: Drawn.bounds, masses: Drawn.masses };

/** A second world in the same place: of its bodies those with these rows, which are clear. */
export interface Ghost {
  stage: Stage;
  has: (row: number) => boolean;
}

/** A world in its own light. */
export class Diorama {
  readonly scene = new three.Scene();
  readonly bodies = new Bodies();
  private readonly ghosts = new Bodies();
  private readonly overlays = new Overlays();
  private readonly sky = new three.HemisphereLight(0xffffff, 0x8899aa, 1.5);
  private readonly sun = new three.DirectionalLight(0xffffff, 2.2);

  /** `pins`: places to point at, of the present tick. */
  constructor(readonly stage: Stage, readonly paint: Painter, private readonly pins: () => readonly Pin[] = () => [], private readonly ghost?: Ghost) {
    this.sun.castShadow = true;
    this.sun.shadow.mapSize.setScalar(SOFTWARE ? 512 : 2048);
    this.scene.add(this.sky, this.sun, this.sun.target, this.bodies.group, this.ghosts.group, this.overlays.group);
  }

  /** `fraction`: between the last two ticks. */
  update(fraction: number, shown: ReadonlySet<string>, markSize: number, pulled: three.Vector3[] | null): void {
    const { stage } = this;
    const wanted = OVERLAYS.reduce((bits, name) => (shown.has(name) ? bits | LISTS[name]! : bits), Drawn.bodies as number);
    const fill = () => {
      const { positions, orientations } = stage.view.at(fraction);
      const lists = stage.engine.draw(stage.world, wanted);
      const visible = shown.has("triggers") ? lists.bodies : withoutTriggers(lists.bodies);
      return this.bodies.update(stage.world, stage.view.bodies, visible, positions, orientations, this.paint) ? lists : undefined;
    };
    const lists = fill() ?? fill(); // again once all outlines are known
    this.overlays.update(lists!, markSize, pulled, this.pins());
    if (this.ghost) this.updateGhosts(this.ghost, fraction);
  }

  dispose(): void {
    this.bodies.dispose();
    this.ghosts.dispose();
  }

  private updateGhosts({ stage, has }: Ghost, fraction: number): void {
    const list = stage.engine.draw(stage.world, Drawn.bodies).bodies;
    const clear: number[] = [];
    for (let at = 0; at < list.length; at += STRIDE.bodies) {
      if (has(list[at]!)) clear.push(list[at]!, State.trigger, list[at + 2]!, list[at + 3]!);
    }
    const fill = () => {
      const { positions, orientations } = stage.view.at(fraction);
      return this.ghosts.update(stage.world, stage.view.bodies, new Float32Array(clear), positions, orientations, this.paint);
    };
    if (!fill()) fill();
  }

  light(target: three.Vector3, radius: number, background: three.Color, floor: three.Color, dark: boolean): void {
    this.scene.background = background;
    this.scene.fog = new three.Fog(background, 12 * radius, 40 * radius);
    this.bodies.floor.color = floor;
    this.sky.intensity = dark ? 0.9 : 1.5;
    this.sun.position.copy(target).add(new three.Vector3(radius, 2.5 * radius, 1.5 * radius));
    this.sun.target.position.copy(target);
    const r = 2 * radius;
    this.sun.shadow.normalBias = (2.5 * (2 * r)) / this.sun.shadow.mapSize.width; // texels: no stripes on flat ground
    Object.assign(this.sun.shadow.camera, { left: -r, right: r, top: r, bottom: -r, near: 0.1, far: 8 * radius });
    this.sun.shadow.camera.updateProjectionMatrix();
  }
}

function withoutTriggers(list: Float32Array): Float32Array {
  const kept: number[] = [];
  for (let at = 0; at < list.length; at += STRIDE.bodies) if (list[at + 1] !== State.trigger) kept.push(...list.subarray(at, at + STRIDE.bodies));
  return new Float32Array(kept);
}

export class Picture {
  readonly renderer: three.WebGLRenderer;
  readonly camera = new three.PerspectiveCamera(50, 1, 0.05, 2000);
  readonly target = new three.Vector3();
  turn = 0.6;
  rise = 0.35;
  /** Of the camera, in radii of the scene. */
  distance = 2.6;
  radius = 5;
  dark = false;
  private readonly background = new three.Color();
  private readonly floor = new three.Color();
  private readonly thrift = new Thrift();

  constructor(readonly canvas: HTMLCanvasElement) {
    this.renderer = new three.WebGLRenderer({ canvas, antialias: !SOFTWARE, preserveDrawingBuffer: true });
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.autoUpdate = false;
    this.renderer.setScissorTest(true);
  }

  /** Takes its colours from the page. */
  setTheme(): void {
    const style = getComputedStyle(document.documentElement);
    this.background.set(style.getPropertyValue("--sky").trim());
    this.floor.set(style.getPropertyValue("--floor").trim());
    FIXED.set(style.getPropertyValue("--fixed").trim());
    this.dark = this.background.getHSL({ h: 0, s: 0, l: 0 }).l < 0.3;
  }

  /** Looks at the bodies that move. */
  frame(stage: Stage): void {
    const box = new three.Box3();
    const { positions } = stage.view.at(1);
    const { bodies } = stage.engine.draw(stage.world, Drawn.bodies);
    for (let at = 0; at < bodies.length; at += 4) {
      if (bodies[at + 1]! >= 1) box.expandByPoint(new three.Vector3().fromArray(positions, 3 * bodies[at]!));
    }
    if (box.isEmpty()) box.expandByPoint(new three.Vector3());
    // What hangs in the air will fall.
    if (box.min.y > 0) box.min.y = 0;
    box.getCenter(this.target);
    this.radius = Math.min(Math.max(box.getSize(new three.Vector3()).length() / 2, 2.5), 60);
    this.distance = 2.1;
  }

  /** Turn, rise, distance and target. */
  get pose(): number[] {
    return [this.turn, this.rise, this.distance * this.radius, ...this.target.toArray()];
  }
  set pose([turn, rise, distance, x, y, z]: number[]) {
    if (z === undefined) return;
    [this.turn, this.rise, this.distance] = [turn!, rise!, distance! / this.radius];
    this.target.set(x!, y!, z);
  }

  /** `moves`: the next picture follows at once, so that this one may be plainer. */
  draw(dioramas: readonly Diorama[], fraction: number, shown: ReadonlySet<string>, pulled: three.Vector3[] | null, moves: boolean): void {
    this.thrift.next(moves, performance.now());
    this.resize();
    this.aim(dioramas.length);
    const { width, height } = this.size();
    if (dioramas.length > 1) this.clear(width, height); // the gap between them too
    dioramas.forEach((diorama, i) => {
      diorama.light(this.target, this.radius, this.background, this.floor, this.dark);
      diorama.update(fraction, shown, 0.06 * this.radius, i === 0 ? pulled : null);
      const share = width / dioramas.length;
      this.renderer.setViewport(i * share, 0, share, height);
      this.renderer.setScissor(i * share, 0, share - (i + 1 < dioramas.length ? 2 : 0), height);
      this.renderer.shadowMap.needsUpdate = this.thrift.wantsShadows(diorama.bodies.count);
      this.renderer.render(diorama.scene, this.camera);
    });
  }

  /** Whether the figures and charts beside the picture are due with the last one drawn. */
  get wantsFigures(): boolean {
    return this.thrift.wantsFigures;
  }

  /** The ray through a point of the canvas; both halves have the same camera. */
  ray(x: number, y: number, parts = 1): three.Ray {
    const { width, height } = this.size();
    const share = width / parts;
    const at = new three.Vector2((2 * (x % share)) / share - 1, 1 - (2 * y) / height);
    const caster = new three.Raycaster();
    caster.setFromCamera(at, this.camera);
    return caster.ray;
  }

  orbit(dx: number, dy: number): void {
    this.turn -= dx * 0.006;
    this.rise = Math.min(Math.max(this.rise + dy * 0.006, -0.3), 1.55);
  }

  pan(dx: number, dy: number): void {
    const step = (this.distance * this.radius) / this.size().height;
    const right = new three.Vector3().setFromMatrixColumn(this.camera.matrix, 0);
    const up = new three.Vector3().setFromMatrixColumn(this.camera.matrix, 1);
    this.target.addScaledVector(right, -dx * step).addScaledVector(up, dy * step);
  }

  zoom(factor: number): void {
    this.distance = Math.min(Math.max(this.distance * factor, 0.15), 20);
  }

  private size(): { width: number; height: number } {
    return { width: this.canvas.clientWidth, height: this.canvas.clientHeight };
  }

  private clear(width: number, height: number): void {
    this.renderer.setScissor(0, 0, width, height);
    this.renderer.setClearColor(0, 0);
    this.renderer.clear();
  }

  private resize(): void {
    const { width, height } = this.size();
    const now = this.renderer.getSize(new three.Vector2());
    if (now.x === width && now.y === height && this.renderer.getPixelRatio() === this.thrift.scale) return;
    this.renderer.setPixelRatio(this.thrift.scale);
    this.renderer.setSize(width, height, false);
  }

  private aim(parts: number): void {
    const { width, height } = this.size();
    const away = this.distance * this.radius;
    const flat = Math.cos(this.rise);
    this.camera.aspect = width / parts / Math.max(height, 1);
    this.camera.position.set(Math.sin(this.turn) * flat, Math.sin(this.rise), Math.cos(this.turn) * flat)
      .multiplyScalar(away).add(this.target);
    this.camera.lookAt(this.target);
    this.camera.far = 20 * away + 400;
    this.camera.updateProjectionMatrix();
    this.camera.updateMatrixWorld();
  }
}
