// Draws the bodies of a world with three.js.
import * as three from "three";
import { Body, Motion, outlineOf } from "lockstone/full";

const SPHERE = 0, CAPSULE = 1, BOX = 2, HALF_SPACE = 4, CYLINDER = 8, CONE = 9;
const COLORS = [0x4e79a7, 0xf28e2b, 0xe15759, 0x76b7b2, 0x59a14f, 0xedc948, 0xb07aa1, 0x9c755f];
const FLOOR = 0xb8c0c8, FIXED = 0x8a949e, TRIGGER = 0x66bb66;

function geometryOf({ kind, size: [x, y, z] }) {
  switch (kind) {
    case SPHERE: return new three.SphereGeometry(x, 24, 16);
    case CAPSULE: return new three.CapsuleGeometry(x, 2 * y, 8, 16);
    case BOX: return new three.BoxGeometry(2 * x, 2 * y, 2 * z);
    case CYLINDER: return new three.CylinderGeometry(x, x, 2 * y, 24);
    case CONE: return new three.ConeGeometry(x, y, 24).translate(0, y / 4, 0);
    case HALF_SPACE: return new three.PlaneGeometry(400, 400).rotateX(-Math.PI / 2);
    default: return new three.BufferGeometry();
  }
}

function materialOf(row, { motion, trigger, shape }) {
  const color = trigger ? TRIGGER : motion !== Motion.static ? COLORS[row % COLORS.length] : shape.kind === HALF_SPACE ? FLOOR : FIXED;
  return new three.MeshStandardMaterial({ color, roughness: 0.8, flatShading: true, transparent: trigger, opacity: trigger ? 0.3 : 1 });
}

/** The parts and triangles of a body as one object. */
function objectOf(body) {
  const view = body.view;
  const material = materialOf(body.index, view);
  const { parts, triangles } = outlineOf(body);
  const object = new three.Group();
  for (const part of parts) {
    const mesh = new three.Mesh(geometryOf(part), material);
    const [x, y, z] = [0, 3, 6].map((i) => new three.Vector3().fromArray(part.axes, i));
    mesh.applyMatrix4(new three.Matrix4().makeBasis(x, y, z).setPosition(...part.place));
    object.add(mesh);
  }
  if (triangles.length > 0) {
    const geometry = new three.BufferGeometry().setAttribute("position", new three.BufferAttribute(triangles, 3));
    geometry.computeVertexNormals();
    object.add(new three.Mesh(geometry, material));
  }
  object.traverse((child) => {
    child.castShadow = view.motion !== Motion.static;
    child.receiveShadow = true;
  });
  return object;
}

export class Picture {
  constructor(canvas) {
    this.renderer = new three.WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: true });
    this.renderer.shadowMap.enabled = true;
    this.scene = new three.Scene();
    this.scene.background = new three.Color(0xdfe8f0);
    this.camera = new three.PerspectiveCamera(50, 1, 0.1, 1000);
    this.scene.add(new three.HemisphereLight(0xffffff, 0x8899aa, 1.6));
    this.sun = new three.DirectionalLight(0xffffff, 2);
    this.sun.castShadow = true;
    this.sun.shadow.mapSize.set(2048, 2048);
    this.scene.add(this.sun, this.sun.target);
    this.objects = new Map(); // by the body's id
    this.turn = 0.6;
    this.rise = 0.35;
    this.distance = 1;
  }

  /** Begins with another world: looks at its moving bodies. */
  show(view) {
    for (const object of this.objects.values()) this.scene.remove(object);
    this.objects.clear();
    const box = new three.Box3();
    view.at(1);
    for (const { index, view: { motion } } of view.world.bodies()) {
      if (motion === Motion.dynamic) box.expandByPoint(new three.Vector3().fromArray(view.positions, 3 * index));
    }
    if (box.isEmpty()) box.expandByPoint(new three.Vector3());
    box.getCenter(this.sun.target.position);
    this.radius = Math.min(Math.max(box.getSize(new three.Vector3()).length() / 2, 3), 60);
  }

  draw(view, fraction) {
    view.at(fraction);
    this.follow(view);
    this.aim();
    this.renderer.render(this.scene, this.camera);
  }

  /** An object for every body, where the body is. */
  follow(view) {
    // Outlines take memory, which may grow: arrays that were read before are empty then.
    for (const id of [...view.bodies]) {
      if (id === 0n || this.objects.has(id)) continue;
      const object = objectOf(new Body(view.world, id));
      this.scene.add(object);
      this.objects.set(id, object);
    }
    const { bodies, positions, orientations } = view;
    const gone = new Set(this.objects.keys());
    bodies.forEach((id, row) => {
      if (id === 0n) return;
      gone.delete(id);
      const object = this.objects.get(id);
      object.position.fromArray(positions, 3 * row);
      object.quaternion.fromArray(orientations, 4 * row);
    });
    for (const id of gone) {
      this.scene.remove(this.objects.get(id));
      this.objects.delete(id);
    }
  }

  aim() {
    const { clientWidth: width, clientHeight: height } = this.renderer.domElement;
    if (this.renderer.domElement.width !== width || this.renderer.domElement.height !== height) {
      this.renderer.setSize(width, height, false);
    }
    const { target } = this.sun, r = this.radius;
    const away = 2.6 * r * this.distance;
    this.camera.aspect = width / height;
    this.camera.position.set(Math.sin(this.turn) * Math.cos(this.rise), Math.sin(this.rise), Math.cos(this.turn) * Math.cos(this.rise))
      .multiplyScalar(away).add(target.position);
    this.camera.lookAt(target.position);
    this.camera.far = 20 * away + 400;
    this.camera.updateProjectionMatrix();
    this.sun.position.copy(target.position).add(new three.Vector3(r, 2.5 * r, 1.5 * r));
    Object.assign(this.sun.shadow.camera, { left: -2 * r, right: 2 * r, top: 2 * r, bottom: -2 * r, near: 0.1, far: 8 * r });
    this.sun.shadow.camera.updateProjectionMatrix();
  }
}
