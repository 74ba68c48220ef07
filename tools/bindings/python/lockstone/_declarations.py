# Written by tools/bindings/generate.py from the C headers, which document each declaration.
# flake8: noqa
from ctypes import (CFUNCTYPE, POINTER, Structure, c_char, c_char_p, c_int32, c_int64, c_size_t, c_uint8,
                    c_uint16, c_uint32, c_uint64, c_void_p)

LKS_SPHERE = 0
LKS_CAPSULE = 1
LKS_BOX = 2
LKS_HULL = 3
LKS_HALF_SPACE = 4
LKS_MESH = 5
LKS_HEIGHT_FIELD = 6
LKS_COMPOUND = 7
LKS_CYLINDER = 8
LKS_CONE = 9
LKS_TAPERED_CAPSULE = 10
LKS_ROUNDED_BOX = 11
LKS_C_ABI = 0
LKS_OK = 0
LKS_CAPACITY_EXHAUSTED = 1
LKS_STALE_HANDLE = 2
LKS_INVALID_ARGUMENT = 3
LKS_TRUNCATED = 4
LKS_MALFORMED = 5
LKS_CHECKSUM_MISMATCH = 6
LKS_UNSUPPORTED_VERSION = 7
LKS_INCOMPATIBLE = 8
LKS_IO_ERROR = 9
LKS_NOT_FOUND = 10
LKS_NULL_ARGUMENT = 64
LKS_WRONG_SIZE = 65
LKS_BUFFER_TOO_SMALL = 66
LKS_READ_ONLY = 67
LKS_OUT_OF_MEMORY = 68
LKS_INTERNAL = 69
LKS_UNSUPPORTED = 70
LKS_STATIC = 1
LKS_KINEMATIC = 2
LKS_DYNAMIC = 3
LKS_FRAME_WORLD = 0
LKS_FRAME_BODY = 1
LKS_COMBINE_STANDARD = 0
LKS_COMBINE_AVERAGE = 1
LKS_COMBINE_GEOMETRIC_MEAN = 2
LKS_COMBINE_MINIMUM = 3
LKS_COMBINE_MULTIPLY = 4
LKS_COMBINE_MAXIMUM = 5
LKS_BODY_TRIGGER = 1
LKS_BODY_FIXED_ROTATION = 2
LKS_BODY_BULLET = 4
LKS_BODY_ALLOW_SLEEP = 8
LKS_BODY_ASLEEP = 16
LKS_BODY_DISABLED = 32
LKS_BODY_CONTACT_EVENTS = 1
LKS_BODY_PERSIST_EVENTS = 2
LKS_LOCK_MOVE_X = 1
LKS_LOCK_MOVE_Y = 2
LKS_LOCK_MOVE_Z = 4
LKS_LOCK_TURN_X = 8
LKS_LOCK_TURN_Y = 16
LKS_LOCK_TURN_Z = 32
LKS_CLIENT_CONNECTING = 0
LKS_CLIENT_HANDSHAKING = 1
LKS_CLIENT_LOBBY = 2
LKS_CLIENT_JOINING = 3
LKS_CLIENT_RUNNING = 4
LKS_CLIENT_FINISHED = 5
LKS_CLIENT_REFUSED = 6
LKS_CLIENT_FAILED = 7
LKS_CONTACT_BEGIN = 0
LKS_CONTACT_END = 1
LKS_TRIGGER_ENTER = 2
LKS_TRIGGER_STAY = 3
LKS_TRIGGER_EXIT = 4
LKS_IMPACT = 5
LKS_SLEEP = 6
LKS_WAKE = 7
LKS_CONTACT_PERSIST = 8
LKS_INPUT_RECEIVED = 0
LKS_INPUT_REPEATED = 1
LKS_INPUT_NEUTRAL = 2
LKS_INPUT_ABSENT = 3
LKS_LEVEL_DEBUG = 0
LKS_LEVEL_INFO = 1
LKS_LEVEL_WARNING = 2
LKS_LEVEL_ERROR = 3
LKS_JOINT_DISTANCE = 1
LKS_JOINT_BALL = 2
LKS_JOINT_HINGE = 3
LKS_JOINT_SLIDER = 4
LKS_JOINT_WELD = 5
LKS_JOINT_WHEEL = 6
LKS_JOINT_MOTOR = 7
LKS_JOINT_SIX_AXIS = 8
LKS_JOINT_PULLEY = 9
LKS_JOINT_GEAR = 10
LKS_JOINT_RACK = 11
LKS_JOINT_RATCHET = 12
LKS_JOINT_PATH = 13
LKS_AXIS_LOCKED = 0
LKS_AXIS_FREE = 1
LKS_AXIS_LIMITED = 2
LKS_LOG_SAME = 0
LKS_LOG_DIVERGED = 1
LKS_LOG_CORRUPT = 2
LKS_LOG_INCOMPATIBLE = 3
LKS_FILTER_BODIES = 16
LKS_MAX_BONES = 64
LKS_NO_BONE = 4294967295
LKS_BONE_LIMP = 0
LKS_BONE_SPRUNG = 1
LKS_BONE_DRIVEN = 2
LKS_BONE_KINEMATIC = 3
LKS_SERVER_LOBBY = 0
LKS_SERVER_RUNNING = 1
LKS_SERVER_FINISHING = 2
LKS_SERVER_CLOSING = 3
LKS_SERVER_OVER = 4
LKS_LATE_DEADLINE = 0
LKS_LATE_STRICT = 1
LKS_SUBSTITUTE_REPEAT = 0
LKS_SUBSTITUTE_NEUTRAL = 1
LKS_PACING_REAL_TIME = 0
LKS_PACING_FAST = 1
LKS_DESYNC_END = 0
LKS_DESYNC_KICK = 1
LKS_DESYNC_RESYNC = 2
LKS_NO_SLOT = 255
LKS_SPECTATOR_SLOT = 254
LKS_SERVER_SLOT = 253
LKS_SESSION_STARTED = 1
LKS_SESSION_TICK = 2
LKS_SESSION_FINISHED = 3
LKS_SESSION_DESYNC = 4
LKS_SESSION_SILENT = 5
LKS_SESSION_JOINED = 6
LKS_SESSION_PLAYER_ACTIVE = 7
LKS_SESSION_NAMED = 8
LKS_SESSION_COMMAND = 9
LKS_SESSION_LEFT = 16
LKS_SESSION_REFUSED = 17
LKS_SESSION_ASKED = 18
LKS_SESSION_STATE_LOADED = 32
LKS_SESSION_PAUSED = 33
LKS_SESSION_INPUT_REPLACED = 34
LKS_SESSION_PREDICTED = 35
LKS_SESSION_ROLLED_BACK = 36
LKS_SESSION_COMMAND_REFUSED = 37
LKS_ASK_PAUSE = 0
LKS_ASK_RESUME = 1
LKS_ASK_VOTE = 2
LKS_FINISH_COMPLETED = 0
LKS_FINISH_STOPPED = 1
LKS_FINISH_DESYNC = 2
LKS_FINISH_NO_PLAYERS = 3
LKS_NATIVE = 0
LKS_CANONICAL = 1
LKS_POSITION_BITS = 32
LKS_VELOCITY_BITS = 32
LKS_ANGULAR_VELOCITY_BITS = 32
LKS_ACCELERATION_BITS = 32
LKS_MASS_BITS = 32
LKS_IMPULSE_BITS = 24
LKS_FORCE_BITS = 20
LKS_LENGTH_BITS = 20
LKS_SPEED_BITS = 20
LKS_DISPLACEMENT_BITS = 24
LKS_UNIT_BITS = 30
LKS_NUMBER_BITS = 20
LKS_RATE_BITS = 20
LKS_ANGLE_BITS = 27
LKS_DENSITY_BITS = 8
LKS_INERTIA_BITS = 28
LKS_WHEEL_RAY = 0
LKS_WHEEL_SPHERE = 1
LKS_VEHICLE_CAR = 0
LKS_VEHICLE_MOTORCYCLE = 1
LKS_VEHICLE_TRACKED = 2
LKS_MAX_HISTORY_TICKS = 256
LOCKSTONE_GAME_ABI = 1
LOCKSTONE_GAME_MAX_PARTS = 8
LOCKSTONE_GAME_TEXT_BYTES = 96
LOCKSTONE_GAME_OK = 0
LOCKSTONE_GAME_CAPACITY_EXHAUSTED = 1
LOCKSTONE_GAME_INVALID_ARGUMENT = 3
LOCKSTONE_GAME_TRUNCATED = 4
LOCKSTONE_GAME_MALFORMED = 5
LOCKSTONE_GAME_UNSUPPORTED_VERSION = 7
LOCKSTONE_GAME_INCOMPATIBLE = 8
LOCKSTONE_GAME_NOT_FOUND = 10
LOCKSTONE_GAME_NATIVE = 0
LOCKSTONE_GAME_CANONICAL = 1

lks_sample_function = CFUNCTYPE(None, c_void_p, c_uint64, c_void_p, c_size_t)
lks_predict_function = CFUNCTYPE(None, c_void_p, c_uint64, c_uint32, c_void_p, c_size_t)
lks_allocate_function = CFUNCTYPE(c_void_p, c_void_p, c_size_t, c_size_t)
lks_release_function = CFUNCTYPE(None, c_void_p, c_void_p, c_size_t, c_size_t)
lks_log_function = CFUNCTYPE(None, c_void_p, c_uint32, c_char_p)


class lks_i32x3(Structure):
    _fields_ = [
        ("x", c_int32),
        ("y", c_int32),
        ("z", c_int32),
    ]


class lks_shape(Structure):
    _fields_ = [
        ("kind", c_uint32),
        ("size", lks_i32x3),
        ("asset", c_uint64),
    ]


class lks_path_point(Structure):
    _fields_ = [
        ("position", lks_i32x3),
        ("up", lks_i32x3),
    ]


class lks_i64x3(Structure):
    _fields_ = [
        ("x", c_int64),
        ("y", c_int64),
        ("z", c_int64),
    ]


class lks_quat(Structure):
    _fields_ = [
        ("x", c_int32),
        ("y", c_int32),
        ("z", c_int32),
        ("w", c_int32),
    ]


class lks_pose(Structure):
    _fields_ = [
        ("position", lks_i64x3),
        ("orientation", lks_quat),
    ]


class lks_placed_shape(Structure):
    _fields_ = [
        ("shape", lks_shape),
        ("pose", lks_pose),
    ]


class lks_shape_gap(Structure):
    _fields_ = [
        ("distance", c_int64),
        ("point_a", lks_i64x3),
        ("point_b", lks_i64x3),
        ("normal", lks_i32x3),
        ("part_a", c_uint32),
        ("part_b", c_uint32),
        ("found", c_uint32),
        ("overlapping", c_uint32),
        ("reserved", c_uint32),
    ]


class lks_shape_hit(Structure):
    _fields_ = [
        ("point_a", lks_i64x3),
        ("fraction", c_int32),
        ("normal", lks_i32x3),
        ("part_a", c_uint32),
        ("part_b", c_uint32),
        ("hit", c_uint32),
        ("overlapping", c_uint32),
    ]


class lks_surface(Structure):
    _fields_ = [
        ("friction", c_int32),
        ("restitution", c_int32),
        ("rolling_resistance", c_int32),
        ("friction_rule", c_uint32),
        ("restitution_rule", c_uint32),
        ("rolling_rule", c_uint32),
        ("tag", c_uint32),
    ]


class lks_surface_motion(Structure):
    _fields_ = [
        ("velocity", lks_i32x3),
        ("turning", lks_i32x3),
    ]


class lks_filter(Structure):
    _fields_ = [
        ("category", c_uint32),
        ("mask", c_uint32),
        ("group", c_int32),
    ]


class lks_body_def(Structure):
    _fields_ = [
        ("size", c_uint32),
        ("motion", c_uint32),
        ("shape", lks_shape),
        ("position", lks_i64x3),
        ("velocity", lks_i64x3),
        ("angular_velocity", lks_i64x3),
        ("orientation", lks_quat),
        ("surface", lks_surface),
        ("density", c_int32),
        ("surface_motion", lks_surface_motion),
        ("filter", lks_filter),
        ("gravity_scale", c_int32),
        ("linear_damping", c_int32),
        ("angular_damping", c_int32),
        ("flags", c_uint32),
        ("locks", c_uint32),
        ("speed_limit", c_int64),
        ("angular_speed_limit", c_int64),
        ("user_data", c_uint64),
        ("events", c_uint32),
        ("hit_speed", c_int32),
        ("mass", c_int64),
        ("inertia", lks_i64x3),
    ]


class lks_body_view(Structure):
    _fields_ = [
        ("size", c_uint32),
        ("motion", c_uint32),
        ("shape", lks_shape),
        ("position", lks_i64x3),
        ("centre_of_mass", lks_i64x3),
        ("velocity", lks_i64x3),
        ("angular_velocity", lks_i64x3),
        ("orientation", lks_quat),
        ("surface", lks_surface),
        ("filter", lks_filter),
        ("flags", c_uint32),
        ("locks", c_uint32),
        ("mass", c_int64),
        ("user_data", c_uint64),
        ("events", c_uint32),
        ("hit_speed", c_int32),
        ("inertia", lks_i64x3),
        ("principal_axes", lks_quat),
        ("surface_motion", lks_surface_motion),
        ("gravity_scale", c_int32),
        ("linear_damping", c_int32),
        ("angular_damping", c_int32),
        ("reserved", c_uint32),
        ("speed_limit", c_int64),
        ("angular_speed_limit", c_int64),
    ]


class lks_fluid(Structure):
    _fields_ = [
        ("size", c_uint32),
        ("mask", c_uint32),
        ("surface", lks_i64x3),
        ("extents", lks_i64x3),
        ("flow", lks_i64x3),
        ("orientation", lks_quat),
        ("density", c_int32),
        ("drag", c_int32),
        ("linear_drag", c_int32),
        ("reserved", c_uint32),
    ]


class lks_pair_surface(Structure):
    _fields_ = [
        ("friction", c_int32),
        ("restitution", c_int32),
        ("rolling_resistance", c_int32),
    ]


class lks_client_def(Structure):
    _fields_ = [
        ("size", c_uint32),
        ("insecure", c_uint32),
        ("wanted_slot", c_uint32),
        ("prediction_ticks", c_uint32),
        ("prediction_delay_ticks", c_uint32),
        ("sync_test", c_uint32),
        ("history_ticks", c_uint32),
        ("snapshot_ticks", c_uint32),
        ("adapt_lead", c_uint32),
        ("play_out_evenly", c_uint32),
        ("rejoin_key", c_uint64),
        ("handshake_us", c_int64),
        ("drop_us", c_int64),
        ("name", c_char * 40),
        ("build", c_char * 72),
    ]


class lks_client_view(Structure):
    _fields_ = [
        ("size", c_uint32),
        ("state", c_uint32),
        ("ticks_stepped", c_uint64),
        ("ticks_predicted", c_uint64),
        ("rejoin_key", c_uint64),
        ("slot", c_uint32),
        ("finish_reason", c_uint32),
        ("may_reconnect", c_uint32),
        ("paused", c_uint32),
        ("waiting_mask", c_uint32),
        ("reserved", c_uint32),
        ("waiting", c_uint64),
    ]


class lks_event(Structure):
    _fields_ = [
        ("kind", c_uint32),
        ("reserved", c_uint32),
        ("a", c_uint64),
        ("b", c_uint64),
        ("approach_speed", c_int64),
        ("tag_a", c_uint32),
        ("tag_b", c_uint32),
    ]


class lks_hit_event(Structure):
    _fields_ = [
        ("a", c_uint64),
        ("b", c_uint64),
        ("point", lks_i64x3),
        ("normal_impulse", c_int64),
        ("friction_impulse", lks_i64x3),
        ("approach_speed", c_int64),
        ("normal", lks_i32x3),
        ("was_stopped", c_uint32),
        ("part_a", c_uint32),
        ("part_b", c_uint32),
        ("tag_a", c_uint32),
        ("tag_b", c_uint32),
    ]


class lks_joint_event(Structure):
    _fields_ = [
        ("joint", c_uint64),
        ("a", c_uint64),
        ("b", c_uint64),
        ("user_data", c_uint64),
    ]


class lks_touching_point(Structure):
    _fields_ = [
        ("point", lks_i64x3),
        ("normal_force", c_int64),
        ("separation", c_int32),
        ("reserved", c_uint32),
    ]


class lks_body_contact(Structure):
    _fields_ = [
        ("other", c_uint64),
        ("points", lks_touching_point * 4),
        ("normal_force", c_int64),
        ("friction", lks_i64x3),
        ("normal", lks_i32x3),
        ("count", c_uint32),
        ("part", c_uint32),
        ("other_part", c_uint32),
        ("tag", c_uint32),
        ("other_tag", c_uint32),
    ]


class lks_simulation_info(Structure):
    _fields_ = [
        ("config_hash", c_uint64),
        ("scene_hash", c_uint64),
        ("canary", c_uint64),
        ("abi", c_uint32),
        ("tick_rate", c_uint32),
        ("player_count", c_uint32),
        ("input_bytes", c_uint32),
    ]


class lks_axis(Structure):
    _fields_ = [
        ("mode", c_uint32),
        ("lower", c_int32),
        ("upper", c_int32),
        ("target", c_int32),
        ("speed", c_int32),
        ("hertz", c_int32),
        ("damping_ratio", c_int32),
        ("reserved", c_uint32),
        ("max_effort", c_int64),
    ]


class lks_joint_frame(Structure):
    _fields_ = [
        ("position", lks_i32x3),
        ("orientation", lks_quat),
    ]


class lks_joint_def(Structure):
    _fields_ = [
        ("size", c_uint32),
        ("kind", c_uint32),
        ("body_a", c_uint64),
        ("body_b", c_uint64),
        ("frame_a", lks_joint_frame),
        ("frame_b", lks_joint_frame),
        ("linear", lks_axis * 3),
        ("angular", lks_axis * 3),
        ("ground_a", lks_i64x3),
        ("ground_b", lks_i64x3),
        ("ratio", c_int32),
        ("collide", c_uint32),
        ("break_force", c_int64),
        ("break_torque", c_int64),
        ("user_data", c_uint64),
        ("path", c_uint64),
    ]


class lks_joint_view(Structure):
    _fields_ = [
        ("size", c_uint32),
        ("kind", c_uint32),
        ("body_a", c_uint64),
        ("body_b", c_uint64),
        ("user_data", c_uint64),
        ("offset", lks_i32x3),
        ("angle", lks_i32x3),
        ("force", lks_i64x3),
        ("torque", lks_i64x3),
    ]


class lks_log_report(Structure):
    _fields_ = [
        ("size", c_uint32),
        ("outcome", c_uint32),
        ("start_tick", c_uint64),
        ("ticks_verified", c_uint64),
        ("final_hash", c_uint64),
        ("diverged_tick", c_uint64),
        ("expected", c_uint64),
        ("actual", c_uint64),
        ("complete", c_uint32),
        ("torn_tail", c_uint32),
        ("line", c_char * 512),
    ]


class lks_log_info(Structure):
    _fields_ = [
        ("size", c_uint32),
        ("complete", c_uint32),
        ("torn_tail", c_uint32),
        ("damaged", c_uint32),
        ("simulation", lks_simulation_info),
        ("match_id", c_uint64),
        ("seed", c_uint64),
        ("start_tick", c_uint64),
        ("ticks", c_uint64),
        ("last_hash", c_uint64),
        ("keyframes", c_uint64),
        ("game", c_char * 72),
        ("game_version", c_char * 72),
        ("build", c_char * 136),
        ("end_reason", c_char * 264),
    ]


class lks_bisect_report(Structure):
    _fields_ = [
        ("size", c_uint32),
        ("found", c_uint32),
        ("tick", c_uint64),
        ("hash_here", c_uint64),
        ("hash_there", c_uint64),
        ("difference_tick", c_uint64),
        ("in_inputs", c_uint32),
        ("slot", c_uint32),
        ("line", c_char * 512),
    ]


class lks_query_filter(Structure):
    _fields_ = [
        ("size", c_uint32),
        ("mask", c_uint32),
        ("ignore", c_uint64),
        ("triggers", c_uint32),
        ("only_listed", c_uint32),
        ("tag_mask", c_uint32),
        ("tag", c_uint32),
        ("listed_count", c_uint32),
        ("reserved", c_uint32),
        ("listed", c_uint64 * 16),
    ]


class lks_hit(Structure):
    _fields_ = [
        ("body", c_uint64),
        ("fraction", c_int32),
        ("normal", lks_i32x3),
        ("point", lks_i64x3),
        ("part", c_uint32),
        ("reserved", c_uint32),
    ]


class lks_closest(Structure):
    _fields_ = [
        ("body", c_uint64),
        ("point", lks_i64x3),
        ("distance", c_int32),
        ("part", c_uint32),
    ]


class lks_bone(Structure):
    _fields_ = [
        ("parent", c_uint32),
        ("joint", c_uint32),
        ("shape", lks_shape),
        ("pose", lks_pose),
        ("joint_frame", lks_pose),
        ("mass", c_int64),
        ("friction", c_int64),
        ("surface", lks_surface),
        ("density", c_int32),
        ("min_twist", c_int32),
        ("max_twist", c_int32),
        ("max_swing", c_int32),
        ("reserved", c_uint32),
    ]


class lks_ragdoll_def(Structure):
    _fields_ = [
        ("size", c_uint32),
        ("filter", lks_filter),
        ("user_data", c_uint64),
    ]


class lks_ragdoll_pose(Structure):
    _fields_ = [
        ("root", lks_pose),
        ("turns", lks_quat * 64),
    ]


class lks_ragdoll(Structure):
    _fields_ = [
        ("size", c_uint32),
        ("bone_count", c_uint32),
        ("bodies", c_uint64 * 64),
        ("joints", c_uint64 * 64),
        ("masses", c_int64 * 64),
    ]


class lks_bone_drive(Structure):
    _fields_ = [
        ("mode", c_uint32),
        ("hertz", c_int32),
        ("damping_ratio", c_int32),
        ("reserved", c_uint32),
        ("max_torque", c_int64),
    ]


class lks_drag(Structure):
    _fields_ = [
        ("size", c_uint32),
        ("point", lks_i32x3),
        ("ground", c_uint64),
        ("body", c_uint64),
        ("hertz", c_int32),
        ("damping_ratio", c_int32),
        ("max_force", c_int64),
    ]


class lks_recorder_def(Structure):
    _fields_ = [
        ("size", c_uint32),
        ("keyframe_interval_ticks", c_uint32),
        ("match_id", c_uint64),
        ("seed", c_uint64),
        ("compress", c_uint32),
        ("replace", c_uint32),
        ("build", c_char * 136),
    ]


class lks_server_def(Structure):
    _fields_ = [
        ("size", c_uint32),
        ("insecure", c_uint32),
        ("relay", c_uint32),
        ("input_delay_ticks", c_uint32),
        ("late_policy", c_uint32),
        ("substitute", c_uint32),
        ("pacing", c_uint32),
        ("desync_policy", c_uint32),
        ("history_ticks", c_uint32),
        ("snapshot_ticks", c_uint32),
        ("late_join", c_uint32),
        ("start_players", c_uint32),
        ("max_spectators", c_uint32),
        ("spectator_delay_ticks", c_uint32),
        ("tick_count", c_uint64),
        ("rejoin_seed", c_uint64),
        ("drop_us", c_int64),
        ("rejoin_us", c_int64),
        ("command_bytes_max", c_uint32),
        ("commands_per_second", c_uint32),
        ("command_bytes_per_second", c_uint32),
        ("reserved", c_uint32),
    ]


class lks_server_view(Structure):
    _fields_ = [
        ("size", c_uint32),
        ("state", c_uint32),
        ("ticks_closed", c_uint64),
        ("finish_reason", c_uint32),
        ("present_mask", c_uint32),
        ("waiting_mask", c_uint32),
        ("spectators", c_uint32),
        ("paused", c_uint32),
        ("reserved", c_uint32),
        ("present", c_uint64),
        ("waiting", c_uint64),
    ]


class lks_session_event(Structure):
    _fields_ = [
        ("kind", c_uint32),
        ("slot", c_uint32),
        ("tick", c_uint64),
        ("hash", c_uint64),
        ("other_hash", c_uint64),
        ("value", c_int64),
        ("reason", c_uint32),
        ("reserved", c_uint32),
    ]


class lks_session_stats(Structure):
    _fields_ = [
        ("size", c_uint32),
        ("margin_quarters", c_int32),
        ("bytes_sent", c_uint64),
        ("bytes_received", c_uint64),
        ("packets_sent", c_uint64),
        ("packets_received", c_uint64),
        ("round_trip_us", c_int64),
        ("substituted_inputs", c_uint64),
        ("malformed_packets", c_uint64),
        ("hashes_compared", c_uint64),
        ("hashes_equal", c_uint64),
        ("rollbacks", c_uint64),
        ("ticks_stepped_again", c_uint64),
        ("states_loaded", c_uint64),
        ("commands_taken", c_uint64),
        ("commands_refused", c_uint64),
        ("islands_computed_again", c_uint64),
        ("islands_recalled", c_uint64),
        ("jitter_us", c_int64),
    ]


class lks_hashes(Structure):
    _fields_ = [
        ("total", c_uint64),
        ("header", c_uint64),
        ("bodies", c_uint64),
        ("contacts", c_uint64),
        ("joints", c_uint64),
    ]


class lks_height_rectangle(Structure):
    _fields_ = [
        ("column", c_uint32),
        ("row", c_uint32),
        ("columns", c_uint32),
        ("rows", c_uint32),
    ]


class lks_enet_def(Structure):
    _fields_ = [
        ("size", c_uint32),
        ("port", c_uint32),
        ("max_connections", c_uint32),
        ("max_connections_per_address", c_uint32),
        ("unlimited", c_uint32),
        ("timeout_ms", c_uint32),
        ("match_id", c_uint64),
    ]


class lks_link_faults(Structure):
    _fields_ = [
        ("size", c_uint32),
        ("loss_ppm", c_uint32),
        ("duplicate_ppm", c_uint32),
        ("reorder_ppm", c_uint32),
        ("delay_us", c_int64),
        ("jitter_us", c_int64),
    ]


class lks_axle(Structure):
    _fields_ = [
        ("mount", lks_i32x3),
        ("half_track", c_int32),
        ("radius", c_int32),
        ("travel", c_int32),
        ("frequency", c_int32),
        ("damping_ratio", c_int32),
        ("anti_roll", c_int32),
        ("max_steer", c_int32),
        ("drive", c_int32),
        ("friction", c_int32),
        ("brake", c_int64),
        ("handbrake", c_int64),
        ("differential_lock", c_int64),
    ]


class lks_vehicle_def(Structure):
    _fields_ = [
        ("size", c_uint32),
        ("axle_count", c_uint32),
        ("axles", lks_axle * 3),
        ("peak_slip", c_int32),
        ("peak_angle", c_int32),
        ("relaxation", c_int32),
        ("rolling_resistance", c_int32),
        ("torque", c_int64 * 8),
        ("idle_speed", c_int64),
        ("max_speed", c_int64),
        ("engine_inertia", c_int64),
        ("engine_friction", c_int64),
        ("ratios", c_int32 * 8),
        ("reverse", c_int32),
        ("final_drive", c_int32),
        ("automatic", c_uint32),
        ("shift_ticks", c_uint32),
        ("shift_up", c_int64),
        ("shift_down", c_int64),
        ("clutch", c_int64),
        ("wheel_inertia", c_int64),
        ("cast", c_uint32),
        ("mask", c_uint32),
        ("kind", c_uint32),
        ("max_lean", c_int32),
    ]


class lks_vehicle_controls(Structure):
    _fields_ = [
        ("size", c_uint32),
        ("gear", c_int32),
        ("throttle", c_int32),
        ("brake", c_int32),
        ("handbrake", c_int32),
        ("steer", c_int32),
        ("clutch", c_int32),
        ("reserved", c_uint32),
    ]


class lks_wheel_view(Structure):
    _fields_ = [
        ("centre", lks_i64x3),
        ("spin", c_int64),
        ("load", c_int64),
        ("compression", c_int32),
        ("steer_sin", c_int32),
        ("is_grounded", c_uint32),
        ("reserved", c_uint32),
    ]


class lks_vehicle_view(Structure):
    _fields_ = [
        ("size", c_uint32),
        ("gear", c_int32),
        ("engine_speed", c_int64),
        ("wheel_count", c_uint32),
        ("lean", c_int32),
        ("wheels", lks_wheel_view * 6),
    ]


class lks_world_def(Structure):
    _fields_ = [
        ("size", c_uint32),
        ("body_capacity", c_uint32),
        ("pair_capacity", c_uint32),
        ("contact_capacity", c_uint32),
        ("joint_capacity", c_uint32),
        ("tick_rate", c_uint32),
        ("substeps", c_uint32),
        ("sleep_ms", c_uint32),
        ("sleep_distance", c_int32),
        ("broad_phase", c_uint32),
        ("gravity", lks_i64x3),
        ("speed_limit", c_int64),
        ("converged_contacts", c_uint32),
        ("vehicle_capacity", c_uint32),
        ("terrain_tile_capacity", c_uint32),
        ("reserved", c_uint32),
    ]


class lks_step_report(Structure):
    _fields_ = [
        ("size", c_uint32),
        ("status", c_int32),
        ("moving_bodies", c_uint32),
        ("asleep_bodies", c_uint32),
        ("islands", c_uint32),
        ("free_bodies", c_uint32),
        ("axis_turns", c_uint32),
        ("pairs", c_uint32),
        ("contacts", c_uint32),
        ("contact_points", c_uint32),
        ("colors", c_uint32),
        ("overflow_contacts", c_uint32),
        ("continuous_bodies", c_uint32),
        ("impacts", c_uint32),
        ("saturations", c_uint32),
        ("energy_limits", c_uint32),
        ("computed_islands", c_uint32),
        ("recalled_islands", c_uint32),
        ("still_bodies", c_uint32),
        ("still_contacts", c_uint32),
    ]


class lockstone_game_info(Structure):
    _fields_ = [
        ("config_hash", c_uint64),
        ("scene_hash", c_uint64),
        ("canary", c_uint64),
        ("abi", c_uint32),
        ("tick_rate", c_uint16),
        ("player_count", c_uint8),
        ("input_bytes", c_uint8),
    ]


class lockstone_game_input(Structure):
    _fields_ = [
        ("bytes", c_void_p),
        ("origin", c_uint32),
    ]


class lockstone_game_hash(Structure):
    _fields_ = [
        ("name", c_char_p),
        ("low", c_uint64),
        ("high", c_uint64),
    ]


class lockstone_game_difference(Structure):
    _fields_ = [
        ("object", c_uint64),
        ("store", c_char * 96),
        ("name", c_char * 96),
        ("field", c_char * 96),
        ("here", c_char * 96),
        ("there", c_char * 96),
    ]


class lockstone_game_scene(Structure):
    _fields_ = [
        ("name", c_char_p),
        ("description", c_char_p),
        ("ticks", c_uint32),
    ]


class lockstone_game_request(Structure):
    _fields_ = [
        ("scene", c_char_p),
        ("seed", c_uint64),
        ("bodies", c_int64),
        ("players", c_uint32),
    ]


class lockstone_game_table(Structure):
    _fields_ = [
        ("abi", c_uint32),
        ("bytes", c_uint32),
        ("name", c_char_p),
        ("version", c_char_p),
        ("build", c_char_p),
        ("create", CFUNCTYPE(c_int32, c_void_p, c_size_t, POINTER(c_void_p))),
        ("destroy", CFUNCTYPE(None, c_void_p)),
        ("info", CFUNCTYPE(None, c_void_p, POINTER(lockstone_game_info))),
        ("tick", CFUNCTYPE(c_uint64, c_void_p)),
        ("step", CFUNCTYPE(None, c_void_p, POINTER(lockstone_game_input), c_size_t)),
        ("snapshot_bytes_max", CFUNCTYPE(c_size_t, c_void_p, c_uint32)),
        ("save", CFUNCTYPE(c_size_t, c_void_p, c_uint32, c_void_p, c_size_t)),
        ("load", CFUNCTYPE(c_int32, c_void_p, c_uint32, c_void_p, c_size_t)),
        ("hash", CFUNCTYPE(c_uint64, c_void_p)),
        ("part_hashes", CFUNCTYPE(c_size_t, c_void_p, POINTER(lockstone_game_hash))),
        ("describe", CFUNCTYPE(c_int32, c_void_p, c_void_p, c_size_t, c_void_p, c_size_t, POINTER(lockstone_game_difference))),
        ("configure", CFUNCTYPE(c_int32, POINTER(lockstone_game_request), c_void_p, POINTER(c_size_t))),
        ("bot", CFUNCTYPE(c_int32, c_void_p, c_uint64, c_uint32, c_uint64, c_void_p)),
        ("step_traced", CFUNCTYPE(c_size_t, c_void_p, POINTER(lockstone_game_input), c_size_t, POINTER(lockstone_game_hash), c_size_t)),
        ("draw", CFUNCTYPE(c_size_t, c_void_p, c_void_p, c_size_t)),
        ("scenes", POINTER(lockstone_game_scene)),
        ("scene_count", c_size_t),
        ("keep_history", CFUNCTYPE(None, c_void_p, c_uint32)),
        ("forget_history", CFUNCTYPE(None, c_void_p)),
        ("command", CFUNCTYPE(None, c_void_p, c_uint32, c_void_p, c_size_t)),
    ]


# The types of the result and of the arguments.
FUNCTIONS = {
    "lks_fit": [c_int32, c_uint32, POINTER(lks_i32x3), c_size_t, POINTER(lks_shape), POINTER(lks_pose)],
    "lks_assets_create": [c_int32, POINTER(c_void_p)],
    "lks_assets_destroy": [None, c_void_p],
    "lks_assets_add_hull": [c_int32, c_void_p, POINTER(lks_i32x3), c_size_t, c_int32, POINTER(c_uint64)],
    "lks_assets_add_path": [c_int32, c_void_p, POINTER(lks_path_point), c_size_t, c_uint32, POINTER(c_uint64)],
    "lks_assets_add_banked_path": [c_int32, c_void_p, POINTER(lks_path_point), POINTER(c_int32), c_size_t, c_uint32, POINTER(c_uint64)],
    "lks_assets_add_rounded_hull": [c_int32, c_void_p, POINTER(lks_i32x3), c_size_t, c_int32, c_int32, POINTER(c_uint64)],
    "lks_assets_add_bytes": [c_int32, c_void_p, c_void_p, c_size_t, POINTER(c_uint64)],
    "lks_assets_find_part": [c_int32, c_void_p, c_uint64, c_uint32, POINTER(c_uint32), POINTER(c_uint32)],
    "lks_assets_add_scaled": [c_int32, c_void_p, c_uint64, POINTER(lks_i32x3), POINTER(c_uint64)],
    "lks_shape_distance": [c_int32, c_void_p, POINTER(lks_placed_shape), POINTER(lks_placed_shape), c_int32, POINTER(lks_shape_gap)],
    "lks_shape_cast": [c_int32, c_void_p, POINTER(lks_placed_shape), POINTER(lks_placed_shape), POINTER(lks_i32x3), POINTER(lks_shape_hit)],
    "lks_shape_impact": [c_int32, c_void_p, POINTER(lks_placed_shape), POINTER(lks_pose), POINTER(lks_placed_shape), POINTER(lks_pose), c_int32, POINTER(lks_shape_hit)],
    "lks_status_name": [c_char_p, c_int32],
    "lks_last_error": [c_char_p],
    "lks_c_abi": [c_uint32],
    "lks_version": [c_char_p],
    "lks_simulation_abi": [c_uint32],
    "lks_canary_hash": [c_uint64],
    "lks_body_def_init": [c_int32, POINTER(lks_body_def), c_size_t],
    "lks_create_body": [c_int32, c_void_p, POINTER(lks_body_def), POINTER(c_uint64)],
    "lks_destroy_body": [c_int32, c_void_p, c_uint64],
    "lks_teleport": [c_int32, c_void_p, c_uint64, POINTER(lks_pose)],
    "lks_set_velocity": [c_int32, c_void_p, c_uint64, POINTER(lks_i64x3)],
    "lks_set_angular_velocity": [c_int32, c_void_p, c_uint64, POINTER(lks_i64x3)],
    "lks_apply_impulse": [c_int32, c_void_p, c_uint64, POINTER(lks_i64x3), c_uint32],
    "lks_apply_impulse_at": [c_int32, c_void_p, c_uint64, POINTER(lks_i64x3), POINTER(lks_i32x3), c_uint32],
    "lks_apply_angular_impulse": [c_int32, c_void_p, c_uint64, POINTER(lks_i64x3), c_uint32],
    "lks_apply_force": [c_int32, c_void_p, c_uint64, POINTER(lks_i64x3), c_uint32],
    "lks_apply_force_at": [c_int32, c_void_p, c_uint64, POINTER(lks_i64x3), POINTER(lks_i32x3), c_uint32],
    "lks_apply_torque": [c_int32, c_void_p, c_uint64, POINTER(lks_i64x3), c_uint32],
    "lks_move_kinematic": [c_int32, c_void_p, c_uint64, POINTER(lks_pose)],
    "lks_set_material": [c_int32, c_void_p, c_uint64, POINTER(lks_surface)],
    "lks_set_surface_motion": [c_int32, c_void_p, c_uint64, POINTER(lks_surface_motion)],
    "lks_set_gravity_scale": [c_int32, c_void_p, c_uint64, c_int32],
    "lks_set_damping": [c_int32, c_void_p, c_uint64, c_int32, c_int32],
    "lks_set_axis_locks": [c_int32, c_void_p, c_uint64, c_uint32],
    "lks_set_speed_limit": [c_int32, c_void_p, c_uint64, c_int64, c_int64],
    "lks_set_filter": [c_int32, c_void_p, c_uint64, POINTER(lks_filter)],
    "lks_set_events": [c_int32, c_void_p, c_uint64, c_uint32, c_int32],
    "lks_set_user_data": [c_int32, c_void_p, c_uint64, c_uint64],
    "lks_set_motion_type": [c_int32, c_void_p, c_uint64, c_uint32, c_int64],
    "lks_set_shape": [c_int32, c_void_p, c_uint64, POINTER(lks_shape), c_int64],
    "lks_set_mass_data": [c_int32, c_void_p, c_uint64, c_int64, POINTER(lks_i64x3)],
    "lks_set_enabled": [c_int32, c_void_p, c_uint64, c_uint32],
    "lks_wake_body": [c_int32, c_void_p, c_uint64],
    "lks_sleep_body": [c_int32, c_void_p, c_uint64],
    "lks_set_allow_sleep": [c_int32, c_void_p, c_uint64, c_uint32],
    "lks_set_gravity": [c_int32, c_void_p, POINTER(lks_i64x3)],
    "lks_fluid_init": [c_int32, POINTER(lks_fluid), c_size_t],
    "lks_set_fluid": [c_int32, c_void_p, c_uint32, POINTER(lks_fluid)],
    "lks_fluid_get": [c_int32, c_void_p, c_uint32, POINTER(lks_fluid)],
    "lks_set_pair_rule": [c_int32, c_void_p, c_uint64, c_uint64, c_uint32, POINTER(lks_pair_surface)],
    "lks_pair_rule_get": [c_int32, c_void_p, c_uint64, c_uint64, POINTER(c_uint32), POINTER(c_uint32), POINTER(lks_pair_surface)],
    "lks_set_surface_rule": [c_int32, c_void_p, c_uint32, c_uint32, POINTER(lks_pair_surface)],
    "lks_surface_rule_get": [c_int32, c_void_p, c_uint32, c_uint32, POINTER(c_uint32), POINTER(lks_pair_surface)],
    "lks_set_one_way": [c_int32, c_void_p, c_uint64, POINTER(lks_i32x3), c_uint32],
    "lks_one_way_get": [c_int32, c_void_p, c_uint64, POINTER(lks_i32x3), POINTER(c_uint32)],
    "lks_set_name": [c_int32, c_void_p, c_uint64, c_char_p],
    "lks_body_exists": [c_int32, c_void_p, c_uint64, POINTER(c_uint32)],
    "lks_body_get": [c_int32, c_void_p, c_uint64, POINTER(lks_body_view)],
    "lks_body_pose": [c_int32, c_void_p, c_uint64, POINTER(lks_pose)],
    "lks_body_velocity": [c_int32, c_void_p, c_uint64, POINTER(lks_i64x3)],
    "lks_bodies": [c_int32, c_void_p, POINTER(c_uint64), POINTER(lks_pose), POINTER(lks_i64x3), c_size_t, POINTER(c_size_t)],
    "lks_client_def_init": [c_int32, POINTER(lks_client_def), c_size_t],
    "lks_client_create": [c_int32, POINTER(lks_client_def), c_void_p, c_void_p, c_uint32, POINTER(c_void_p)],
    "lks_client_destroy": [None, c_void_p],
    "lks_client_set_input": [c_int32, c_void_p, c_void_p, c_size_t],
    "lks_client_on_sample": [c_int32, c_void_p, lks_sample_function, c_void_p],
    "lks_client_on_predict": [c_int32, c_void_p, lks_predict_function, c_void_p],
    "lks_client_update": [c_int32, c_void_p, c_int64],
    "lks_client_events": [c_int32, c_void_p, POINTER(lks_session_event), c_size_t, POINTER(c_size_t)],
    "lks_client_event_text": [c_int32, c_void_p, c_size_t, c_void_p, c_size_t],
    "lks_client_event_bytes": [c_int32, c_void_p, c_size_t, c_void_p, c_size_t, POINTER(c_size_t)],
    "lks_client_send_command": [c_int32, c_void_p, c_void_p, c_size_t, POINTER(c_uint64)],
    "lks_client_get": [c_int32, c_void_p, POINTER(lks_client_view)],
    "lks_client_reason": [c_int32, c_void_p, c_void_p, c_size_t],
    "lks_client_player_name": [c_int32, c_void_p, c_uint32, c_void_p, c_size_t],
    "lks_client_simulation": [c_int32, c_void_p, POINTER(c_void_p)],
    "lks_client_stats": [c_int32, c_void_p, POINTER(lks_session_stats)],
    "lks_client_ask": [c_int32, c_void_p, c_uint32, c_uint32, c_uint32],
    "lks_client_reconnect": [c_int32, c_void_p, c_uint32],
    "lks_client_leave": [c_int32, c_void_p],
    "lks_client_record": [c_int32, c_void_p, POINTER(lks_recorder_def), POINTER(c_void_p)],
    "lks_events": [c_int32, c_void_p, POINTER(lks_event), c_size_t, POINTER(c_size_t)],
    "lks_joint_events": [c_int32, c_void_p, POINTER(lks_joint_event), c_size_t, POINTER(c_size_t)],
    "lks_hit_events": [c_int32, c_void_p, POINTER(lks_hit_event), c_size_t, POINTER(c_size_t)],
    "lks_contacts_of": [c_int32, c_void_p, c_uint64, POINTER(lks_body_contact), c_size_t, POINTER(c_size_t)],
    "lks_joints_of": [c_int32, c_void_p, c_uint64, POINTER(c_uint64), c_size_t, POINTER(c_size_t)],
    "lks_touching": [c_int32, c_void_p, c_uint64, c_uint64, POINTER(c_uint32)],
    "lks_game_create": [c_int32, POINTER(lockstone_game_table), POINTER(c_void_p)],
    "lks_game_builtin": [c_int32, POINTER(c_void_p)],
    "lks_game_destroy": [None, c_void_p],
    "lks_simulation_create": [c_int32, c_void_p, c_void_p, c_size_t, POINTER(c_void_p)],
    "lks_simulation_destroy": [None, c_void_p],
    "lks_simulation_get_info": [c_int32, c_void_p, POINTER(lks_simulation_info)],
    "lks_simulation_tick": [c_int32, c_void_p, POINTER(c_uint64)],
    "lks_simulation_match": [c_int32, c_void_p, POINTER(c_void_p)],
    "lks_simulation_world": [c_int32, c_void_p, POINTER(c_void_p)],
    "lks_simulation_step": [c_int32, c_void_p, c_void_p, c_size_t, POINTER(c_uint32)],
    "lks_simulation_command": [c_int32, c_void_p, c_uint32, c_void_p, c_size_t],
    "lks_simulation_hash": [c_int32, c_void_p, POINTER(c_uint64)],
    "lks_simulation_snapshot_bytes_max": [c_int32, c_void_p, c_uint32, POINTER(c_size_t)],
    "lks_simulation_save": [c_int32, c_void_p, c_uint32, c_void_p, c_size_t, POINTER(c_size_t)],
    "lks_simulation_load": [c_int32, c_void_p, c_uint32, c_void_p, c_size_t],
    "lks_set_allocator": [c_int32, lks_allocate_function, lks_release_function, c_void_p],
    "lks_set_log": [c_int32, lks_log_function, c_void_p],
    "lks_joint_def_init": [c_int32, POINTER(lks_joint_def), c_size_t, c_uint32, c_uint64, c_uint64],
    "lks_create_joint": [c_int32, c_void_p, POINTER(lks_joint_def), POINTER(c_uint64)],
    "lks_destroy_joint": [c_int32, c_void_p, c_uint64],
    "lks_set_linear_axis": [c_int32, c_void_p, c_uint64, c_uint32, POINTER(lks_axis)],
    "lks_set_angular_axis": [c_int32, c_void_p, c_uint64, c_uint32, POINTER(lks_axis)],
    "lks_joint_get": [c_int32, c_void_p, c_uint64, POINTER(lks_joint_view)],
    "lks_joints": [c_int32, c_void_p, POINTER(c_uint64), c_size_t, POINTER(c_size_t)],
    "lks_verify_log": [c_int32, c_char_p, POINTER(lks_log_report)],
    "lks_verify_log_bytes": [c_int32, c_void_p, c_size_t, POINTER(lks_log_report)],
    "lks_log_open": [c_int32, c_char_p, POINTER(c_void_p)],
    "lks_log_open_bytes": [c_int32, c_void_p, c_size_t, POINTER(c_void_p)],
    "lks_log_close": [None, c_void_p],
    "lks_log_get_info": [c_int32, c_void_p, POINTER(lks_log_info)],
    "lks_log_player_name": [c_int32, c_void_p, c_uint32, c_void_p, c_size_t],
    "lks_log_config": [c_int32, c_void_p, c_void_p, c_size_t, POINTER(c_size_t)],
    "lks_log_next": [c_int32, c_void_p, POINTER(c_uint64), c_void_p, c_size_t, POINTER(c_uint32), POINTER(c_uint64)],
    "lks_log_command": [c_int32, c_void_p, c_size_t, POINTER(c_uint32), c_void_p, c_size_t, POINTER(c_size_t)],
    "lks_log_seek": [c_int32, c_void_p, c_void_p, c_uint64, POINTER(c_void_p)],
    "lks_log_verify": [c_int32, c_void_p, c_void_p, POINTER(lks_log_report)],
    "lks_log_bisect": [c_int32, c_void_p, c_void_p, c_void_p, POINTER(lks_bisect_report)],
    "lks_query_filter_init": [c_int32, POINTER(lks_query_filter), c_size_t],
    "lks_cast_ray": [c_int32, c_void_p, POINTER(lks_i64x3), POINTER(lks_i32x3), POINTER(lks_query_filter), POINTER(lks_hit)],
    "lks_cast_ray_all": [c_int32, c_void_p, POINTER(lks_i64x3), POINTER(lks_i32x3), POINTER(lks_query_filter), POINTER(lks_hit), c_size_t, POINTER(c_size_t)],
    "lks_is_ray_blocked": [c_int32, c_void_p, POINTER(lks_i64x3), POINTER(lks_i32x3), POINTER(lks_query_filter), POINTER(c_uint32)],
    "lks_cast_shape": [c_int32, c_void_p, POINTER(lks_shape), POINTER(lks_pose), POINTER(lks_i32x3), POINTER(lks_query_filter), POINTER(lks_hit)],
    "lks_overlap_sphere": [c_int32, c_void_p, POINTER(lks_i64x3), c_int32, POINTER(lks_query_filter), POINTER(c_uint64), c_size_t, POINTER(c_size_t)],
    "lks_overlap_shape": [c_int32, c_void_p, POINTER(lks_shape), POINTER(lks_pose), POINTER(lks_query_filter), POINTER(c_uint64), c_size_t, POINTER(c_size_t)],
    "lks_bodies_in_box": [c_int32, c_void_p, POINTER(lks_i64x3), POINTER(lks_i64x3), POINTER(lks_query_filter), POINTER(c_uint64), c_size_t, POINTER(c_size_t)],
    "lks_closest_point": [c_int32, c_void_p, POINTER(lks_i64x3), c_int32, POINTER(lks_query_filter), POINTER(lks_closest)],
    "lks_bone_init": [c_int32, POINTER(lks_bone)],
    "lks_ragdoll_def_init": [c_int32, POINTER(lks_ragdoll_def), c_size_t],
    "lks_ragdoll_pose_init": [c_int32, POINTER(lks_ragdoll_pose)],
    "lks_bone_drive_init": [c_int32, POINTER(lks_bone_drive)],
    "lks_create_ragdoll": [c_int32, c_void_p, POINTER(lks_ragdoll_def), POINTER(lks_bone), c_size_t, POINTER(lks_ragdoll_pose), POINTER(lks_ragdoll)],
    "lks_destroy_ragdoll": [c_int32, c_void_p, POINTER(lks_ragdoll)],
    "lks_drive_ragdoll": [c_int32, c_void_p, POINTER(lks_ragdoll_def), POINTER(lks_bone), c_size_t, POINTER(lks_ragdoll), POINTER(lks_ragdoll_pose), POINTER(lks_ragdoll_pose), POINTER(lks_bone_drive), c_size_t],
    "lks_ragdoll_pose_get": [c_int32, c_void_p, POINTER(lks_bone), c_size_t, POINTER(lks_ragdoll), POINTER(lks_ragdoll_pose)],
    "lks_bone_poses": [c_int32, POINTER(lks_bone), c_size_t, POINTER(lks_ragdoll_pose), POINTER(lks_pose)],
    "lks_drag_init": [c_int32, POINTER(lks_drag), c_size_t, c_uint64, c_uint64],
    "lks_create_drag": [c_int32, c_void_p, POINTER(lks_drag), POINTER(lks_i64x3), POINTER(c_uint64)],
    "lks_move_drag": [c_int32, c_void_p, c_uint64, POINTER(lks_drag), POINTER(lks_i64x3)],
    "lks_recorder_def_init": [c_int32, POINTER(lks_recorder_def), c_size_t],
    "lks_recorder_create": [c_int32, POINTER(lks_recorder_def), c_void_p, c_char_p, POINTER(c_void_p)],
    "lks_recorder_create_in_memory": [c_int32, POINTER(lks_recorder_def), c_void_p, POINTER(c_void_p)],
    "lks_recorder_destroy": [None, c_void_p],
    "lks_recorder_step": [c_int32, c_void_p, c_void_p, c_size_t, POINTER(c_uint32)],
    "lks_recorder_note": [c_int32, c_void_p, c_char_p],
    "lks_recorder_finish": [c_int32, c_void_p, c_char_p],
    "lks_recorder_bytes": [c_int32, c_void_p, c_void_p, c_size_t, POINTER(c_size_t)],
    "lks_server_def_init": [c_int32, POINTER(lks_server_def), c_size_t],
    "lks_server_create": [c_int32, POINTER(lks_server_def), c_void_p, c_void_p, POINTER(c_void_p)],
    "lks_server_destroy": [None, c_void_p],
    "lks_server_update": [c_int32, c_void_p, c_int64],
    "lks_server_events": [c_int32, c_void_p, POINTER(lks_session_event), c_size_t, POINTER(c_size_t)],
    "lks_server_event_text": [c_int32, c_void_p, c_size_t, c_void_p, c_size_t],
    "lks_server_event_bytes": [c_int32, c_void_p, c_size_t, c_void_p, c_size_t, POINTER(c_size_t)],
    "lks_server_send_command": [c_int32, c_void_p, c_void_p, c_size_t],
    "lks_server_record": [c_int32, c_void_p, c_void_p],
    "lks_server_stop": [c_int32, c_void_p],
    "lks_server_pause": [c_int32, c_void_p, c_uint32],
    "lks_server_get": [c_int32, c_void_p, POINTER(lks_server_view)],
    "lks_server_player_name": [c_int32, c_void_p, c_uint32, c_void_p, c_size_t],
    "lks_server_stats": [c_int32, c_void_p, c_uint32, POINTER(lks_session_stats)],
    "lks_hash": [c_int32, c_void_p, POINTER(c_uint64)],
    "lks_part_hashes": [c_int32, c_void_p, POINTER(lks_hashes)],
    "lks_snapshot_bytes_max": [c_int32, c_void_p, c_uint32, POINTER(c_size_t)],
    "lks_save": [c_int32, c_void_p, c_uint32, c_void_p, c_size_t, POINTER(c_size_t)],
    "lks_load": [c_int32, c_void_p, c_uint32, c_void_p, c_size_t],
    "lks_describe_difference": [c_int32, c_void_p, c_void_p, c_size_t, c_void_p, c_size_t, POINTER(c_uint32), c_void_p, c_size_t],
    "lks_set_heights": [c_int32, c_void_p, c_uint64, POINTER(lks_height_rectangle), POINTER(c_int32), c_void_p, c_void_p],
    "lks_terrain_sample_get": [c_int32, c_void_p, c_uint64, c_uint32, c_uint32, POINTER(c_int32), POINTER(c_uint32), POINTER(c_uint32)],
    "lks_set_mesh_group": [c_int32, c_void_p, c_uint64, c_uint32, c_uint32],
    "lks_mesh_group_get": [c_int32, c_void_p, c_uint64, c_uint32, POINTER(c_uint32)],
    "lks_terrain_tile_count": [c_int32, c_void_p, POINTER(c_uint32)],
    "lks_transport_destroy": [None, c_void_p],
    "lks_enet_def_init": [c_int32, POINTER(lks_enet_def), c_size_t],
    "lks_enet_listen": [c_int32, POINTER(lks_enet_def), c_char_p, c_void_p, POINTER(c_void_p)],
    "lks_enet_connect": [c_int32, c_char_p, c_uint32, POINTER(c_void_p), POINTER(c_uint32)],
    "lks_enet_join": [c_int32, c_char_p, POINTER(c_void_p), POINTER(c_uint32)],
    "lks_enet_connect_again": [c_int32, c_void_p, POINTER(c_uint32)],
    "lks_enet_port": [c_int32, c_void_p, POINTER(c_uint32)],
    "lks_enet_wait": [c_int32, c_void_p, c_int64],
    "lks_issue_token": [c_int32, c_void_p, c_uint64, c_uint64, c_uint32, c_uint64, c_char_p, c_uint32, c_void_p, c_size_t],
    "lks_carried_create": [c_int32, c_char_p, POINTER(c_void_p)],
    "lks_carried_call": [c_int32, c_void_p, POINTER(c_uint32)],
    "lks_carried_opened": [c_int32, c_void_p],
    "lks_carried_receive": [c_int32, c_void_p, c_void_p, c_size_t],
    "lks_carried_take": [c_int32, c_void_p, c_void_p, c_size_t, POINTER(c_size_t)],
    "lks_carried_closed": [c_int32, c_void_p, c_uint32],
    "lks_carried_is_open": [c_int32, c_void_p, POINTER(c_uint32)],
    "lks_network_create": [c_int32, c_uint64, POINTER(c_void_p)],
    "lks_network_destroy": [None, c_void_p],
    "lks_network_add": [c_int32, c_void_p, POINTER(c_void_p)],
    "lks_network_connect": [c_int32, c_void_p, c_void_p, c_void_p, POINTER(lks_link_faults), POINTER(c_uint32)],
    "lks_now_us": [c_int64],
    "lks_quat_from_axis_angle": [c_int32, POINTER(lks_i32x3), c_int32, POINTER(lks_quat)],
    "lks_from_ratio": [c_int32, c_int64, c_int64, c_int32, POINTER(c_int64)],
    "lks_from_decimal": [c_int32, c_char_p, c_int32, POINTER(c_int64)],
    "lks_to_decimal": [c_int32, c_int64, c_int32, c_void_p, c_size_t],
    "lks_vehicle_controls_init": [c_int32, POINTER(lks_vehicle_controls), c_size_t],
    "lks_make_car": [c_int32, c_int32, c_int32, c_int32, c_int64, POINTER(lks_vehicle_def), c_size_t],
    "lks_make_motorcycle": [c_int32, c_int32, c_int32, c_int64, POINTER(lks_vehicle_def), c_size_t],
    "lks_make_tank": [c_int32, c_int32, c_int32, c_int32, c_int64, POINTER(lks_vehicle_def), c_size_t],
    "lks_set_vehicle": [c_int32, c_void_p, c_uint64, POINTER(lks_vehicle_def)],
    "lks_drive_vehicle": [c_int32, c_void_p, c_uint64, POINTER(lks_vehicle_controls)],
    "lks_vehicle_get": [c_int32, c_void_p, c_uint64, POINTER(lks_vehicle_view)],
    "lks_world_def_init": [c_int32, POINTER(lks_world_def), c_size_t],
    "lks_world_create": [c_int32, POINTER(lks_world_def), c_void_p, POINTER(c_void_p)],
    "lks_world_create_scene": [c_int32, c_char_p, c_uint64, POINTER(c_void_p)],
    "lks_scene_count": [c_uint32],
    "lks_scene_name": [c_char_p, c_uint32],
    "lks_world_destroy": [None, c_void_p],
    "lks_world_get_def": [c_int32, c_void_p, POINTER(lks_world_def)],
    "lks_config_hash": [c_int32, POINTER(lks_world_def), c_void_p, POINTER(c_uint64)],
    "lks_world_set_threads": [c_int32, c_void_p, c_uint32],
    "lks_step": [c_int32, c_void_p, POINTER(lks_step_report)],
    "lks_world_keep_history": [c_int32, c_void_p, c_uint32],
    "lks_world_forget_history": [c_int32, c_void_p],
    "lks_tick": [c_int32, c_void_p, POINTER(c_uint64)],
}
