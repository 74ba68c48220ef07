// Written by tools/bindings/generate.py from the C headers, which document each declaration.
#![allow(non_camel_case_types)]
#![allow(clippy::all)]
#![cfg_attr(rustfmt, rustfmt_skip)]

use std::os::raw::{c_char, c_void};

pub type lks_status = i32;
pub type lks_body = u64;
pub type lks_joint = u64;
pub type lks_connection = u32;
pub type lks_position = i64;
pub type lks_velocity = i64;
pub type lks_angular_velocity = i64;
pub type lks_acceleration = i64;
pub type lks_mass = i64;
pub type lks_inertia = i64;
pub type lks_impulse = i64;
pub type lks_force = i64;
pub type lks_length = i32;
pub type lks_speed = i32;
pub type lks_displacement = i32;
pub type lks_unit = i32;
pub type lks_number = i32;
pub type lks_rate = i32;
pub type lks_angle = i32;
pub type lks_density = i32;
pub type lks_position3 = lks_i64x3;
pub type lks_velocity3 = lks_i64x3;
pub type lks_angular_velocity3 = lks_i64x3;
pub type lks_acceleration3 = lks_i64x3;
pub type lks_inertia3 = lks_i64x3;
pub type lks_impulse3 = lks_i64x3;
pub type lks_force3 = lks_i64x3;
pub type lks_length3 = lks_i32x3;
pub type lks_speed3 = lks_i32x3;
pub type lks_unit3 = lks_i32x3;
pub type lks_number3 = lks_i32x3;
pub type lks_rate3 = lks_i32x3;
pub type lks_angle3 = lks_i32x3;

pub const LKS_SPHERE: u32 = 0;
pub const LKS_CAPSULE: u32 = 1;
pub const LKS_BOX: u32 = 2;
pub const LKS_HULL: u32 = 3;
pub const LKS_HALF_SPACE: u32 = 4;
pub const LKS_MESH: u32 = 5;
pub const LKS_HEIGHT_FIELD: u32 = 6;
pub const LKS_COMPOUND: u32 = 7;
pub const LKS_CYLINDER: u32 = 8;
pub const LKS_CONE: u32 = 9;
pub const LKS_TAPERED_CAPSULE: u32 = 10;
pub const LKS_ROUNDED_BOX: u32 = 11;
pub const LKS_C_ABI: u32 = 0;
pub const LKS_OK: i32 = 0;
pub const LKS_CAPACITY_EXHAUSTED: i32 = 1;
pub const LKS_STALE_HANDLE: i32 = 2;
pub const LKS_INVALID_ARGUMENT: i32 = 3;
pub const LKS_TRUNCATED: i32 = 4;
pub const LKS_MALFORMED: i32 = 5;
pub const LKS_CHECKSUM_MISMATCH: i32 = 6;
pub const LKS_UNSUPPORTED_VERSION: i32 = 7;
pub const LKS_INCOMPATIBLE: i32 = 8;
pub const LKS_IO_ERROR: i32 = 9;
pub const LKS_NOT_FOUND: i32 = 10;
pub const LKS_NULL_ARGUMENT: i32 = 64;
pub const LKS_WRONG_SIZE: i32 = 65;
pub const LKS_BUFFER_TOO_SMALL: i32 = 66;
pub const LKS_READ_ONLY: i32 = 67;
pub const LKS_OUT_OF_MEMORY: i32 = 68;
pub const LKS_INTERNAL: i32 = 69;
pub const LKS_UNSUPPORTED: i32 = 70;
pub const LKS_STATIC: u32 = 1;
pub const LKS_KINEMATIC: u32 = 2;
pub const LKS_DYNAMIC: u32 = 3;
pub const LKS_FRAME_WORLD: u32 = 0;
pub const LKS_FRAME_BODY: u32 = 1;
pub const LKS_COMBINE_STANDARD: u32 = 0;
pub const LKS_COMBINE_AVERAGE: u32 = 1;
pub const LKS_COMBINE_GEOMETRIC_MEAN: u32 = 2;
pub const LKS_COMBINE_MINIMUM: u32 = 3;
pub const LKS_COMBINE_MULTIPLY: u32 = 4;
pub const LKS_COMBINE_MAXIMUM: u32 = 5;
pub const LKS_BODY_TRIGGER: u32 = 1;
pub const LKS_BODY_FIXED_ROTATION: u32 = 2;
pub const LKS_BODY_BULLET: u32 = 4;
pub const LKS_BODY_ALLOW_SLEEP: u32 = 8;
pub const LKS_BODY_ASLEEP: u32 = 16;
pub const LKS_BODY_DISABLED: u32 = 32;
pub const LKS_BODY_CONTACT_EVENTS: u32 = 1;
pub const LKS_BODY_PERSIST_EVENTS: u32 = 2;
pub const LKS_LOCK_MOVE_X: u32 = 1;
pub const LKS_LOCK_MOVE_Y: u32 = 2;
pub const LKS_LOCK_MOVE_Z: u32 = 4;
pub const LKS_LOCK_TURN_X: u32 = 8;
pub const LKS_LOCK_TURN_Y: u32 = 16;
pub const LKS_LOCK_TURN_Z: u32 = 32;
pub const LKS_CLIENT_CONNECTING: u32 = 0;
pub const LKS_CLIENT_HANDSHAKING: u32 = 1;
pub const LKS_CLIENT_LOBBY: u32 = 2;
pub const LKS_CLIENT_JOINING: u32 = 3;
pub const LKS_CLIENT_RUNNING: u32 = 4;
pub const LKS_CLIENT_FINISHED: u32 = 5;
pub const LKS_CLIENT_REFUSED: u32 = 6;
pub const LKS_CLIENT_FAILED: u32 = 7;
pub const LKS_CONTACT_BEGIN: u32 = 0;
pub const LKS_CONTACT_END: u32 = 1;
pub const LKS_TRIGGER_ENTER: u32 = 2;
pub const LKS_TRIGGER_STAY: u32 = 3;
pub const LKS_TRIGGER_EXIT: u32 = 4;
pub const LKS_IMPACT: u32 = 5;
pub const LKS_SLEEP: u32 = 6;
pub const LKS_WAKE: u32 = 7;
pub const LKS_CONTACT_PERSIST: u32 = 8;
pub const LKS_INPUT_RECEIVED: u32 = 0;
pub const LKS_INPUT_REPEATED: u32 = 1;
pub const LKS_INPUT_NEUTRAL: u32 = 2;
pub const LKS_INPUT_ABSENT: u32 = 3;
pub const LKS_LEVEL_DEBUG: u32 = 0;
pub const LKS_LEVEL_INFO: u32 = 1;
pub const LKS_LEVEL_WARNING: u32 = 2;
pub const LKS_LEVEL_ERROR: u32 = 3;
pub const LKS_JOINT_DISTANCE: u32 = 1;
pub const LKS_JOINT_BALL: u32 = 2;
pub const LKS_JOINT_HINGE: u32 = 3;
pub const LKS_JOINT_SLIDER: u32 = 4;
pub const LKS_JOINT_WELD: u32 = 5;
pub const LKS_JOINT_WHEEL: u32 = 6;
pub const LKS_JOINT_MOTOR: u32 = 7;
pub const LKS_JOINT_SIX_AXIS: u32 = 8;
pub const LKS_JOINT_PULLEY: u32 = 9;
pub const LKS_JOINT_GEAR: u32 = 10;
pub const LKS_JOINT_RACK: u32 = 11;
pub const LKS_JOINT_RATCHET: u32 = 12;
pub const LKS_JOINT_PATH: u32 = 13;
pub const LKS_AXIS_LOCKED: u32 = 0;
pub const LKS_AXIS_FREE: u32 = 1;
pub const LKS_AXIS_LIMITED: u32 = 2;
pub const LKS_LOG_SAME: u32 = 0;
pub const LKS_LOG_DIVERGED: u32 = 1;
pub const LKS_LOG_CORRUPT: u32 = 2;
pub const LKS_LOG_INCOMPATIBLE: u32 = 3;
pub const LKS_FILTER_BODIES: u32 = 16;
pub const LKS_MAX_BONES: u32 = 64;
pub const LKS_NO_BONE: u32 = 4294967295;
pub const LKS_BONE_LIMP: u32 = 0;
pub const LKS_BONE_SPRUNG: u32 = 1;
pub const LKS_BONE_DRIVEN: u32 = 2;
pub const LKS_BONE_KINEMATIC: u32 = 3;
pub const LKS_SERVER_LOBBY: u32 = 0;
pub const LKS_SERVER_RUNNING: u32 = 1;
pub const LKS_SERVER_FINISHING: u32 = 2;
pub const LKS_SERVER_CLOSING: u32 = 3;
pub const LKS_SERVER_OVER: u32 = 4;
pub const LKS_LATE_DEADLINE: u32 = 0;
pub const LKS_LATE_STRICT: u32 = 1;
pub const LKS_SUBSTITUTE_REPEAT: u32 = 0;
pub const LKS_SUBSTITUTE_NEUTRAL: u32 = 1;
pub const LKS_PACING_REAL_TIME: u32 = 0;
pub const LKS_PACING_FAST: u32 = 1;
pub const LKS_DESYNC_END: u32 = 0;
pub const LKS_DESYNC_KICK: u32 = 1;
pub const LKS_DESYNC_RESYNC: u32 = 2;
pub const LKS_NO_SLOT: u32 = 255;
pub const LKS_SPECTATOR_SLOT: u32 = 254;
pub const LKS_SERVER_SLOT: u32 = 253;
pub const LKS_SESSION_STARTED: u32 = 1;
pub const LKS_SESSION_TICK: u32 = 2;
pub const LKS_SESSION_FINISHED: u32 = 3;
pub const LKS_SESSION_DESYNC: u32 = 4;
pub const LKS_SESSION_SILENT: u32 = 5;
pub const LKS_SESSION_JOINED: u32 = 6;
pub const LKS_SESSION_PLAYER_ACTIVE: u32 = 7;
pub const LKS_SESSION_NAMED: u32 = 8;
pub const LKS_SESSION_COMMAND: u32 = 9;
pub const LKS_SESSION_LEFT: u32 = 16;
pub const LKS_SESSION_REFUSED: u32 = 17;
pub const LKS_SESSION_ASKED: u32 = 18;
pub const LKS_SESSION_STATE_LOADED: u32 = 32;
pub const LKS_SESSION_PAUSED: u32 = 33;
pub const LKS_SESSION_INPUT_REPLACED: u32 = 34;
pub const LKS_SESSION_PREDICTED: u32 = 35;
pub const LKS_SESSION_ROLLED_BACK: u32 = 36;
pub const LKS_SESSION_COMMAND_REFUSED: u32 = 37;
pub const LKS_ASK_PAUSE: u32 = 0;
pub const LKS_ASK_RESUME: u32 = 1;
pub const LKS_ASK_VOTE: u32 = 2;
pub const LKS_FINISH_COMPLETED: u32 = 0;
pub const LKS_FINISH_STOPPED: u32 = 1;
pub const LKS_FINISH_DESYNC: u32 = 2;
pub const LKS_FINISH_NO_PLAYERS: u32 = 3;
pub const LKS_NATIVE: u32 = 0;
pub const LKS_CANONICAL: u32 = 1;
pub const LKS_POSITION_BITS: i32 = 32;
pub const LKS_VELOCITY_BITS: i32 = 32;
pub const LKS_ANGULAR_VELOCITY_BITS: i32 = 32;
pub const LKS_ACCELERATION_BITS: i32 = 32;
pub const LKS_MASS_BITS: i32 = 32;
pub const LKS_IMPULSE_BITS: i32 = 24;
pub const LKS_FORCE_BITS: i32 = 20;
pub const LKS_LENGTH_BITS: i32 = 20;
pub const LKS_SPEED_BITS: i32 = 20;
pub const LKS_DISPLACEMENT_BITS: i32 = 24;
pub const LKS_UNIT_BITS: i32 = 30;
pub const LKS_NUMBER_BITS: i32 = 20;
pub const LKS_RATE_BITS: i32 = 20;
pub const LKS_ANGLE_BITS: i32 = 27;
pub const LKS_DENSITY_BITS: i32 = 8;
pub const LKS_INERTIA_BITS: i32 = 28;
pub const LKS_WHEEL_RAY: u32 = 0;
pub const LKS_WHEEL_SPHERE: u32 = 1;
pub const LKS_VEHICLE_CAR: u32 = 0;
pub const LKS_VEHICLE_MOTORCYCLE: u32 = 1;
pub const LKS_VEHICLE_TRACKED: u32 = 2;
pub const LKS_MAX_HISTORY_TICKS: u32 = 256;
pub const LOCKSTONE_GAME_ABI: u32 = 1;
pub const LOCKSTONE_GAME_MAX_PARTS: u32 = 8;
pub const LOCKSTONE_GAME_TEXT_BYTES: u32 = 96;
pub const LOCKSTONE_GAME_OK: i32 = 0;
pub const LOCKSTONE_GAME_CAPACITY_EXHAUSTED: i32 = 1;
pub const LOCKSTONE_GAME_INVALID_ARGUMENT: i32 = 3;
pub const LOCKSTONE_GAME_TRUNCATED: i32 = 4;
pub const LOCKSTONE_GAME_MALFORMED: i32 = 5;
pub const LOCKSTONE_GAME_UNSUPPORTED_VERSION: i32 = 7;
pub const LOCKSTONE_GAME_INCOMPATIBLE: i32 = 8;
pub const LOCKSTONE_GAME_NOT_FOUND: i32 = 10;
pub const LOCKSTONE_GAME_NATIVE: u32 = 0;
pub const LOCKSTONE_GAME_CANONICAL: u32 = 1;

#[repr(C)]
pub struct lks_assets {
    _private: [u8; 0],
}
#[repr(C)]
pub struct lks_client {
    _private: [u8; 0],
}
#[repr(C)]
pub struct lks_game {
    _private: [u8; 0],
}
#[repr(C)]
pub struct lks_simulation {
    _private: [u8; 0],
}
#[repr(C)]
pub struct lks_log {
    _private: [u8; 0],
}
#[repr(C)]
pub struct lks_recorder {
    _private: [u8; 0],
}
#[repr(C)]
pub struct lks_server {
    _private: [u8; 0],
}
#[repr(C)]
pub struct lks_transport {
    _private: [u8; 0],
}
#[repr(C)]
pub struct lks_network {
    _private: [u8; 0],
}
#[repr(C)]
pub struct lks_world {
    _private: [u8; 0],
}

pub type lks_sample_function = Option<unsafe extern "C" fn(user: *mut c_void, tick: u64, out: *mut u8, bytes: usize)>;
pub type lks_predict_function = Option<unsafe extern "C" fn(user: *mut c_void, tick: u64, slot: u32, out: *mut u8, bytes: usize)>;
pub type lks_allocate_function = Option<unsafe extern "C" fn(user: *mut c_void, bytes: usize, alignment: usize) -> *mut c_void>;
pub type lks_release_function = Option<unsafe extern "C" fn(user: *mut c_void, memory: *mut c_void, bytes: usize, alignment: usize)>;
pub type lks_log_function = Option<unsafe extern "C" fn(user: *mut c_void, level: u32, text: *const c_char)>;

#[repr(C)]
#[derive(Clone, Copy)]
pub struct lks_shape {
    pub kind: u32,
    pub size: lks_length3,
    pub asset: u64,
}
#[repr(C)]
#[derive(Clone, Copy)]
pub struct lks_path_point {
    pub position: lks_length3,
    pub up: lks_unit3,
}
#[repr(C)]
#[derive(Clone, Copy)]
pub struct lks_placed_shape {
    pub shape: lks_shape,
    pub pose: lks_pose,
}
#[repr(C)]
#[derive(Clone, Copy)]
pub struct lks_shape_gap {
    pub distance: lks_position,
    pub point_a: lks_position3,
    pub point_b: lks_position3,
    pub normal: lks_unit3,
    pub part_a: u32,
    pub part_b: u32,
    pub found: u32,
    pub overlapping: u32,
    pub reserved: u32,
}
#[repr(C)]
#[derive(Clone, Copy)]
pub struct lks_shape_hit {
    pub point_a: lks_position3,
    pub fraction: lks_unit,
    pub normal: lks_unit3,
    pub part_a: u32,
    pub part_b: u32,
    pub hit: u32,
    pub overlapping: u32,
}
#[repr(C)]
#[derive(Clone, Copy)]
pub struct lks_surface {
    pub friction: lks_unit,
    pub restitution: lks_unit,
    pub rolling_resistance: lks_unit,
    pub friction_rule: u32,
    pub restitution_rule: u32,
    pub rolling_rule: u32,
    pub tag: u32,
}
#[repr(C)]
#[derive(Clone, Copy)]
pub struct lks_surface_motion {
    pub velocity: lks_speed3,
    pub turning: lks_rate3,
}
#[repr(C)]
#[derive(Clone, Copy)]
pub struct lks_filter {
    pub category: u32,
    pub mask: u32,
    pub group: i32,
}
#[repr(C)]
#[derive(Clone, Copy)]
pub struct lks_body_def {
    pub size: u32,
    pub motion: u32,
    pub shape: lks_shape,
    pub position: lks_position3,
    pub velocity: lks_velocity3,
    pub angular_velocity: lks_angular_velocity3,
    pub orientation: lks_quat,
    pub surface: lks_surface,
    pub density: lks_density,
    pub surface_motion: lks_surface_motion,
    pub filter: lks_filter,
    pub gravity_scale: lks_number,
    pub linear_damping: lks_rate,
    pub angular_damping: lks_rate,
    pub flags: u32,
    pub locks: u32,
    pub speed_limit: lks_velocity,
    pub angular_speed_limit: lks_angular_velocity,
    pub user_data: u64,
    pub events: u32,
    pub hit_speed: lks_speed,
    pub mass: lks_mass,
    pub inertia: lks_inertia3,
}
#[repr(C)]
#[derive(Clone, Copy)]
pub struct lks_body_view {
    pub size: u32,
    pub motion: u32,
    pub shape: lks_shape,
    pub position: lks_position3,
    pub centre_of_mass: lks_position3,
    pub velocity: lks_velocity3,
    pub angular_velocity: lks_angular_velocity3,
    pub orientation: lks_quat,
    pub surface: lks_surface,
    pub filter: lks_filter,
    pub flags: u32,
    pub locks: u32,
    pub mass: lks_mass,
    pub user_data: u64,
    pub events: u32,
    pub hit_speed: lks_speed,
    pub inertia: lks_inertia3,
    pub principal_axes: lks_quat,
    pub surface_motion: lks_surface_motion,
    pub gravity_scale: lks_number,
    pub linear_damping: lks_rate,
    pub angular_damping: lks_rate,
    pub reserved: u32,
    pub speed_limit: lks_velocity,
    pub angular_speed_limit: lks_angular_velocity,
}
#[repr(C)]
#[derive(Clone, Copy)]
pub struct lks_fluid {
    pub size: u32,
    pub mask: u32,
    pub surface: lks_position3,
    pub extents: lks_position3,
    pub flow: lks_velocity3,
    pub orientation: lks_quat,
    pub density: lks_density,
    pub drag: lks_number,
    pub linear_drag: lks_rate,
    pub reserved: u32,
}
#[repr(C)]
#[derive(Clone, Copy)]
pub struct lks_pair_surface {
    pub friction: lks_unit,
    pub restitution: lks_unit,
    pub rolling_resistance: lks_unit,
}
#[repr(C)]
#[derive(Clone, Copy)]
pub struct lks_client_def {
    pub size: u32,
    pub insecure: u32,
    pub wanted_slot: u32,
    pub prediction_ticks: u32,
    pub prediction_delay_ticks: u32,
    pub sync_test: u32,
    pub history_ticks: u32,
    pub snapshot_ticks: u32,
    pub adapt_lead: u32,
    pub play_out_evenly: u32,
    pub rejoin_key: u64,
    pub handshake_us: i64,
    pub drop_us: i64,
    pub name: [c_char; 40],
    pub build: [c_char; 72],
}
#[repr(C)]
#[derive(Clone, Copy)]
pub struct lks_client_view {
    pub size: u32,
    pub state: u32,
    pub ticks_stepped: u64,
    pub ticks_predicted: u64,
    pub rejoin_key: u64,
    pub slot: u32,
    pub finish_reason: u32,
    pub may_reconnect: u32,
    pub paused: u32,
    pub waiting_mask: u32,
    pub reserved: u32,
    pub waiting: u64,
}
#[repr(C)]
#[derive(Clone, Copy)]
pub struct lks_event {
    pub kind: u32,
    pub reserved: u32,
    pub a: lks_body,
    pub b: lks_body,
    pub approach_speed: lks_velocity,
    pub tag_a: u32,
    pub tag_b: u32,
}
#[repr(C)]
#[derive(Clone, Copy)]
pub struct lks_hit_event {
    pub a: lks_body,
    pub b: lks_body,
    pub point: lks_position3,
    pub normal_impulse: lks_impulse,
    pub friction_impulse: lks_impulse3,
    pub approach_speed: lks_velocity,
    pub normal: lks_unit3,
    pub was_stopped: u32,
    pub part_a: u32,
    pub part_b: u32,
    pub tag_a: u32,
    pub tag_b: u32,
}
#[repr(C)]
#[derive(Clone, Copy)]
pub struct lks_joint_event {
    pub joint: lks_joint,
    pub a: lks_body,
    pub b: lks_body,
    pub user_data: u64,
}
#[repr(C)]
#[derive(Clone, Copy)]
pub struct lks_touching_point {
    pub point: lks_position3,
    pub normal_force: lks_force,
    pub separation: lks_displacement,
    pub reserved: u32,
}
#[repr(C)]
#[derive(Clone, Copy)]
pub struct lks_body_contact {
    pub other: lks_body,
    pub points: [lks_touching_point; 4],
    pub normal_force: lks_force,
    pub friction: lks_force3,
    pub normal: lks_unit3,
    pub count: u32,
    pub part: u32,
    pub other_part: u32,
    pub tag: u32,
    pub other_tag: u32,
}
#[repr(C)]
#[derive(Clone, Copy)]
pub struct lks_simulation_info {
    pub config_hash: u64,
    pub scene_hash: u64,
    pub canary: u64,
    pub abi: u32,
    pub tick_rate: u32,
    pub player_count: u32,
    pub input_bytes: u32,
}
#[repr(C)]
#[derive(Clone, Copy)]
pub struct lks_axis {
    pub mode: u32,
    pub lower: i32,
    pub upper: i32,
    pub target: i32,
    pub speed: i32,
    pub hertz: lks_number,
    pub damping_ratio: lks_number,
    pub reserved: u32,
    pub max_effort: lks_force,
}
#[repr(C)]
#[derive(Clone, Copy)]
pub struct lks_joint_frame {
    pub position: lks_length3,
    pub orientation: lks_quat,
}
#[repr(C)]
#[derive(Clone, Copy)]
pub struct lks_joint_def {
    pub size: u32,
    pub kind: u32,
    pub body_a: lks_body,
    pub body_b: lks_body,
    pub frame_a: lks_joint_frame,
    pub frame_b: lks_joint_frame,
    pub linear: [lks_axis; 3],
    pub angular: [lks_axis; 3],
    pub ground_a: lks_position3,
    pub ground_b: lks_position3,
    pub ratio: lks_number,
    pub collide: u32,
    pub break_force: lks_force,
    pub break_torque: lks_force,
    pub user_data: u64,
    pub path: u64,
}
#[repr(C)]
#[derive(Clone, Copy)]
pub struct lks_joint_view {
    pub size: u32,
    pub kind: u32,
    pub body_a: lks_body,
    pub body_b: lks_body,
    pub user_data: u64,
    pub offset: lks_length3,
    pub angle: lks_angle3,
    pub force: lks_force3,
    pub torque: lks_force3,
}
#[repr(C)]
#[derive(Clone, Copy)]
pub struct lks_log_report {
    pub size: u32,
    pub outcome: u32,
    pub start_tick: u64,
    pub ticks_verified: u64,
    pub final_hash: u64,
    pub diverged_tick: u64,
    pub expected: u64,
    pub actual: u64,
    pub complete: u32,
    pub torn_tail: u32,
    pub line: [c_char; 512],
}
#[repr(C)]
#[derive(Clone, Copy)]
pub struct lks_log_info {
    pub size: u32,
    pub complete: u32,
    pub torn_tail: u32,
    pub damaged: u32,
    pub simulation: lks_simulation_info,
    pub match_id: u64,
    pub seed: u64,
    pub start_tick: u64,
    pub ticks: u64,
    pub last_hash: u64,
    pub keyframes: u64,
    pub game: [c_char; 72],
    pub game_version: [c_char; 72],
    pub build: [c_char; 136],
    pub end_reason: [c_char; 264],
}
#[repr(C)]
#[derive(Clone, Copy)]
pub struct lks_bisect_report {
    pub size: u32,
    pub found: u32,
    pub tick: u64,
    pub hash_here: u64,
    pub hash_there: u64,
    pub difference_tick: u64,
    pub in_inputs: u32,
    pub slot: u32,
    pub line: [c_char; 512],
}
#[repr(C)]
#[derive(Clone, Copy)]
pub struct lks_query_filter {
    pub size: u32,
    pub mask: u32,
    pub ignore: lks_body,
    pub triggers: u32,
    pub only_listed: u32,
    pub tag_mask: u32,
    pub tag: u32,
    pub listed_count: u32,
    pub reserved: u32,
    pub listed: [lks_body; 16],
}
#[repr(C)]
#[derive(Clone, Copy)]
pub struct lks_hit {
    pub body: lks_body,
    pub fraction: lks_unit,
    pub normal: lks_unit3,
    pub point: lks_position3,
    pub part: u32,
    pub reserved: u32,
}
#[repr(C)]
#[derive(Clone, Copy)]
pub struct lks_closest {
    pub body: lks_body,
    pub point: lks_position3,
    pub distance: lks_length,
    pub part: u32,
}
#[repr(C)]
#[derive(Clone, Copy)]
pub struct lks_bone {
    pub parent: u32,
    pub joint: u32,
    pub shape: lks_shape,
    pub pose: lks_pose,
    pub joint_frame: lks_pose,
    pub mass: lks_mass,
    pub friction: lks_force,
    pub surface: lks_surface,
    pub density: lks_density,
    pub min_twist: lks_angle,
    pub max_twist: lks_angle,
    pub max_swing: lks_angle,
    pub reserved: u32,
}
#[repr(C)]
#[derive(Clone, Copy)]
pub struct lks_ragdoll_def {
    pub size: u32,
    pub filter: lks_filter,
    pub user_data: u64,
}
#[repr(C)]
#[derive(Clone, Copy)]
pub struct lks_ragdoll_pose {
    pub root: lks_pose,
    pub turns: [lks_quat; 64],
}
#[repr(C)]
#[derive(Clone, Copy)]
pub struct lks_ragdoll {
    pub size: u32,
    pub bone_count: u32,
    pub bodies: [lks_body; 64],
    pub joints: [lks_joint; 64],
    pub masses: [lks_mass; 64],
}
#[repr(C)]
#[derive(Clone, Copy)]
pub struct lks_bone_drive {
    pub mode: u32,
    pub hertz: lks_number,
    pub damping_ratio: lks_number,
    pub reserved: u32,
    pub max_torque: lks_force,
}
#[repr(C)]
#[derive(Clone, Copy)]
pub struct lks_drag {
    pub size: u32,
    pub point: lks_length3,
    pub ground: lks_body,
    pub body: lks_body,
    pub hertz: lks_number,
    pub damping_ratio: lks_number,
    pub max_force: lks_force,
}
#[repr(C)]
#[derive(Clone, Copy)]
pub struct lks_recorder_def {
    pub size: u32,
    pub keyframe_interval_ticks: u32,
    pub match_id: u64,
    pub seed: u64,
    pub compress: u32,
    pub replace: u32,
    pub build: [c_char; 136],
}
#[repr(C)]
#[derive(Clone, Copy)]
pub struct lks_server_def {
    pub size: u32,
    pub insecure: u32,
    pub relay: u32,
    pub input_delay_ticks: u32,
    pub late_policy: u32,
    pub substitute: u32,
    pub pacing: u32,
    pub desync_policy: u32,
    pub history_ticks: u32,
    pub snapshot_ticks: u32,
    pub late_join: u32,
    pub start_players: u32,
    pub max_spectators: u32,
    pub spectator_delay_ticks: u32,
    pub tick_count: u64,
    pub rejoin_seed: u64,
    pub drop_us: i64,
    pub rejoin_us: i64,
    pub command_bytes_max: u32,
    pub commands_per_second: u32,
    pub command_bytes_per_second: u32,
    pub reserved: u32,
}
#[repr(C)]
#[derive(Clone, Copy)]
pub struct lks_server_view {
    pub size: u32,
    pub state: u32,
    pub ticks_closed: u64,
    pub finish_reason: u32,
    pub present_mask: u32,
    pub waiting_mask: u32,
    pub spectators: u32,
    pub paused: u32,
    pub reserved: u32,
    pub present: u64,
    pub waiting: u64,
}
#[repr(C)]
#[derive(Clone, Copy)]
pub struct lks_session_event {
    pub kind: u32,
    pub slot: u32,
    pub tick: u64,
    pub hash: u64,
    pub other_hash: u64,
    pub value: i64,
    pub reason: u32,
    pub reserved: u32,
}
#[repr(C)]
#[derive(Clone, Copy)]
pub struct lks_session_stats {
    pub size: u32,
    pub margin_quarters: i32,
    pub bytes_sent: u64,
    pub bytes_received: u64,
    pub packets_sent: u64,
    pub packets_received: u64,
    pub round_trip_us: i64,
    pub substituted_inputs: u64,
    pub malformed_packets: u64,
    pub hashes_compared: u64,
    pub hashes_equal: u64,
    pub rollbacks: u64,
    pub ticks_stepped_again: u64,
    pub states_loaded: u64,
    pub commands_taken: u64,
    pub commands_refused: u64,
    pub islands_computed_again: u64,
    pub islands_recalled: u64,
    pub jitter_us: i64,
}
#[repr(C)]
#[derive(Clone, Copy)]
pub struct lks_hashes {
    pub total: u64,
    pub header: u64,
    pub bodies: u64,
    pub contacts: u64,
    pub joints: u64,
}
#[repr(C)]
#[derive(Clone, Copy)]
pub struct lks_height_rectangle {
    pub column: u32,
    pub row: u32,
    pub columns: u32,
    pub rows: u32,
}
#[repr(C)]
#[derive(Clone, Copy)]
pub struct lks_enet_def {
    pub size: u32,
    pub port: u32,
    pub max_connections: u32,
    pub max_connections_per_address: u32,
    pub unlimited: u32,
    pub timeout_ms: u32,
    pub match_id: u64,
}
#[repr(C)]
#[derive(Clone, Copy)]
pub struct lks_link_faults {
    pub size: u32,
    pub loss_ppm: u32,
    pub duplicate_ppm: u32,
    pub reorder_ppm: u32,
    pub delay_us: i64,
    pub jitter_us: i64,
}
#[repr(C)]
#[derive(Clone, Copy)]
pub struct lks_i64x3 {
    pub x: i64,
    pub y: i64,
    pub z: i64,
}
#[repr(C)]
#[derive(Clone, Copy)]
pub struct lks_i32x3 {
    pub x: i32,
    pub y: i32,
    pub z: i32,
}
#[repr(C)]
#[derive(Clone, Copy)]
pub struct lks_quat {
    pub x: lks_unit,
    pub y: lks_unit,
    pub z: lks_unit,
    pub w: lks_unit,
}
#[repr(C)]
#[derive(Clone, Copy)]
pub struct lks_pose {
    pub position: lks_position3,
    pub orientation: lks_quat,
}
#[repr(C)]
#[derive(Clone, Copy)]
pub struct lks_axle {
    pub mount: lks_length3,
    pub half_track: lks_length,
    pub radius: lks_length,
    pub travel: lks_length,
    pub frequency: lks_number,
    pub damping_ratio: lks_number,
    pub anti_roll: lks_number,
    pub max_steer: lks_angle,
    pub drive: lks_unit,
    pub friction: lks_unit,
    pub brake: lks_force,
    pub handbrake: lks_force,
    pub differential_lock: lks_force,
}
#[repr(C)]
#[derive(Clone, Copy)]
pub struct lks_vehicle_def {
    pub size: u32,
    pub axle_count: u32,
    pub axles: [lks_axle; 3],
    pub peak_slip: lks_unit,
    pub peak_angle: lks_unit,
    pub relaxation: lks_length,
    pub rolling_resistance: lks_unit,
    pub torque: [lks_force; 8],
    pub idle_speed: lks_angular_velocity,
    pub max_speed: lks_angular_velocity,
    pub engine_inertia: lks_inertia,
    pub engine_friction: lks_force,
    pub ratios: [lks_number; 8],
    pub reverse: lks_number,
    pub final_drive: lks_number,
    pub automatic: u32,
    pub shift_ticks: u32,
    pub shift_up: lks_angular_velocity,
    pub shift_down: lks_angular_velocity,
    pub clutch: lks_force,
    pub wheel_inertia: lks_inertia,
    pub cast: u32,
    pub mask: u32,
    pub kind: u32,
    pub max_lean: lks_angle,
}
#[repr(C)]
#[derive(Clone, Copy)]
pub struct lks_vehicle_controls {
    pub size: u32,
    pub gear: i32,
    pub throttle: lks_unit,
    pub brake: lks_unit,
    pub handbrake: lks_unit,
    pub steer: lks_unit,
    pub clutch: lks_unit,
    pub reserved: u32,
}
#[repr(C)]
#[derive(Clone, Copy)]
pub struct lks_wheel_view {
    pub centre: lks_position3,
    pub spin: lks_angular_velocity,
    pub load: lks_force,
    pub compression: lks_length,
    pub steer_sin: lks_unit,
    pub is_grounded: u32,
    pub reserved: u32,
}
#[repr(C)]
#[derive(Clone, Copy)]
pub struct lks_vehicle_view {
    pub size: u32,
    pub gear: i32,
    pub engine_speed: lks_angular_velocity,
    pub wheel_count: u32,
    pub lean: lks_angle,
    pub wheels: [lks_wheel_view; 6],
}
#[repr(C)]
#[derive(Clone, Copy)]
pub struct lks_world_def {
    pub size: u32,
    pub body_capacity: u32,
    pub pair_capacity: u32,
    pub contact_capacity: u32,
    pub joint_capacity: u32,
    pub tick_rate: u32,
    pub substeps: u32,
    pub sleep_ms: u32,
    pub sleep_distance: lks_length,
    pub broad_phase: u32,
    pub gravity: lks_acceleration3,
    pub speed_limit: lks_velocity,
    pub converged_contacts: u32,
    pub vehicle_capacity: u32,
    pub terrain_tile_capacity: u32,
    pub reserved: u32,
}
#[repr(C)]
#[derive(Clone, Copy)]
pub struct lks_step_report {
    pub size: u32,
    pub status: lks_status,
    pub moving_bodies: u32,
    pub asleep_bodies: u32,
    pub islands: u32,
    pub free_bodies: u32,
    pub axis_turns: u32,
    pub pairs: u32,
    pub contacts: u32,
    pub contact_points: u32,
    pub colors: u32,
    pub overflow_contacts: u32,
    pub continuous_bodies: u32,
    pub impacts: u32,
    pub saturations: u32,
    pub energy_limits: u32,
    pub computed_islands: u32,
    pub recalled_islands: u32,
    pub still_bodies: u32,
    pub still_contacts: u32,
}
#[repr(C)]
#[derive(Clone, Copy)]
pub struct lockstone_game_info {
    pub config_hash: u64,
    pub scene_hash: u64,
    pub canary: u64,
    pub abi: u32,
    pub tick_rate: u16,
    pub player_count: u8,
    pub input_bytes: u8,
}
#[repr(C)]
#[derive(Clone, Copy)]
pub struct lockstone_game_input {
    pub bytes: *const u8,
    pub origin: u32,
}
#[repr(C)]
#[derive(Clone, Copy)]
pub struct lockstone_game_hash {
    pub name: *const c_char,
    pub low: u64,
    pub high: u64,
}
#[repr(C)]
#[derive(Clone, Copy)]
pub struct lockstone_game_difference {
    pub object: u64,
    pub store: [c_char; 96],
    pub name: [c_char; 96],
    pub field: [c_char; 96],
    pub here: [c_char; 96],
    pub there: [c_char; 96],
}
#[repr(C)]
#[derive(Clone, Copy)]
pub struct lockstone_game_scene {
    pub name: *const c_char,
    pub description: *const c_char,
    pub ticks: u32,
}
#[repr(C)]
#[derive(Clone, Copy)]
pub struct lockstone_game_request {
    pub scene: *const c_char,
    pub seed: u64,
    pub bodies: i64,
    pub players: u32,
}
#[repr(C)]
#[derive(Clone, Copy)]
pub struct lockstone_game_table {
    pub abi: u32,
    pub bytes: u32,
    pub name: *const c_char,
    pub version: *const c_char,
    pub build: *const c_char,
    pub create: Option<unsafe extern "C" fn(*const u8, usize, *mut *mut c_void) -> i32>,
    pub destroy: Option<unsafe extern "C" fn(*mut c_void)>,
    pub info: Option<unsafe extern "C" fn(*const c_void, *mut lockstone_game_info)>,
    pub tick: Option<unsafe extern "C" fn(*const c_void) -> u64>,
    pub step: Option<unsafe extern "C" fn(*mut c_void, *const lockstone_game_input, usize)>,
    pub snapshot_bytes_max: Option<unsafe extern "C" fn(*const c_void, u32) -> usize>,
    pub save: Option<unsafe extern "C" fn(*const c_void, u32, *mut u8, usize) -> usize>,
    pub load: Option<unsafe extern "C" fn(*mut c_void, u32, *const u8, usize) -> i32>,
    pub hash: Option<unsafe extern "C" fn(*const c_void) -> u64>,
    pub part_hashes: Option<unsafe extern "C" fn(*const c_void, *mut lockstone_game_hash) -> usize>,
    pub describe: Option<unsafe extern "C" fn(*const c_void, *const u8, usize, *const u8, usize, *mut lockstone_game_difference) -> i32>,
    pub configure: Option<unsafe extern "C" fn(*const lockstone_game_request, *mut u8, *mut usize) -> i32>,
    pub bot: Option<unsafe extern "C" fn(*const c_void, u64, u32, u64, *mut u8) -> i32>,
    pub step_traced: Option<unsafe extern "C" fn(*mut c_void, *const lockstone_game_input, usize, *mut lockstone_game_hash, usize) -> usize>,
    pub draw: Option<unsafe extern "C" fn(*const c_void, *mut c_char, usize) -> usize>,
    pub scenes: *const lockstone_game_scene,
    pub scene_count: usize,
    pub keep_history: Option<unsafe extern "C" fn(*mut c_void, u32)>,
    pub forget_history: Option<unsafe extern "C" fn(*mut c_void)>,
    pub command: Option<unsafe extern "C" fn(*mut c_void, u32, *const u8, usize)>,
}

extern "C" {
    pub fn lks_fit(kind: u32, points: *const lks_length3, count: usize, shape: *mut lks_shape, pose: *mut lks_pose) -> lks_status;
    pub fn lks_assets_create(out: *mut *mut lks_assets) -> lks_status;
    pub fn lks_assets_destroy(assets: *mut lks_assets);
    pub fn lks_assets_add_hull(assets: *mut lks_assets, points: *const lks_length3, count: usize, max_vertices: i32, out: *mut u64) -> lks_status;
    pub fn lks_assets_add_path(assets: *mut lks_assets, points: *const lks_path_point, count: usize, closed: u32, out: *mut u64) -> lks_status;
    pub fn lks_assets_add_banked_path(assets: *mut lks_assets, points: *const lks_path_point, banks: *const lks_angle, count: usize, closed: u32, out: *mut u64) -> lks_status;
    pub fn lks_assets_add_rounded_hull(assets: *mut lks_assets, points: *const lks_length3, count: usize, max_vertices: i32, radius: lks_length, out: *mut u64) -> lks_status;
    pub fn lks_assets_add_bytes(assets: *mut lks_assets, bytes: *const c_void, count: usize, out: *mut u64) -> lks_status;
    pub fn lks_assets_find_part(assets: *const lks_assets, compound: u64, part: u32, child: *mut u32, triangle: *mut u32) -> lks_status;
    pub fn lks_assets_add_scaled(assets: *mut lks_assets, asset: u64, factors: *const lks_number3, out: *mut u64) -> lks_status;
    pub fn lks_shape_distance(assets: *const lks_assets, a: *const lks_placed_shape, b: *const lks_placed_shape, reach: lks_length, out: *mut lks_shape_gap) -> lks_status;
    pub fn lks_shape_cast(assets: *const lks_assets, a: *const lks_placed_shape, b: *const lks_placed_shape, way: *const lks_length3, out: *mut lks_shape_hit) -> lks_status;
    pub fn lks_shape_impact(assets: *const lks_assets, a: *const lks_placed_shape, end_a: *const lks_pose, b: *const lks_placed_shape, end_b: *const lks_pose, gap: lks_length, out: *mut lks_shape_hit) -> lks_status;
    pub fn lks_status_name(status: lks_status) -> *const c_char;
    pub fn lks_last_error() -> *const c_char;
    pub fn lks_c_abi() -> u32;
    pub fn lks_version() -> *const c_char;
    pub fn lks_simulation_abi() -> u32;
    pub fn lks_canary_hash() -> u64;
    pub fn lks_body_def_init(def: *mut lks_body_def, size: usize) -> lks_status;
    pub fn lks_create_body(world: *mut lks_world, def: *const lks_body_def, out: *mut lks_body) -> lks_status;
    pub fn lks_destroy_body(world: *mut lks_world, body: lks_body) -> lks_status;
    pub fn lks_teleport(world: *mut lks_world, body: lks_body, pose: *const lks_pose) -> lks_status;
    pub fn lks_set_velocity(world: *mut lks_world, body: lks_body, velocity: *const lks_velocity3) -> lks_status;
    pub fn lks_set_angular_velocity(world: *mut lks_world, body: lks_body, velocity: *const lks_angular_velocity3) -> lks_status;
    pub fn lks_apply_impulse(world: *mut lks_world, body: lks_body, impulse: *const lks_impulse3, frame: u32) -> lks_status;
    pub fn lks_apply_impulse_at(world: *mut lks_world, body: lks_body, impulse: *const lks_impulse3, point: *const lks_length3, frame: u32) -> lks_status;
    pub fn lks_apply_angular_impulse(world: *mut lks_world, body: lks_body, impulse: *const lks_impulse3, frame: u32) -> lks_status;
    pub fn lks_apply_force(world: *mut lks_world, body: lks_body, force: *const lks_force3, frame: u32) -> lks_status;
    pub fn lks_apply_force_at(world: *mut lks_world, body: lks_body, force: *const lks_force3, point: *const lks_length3, frame: u32) -> lks_status;
    pub fn lks_apply_torque(world: *mut lks_world, body: lks_body, torque: *const lks_force3, frame: u32) -> lks_status;
    pub fn lks_move_kinematic(world: *mut lks_world, body: lks_body, pose: *const lks_pose) -> lks_status;
    pub fn lks_set_material(world: *mut lks_world, body: lks_body, surface: *const lks_surface) -> lks_status;
    pub fn lks_set_surface_motion(world: *mut lks_world, body: lks_body, motion: *const lks_surface_motion) -> lks_status;
    pub fn lks_set_gravity_scale(world: *mut lks_world, body: lks_body, scale: lks_number) -> lks_status;
    pub fn lks_set_damping(world: *mut lks_world, body: lks_body, linear: lks_rate, angular: lks_rate) -> lks_status;
    pub fn lks_set_axis_locks(world: *mut lks_world, body: lks_body, locks: u32) -> lks_status;
    pub fn lks_set_speed_limit(world: *mut lks_world, body: lks_body, linear: lks_velocity, angular: lks_angular_velocity) -> lks_status;
    pub fn lks_set_filter(world: *mut lks_world, body: lks_body, filter: *const lks_filter) -> lks_status;
    pub fn lks_set_events(world: *mut lks_world, body: lks_body, events: u32, hit_speed: lks_speed) -> lks_status;
    pub fn lks_set_user_data(world: *mut lks_world, body: lks_body, user_data: u64) -> lks_status;
    pub fn lks_set_motion_type(world: *mut lks_world, body: lks_body, motion: u32, mass: lks_mass) -> lks_status;
    pub fn lks_set_shape(world: *mut lks_world, body: lks_body, shape: *const lks_shape, mass: lks_mass) -> lks_status;
    pub fn lks_set_mass_data(world: *mut lks_world, body: lks_body, mass: lks_mass, inertia: *const lks_inertia3) -> lks_status;
    pub fn lks_set_enabled(world: *mut lks_world, body: lks_body, enabled: u32) -> lks_status;
    pub fn lks_wake_body(world: *mut lks_world, body: lks_body) -> lks_status;
    pub fn lks_sleep_body(world: *mut lks_world, body: lks_body) -> lks_status;
    pub fn lks_set_allow_sleep(world: *mut lks_world, body: lks_body, allow: u32) -> lks_status;
    pub fn lks_set_gravity(world: *mut lks_world, gravity: *const lks_acceleration3) -> lks_status;
    pub fn lks_fluid_init(fluid: *mut lks_fluid, size: usize) -> lks_status;
    pub fn lks_set_fluid(world: *mut lks_world, number: u32, fluid: *const lks_fluid) -> lks_status;
    pub fn lks_fluid_get(world: *const lks_world, number: u32, out: *mut lks_fluid) -> lks_status;
    pub fn lks_set_pair_rule(world: *mut lks_world, a: lks_body, b: lks_body, collides: u32, surface: *const lks_pair_surface) -> lks_status;
    pub fn lks_pair_rule_get(world: *const lks_world, a: lks_body, b: lks_body, collides: *mut u32, has_surface: *mut u32, surface: *mut lks_pair_surface) -> lks_status;
    pub fn lks_set_surface_rule(world: *mut lks_world, tag_a: u32, tag_b: u32, surface: *const lks_pair_surface) -> lks_status;
    pub fn lks_surface_rule_get(world: *const lks_world, tag_a: u32, tag_b: u32, has_surface: *mut u32, surface: *mut lks_pair_surface) -> lks_status;
    pub fn lks_set_one_way(world: *mut lks_world, body: lks_body, direction: *const lks_unit3, tolerance: u32) -> lks_status;
    pub fn lks_one_way_get(world: *const lks_world, body: lks_body, direction: *mut lks_unit3, tolerance: *mut u32) -> lks_status;
    pub fn lks_set_name(world: *mut lks_world, body: lks_body, name: *const c_char) -> lks_status;
    pub fn lks_body_exists(world: *const lks_world, body: lks_body, out: *mut u32) -> lks_status;
    pub fn lks_body_get(world: *const lks_world, body: lks_body, out: *mut lks_body_view) -> lks_status;
    pub fn lks_body_pose(world: *const lks_world, body: lks_body, out: *mut lks_pose) -> lks_status;
    pub fn lks_body_velocity(world: *const lks_world, body: lks_body, out: *mut lks_velocity3) -> lks_status;
    pub fn lks_bodies(world: *const lks_world, bodies: *mut lks_body, poses: *mut lks_pose, velocities: *mut lks_velocity3, capacity: usize, count: *mut usize) -> lks_status;
    pub fn lks_client_def_init(def: *mut lks_client_def, size: usize) -> lks_status;
    pub fn lks_client_create(def: *const lks_client_def, game: *const lks_game, transport: *mut lks_transport, connection: lks_connection, out: *mut *mut lks_client) -> lks_status;
    pub fn lks_client_destroy(client: *mut lks_client);
    pub fn lks_client_set_input(client: *mut lks_client, input: *const c_void, bytes: usize) -> lks_status;
    pub fn lks_client_on_sample(client: *mut lks_client, sample: lks_sample_function, user: *mut c_void) -> lks_status;
    pub fn lks_client_on_predict(client: *mut lks_client, predict: lks_predict_function, user: *mut c_void) -> lks_status;
    pub fn lks_client_update(client: *mut lks_client, now_us: i64) -> lks_status;
    pub fn lks_client_events(client: *const lks_client, out: *mut lks_session_event, capacity: usize, count: *mut usize) -> lks_status;
    pub fn lks_client_event_text(client: *const lks_client, index: usize, out: *mut c_char, capacity: usize) -> lks_status;
    pub fn lks_client_event_bytes(client: *const lks_client, index: usize, out: *mut c_void, capacity: usize, count: *mut usize) -> lks_status;
    pub fn lks_client_send_command(client: *mut lks_client, bytes: *const c_void, count: usize, number: *mut u64) -> lks_status;
    pub fn lks_client_get(client: *const lks_client, view: *mut lks_client_view) -> lks_status;
    pub fn lks_client_reason(client: *const lks_client, out: *mut c_char, capacity: usize) -> lks_status;
    pub fn lks_client_player_name(client: *const lks_client, slot: u32, out: *mut c_char, capacity: usize) -> lks_status;
    pub fn lks_client_simulation(client: *const lks_client, out: *mut *mut lks_simulation) -> lks_status;
    pub fn lks_client_stats(client: *const lks_client, stats: *mut lks_session_stats) -> lks_status;
    pub fn lks_client_ask(client: *mut lks_client, kind: u32, topic: u32, choice: u32) -> lks_status;
    pub fn lks_client_reconnect(client: *mut lks_client, connection: lks_connection) -> lks_status;
    pub fn lks_client_leave(client: *mut lks_client) -> lks_status;
    pub fn lks_client_record(client: *mut lks_client, def: *const lks_recorder_def, out: *mut *mut lks_recorder) -> lks_status;
    pub fn lks_events(world: *const lks_world, out: *mut lks_event, capacity: usize, count: *mut usize) -> lks_status;
    pub fn lks_joint_events(world: *const lks_world, out: *mut lks_joint_event, capacity: usize, count: *mut usize) -> lks_status;
    pub fn lks_hit_events(world: *const lks_world, out: *mut lks_hit_event, capacity: usize, count: *mut usize) -> lks_status;
    pub fn lks_contacts_of(world: *const lks_world, body: lks_body, out: *mut lks_body_contact, capacity: usize, count: *mut usize) -> lks_status;
    pub fn lks_joints_of(world: *const lks_world, body: lks_body, out: *mut lks_joint, capacity: usize, count: *mut usize) -> lks_status;
    pub fn lks_touching(world: *const lks_world, a: lks_body, b: lks_body, out: *mut u32) -> lks_status;
    pub fn lks_game_create(table: *const lockstone_game_table, out: *mut *mut lks_game) -> lks_status;
    pub fn lks_game_builtin(out: *mut *mut lks_game) -> lks_status;
    pub fn lks_game_destroy(game: *mut lks_game);
    pub fn lks_simulation_create(game: *const lks_game, config: *const c_void, config_bytes: usize, out: *mut *mut lks_simulation) -> lks_status;
    pub fn lks_simulation_destroy(simulation: *mut lks_simulation);
    pub fn lks_simulation_get_info(simulation: *const lks_simulation, out: *mut lks_simulation_info) -> lks_status;
    pub fn lks_simulation_tick(simulation: *const lks_simulation, out: *mut u64) -> lks_status;
    pub fn lks_simulation_match(simulation: *const lks_simulation, out: *mut *mut c_void) -> lks_status;
    pub fn lks_simulation_world(simulation: *const lks_simulation, out: *mut *mut lks_world) -> lks_status;
    pub fn lks_simulation_step(simulation: *mut lks_simulation, inputs: *const c_void, bytes: usize, origins: *const u32) -> lks_status;
    pub fn lks_simulation_command(simulation: *mut lks_simulation, slot: u32, bytes: *const c_void, count: usize) -> lks_status;
    pub fn lks_simulation_hash(simulation: *const lks_simulation, out: *mut u64) -> lks_status;
    pub fn lks_simulation_snapshot_bytes_max(simulation: *const lks_simulation, kind: u32, out: *mut usize) -> lks_status;
    pub fn lks_simulation_save(simulation: *const lks_simulation, kind: u32, out: *mut c_void, capacity: usize, bytes: *mut usize) -> lks_status;
    pub fn lks_simulation_load(simulation: *mut lks_simulation, kind: u32, bytes: *const c_void, count: usize) -> lks_status;
    pub fn lks_set_allocator(allocate: lks_allocate_function, release: lks_release_function, user: *mut c_void) -> lks_status;
    pub fn lks_set_log(write: lks_log_function, user: *mut c_void) -> lks_status;
    pub fn lks_joint_def_init(def: *mut lks_joint_def, size: usize, kind: u32, a: lks_body, b: lks_body) -> lks_status;
    pub fn lks_create_joint(world: *mut lks_world, def: *const lks_joint_def, out: *mut lks_joint) -> lks_status;
    pub fn lks_destroy_joint(world: *mut lks_world, joint: lks_joint) -> lks_status;
    pub fn lks_set_linear_axis(world: *mut lks_world, joint: lks_joint, axis: u32, settings: *const lks_axis) -> lks_status;
    pub fn lks_set_angular_axis(world: *mut lks_world, joint: lks_joint, axis: u32, settings: *const lks_axis) -> lks_status;
    pub fn lks_joint_get(world: *const lks_world, joint: lks_joint, out: *mut lks_joint_view) -> lks_status;
    pub fn lks_joints(world: *const lks_world, joints: *mut lks_joint, capacity: usize, count: *mut usize) -> lks_status;
    pub fn lks_verify_log(path: *const c_char, report: *mut lks_log_report) -> lks_status;
    pub fn lks_verify_log_bytes(bytes: *const c_void, count: usize, report: *mut lks_log_report) -> lks_status;
    pub fn lks_log_open(path: *const c_char, out: *mut *mut lks_log) -> lks_status;
    pub fn lks_log_open_bytes(bytes: *const c_void, count: usize, out: *mut *mut lks_log) -> lks_status;
    pub fn lks_log_close(log: *mut lks_log);
    pub fn lks_log_get_info(log: *mut lks_log, info: *mut lks_log_info) -> lks_status;
    pub fn lks_log_player_name(log: *mut lks_log, slot: u32, out: *mut c_char, capacity: usize) -> lks_status;
    pub fn lks_log_config(log: *mut lks_log, out: *mut c_void, capacity: usize, count: *mut usize) -> lks_status;
    pub fn lks_log_next(log: *mut lks_log, tick: *mut u64, inputs: *mut c_void, bytes: usize, origins: *mut u32, hash: *mut u64) -> lks_status;
    pub fn lks_log_command(log: *mut lks_log, index: usize, slot: *mut u32, out: *mut c_void, capacity: usize, count: *mut usize) -> lks_status;
    pub fn lks_log_seek(log: *mut lks_log, game: *const lks_game, tick: u64, out: *mut *mut lks_simulation) -> lks_status;
    pub fn lks_log_verify(log: *mut lks_log, game: *const lks_game, report: *mut lks_log_report) -> lks_status;
    pub fn lks_log_bisect(here: *mut lks_log, there: *mut lks_log, game: *const lks_game, report: *mut lks_bisect_report) -> lks_status;
    pub fn lks_query_filter_init(filter: *mut lks_query_filter, size: usize) -> lks_status;
    pub fn lks_cast_ray(world: *const lks_world, origin: *const lks_position3, way: *const lks_length3, filter: *const lks_query_filter, out: *mut lks_hit) -> lks_status;
    pub fn lks_cast_ray_all(world: *const lks_world, origin: *const lks_position3, way: *const lks_length3, filter: *const lks_query_filter, out: *mut lks_hit, capacity: usize, count: *mut usize) -> lks_status;
    pub fn lks_is_ray_blocked(world: *const lks_world, origin: *const lks_position3, way: *const lks_length3, filter: *const lks_query_filter, out: *mut u32) -> lks_status;
    pub fn lks_cast_shape(world: *const lks_world, shape: *const lks_shape, start: *const lks_pose, way: *const lks_length3, filter: *const lks_query_filter, out: *mut lks_hit) -> lks_status;
    pub fn lks_overlap_sphere(world: *const lks_world, centre: *const lks_position3, radius: lks_length, filter: *const lks_query_filter, out: *mut lks_body, capacity: usize, count: *mut usize) -> lks_status;
    pub fn lks_overlap_shape(world: *const lks_world, shape: *const lks_shape, pose: *const lks_pose, filter: *const lks_query_filter, out: *mut lks_body, capacity: usize, count: *mut usize) -> lks_status;
    pub fn lks_bodies_in_box(world: *const lks_world, lower: *const lks_position3, upper: *const lks_position3, filter: *const lks_query_filter, out: *mut lks_body, capacity: usize, count: *mut usize) -> lks_status;
    pub fn lks_closest_point(world: *const lks_world, point: *const lks_position3, reach: lks_length, filter: *const lks_query_filter, out: *mut lks_closest) -> lks_status;
    pub fn lks_bone_init(bone: *mut lks_bone) -> lks_status;
    pub fn lks_ragdoll_def_init(def: *mut lks_ragdoll_def, size: usize) -> lks_status;
    pub fn lks_ragdoll_pose_init(pose: *mut lks_ragdoll_pose) -> lks_status;
    pub fn lks_bone_drive_init(drive: *mut lks_bone_drive) -> lks_status;
    pub fn lks_create_ragdoll(world: *mut lks_world, def: *const lks_ragdoll_def, bones: *const lks_bone, bone_count: usize, pose: *const lks_ragdoll_pose, out: *mut lks_ragdoll) -> lks_status;
    pub fn lks_destroy_ragdoll(world: *mut lks_world, ragdoll: *const lks_ragdoll) -> lks_status;
    pub fn lks_drive_ragdoll(world: *mut lks_world, def: *const lks_ragdoll_def, bones: *const lks_bone, bone_count: usize, ragdoll: *mut lks_ragdoll, from: *const lks_ragdoll_pose, to: *const lks_ragdoll_pose, drives: *const lks_bone_drive, drive_count: usize) -> lks_status;
    pub fn lks_ragdoll_pose_get(world: *const lks_world, bones: *const lks_bone, bone_count: usize, ragdoll: *const lks_ragdoll, out: *mut lks_ragdoll_pose) -> lks_status;
    pub fn lks_bone_poses(bones: *const lks_bone, bone_count: usize, pose: *const lks_ragdoll_pose, out: *mut lks_pose) -> lks_status;
    pub fn lks_drag_init(drag: *mut lks_drag, size: usize, ground: lks_body, body: lks_body) -> lks_status;
    pub fn lks_create_drag(world: *mut lks_world, drag: *const lks_drag, target: *const lks_position3, out: *mut lks_joint) -> lks_status;
    pub fn lks_move_drag(world: *mut lks_world, joint: lks_joint, drag: *const lks_drag, target: *const lks_position3) -> lks_status;
    pub fn lks_recorder_def_init(def: *mut lks_recorder_def, size: usize) -> lks_status;
    pub fn lks_recorder_create(def: *const lks_recorder_def, simulation: *const lks_simulation, path: *const c_char, out: *mut *mut lks_recorder) -> lks_status;
    pub fn lks_recorder_create_in_memory(def: *const lks_recorder_def, simulation: *const lks_simulation, out: *mut *mut lks_recorder) -> lks_status;
    pub fn lks_recorder_destroy(recorder: *mut lks_recorder);
    pub fn lks_recorder_step(recorder: *mut lks_recorder, inputs: *const c_void, bytes: usize, origins: *const u32) -> lks_status;
    pub fn lks_recorder_note(recorder: *mut lks_recorder, text: *const c_char) -> lks_status;
    pub fn lks_recorder_finish(recorder: *mut lks_recorder, reason: *const c_char) -> lks_status;
    pub fn lks_recorder_bytes(recorder: *const lks_recorder, out: *mut c_void, capacity: usize, count: *mut usize) -> lks_status;
    pub fn lks_server_def_init(def: *mut lks_server_def, size: usize) -> lks_status;
    pub fn lks_server_create(def: *const lks_server_def, simulation: *mut lks_simulation, transport: *mut lks_transport, out: *mut *mut lks_server) -> lks_status;
    pub fn lks_server_destroy(server: *mut lks_server);
    pub fn lks_server_update(server: *mut lks_server, now_us: i64) -> lks_status;
    pub fn lks_server_events(server: *const lks_server, out: *mut lks_session_event, capacity: usize, count: *mut usize) -> lks_status;
    pub fn lks_server_event_text(server: *const lks_server, index: usize, out: *mut c_char, capacity: usize) -> lks_status;
    pub fn lks_server_event_bytes(server: *const lks_server, index: usize, out: *mut c_void, capacity: usize, count: *mut usize) -> lks_status;
    pub fn lks_server_send_command(server: *mut lks_server, bytes: *const c_void, count: usize) -> lks_status;
    pub fn lks_server_record(server: *mut lks_server, recorder: *mut lks_recorder) -> lks_status;
    pub fn lks_server_stop(server: *mut lks_server) -> lks_status;
    pub fn lks_server_pause(server: *mut lks_server, paused: u32) -> lks_status;
    pub fn lks_server_get(server: *const lks_server, view: *mut lks_server_view) -> lks_status;
    pub fn lks_server_player_name(server: *const lks_server, slot: u32, out: *mut c_char, capacity: usize) -> lks_status;
    pub fn lks_server_stats(server: *const lks_server, slot: u32, stats: *mut lks_session_stats) -> lks_status;
    pub fn lks_hash(world: *const lks_world, out: *mut u64) -> lks_status;
    pub fn lks_part_hashes(world: *const lks_world, out: *mut lks_hashes) -> lks_status;
    pub fn lks_snapshot_bytes_max(world: *const lks_world, kind: u32, out: *mut usize) -> lks_status;
    pub fn lks_save(world: *const lks_world, kind: u32, out: *mut c_void, capacity: usize, bytes: *mut usize) -> lks_status;
    pub fn lks_load(world: *mut lks_world, kind: u32, bytes: *const c_void, count: usize) -> lks_status;
    pub fn lks_describe_difference(world: *const lks_world, here: *const c_void, here_bytes: usize, there: *const c_void, there_bytes: usize, differs: *mut u32, text: *mut c_char, capacity: usize) -> lks_status;
    pub fn lks_set_heights(world: *mut lks_world, body: lks_body, rectangle: *const lks_height_rectangle, heights: *const lks_length, holes: *const u8, surfaces: *const u8) -> lks_status;
    pub fn lks_terrain_sample_get(world: *const lks_world, body: lks_body, column: u32, row: u32, height: *mut lks_length, is_hole: *mut u32, surface: *mut u32) -> lks_status;
    pub fn lks_set_mesh_group(world: *mut lks_world, body: lks_body, group: u32, is_on: u32) -> lks_status;
    pub fn lks_mesh_group_get(world: *const lks_world, body: lks_body, group: u32, is_on: *mut u32) -> lks_status;
    pub fn lks_terrain_tile_count(world: *const lks_world, out: *mut u32) -> lks_status;
    pub fn lks_transport_destroy(transport: *mut lks_transport);
    pub fn lks_enet_def_init(def: *mut lks_enet_def, size: usize) -> lks_status;
    pub fn lks_enet_listen(def: *const lks_enet_def, address: *const c_char, key: *const c_void, out: *mut *mut lks_transport) -> lks_status;
    pub fn lks_enet_connect(address: *const c_char, port: u32, out: *mut *mut lks_transport, connection: *mut lks_connection) -> lks_status;
    pub fn lks_enet_join(token: *const c_char, out: *mut *mut lks_transport, connection: *mut lks_connection) -> lks_status;
    pub fn lks_enet_connect_again(transport: *mut lks_transport, connection: *mut lks_connection) -> lks_status;
    pub fn lks_enet_port(transport: *const lks_transport, out: *mut u32) -> lks_status;
    pub fn lks_enet_wait(transport: *mut lks_transport, limit_us: i64) -> lks_status;
    pub fn lks_issue_token(key: *const c_void, match_id: u64, player: u64, slot: u32, expires_unix_s: u64, address: *const c_char, port: u32, out: *mut c_char, capacity: usize) -> lks_status;
    pub fn lks_carried_create(token: *const c_char, out: *mut *mut lks_transport) -> lks_status;
    pub fn lks_carried_call(transport: *mut lks_transport, connection: *mut lks_connection) -> lks_status;
    pub fn lks_carried_opened(transport: *mut lks_transport) -> lks_status;
    pub fn lks_carried_receive(transport: *mut lks_transport, message: *const c_void, bytes: usize) -> lks_status;
    pub fn lks_carried_take(transport: *mut lks_transport, out: *mut c_void, capacity: usize, bytes: *mut usize) -> lks_status;
    pub fn lks_carried_closed(transport: *mut lks_transport, code: u32) -> lks_status;
    pub fn lks_carried_is_open(transport: *const lks_transport, out: *mut u32) -> lks_status;
    pub fn lks_network_create(seed: u64, out: *mut *mut lks_network) -> lks_status;
    pub fn lks_network_destroy(network: *mut lks_network);
    pub fn lks_network_add(network: *mut lks_network, out: *mut *mut lks_transport) -> lks_status;
    pub fn lks_network_connect(network: *mut lks_network, from: *mut lks_transport, to: *mut lks_transport, faults: *const lks_link_faults, connection: *mut lks_connection) -> lks_status;
    pub fn lks_now_us() -> i64;
    pub fn lks_quat_from_axis_angle(axis: *const lks_unit3, angle: lks_angle, out: *mut lks_quat) -> lks_status;
    pub fn lks_from_ratio(numerator: i64, denominator: i64, bits: i32, out: *mut i64) -> lks_status;
    pub fn lks_from_decimal(text: *const c_char, bits: i32, out: *mut i64) -> lks_status;
    pub fn lks_to_decimal(raw: i64, bits: i32, out: *mut c_char, capacity: usize) -> lks_status;
    pub fn lks_vehicle_controls_init(controls: *mut lks_vehicle_controls, size: usize) -> lks_status;
    pub fn lks_make_car(length: lks_length, half_track: lks_length, height: lks_length, torque: lks_force, out: *mut lks_vehicle_def, size: usize) -> lks_status;
    pub fn lks_make_motorcycle(length: lks_length, height: lks_length, torque: lks_force, out: *mut lks_vehicle_def, size: usize) -> lks_status;
    pub fn lks_make_tank(length: lks_length, half_track: lks_length, height: lks_length, torque: lks_force, out: *mut lks_vehicle_def, size: usize) -> lks_status;
    pub fn lks_set_vehicle(world: *mut lks_world, chassis: lks_body, def: *const lks_vehicle_def) -> lks_status;
    pub fn lks_drive_vehicle(world: *mut lks_world, chassis: lks_body, controls: *const lks_vehicle_controls) -> lks_status;
    pub fn lks_vehicle_get(world: *const lks_world, chassis: lks_body, out: *mut lks_vehicle_view) -> lks_status;
    pub fn lks_world_def_init(def: *mut lks_world_def, size: usize) -> lks_status;
    pub fn lks_world_create(def: *const lks_world_def, assets: *const lks_assets, out: *mut *mut lks_world) -> lks_status;
    pub fn lks_world_create_scene(name: *const c_char, seed: u64, out: *mut *mut lks_world) -> lks_status;
    pub fn lks_scene_count() -> u32;
    pub fn lks_scene_name(index: u32) -> *const c_char;
    pub fn lks_world_destroy(world: *mut lks_world);
    pub fn lks_world_get_def(world: *const lks_world, def: *mut lks_world_def) -> lks_status;
    pub fn lks_config_hash(def: *const lks_world_def, assets: *const lks_assets, out: *mut u64) -> lks_status;
    pub fn lks_world_set_threads(world: *mut lks_world, threads: u32) -> lks_status;
    pub fn lks_step(world: *mut lks_world, report: *mut lks_step_report) -> lks_status;
    pub fn lks_world_keep_history(world: *mut lks_world, ticks: u32) -> lks_status;
    pub fn lks_world_forget_history(world: *mut lks_world) -> lks_status;
    pub fn lks_tick(world: *const lks_world, out: *mut u64) -> lks_status;
}
