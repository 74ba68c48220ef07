// Rapier, the build that is the same on every machine. Its knob: iterations of the solver, which
// are its substeps.

const PACKAGE = "@dimforge/rapier3d-deterministic-compat";

function vector([x, y, z]) {
  return { x, y, z };
}

export async function load() {
  const rapier = await import(PACKAGE);
  await rapier.init();
  return { name: "Rapier", version: rapier.version(), make: (...what) => new Scene(rapier, ...what) };
}

class Scene {
  constructor(rapier, scene, iterations, gravity) {
    this.world = new rapier.World(vector(gravity));
    this.world.timestep = 1 / 60;
    this.world.integrationParameters.numSolverIterations = iterations;
    this.bodies = scene.bodies.map((body) => this.add(rapier, scene, body));
    for (const joint of scene.joints) {
      const data = rapier.JointData.spherical(vector(joint.anchor_a), vector(joint.anchor_b));
      this.world.createImpulseJoint(data, this.bodies[joint.a], this.bodies[joint.b], true);
    }
  }

  add(rapier, scene, body) {
    const desc = body.fixed ? rapier.RigidBodyDesc.fixed() : rapier.RigidBodyDesc.dynamic();
    desc.setTranslation(...body.position).setLinvel(...body.velocity).setAngvel(vector(body.angular_velocity));
    desc.setCanSleep(false);
    const shape = body.shape === "box" ? rapier.ColliderDesc.cuboid(...body.size) : rapier.ColliderDesc.ball(body.size[0]);
    shape.setDensity(body.density).setFriction(scene.friction).setRestitution(scene.restitution);
    if (!body.collides) shape.setCollisionGroups(0);
    const made = this.world.createRigidBody(desc);
    this.world.createCollider(shape, made);
    return made;
  }

  step() {
    this.world.step();
  }
  setGravity(gravity) {
    this.world.gravity = vector(gravity);
  }
  setVelocity(body, velocity) {
    this.bodies[body].setLinvel(vector(velocity), true);
  }
  state(index) {
    const body = this.bodies[index];
    const p = body.translation(), q = body.rotation(), v = body.linvel(), w = body.angvel();
    return [p.x, p.y, p.z, q.x, q.y, q.z, q.w, v.x, v.y, v.z, w.x, w.y, w.z];
  }
  free() {
    this.world.free();
  }
}
