use std::ptr;

use crate::error::{c_text, check, definition, sized, Result};
use crate::sys::{
    self, lks_angular_velocity, lks_axis, lks_body_view, lks_filter, lks_hit, lks_i32x3, lks_i64x3, lks_joint_event,
    lks_joint_view, lks_length, lks_mass, lks_number, lks_pose, lks_rate, lks_shape, lks_speed, lks_step_report,
    lks_surface, lks_surface_motion, lks_velocity,
};

definition!(
    /// Capacities and rules of a world.
    WorldDef, lks_world_def, lks_world_def_init
);
definition!(
    /// A body to be made: at first a dynamic sphere of 0.5 m.
    BodyDef, lks_body_def, lks_body_def_init
);
definition!(
    /// The bodies that a query sees.
    QueryFilter, lks_query_filter, lks_query_filter_init
);

/// Asks again with more room until all bodies have room.
fn list_bodies(mut ask: impl FnMut(*mut u64, usize, &mut usize) -> i32) -> Result<Vec<Body>> {
    let mut found = vec![0_u64; 64];
    let mut count = found.len();
    while count == found.len() {
        found.resize(found.len() * 2, 0);
        check(ask(found.as_mut_ptr(), found.len(), &mut count))?;
    }
    Ok(found[..count].iter().copied().map(Body).collect())
}

/// Names a body. The name of a destroyed one never names another.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Body(pub u64);

/// Names a joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Joint(pub u64);

/// A joint to be made.
#[derive(Clone, Copy)]
pub struct JointDef(pub sys::lks_joint_def);

impl JointDef {
    /// `kind`: `sys::LKS_JOINT_…`, which locks and frees the axes.
    pub fn new(kind: u32, a: Body, b: Body) -> Result<Self> {
        let mut def = sized!(lks_joint_def);
        check(unsafe { sys::lks_joint_def_init(&mut def, std::mem::size_of_val(&def), kind, a.0, b.0) })?;
        Ok(JointDef(def))
    }
}

/// The axes in which an impulse or force is given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum Frame {
    World = sys::LKS_FRAME_WORLD,
    Body = sys::LKS_FRAME_BODY,
}

/// Shapes, by their sizes.
pub struct Shape;

impl Shape {
    const fn of(kind: u32, x: lks_length, y: lks_length, z: lks_length, asset: u64) -> lks_shape {
        lks_shape { kind, size: lks_i32x3 { x, y, z }, asset }
    }
    pub const fn sphere(radius: lks_length) -> lks_shape {
        Self::of(sys::LKS_SPHERE, radius, 0, 0, 0)
    }
    pub const fn capsule(half_height: lks_length, radius: lks_length) -> lks_shape {
        Self::of(sys::LKS_CAPSULE, radius, half_height, 0, 0)
    }
    pub const fn cuboid(half_x: lks_length, half_y: lks_length, half_z: lks_length) -> lks_shape {
        Self::of(sys::LKS_BOX, half_x, half_y, half_z, 0)
    }
    pub const fn cylinder(half_height: lks_length, radius: lks_length) -> lks_shape {
        Self::of(sys::LKS_CYLINDER, radius, half_height, 0, 0)
    }
    pub const fn cone(height: lks_length, radius: lks_length) -> lks_shape {
        Self::of(sys::LKS_CONE, radius, height, 0, 0)
    }
    /// The hull of two balls along y, whose centres are the height apart.
    pub const fn tapered_capsule(
        height: lks_length,
        bottom_radius: lks_length,
        top_radius: lks_length,
    ) -> lks_shape {
        Self::of(sys::LKS_TAPERED_CAPSULE, bottom_radius, height, top_radius, 0)
    }
    /// A box of these half extents, and all within the radius of it.
    pub const fn rounded_box(
        half_x: lks_length,
        half_y: lks_length,
        half_z: lks_length,
        radius: lks_length,
    ) -> lks_shape {
        Self::of(sys::LKS_ROUNDED_BOX, half_x, half_y, half_z, radius as u32 as u64)
    }
    pub const fn half_space() -> lks_shape {
        Self::of(sys::LKS_HALF_SPACE, 0, 0, 0, 0)
    }
    /// Of an asset: `sys::LKS_HULL`, `LKS_MESH`, `LKS_HEIGHT_FIELD` or `LKS_COMPOUND`.
    pub const fn asset(kind: u32, name: u64) -> lks_shape {
        Self::of(kind, 0, 0, 0, name)
    }
}

/// Geometry that shapes name; every peer needs the same set.
pub struct Assets(*mut sys::lks_assets);

impl Assets {
    pub fn new() -> Result<Self> {
        let mut assets = ptr::null_mut();
        check(unsafe { sys::lks_assets_create(&mut assets) })?;
        Ok(Assets(assets))
    }
    /// Adds the convex hull of the points; returns its name.
    pub fn add_hull(&mut self, points: &[lks_i32x3], max_vertices: i32) -> Result<u64> {
        let mut name = 0;
        check(unsafe { sys::lks_assets_add_hull(self.0, points.as_ptr(), points.len(), max_vertices, &mut name) })?;
        Ok(name)
    }
    /// Adds a path for path joints: a smooth curve through the points; returns its name.
    pub fn add_path(&mut self, points: &[sys::lks_path_point], closed: bool) -> Result<u64> {
        let mut name = 0;
        check(unsafe { sys::lks_assets_add_path(self.0, points.as_ptr(), points.len(), closed.into(), &mut name) })?;
        Ok(name)
    }
    /// Adds a banked path: the track leans to the right by an angle at each point; returns its name.
    /// As many banks as points.
    pub fn add_banked_path(
        &mut self,
        points: &[sys::lks_path_point],
        banks: &[sys::lks_angle],
        closed: bool,
    ) -> Result<u64> {
        assert_eq!(points.len(), banks.len(), "as many banks as points");
        let mut name = 0;
        check(unsafe {
            sys::lks_assets_add_banked_path(
                self.0,
                points.as_ptr(),
                banks.as_ptr(),
                points.len(),
                closed.into(),
                &mut name,
            )
        })?;
        Ok(name)
    }
    /// Adds all points within the radius of that hull; returns its name.
    pub fn add_rounded_hull(&mut self, points: &[lks_i32x3], max_vertices: i32, radius: lks_length) -> Result<u64> {
        let mut name = 0;
        check(unsafe {
            sys::lks_assets_add_rounded_hull(self.0, points.as_ptr(), points.len(), max_vertices, radius, &mut name)
        })?;
        Ok(name)
    }
    /// Adds a hull, mesh or height field of the set scaled along its axes; returns its name. Negative factors mirror.
    pub fn add_scaled(&mut self, asset: u64, factors: lks_i32x3) -> Result<u64> {
        let mut name = 0;
        check(unsafe { sys::lks_assets_add_scaled(self.0, asset, &factors, &mut name) })?;
        Ok(name)
    }
    /// The child of a compound that a part of an event or query belongs to; of a mesh also the triangle, else 0.
    pub fn find_part(&self, compound: u64, part: u32) -> Result<(u32, u32)> {
        let (mut child, mut triangle) = (0, 0);
        check(unsafe { sys::lks_assets_find_part(self.0, compound, part, &mut child, &mut triangle) })?;
        Ok((child, triangle))
    }
    /// Adds an asset from its canonical bytes.
    pub fn add_bytes(&mut self, bytes: &[u8]) -> Result<u64> {
        let mut name = 0;
        check(unsafe { sys::lks_assets_add_bytes(self.0, bytes.as_ptr().cast(), bytes.len(), &mut name) })?;
        Ok(name)
    }
}

impl Drop for Assets {
    fn drop(&mut self) {
        unsafe { sys::lks_assets_destroy(self.0) }
    }
}

/// The hash of a world and of its parts.
pub type Hashes = sys::lks_hashes;

/// A body with its pose and velocity.
#[derive(Clone, Copy)]
pub struct Placed {
    pub body: Body,
    pub pose: lks_pose,
    pub velocity: lks_i64x3,
}

/// A world of bodies and joints. Written by commands alone: on an error nothing has changed.
pub struct World(*mut sys::lks_world);

// One thread at a time uses it; queries may run on several.
unsafe impl Send for World {}

impl Drop for World {
    fn drop(&mut self) {
        unsafe { sys::lks_world_destroy(self.0) }
    }
}

fn pointer_to<T>(value: Option<&T>) -> *const T {
    value.map_or(ptr::null(), |value| value as *const T)
}

macro_rules! commands {
    ($($(#[$note:meta])* $name:ident($($argument:ident: $kind:ty => $pass:expr),*) = $c:ident;)*) => {
        $($(#[$note])*
        pub fn $name(&mut self, $($argument: $kind),*) -> Result<()> {
            check(unsafe { sys::$c(self.0, $($pass),*) })
        })*
    };
}

impl World {
    pub fn new(def: &WorldDef) -> Result<Self> {
        Self::create(def, ptr::null())
    }
    pub fn with_assets(def: &WorldDef, assets: &Assets) -> Result<Self> {
        Self::create(def, assets.0)
    }
    fn create(def: &WorldDef, assets: *const sys::lks_assets) -> Result<Self> {
        let mut world = ptr::null_mut();
        check(unsafe { sys::lks_world_create(&def.0, assets, &mut world) })?;
        Ok(World(world))
    }
    /// A built-in scene, which takes no command: its hashes are known.
    pub fn scene(name: &str, seed: u64) -> Result<Self> {
        let name = c_text(name)?;
        let mut world = ptr::null_mut();
        check(unsafe { sys::lks_world_create_scene(name.as_ptr(), seed, &mut world) })?;
        Ok(World(world))
    }
    /// Of the definition without assets: peers compare it before they play.
    pub fn config_hash(def: &WorldDef) -> Result<u64> {
        let mut hash = 0;
        check(unsafe { sys::lks_config_hash(&def.0, ptr::null(), &mut hash) })?;
        Ok(hash)
    }
    /// For functions of `sys` that are not wrapped here.
    pub fn as_ptr(&self) -> *mut sys::lks_world {
        self.0
    }

    pub fn set_threads(&mut self, threads: u32) -> Result<()> {
        check(unsafe { sys::lks_world_set_threads(self.0, threads) })
    }
    /// Remembers the last ticks, at most 256, so that stepping them again after `load` costs as much as differs.
    pub fn keep_history(&mut self, ticks: u32) -> Result<()> {
        check(unsafe { sys::lks_world_keep_history(self.0, ticks) })
    }
    pub fn forget_history(&mut self) -> Result<()> {
        check(unsafe { sys::lks_world_forget_history(self.0) })
    }
    pub fn step(&mut self) -> Result<lks_step_report> {
        let mut report = sized!(lks_step_report);
        check(unsafe { sys::lks_step(self.0, &mut report) })?;
        Ok(report)
    }
    pub fn tick(&self) -> u64 {
        let mut tick = 0;
        unsafe { sys::lks_tick(self.0, &mut tick) };
        tick
    }
    pub fn hash(&self) -> u64 {
        let mut hash = 0;
        unsafe { sys::lks_hash(self.0, &mut hash) };
        hash
    }
    pub fn part_hashes(&self) -> Hashes {
        let mut hashes = unsafe { std::mem::zeroed() };
        unsafe { sys::lks_part_hashes(self.0, &mut hashes) };
        hashes
    }

    pub fn create_body(&mut self, def: &BodyDef) -> Result<Body> {
        let mut body = 0;
        check(unsafe { sys::lks_create_body(self.0, &def.0, &mut body) })?;
        Ok(Body(body))
    }
    pub fn create_joint(&mut self, def: &JointDef) -> Result<Joint> {
        let mut joint = 0;
        check(unsafe { sys::lks_create_joint(self.0, &def.0, &mut joint) })?;
        Ok(Joint(joint))
    }
    /// Names a body for people: not state.
    pub fn set_name(&mut self, body: Body, name: &str) -> Result<()> {
        let name = c_text(name)?;
        check(unsafe { sys::lks_set_name(self.0, body.0, name.as_ptr()) })
    }

    commands! {
        destroy_body(body: Body => body.0) = lks_destroy_body;
        teleport(body: Body => body.0, pose: &lks_pose => pose) = lks_teleport;
        set_velocity(body: Body => body.0, velocity: lks_i64x3 => &velocity) = lks_set_velocity;
        set_angular_velocity(body: Body => body.0, velocity: lks_i64x3 => &velocity) = lks_set_angular_velocity;
        /// At the centre of mass.
        apply_impulse(body: Body => body.0, impulse: lks_i64x3 => &impulse, frame: Frame => frame as u32)
            = lks_apply_impulse;
        apply_impulse_at(body: Body => body.0, impulse: lks_i64x3 => &impulse, point: lks_i32x3 => &point,
                         frame: Frame => frame as u32) = lks_apply_impulse_at;
        apply_angular_impulse(body: Body => body.0, impulse: lks_i64x3 => &impulse, frame: Frame => frame as u32)
            = lks_apply_angular_impulse;
        /// Works over the coming tick.
        apply_force(body: Body => body.0, force: lks_i64x3 => &force, frame: Frame => frame as u32) = lks_apply_force;
        apply_force_at(body: Body => body.0, force: lks_i64x3 => &force, point: lks_i32x3 => &point,
                       frame: Frame => frame as u32) = lks_apply_force_at;
        apply_torque(body: Body => body.0, torque: lks_i64x3 => &torque, frame: Frame => frame as u32)
            = lks_apply_torque;
        move_kinematic(body: Body => body.0, pose: &lks_pose => pose) = lks_move_kinematic;
        set_material(body: Body => body.0, surface: &lks_surface => surface) = lks_set_material;
        set_surface_motion(body: Body => body.0, motion: &lks_surface_motion => motion) = lks_set_surface_motion;
        set_gravity_scale(body: Body => body.0, scale: lks_number => scale) = lks_set_gravity_scale;
        set_damping(body: Body => body.0, linear: lks_rate => linear, angular: lks_rate => angular) = lks_set_damping;
        set_axis_locks(body: Body => body.0, locks: u32 => locks) = lks_set_axis_locks;
        set_speed_limit(body: Body => body.0, linear: lks_velocity => linear, angular: lks_angular_velocity => angular)
            = lks_set_speed_limit;
        set_filter(body: Body => body.0, filter: &lks_filter => filter) = lks_set_filter;
        set_events(body: Body => body.0, events: u32 => events, hit_speed: lks_speed => hit_speed) = lks_set_events;
        set_user_data(body: Body => body.0, user_data: u64 => user_data) = lks_set_user_data;
        /// A body that becomes dynamic gets the mass; 0: that of its solid at 1000 kg/m³.
        set_motion_type(body: Body => body.0, motion: u32 => motion, mass: lks_mass => mass) = lks_set_motion_type;
        /// In the frame of the old shape; with mass 0 a dynamic body keeps its own.
        set_shape(body: Body => body.0, shape: &lks_shape => shape, mass: lks_mass => mass) = lks_set_shape;
        set_mass_data(body: Body => body.0, mass: lks_mass => mass, inertia: lks_i64x3 => &inertia)
            = lks_set_mass_data;
        set_enabled(body: Body => body.0, enabled: bool => enabled as u32) = lks_set_enabled;
        wake_body(body: Body => body.0) = lks_wake_body;
        sleep_body(body: Body => body.0) = lks_sleep_body;
        set_allow_sleep(body: Body => body.0, allow: bool => allow as u32) = lks_set_allow_sleep;
        set_gravity(gravity: lks_i64x3 => &gravity) = lks_set_gravity;
        /// The surface of all contacts between two tags; none takes the rule back.
        set_surface_rule(tag_a: u32 => tag_a, tag_b: u32 => tag_b, surface: Option<&sys::lks_pair_surface> => pointer_to(surface))
            = lks_set_surface_rule;
        /// Whether two bodies meet, and the surface of their contacts.
        set_pair_rule(a: Body => a.0, b: Body => b.0, collides: bool => collides as u32,
                      surface: Option<&sys::lks_pair_surface> => pointer_to(surface)) = lks_set_pair_rule;
        /// Lets a body stop others from its front alone; the direction is in the axes of its shape.
        set_one_way(body: Body => body.0, direction: sys::lks_i32x3 => &direction, tolerance: u32 => tolerance)
            = lks_set_one_way;
        /// Makes a dynamic body a chassis; none takes its wheels away.
        set_vehicle(chassis: Body => chassis.0, def: Option<&sys::lks_vehicle_def> => pointer_to(def)) = lks_set_vehicle;
        drive_vehicle(chassis: Body => chassis.0, controls: &sys::lks_vehicle_controls => controls) = lks_drive_vehicle;
        /// Fluid 0 … 15; density 0 removes it.
        set_fluid(number: u32 => number, fluid: &sys::lks_fluid => fluid) = lks_set_fluid;
        destroy_joint(joint: Joint => joint.0) = lks_destroy_joint;
        set_linear_axis(joint: Joint => joint.0, axis: u32 => axis, settings: &lks_axis => settings)
            = lks_set_linear_axis;
        set_angular_axis(joint: Joint => joint.0, axis: u32 => axis, settings: &lks_axis => settings)
            = lks_set_angular_axis;
    }

    pub fn exists(&self, body: Body) -> bool {
        let mut exists = 0;
        unsafe { sys::lks_body_exists(self.0, body.0, &mut exists) };
        exists == 1
    }
    pub fn body(&self, body: Body) -> Result<lks_body_view> {
        let mut view = sized!(lks_body_view);
        check(unsafe { sys::lks_body_get(self.0, body.0, &mut view) })?;
        Ok(view)
    }
    pub fn joint(&self, joint: Joint) -> Result<lks_joint_view> {
        let mut view = sized!(lks_joint_view);
        check(unsafe { sys::lks_joint_get(self.0, joint.0, &mut view) })?;
        Ok(view)
    }
    pub fn pose(&self, body: Body) -> Result<lks_pose> {
        let mut pose = unsafe { std::mem::zeroed() };
        check(unsafe { sys::lks_body_pose(self.0, body.0, &mut pose) })?;
        Ok(pose)
    }
    /// All bodies by ascending index.
    pub fn bodies(&self) -> Vec<Placed> {
        let mut count = 0;
        unsafe { sys::lks_bodies(self.0, ptr::null_mut(), ptr::null_mut(), ptr::null_mut(), 0, &mut count) };
        let mut names = vec![0_u64; count];
        let mut poses: Vec<lks_pose> = vec![unsafe { std::mem::zeroed() }; count];
        let mut velocities = vec![lks_i64x3 { x: 0, y: 0, z: 0 }; count];
        unsafe {
            sys::lks_bodies(self.0, names.as_mut_ptr(), poses.as_mut_ptr(), velocities.as_mut_ptr(), count, &mut count)
        };
        let placed = |i: usize| Placed { body: Body(names[i]), pose: poses[i], velocity: velocities[i] };
        (0..count).map(placed).collect()
    }
    /// Of the last step.
    pub fn events(&self) -> Vec<sys::lks_event> {
        let mut count = 0;
        unsafe { sys::lks_events(self.0, ptr::null_mut(), 0, &mut count) };
        let mut events: Vec<sys::lks_event> = vec![unsafe { std::mem::zeroed() }; count];
        unsafe { sys::lks_events(self.0, events.as_mut_ptr(), count, &mut count) };
        events
    }
    /// The impacts of the last step that were faster than a hit speed of their bodies.
    pub fn hit_events(&self) -> Vec<sys::lks_hit_event> {
        let mut count = 0;
        unsafe { sys::lks_hit_events(self.0, ptr::null_mut(), 0, &mut count) };
        let mut events: Vec<sys::lks_hit_event> = vec![unsafe { std::mem::zeroed() }; count];
        unsafe { sys::lks_hit_events(self.0, events.as_mut_ptr(), count, &mut count) };
        events
    }
    /// The joints that broke in the last step.
    pub fn joint_events(&self) -> Vec<lks_joint_event> {
        let mut count = 0;
        unsafe { sys::lks_joint_events(self.0, ptr::null_mut(), 0, &mut count) };
        let mut events: Vec<lks_joint_event> = vec![unsafe { std::mem::zeroed() }; count];
        unsafe { sys::lks_joint_events(self.0, events.as_mut_ptr(), count, &mut count) };
        events
    }
    pub fn touching(&self, a: Body, b: Body) -> Result<bool> {
        let mut touching = 0;
        check(unsafe { sys::lks_touching(self.0, a.0, b.0, &mut touching) })?;
        Ok(touching == 1)
    }

    /// The first body along the ray, if any.
    pub fn cast_ray(&self, origin: lks_i64x3, way: lks_i32x3, filter: &QueryFilter) -> Result<Option<lks_hit>> {
        let mut hit: lks_hit = unsafe { std::mem::zeroed() };
        check(unsafe { sys::lks_cast_ray(self.0, &origin, &way, &filter.0, &mut hit) })?;
        Ok(Some(hit).filter(|hit| hit.body != 0))
    }
    /// The first body that a shape meets on its way, if any.
    pub fn cast_shape(
        &self,
        shape: &lks_shape,
        start: &lks_pose,
        way: lks_i32x3,
        filter: &QueryFilter,
    ) -> Result<Option<lks_hit>> {
        let mut hit: lks_hit = unsafe { std::mem::zeroed() };
        check(unsafe { sys::lks_cast_shape(self.0, shape, start, &way, &filter.0, &mut hit) })?;
        Ok(Some(hit).filter(|hit| hit.body != 0))
    }
    /// The bodies that overlap the sphere, by ascending index.
    pub fn overlap_sphere(&self, centre: lks_i64x3, radius: lks_length, filter: &QueryFilter) -> Result<Vec<Body>> {
        list_bodies(|room, capacity, count| unsafe {
            sys::lks_overlap_sphere(self.0, &centre, radius, &filter.0, room, capacity, count)
        })
    }
    /// The bodies whose bounds along the world's axes overlap a box, by ascending index.
    pub fn bodies_in_box(&self, lower: lks_i64x3, upper: lks_i64x3, filter: &QueryFilter) -> Result<Vec<Body>> {
        list_bodies(|room, capacity, count| unsafe {
            sys::lks_bodies_in_box(self.0, &lower, &upper, &filter.0, room, capacity, count)
        })
    }

    pub fn snapshot_bytes_max(&self, kind: crate::Snapshot) -> usize {
        let mut bytes = 0;
        unsafe { sys::lks_snapshot_bytes_max(self.0, kind as u32, &mut bytes) };
        bytes
    }
    /// Writes the state; returns its bytes.
    pub fn save(&self, kind: crate::Snapshot, out: &mut [u8]) -> Result<usize> {
        let mut bytes = 0;
        check(unsafe { sys::lks_save(self.0, kind as u32, out.as_mut_ptr().cast(), out.len(), &mut bytes) })?;
        Ok(bytes)
    }
    /// Canonical bytes may come from anywhere. Native ones must be those that `save` wrote in this
    /// process: hence unsafe.
    ///
    /// # Safety
    /// Of native bytes: unchanged since `save` wrote them in this process.
    pub unsafe fn load(&mut self, kind: crate::Snapshot, bytes: &[u8]) -> Result<()> {
        check(sys::lks_load(self.0, kind as u32, bytes.as_ptr().cast(), bytes.len()))
    }
    /// The first difference between two canonical snapshots, for people.
    pub fn describe_difference(&self, here: &[u8], there: &[u8]) -> Result<Option<String>> {
        let mut text = [0; 512];
        let mut differs = 0;
        check(unsafe {
            sys::lks_describe_difference(
                self.0,
                here.as_ptr().cast(),
                here.len(),
                there.as_ptr().cast(),
                there.len(),
                &mut differs,
                text.as_mut_ptr(),
                text.len(),
            )
        })?;
        Ok((differs == 1).then(|| crate::error::text_in(&text)))
    }
}
