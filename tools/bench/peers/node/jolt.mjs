// Jolt, one thread. Its knob: collision steps, each of ten velocity and two position iterations.
const FIXED = 0, LOOSE = 1, GHOST = 2; // layers

export async function load() {
  const jolt = await (await import("jolt-physics")).default();
  return { name: "Jolt", version: "jolt-physics", make: (...what) => new Scene(jolt, ...what) };
}

function settingsOf(jolt) {
  const settings = new jolt.JoltSettings();
  settings.mMaxWorkerThreads = 0;
  const pairs = new jolt.ObjectLayerPairFilterTable(3);
  pairs.EnableCollision(FIXED, LOOSE);
  pairs.EnableCollision(LOOSE, LOOSE);
  const broad = new jolt.BroadPhaseLayerInterfaceTable(3, 2);
  const [still, moving] = [new jolt.BroadPhaseLayer(0), new jolt.BroadPhaseLayer(1)];
  broad.MapObjectToBroadPhaseLayer(FIXED, still);
  broad.MapObjectToBroadPhaseLayer(LOOSE, moving);
  broad.MapObjectToBroadPhaseLayer(GHOST, moving);
  settings.mObjectLayerPairFilter = pairs;
  settings.mBroadPhaseLayerInterface = broad;
  settings.mObjectVsBroadPhaseLayerFilter = new jolt.ObjectVsBroadPhaseLayerFilterTable(broad, 2, pairs, 3);
  return settings;
}

class Scene {
  constructor(jolt, scene, steps, gravity) {
    this.jolt = jolt;
    this.steps = steps;
    const settings = settingsOf(jolt);
    this.whole = new jolt.JoltInterface(settings);
    jolt.destroy(settings);
    this.system = this.whole.GetPhysicsSystem();
    this.interface = this.system.GetBodyInterface();
    this.setGravity(gravity);
    this.bodies = scene.bodies.map((body) => this.add(scene, body));
    for (const joint of scene.joints) this.join(joint);
  }

  with(make, use) {
    const made = make;
    const result = use(made);
    this.jolt.destroy(made);
    return result;
  }

  add(scene, body) {
    const { jolt } = this;
    const half = new jolt.Vec3(...body.size);
    const shape = body.shape === "box" ? new jolt.BoxShape(half, Math.min(0.05, ...body.size)) : new jolt.SphereShape(body.size[0]);
    shape.SetDensity(body.density);
    const layer = !body.collides ? GHOST : body.fixed ? FIXED : LOOSE;
    const place = new jolt.RVec3(...body.position), turned = new jolt.Quat(0, 0, 0, 1);
    const motion = body.fixed ? jolt.EMotionType_Static : jolt.EMotionType_Dynamic;
    const settings = new jolt.BodyCreationSettings(shape, place, turned, motion, layer);
    settings.mFriction = scene.friction;
    settings.mRestitution = scene.restitution;
    settings.mLinearDamping = settings.mAngularDamping = 0;
    settings.mMaxLinearVelocity = 500;
    settings.mMaxAngularVelocity = 1000;
    settings.mApplyGyroscopicForce = true;
    settings.mAllowSleeping = false;
    this.with(new jolt.Vec3(...body.velocity), (v) => (settings.mLinearVelocity = v));
    this.with(new jolt.Vec3(...body.angular_velocity), (w) => (settings.mAngularVelocity = w));
    const made = this.interface.CreateBody(settings);
    this.interface.AddBody(made.GetID(), jolt.EActivation_Activate);
    for (const used of [half, place, turned, settings]) jolt.destroy(used);
    return made;
  }

  join(joint) {
    const { jolt } = this;
    const settings = new jolt.PointConstraintSettings();
    settings.mSpace = jolt.EConstraintSpace_LocalToBodyCOM;
    this.with(new jolt.RVec3(...joint.anchor_a), (p) => (settings.mPoint1 = p));
    this.with(new jolt.RVec3(...joint.anchor_b), (p) => (settings.mPoint2 = p));
    this.system.AddConstraint(settings.Create(this.bodies[joint.a], this.bodies[joint.b]));
    jolt.destroy(settings);
  }

  step() {
    this.whole.Step(1 / 60, this.steps);
  }
  setGravity(gravity) {
    this.with(new this.jolt.Vec3(...gravity), (g) => this.system.SetGravity(g));
  }
  setVelocity(body, velocity) {
    this.with(new this.jolt.Vec3(...velocity), (v) => this.interface.SetLinearVelocity(this.bodies[body].GetID(), v));
  }
  state(index) {
    const body = this.bodies[index];
    const numbers = [];
    const add = (v) => numbers.push(v.GetX(), v.GetY(), v.GetZ());
    add(body.GetPosition());
    const q = body.GetRotation();
    numbers.push(q.GetX(), q.GetY(), q.GetZ(), q.GetW());
    if (body.IsStatic()) return [...numbers, 0, 0, 0, 0, 0, 0];
    add(body.GetLinearVelocity());
    add(body.GetAngularVelocity());
    return numbers;
  }
  free() {
    for (const body of this.bodies) {
      this.interface.RemoveBody(body.GetID());
      this.interface.DestroyBody(body.GetID());
    }
    this.jolt.destroy(this.whole);
  }
}
