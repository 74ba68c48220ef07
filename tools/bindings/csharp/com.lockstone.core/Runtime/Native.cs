// Written by tools/bindings/generate.py from the C headers, which document each declaration.
using System;
using System.Runtime.InteropServices;

namespace Lockstone.Interop
{
    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct lks_shape
    {
        public uint kind;
        public lks_i32x3 size;
        public ulong asset;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct lks_path_point
    {
        public lks_i32x3 position;
        public lks_i32x3 up;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct lks_placed_shape
    {
        public lks_shape shape;
        public lks_pose pose;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct lks_shape_gap
    {
        public long distance;
        public lks_i64x3 point_a;
        public lks_i64x3 point_b;
        public lks_i32x3 normal;
        public uint part_a;
        public uint part_b;
        public uint found;
        public uint overlapping;
        public uint reserved;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct lks_shape_hit
    {
        public lks_i64x3 point_a;
        public int fraction;
        public lks_i32x3 normal;
        public uint part_a;
        public uint part_b;
        public uint hit;
        public uint overlapping;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct lks_surface
    {
        public int friction;
        public int restitution;
        public int rolling_resistance;
        public uint friction_rule;
        public uint restitution_rule;
        public uint rolling_rule;
        public uint tag;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct lks_surface_motion
    {
        public lks_i32x3 velocity;
        public lks_i32x3 turning;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct lks_filter
    {
        public uint category;
        public uint mask;
        public int group;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct lks_body_def
    {
        public uint size;
        public uint motion;
        public lks_shape shape;
        public lks_i64x3 position;
        public lks_i64x3 velocity;
        public lks_i64x3 angular_velocity;
        public lks_quat orientation;
        public lks_surface surface;
        public int density;
        public lks_surface_motion surface_motion;
        public lks_filter filter;
        public int gravity_scale;
        public int linear_damping;
        public int angular_damping;
        public uint flags;
        public uint locks;
        public long speed_limit;
        public long angular_speed_limit;
        public ulong user_data;
        public uint events;
        public int hit_speed;
        public long mass;
        public lks_i64x3 inertia;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct lks_body_view
    {
        public uint size;
        public uint motion;
        public lks_shape shape;
        public lks_i64x3 position;
        public lks_i64x3 centre_of_mass;
        public lks_i64x3 velocity;
        public lks_i64x3 angular_velocity;
        public lks_quat orientation;
        public lks_surface surface;
        public lks_filter filter;
        public uint flags;
        public uint locks;
        public long mass;
        public ulong user_data;
        public uint events;
        public int hit_speed;
        public lks_i64x3 inertia;
        public lks_quat principal_axes;
        public lks_surface_motion surface_motion;
        public int gravity_scale;
        public int linear_damping;
        public int angular_damping;
        public uint reserved;
        public long speed_limit;
        public long angular_speed_limit;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct lks_fluid
    {
        public uint size;
        public uint mask;
        public lks_i64x3 surface;
        public lks_i64x3 extents;
        public lks_i64x3 flow;
        public lks_quat orientation;
        public int density;
        public int drag;
        public int linear_drag;
        public uint reserved;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct lks_pair_surface
    {
        public int friction;
        public int restitution;
        public int rolling_resistance;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct lks_client_def
    {
        public uint size;
        public uint insecure;
        public uint wanted_slot;
        public uint prediction_ticks;
        public uint prediction_delay_ticks;
        public uint sync_test;
        public uint history_ticks;
        public uint snapshot_ticks;
        public uint adapt_lead;
        public uint play_out_evenly;
        public ulong rejoin_key;
        public long handshake_us;
        public long drop_us;
        public fixed byte name[40];
        public fixed byte build[72];
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct lks_client_view
    {
        public uint size;
        public uint state;
        public ulong ticks_stepped;
        public ulong ticks_predicted;
        public ulong rejoin_key;
        public uint slot;
        public uint finish_reason;
        public uint may_reconnect;
        public uint paused;
        public uint waiting_mask;
        public uint reserved;
        public ulong waiting;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct lks_event
    {
        public uint kind;
        public uint reserved;
        public ulong a;
        public ulong b;
        public long approach_speed;
        public uint tag_a;
        public uint tag_b;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct lks_hit_event
    {
        public ulong a;
        public ulong b;
        public lks_i64x3 point;
        public long normal_impulse;
        public lks_i64x3 friction_impulse;
        public long approach_speed;
        public lks_i32x3 normal;
        public uint was_stopped;
        public uint part_a;
        public uint part_b;
        public uint tag_a;
        public uint tag_b;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct lks_joint_event
    {
        public ulong joint;
        public ulong a;
        public ulong b;
        public ulong user_data;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct lks_touching_point
    {
        public lks_i64x3 point;
        public long normal_force;
        public int separation;
        public uint reserved;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct lks_body_contact
    {
        public ulong other;
        public lks_touching_point points_0;
        public lks_touching_point points_1;
        public lks_touching_point points_2;
        public lks_touching_point points_3;
        public long normal_force;
        public lks_i64x3 friction;
        public lks_i32x3 normal;
        public uint count;
        public uint part;
        public uint other_part;
        public uint tag;
        public uint other_tag;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct lks_simulation_info
    {
        public ulong config_hash;
        public ulong scene_hash;
        public ulong canary;
        public uint abi;
        public uint tick_rate;
        public uint player_count;
        public uint input_bytes;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct lks_axis
    {
        public uint mode;
        public int lower;
        public int upper;
        public int target;
        public int speed;
        public int hertz;
        public int damping_ratio;
        public uint reserved;
        public long max_effort;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct lks_joint_frame
    {
        public lks_i32x3 position;
        public lks_quat orientation;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct lks_joint_def
    {
        public uint size;
        public uint kind;
        public ulong body_a;
        public ulong body_b;
        public lks_joint_frame frame_a;
        public lks_joint_frame frame_b;
        public lks_axis linear_0;
        public lks_axis linear_1;
        public lks_axis linear_2;
        public lks_axis angular_0;
        public lks_axis angular_1;
        public lks_axis angular_2;
        public lks_i64x3 ground_a;
        public lks_i64x3 ground_b;
        public int ratio;
        public uint collide;
        public long break_force;
        public long break_torque;
        public ulong user_data;
        public ulong path;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct lks_joint_view
    {
        public uint size;
        public uint kind;
        public ulong body_a;
        public ulong body_b;
        public ulong user_data;
        public lks_i32x3 offset;
        public lks_i32x3 angle;
        public lks_i64x3 force;
        public lks_i64x3 torque;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct lks_log_report
    {
        public uint size;
        public uint outcome;
        public ulong start_tick;
        public ulong ticks_verified;
        public ulong final_hash;
        public ulong diverged_tick;
        public ulong expected;
        public ulong actual;
        public uint complete;
        public uint torn_tail;
        public fixed byte line[512];
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct lks_log_info
    {
        public uint size;
        public uint complete;
        public uint torn_tail;
        public uint damaged;
        public lks_simulation_info simulation;
        public ulong match_id;
        public ulong seed;
        public ulong start_tick;
        public ulong ticks;
        public ulong last_hash;
        public ulong keyframes;
        public fixed byte game[72];
        public fixed byte game_version[72];
        public fixed byte build[136];
        public fixed byte end_reason[264];
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct lks_bisect_report
    {
        public uint size;
        public uint found;
        public ulong tick;
        public ulong hash_here;
        public ulong hash_there;
        public ulong difference_tick;
        public uint in_inputs;
        public uint slot;
        public fixed byte line[512];
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct lks_query_filter
    {
        public uint size;
        public uint mask;
        public ulong ignore;
        public uint triggers;
        public uint only_listed;
        public uint tag_mask;
        public uint tag;
        public uint listed_count;
        public uint reserved;
        public fixed ulong listed[16];
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct lks_hit
    {
        public ulong body;
        public int fraction;
        public lks_i32x3 normal;
        public lks_i64x3 point;
        public uint part;
        public uint reserved;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct lks_closest
    {
        public ulong body;
        public lks_i64x3 point;
        public int distance;
        public uint part;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct lks_bone
    {
        public uint parent;
        public uint joint;
        public lks_shape shape;
        public lks_pose pose;
        public lks_pose joint_frame;
        public long mass;
        public long friction;
        public lks_surface surface;
        public int density;
        public int min_twist;
        public int max_twist;
        public int max_swing;
        public uint reserved;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct lks_ragdoll_def
    {
        public uint size;
        public lks_filter filter;
        public ulong user_data;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct lks_ragdoll_pose
    {
        public lks_pose root;
        public lks_quat turns_0;
        public lks_quat turns_1;
        public lks_quat turns_2;
        public lks_quat turns_3;
        public lks_quat turns_4;
        public lks_quat turns_5;
        public lks_quat turns_6;
        public lks_quat turns_7;
        public lks_quat turns_8;
        public lks_quat turns_9;
        public lks_quat turns_10;
        public lks_quat turns_11;
        public lks_quat turns_12;
        public lks_quat turns_13;
        public lks_quat turns_14;
        public lks_quat turns_15;
        public lks_quat turns_16;
        public lks_quat turns_17;
        public lks_quat turns_18;
        public lks_quat turns_19;
        public lks_quat turns_20;
        public lks_quat turns_21;
        public lks_quat turns_22;
        public lks_quat turns_23;
        public lks_quat turns_24;
        public lks_quat turns_25;
        public lks_quat turns_26;
        public lks_quat turns_27;
        public lks_quat turns_28;
        public lks_quat turns_29;
        public lks_quat turns_30;
        public lks_quat turns_31;
        public lks_quat turns_32;
        public lks_quat turns_33;
        public lks_quat turns_34;
        public lks_quat turns_35;
        public lks_quat turns_36;
        public lks_quat turns_37;
        public lks_quat turns_38;
        public lks_quat turns_39;
        public lks_quat turns_40;
        public lks_quat turns_41;
        public lks_quat turns_42;
        public lks_quat turns_43;
        public lks_quat turns_44;
        public lks_quat turns_45;
        public lks_quat turns_46;
        public lks_quat turns_47;
        public lks_quat turns_48;
        public lks_quat turns_49;
        public lks_quat turns_50;
        public lks_quat turns_51;
        public lks_quat turns_52;
        public lks_quat turns_53;
        public lks_quat turns_54;
        public lks_quat turns_55;
        public lks_quat turns_56;
        public lks_quat turns_57;
        public lks_quat turns_58;
        public lks_quat turns_59;
        public lks_quat turns_60;
        public lks_quat turns_61;
        public lks_quat turns_62;
        public lks_quat turns_63;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct lks_ragdoll
    {
        public uint size;
        public uint bone_count;
        public fixed ulong bodies[64];
        public fixed ulong joints[64];
        public fixed long masses[64];
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct lks_bone_drive
    {
        public uint mode;
        public int hertz;
        public int damping_ratio;
        public uint reserved;
        public long max_torque;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct lks_drag
    {
        public uint size;
        public lks_i32x3 point;
        public ulong ground;
        public ulong body;
        public int hertz;
        public int damping_ratio;
        public long max_force;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct lks_recorder_def
    {
        public uint size;
        public uint keyframe_interval_ticks;
        public ulong match_id;
        public ulong seed;
        public uint compress;
        public uint replace;
        public fixed byte build[136];
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct lks_server_def
    {
        public uint size;
        public uint insecure;
        public uint relay;
        public uint input_delay_ticks;
        public uint late_policy;
        public uint substitute;
        public uint pacing;
        public uint desync_policy;
        public uint history_ticks;
        public uint snapshot_ticks;
        public uint late_join;
        public uint start_players;
        public uint max_spectators;
        public uint spectator_delay_ticks;
        public ulong tick_count;
        public ulong rejoin_seed;
        public long drop_us;
        public long rejoin_us;
        public uint command_bytes_max;
        public uint commands_per_second;
        public uint command_bytes_per_second;
        public uint reserved;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct lks_server_view
    {
        public uint size;
        public uint state;
        public ulong ticks_closed;
        public uint finish_reason;
        public uint present_mask;
        public uint waiting_mask;
        public uint spectators;
        public uint paused;
        public uint reserved;
        public ulong present;
        public ulong waiting;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct lks_session_event
    {
        public uint kind;
        public uint slot;
        public ulong tick;
        public ulong hash;
        public ulong other_hash;
        public long value;
        public uint reason;
        public uint reserved;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct lks_session_stats
    {
        public uint size;
        public int margin_quarters;
        public ulong bytes_sent;
        public ulong bytes_received;
        public ulong packets_sent;
        public ulong packets_received;
        public long round_trip_us;
        public ulong substituted_inputs;
        public ulong malformed_packets;
        public ulong hashes_compared;
        public ulong hashes_equal;
        public ulong rollbacks;
        public ulong ticks_stepped_again;
        public ulong states_loaded;
        public ulong commands_taken;
        public ulong commands_refused;
        public ulong islands_computed_again;
        public ulong islands_recalled;
        public long jitter_us;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct lks_hashes
    {
        public ulong total;
        public ulong header;
        public ulong bodies;
        public ulong contacts;
        public ulong joints;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct lks_height_rectangle
    {
        public uint column;
        public uint row;
        public uint columns;
        public uint rows;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct lks_enet_def
    {
        public uint size;
        public uint port;
        public uint max_connections;
        public uint max_connections_per_address;
        public uint unlimited;
        public uint timeout_ms;
        public ulong match_id;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct lks_link_faults
    {
        public uint size;
        public uint loss_ppm;
        public uint duplicate_ppm;
        public uint reorder_ppm;
        public long delay_us;
        public long jitter_us;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct lks_i64x3
    {
        public long x;
        public long y;
        public long z;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct lks_i32x3
    {
        public int x;
        public int y;
        public int z;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct lks_quat
    {
        public int x;
        public int y;
        public int z;
        public int w;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct lks_pose
    {
        public lks_i64x3 position;
        public lks_quat orientation;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct lks_axle
    {
        public lks_i32x3 mount;
        public int half_track;
        public int radius;
        public int travel;
        public int frequency;
        public int damping_ratio;
        public int anti_roll;
        public int max_steer;
        public int drive;
        public int friction;
        public long brake;
        public long handbrake;
        public long differential_lock;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct lks_vehicle_def
    {
        public uint size;
        public uint axle_count;
        public lks_axle axles_0;
        public lks_axle axles_1;
        public lks_axle axles_2;
        public int peak_slip;
        public int peak_angle;
        public int relaxation;
        public int rolling_resistance;
        public fixed long torque[8];
        public long idle_speed;
        public long max_speed;
        public long engine_inertia;
        public long engine_friction;
        public fixed int ratios[8];
        public int reverse;
        public int final_drive;
        public uint automatic;
        public uint shift_ticks;
        public long shift_up;
        public long shift_down;
        public long clutch;
        public long wheel_inertia;
        public uint cast;
        public uint mask;
        public uint kind;
        public int max_lean;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct lks_vehicle_controls
    {
        public uint size;
        public int gear;
        public int throttle;
        public int brake;
        public int handbrake;
        public int steer;
        public int clutch;
        public uint reserved;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct lks_wheel_view
    {
        public lks_i64x3 centre;
        public long spin;
        public long load;
        public int compression;
        public int steer_sin;
        public uint is_grounded;
        public uint reserved;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct lks_vehicle_view
    {
        public uint size;
        public int gear;
        public long engine_speed;
        public uint wheel_count;
        public int lean;
        public lks_wheel_view wheels_0;
        public lks_wheel_view wheels_1;
        public lks_wheel_view wheels_2;
        public lks_wheel_view wheels_3;
        public lks_wheel_view wheels_4;
        public lks_wheel_view wheels_5;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct lks_world_def
    {
        public uint size;
        public uint body_capacity;
        public uint pair_capacity;
        public uint contact_capacity;
        public uint joint_capacity;
        public uint tick_rate;
        public uint substeps;
        public uint sleep_ms;
        public int sleep_distance;
        public uint broad_phase;
        public lks_i64x3 gravity;
        public long speed_limit;
        public uint converged_contacts;
        public uint vehicle_capacity;
        public uint terrain_tile_capacity;
        public uint reserved;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct lks_step_report
    {
        public uint size;
        public int status;
        public uint moving_bodies;
        public uint asleep_bodies;
        public uint islands;
        public uint free_bodies;
        public uint axis_turns;
        public uint pairs;
        public uint contacts;
        public uint contact_points;
        public uint colors;
        public uint overflow_contacts;
        public uint continuous_bodies;
        public uint impacts;
        public uint saturations;
        public uint energy_limits;
        public uint computed_islands;
        public uint recalled_islands;
        public uint still_bodies;
        public uint still_contacts;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct lockstone_game_info
    {
        public ulong config_hash;
        public ulong scene_hash;
        public ulong canary;
        public uint abi;
        public ushort tick_rate;
        public byte player_count;
        public byte input_bytes;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct lockstone_game_input
    {
        public byte* bytes;
        public uint origin;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct lockstone_game_hash
    {
        public byte* name;
        public ulong low;
        public ulong high;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct lockstone_game_difference
    {
        public ulong @object;
        public fixed byte store[96];
        public fixed byte name[96];
        public fixed byte field[96];
        public fixed byte here[96];
        public fixed byte there[96];
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct lockstone_game_scene
    {
        public byte* name;
        public byte* description;
        public uint ticks;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct lockstone_game_request
    {
        public byte* scene;
        public ulong seed;
        public long bodies;
        public uint players;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct lockstone_game_table
    {
        public uint abi;
        public uint bytes;
        public byte* name;
        public byte* version;
        public byte* build;
        public IntPtr create;
        public IntPtr destroy;
        public IntPtr info;
        public IntPtr tick;
        public IntPtr step;
        public IntPtr snapshot_bytes_max;
        public IntPtr save;
        public IntPtr load;
        public IntPtr hash;
        public IntPtr part_hashes;
        public IntPtr describe;
        public IntPtr configure;
        public IntPtr bot;
        public IntPtr step_traced;
        public IntPtr draw;
        public lockstone_game_scene* scenes;
        public UIntPtr scene_count;
        public IntPtr keep_history;
        public IntPtr forget_history;
        public IntPtr command;
    }

    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
    public unsafe delegate void lks_sample_function(void* user, ulong tick, byte* @out, UIntPtr bytes);
    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
    public unsafe delegate void lks_predict_function(void* user, ulong tick, uint slot, byte* @out, UIntPtr bytes);
    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
    public unsafe delegate void* lks_allocate_function(void* user, UIntPtr bytes, UIntPtr alignment);
    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
    public unsafe delegate void lks_release_function(void* user, void* memory, UIntPtr bytes, UIntPtr alignment);
    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
    public unsafe delegate void lks_log_function(void* user, uint level, byte* text);
    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
    public unsafe delegate int lockstone_game_create_function(byte* config, UIntPtr config_bytes, void** match);
    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
    public unsafe delegate void lockstone_game_destroy_function(void* match);
    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
    public unsafe delegate void lockstone_game_info_function(void* match, lockstone_game_info* @out);
    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
    public unsafe delegate ulong lockstone_game_tick_function(void* match);
    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
    public unsafe delegate void lockstone_game_step_function(void* match, lockstone_game_input* inputs, UIntPtr count);
    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
    public unsafe delegate UIntPtr lockstone_game_snapshot_bytes_max_function(void* match, uint kind);
    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
    public unsafe delegate UIntPtr lockstone_game_save_function(void* match, uint kind, byte* @out, UIntPtr capacity);
    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
    public unsafe delegate int lockstone_game_load_function(void* match, uint kind, byte* bytes, UIntPtr size);
    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
    public unsafe delegate ulong lockstone_game_hash_function(void* match);
    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
    public unsafe delegate UIntPtr lockstone_game_part_hashes_function(void* match, lockstone_game_hash* @out);
    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
    public unsafe delegate int lockstone_game_describe_function(void* match, byte* here, UIntPtr here_bytes, byte* there, UIntPtr there_bytes, lockstone_game_difference* @out);
    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
    public unsafe delegate int lockstone_game_configure_function(lockstone_game_request* request, byte* @out, UIntPtr* size);
    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
    public unsafe delegate int lockstone_game_bot_function(void* match, ulong seed, uint slot, ulong tick, byte* @out);
    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
    public unsafe delegate UIntPtr lockstone_game_step_traced_function(void* match, lockstone_game_input* inputs, UIntPtr count, lockstone_game_hash* @out, UIntPtr capacity);
    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
    public unsafe delegate UIntPtr lockstone_game_draw_function(void* match, byte* @out, UIntPtr capacity);
    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
    public unsafe delegate void lockstone_game_keep_history_function(void* match, uint ticks);
    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
    public unsafe delegate void lockstone_game_forget_history_function(void* match);
    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
    public unsafe delegate void lockstone_game_command_function(void* match, uint slot, byte* bytes, UIntPtr size);

    public static unsafe class Native
    {
        const string Library = "lockstone_c";

        public const uint LKS_SPHERE = 0;
        public const uint LKS_CAPSULE = 1;
        public const uint LKS_BOX = 2;
        public const uint LKS_HULL = 3;
        public const uint LKS_HALF_SPACE = 4;
        public const uint LKS_MESH = 5;
        public const uint LKS_HEIGHT_FIELD = 6;
        public const uint LKS_COMPOUND = 7;
        public const uint LKS_CYLINDER = 8;
        public const uint LKS_CONE = 9;
        public const uint LKS_TAPERED_CAPSULE = 10;
        public const uint LKS_ROUNDED_BOX = 11;
        public const uint LKS_C_ABI = 0;
        public const int LKS_OK = 0;
        public const int LKS_CAPACITY_EXHAUSTED = 1;
        public const int LKS_STALE_HANDLE = 2;
        public const int LKS_INVALID_ARGUMENT = 3;
        public const int LKS_TRUNCATED = 4;
        public const int LKS_MALFORMED = 5;
        public const int LKS_CHECKSUM_MISMATCH = 6;
        public const int LKS_UNSUPPORTED_VERSION = 7;
        public const int LKS_INCOMPATIBLE = 8;
        public const int LKS_IO_ERROR = 9;
        public const int LKS_NOT_FOUND = 10;
        public const int LKS_NULL_ARGUMENT = 64;
        public const int LKS_WRONG_SIZE = 65;
        public const int LKS_BUFFER_TOO_SMALL = 66;
        public const int LKS_READ_ONLY = 67;
        public const int LKS_OUT_OF_MEMORY = 68;
        public const int LKS_INTERNAL = 69;
        public const int LKS_UNSUPPORTED = 70;
        public const uint LKS_STATIC = 1;
        public const uint LKS_KINEMATIC = 2;
        public const uint LKS_DYNAMIC = 3;
        public const uint LKS_FRAME_WORLD = 0;
        public const uint LKS_FRAME_BODY = 1;
        public const uint LKS_COMBINE_STANDARD = 0;
        public const uint LKS_COMBINE_AVERAGE = 1;
        public const uint LKS_COMBINE_GEOMETRIC_MEAN = 2;
        public const uint LKS_COMBINE_MINIMUM = 3;
        public const uint LKS_COMBINE_MULTIPLY = 4;
        public const uint LKS_COMBINE_MAXIMUM = 5;
        public const uint LKS_BODY_TRIGGER = 1;
        public const uint LKS_BODY_FIXED_ROTATION = 2;
        public const uint LKS_BODY_BULLET = 4;
        public const uint LKS_BODY_ALLOW_SLEEP = 8;
        public const uint LKS_BODY_ASLEEP = 16;
        public const uint LKS_BODY_DISABLED = 32;
        public const uint LKS_BODY_CONTACT_EVENTS = 1;
        public const uint LKS_BODY_PERSIST_EVENTS = 2;
        public const uint LKS_LOCK_MOVE_X = 1;
        public const uint LKS_LOCK_MOVE_Y = 2;
        public const uint LKS_LOCK_MOVE_Z = 4;
        public const uint LKS_LOCK_TURN_X = 8;
        public const uint LKS_LOCK_TURN_Y = 16;
        public const uint LKS_LOCK_TURN_Z = 32;
        public const uint LKS_CLIENT_CONNECTING = 0;
        public const uint LKS_CLIENT_HANDSHAKING = 1;
        public const uint LKS_CLIENT_LOBBY = 2;
        public const uint LKS_CLIENT_JOINING = 3;
        public const uint LKS_CLIENT_RUNNING = 4;
        public const uint LKS_CLIENT_FINISHED = 5;
        public const uint LKS_CLIENT_REFUSED = 6;
        public const uint LKS_CLIENT_FAILED = 7;
        public const uint LKS_CONTACT_BEGIN = 0;
        public const uint LKS_CONTACT_END = 1;
        public const uint LKS_TRIGGER_ENTER = 2;
        public const uint LKS_TRIGGER_STAY = 3;
        public const uint LKS_TRIGGER_EXIT = 4;
        public const uint LKS_IMPACT = 5;
        public const uint LKS_SLEEP = 6;
        public const uint LKS_WAKE = 7;
        public const uint LKS_CONTACT_PERSIST = 8;
        public const uint LKS_INPUT_RECEIVED = 0;
        public const uint LKS_INPUT_REPEATED = 1;
        public const uint LKS_INPUT_NEUTRAL = 2;
        public const uint LKS_INPUT_ABSENT = 3;
        public const uint LKS_LEVEL_DEBUG = 0;
        public const uint LKS_LEVEL_INFO = 1;
        public const uint LKS_LEVEL_WARNING = 2;
        public const uint LKS_LEVEL_ERROR = 3;
        public const uint LKS_JOINT_DISTANCE = 1;
        public const uint LKS_JOINT_BALL = 2;
        public const uint LKS_JOINT_HINGE = 3;
        public const uint LKS_JOINT_SLIDER = 4;
        public const uint LKS_JOINT_WELD = 5;
        public const uint LKS_JOINT_WHEEL = 6;
        public const uint LKS_JOINT_MOTOR = 7;
        public const uint LKS_JOINT_SIX_AXIS = 8;
        public const uint LKS_JOINT_PULLEY = 9;
        public const uint LKS_JOINT_GEAR = 10;
        public const uint LKS_JOINT_RACK = 11;
        public const uint LKS_JOINT_RATCHET = 12;
        public const uint LKS_JOINT_PATH = 13;
        public const uint LKS_AXIS_LOCKED = 0;
        public const uint LKS_AXIS_FREE = 1;
        public const uint LKS_AXIS_LIMITED = 2;
        public const uint LKS_LOG_SAME = 0;
        public const uint LKS_LOG_DIVERGED = 1;
        public const uint LKS_LOG_CORRUPT = 2;
        public const uint LKS_LOG_INCOMPATIBLE = 3;
        public const uint LKS_FILTER_BODIES = 16;
        public const uint LKS_MAX_BONES = 64;
        public const uint LKS_NO_BONE = 4294967295;
        public const uint LKS_BONE_LIMP = 0;
        public const uint LKS_BONE_SPRUNG = 1;
        public const uint LKS_BONE_DRIVEN = 2;
        public const uint LKS_BONE_KINEMATIC = 3;
        public const uint LKS_SERVER_LOBBY = 0;
        public const uint LKS_SERVER_RUNNING = 1;
        public const uint LKS_SERVER_FINISHING = 2;
        public const uint LKS_SERVER_CLOSING = 3;
        public const uint LKS_SERVER_OVER = 4;
        public const uint LKS_LATE_DEADLINE = 0;
        public const uint LKS_LATE_STRICT = 1;
        public const uint LKS_SUBSTITUTE_REPEAT = 0;
        public const uint LKS_SUBSTITUTE_NEUTRAL = 1;
        public const uint LKS_PACING_REAL_TIME = 0;
        public const uint LKS_PACING_FAST = 1;
        public const uint LKS_DESYNC_END = 0;
        public const uint LKS_DESYNC_KICK = 1;
        public const uint LKS_DESYNC_RESYNC = 2;
        public const uint LKS_NO_SLOT = 255;
        public const uint LKS_SPECTATOR_SLOT = 254;
        public const uint LKS_SERVER_SLOT = 253;
        public const uint LKS_SESSION_STARTED = 1;
        public const uint LKS_SESSION_TICK = 2;
        public const uint LKS_SESSION_FINISHED = 3;
        public const uint LKS_SESSION_DESYNC = 4;
        public const uint LKS_SESSION_SILENT = 5;
        public const uint LKS_SESSION_JOINED = 6;
        public const uint LKS_SESSION_PLAYER_ACTIVE = 7;
        public const uint LKS_SESSION_NAMED = 8;
        public const uint LKS_SESSION_COMMAND = 9;
        public const uint LKS_SESSION_LEFT = 16;
        public const uint LKS_SESSION_REFUSED = 17;
        public const uint LKS_SESSION_ASKED = 18;
        public const uint LKS_SESSION_STATE_LOADED = 32;
        public const uint LKS_SESSION_PAUSED = 33;
        public const uint LKS_SESSION_INPUT_REPLACED = 34;
        public const uint LKS_SESSION_PREDICTED = 35;
        public const uint LKS_SESSION_ROLLED_BACK = 36;
        public const uint LKS_SESSION_COMMAND_REFUSED = 37;
        public const uint LKS_ASK_PAUSE = 0;
        public const uint LKS_ASK_RESUME = 1;
        public const uint LKS_ASK_VOTE = 2;
        public const uint LKS_FINISH_COMPLETED = 0;
        public const uint LKS_FINISH_STOPPED = 1;
        public const uint LKS_FINISH_DESYNC = 2;
        public const uint LKS_FINISH_NO_PLAYERS = 3;
        public const uint LKS_NATIVE = 0;
        public const uint LKS_CANONICAL = 1;
        public const int LKS_POSITION_BITS = 32;
        public const int LKS_VELOCITY_BITS = 32;
        public const int LKS_ANGULAR_VELOCITY_BITS = 32;
        public const int LKS_ACCELERATION_BITS = 32;
        public const int LKS_MASS_BITS = 32;
        public const int LKS_IMPULSE_BITS = 24;
        public const int LKS_FORCE_BITS = 20;
        public const int LKS_LENGTH_BITS = 20;
        public const int LKS_SPEED_BITS = 20;
        public const int LKS_DISPLACEMENT_BITS = 24;
        public const int LKS_UNIT_BITS = 30;
        public const int LKS_NUMBER_BITS = 20;
        public const int LKS_RATE_BITS = 20;
        public const int LKS_ANGLE_BITS = 27;
        public const int LKS_DENSITY_BITS = 8;
        public const int LKS_INERTIA_BITS = 28;
        public const uint LKS_WHEEL_RAY = 0;
        public const uint LKS_WHEEL_SPHERE = 1;
        public const uint LKS_VEHICLE_CAR = 0;
        public const uint LKS_VEHICLE_MOTORCYCLE = 1;
        public const uint LKS_VEHICLE_TRACKED = 2;
        public const uint LKS_MAX_HISTORY_TICKS = 256;
        public const uint LOCKSTONE_GAME_ABI = 1;
        public const uint LOCKSTONE_GAME_MAX_PARTS = 8;
        public const uint LOCKSTONE_GAME_TEXT_BYTES = 96;
        public const int LOCKSTONE_GAME_OK = 0;
        public const int LOCKSTONE_GAME_CAPACITY_EXHAUSTED = 1;
        public const int LOCKSTONE_GAME_INVALID_ARGUMENT = 3;
        public const int LOCKSTONE_GAME_TRUNCATED = 4;
        public const int LOCKSTONE_GAME_MALFORMED = 5;
        public const int LOCKSTONE_GAME_UNSUPPORTED_VERSION = 7;
        public const int LOCKSTONE_GAME_INCOMPATIBLE = 8;
        public const int LOCKSTONE_GAME_NOT_FOUND = 10;
        public const uint LOCKSTONE_GAME_NATIVE = 0;
        public const uint LOCKSTONE_GAME_CANONICAL = 1;

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_fit(uint kind, lks_i32x3* points, UIntPtr count, lks_shape* shape, lks_pose* pose);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_assets_create(IntPtr* @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern void lks_assets_destroy(IntPtr assets);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_assets_add_hull(IntPtr assets, lks_i32x3* points, UIntPtr count, int max_vertices, ulong* @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_assets_add_path(IntPtr assets, lks_path_point* points, UIntPtr count, uint closed, ulong* @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_assets_add_banked_path(IntPtr assets, lks_path_point* points, int* banks, UIntPtr count, uint closed, ulong* @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_assets_add_rounded_hull(IntPtr assets, lks_i32x3* points, UIntPtr count, int max_vertices, int radius, ulong* @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_assets_add_bytes(IntPtr assets, void* bytes, UIntPtr count, ulong* @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_assets_find_part(IntPtr assets, ulong compound, uint part, uint* child, uint* triangle);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_assets_add_scaled(IntPtr assets, ulong asset, lks_i32x3* factors, ulong* @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_shape_distance(IntPtr assets, lks_placed_shape* a, lks_placed_shape* b, int reach, lks_shape_gap* @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_shape_cast(IntPtr assets, lks_placed_shape* a, lks_placed_shape* b, lks_i32x3* way, lks_shape_hit* @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_shape_impact(IntPtr assets, lks_placed_shape* a, lks_pose* end_a, lks_placed_shape* b, lks_pose* end_b, int gap, lks_shape_hit* @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern byte* lks_status_name(int status);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern byte* lks_last_error();

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern uint lks_c_abi();

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern byte* lks_version();

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern uint lks_simulation_abi();

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern ulong lks_canary_hash();

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_body_def_init(lks_body_def* def, UIntPtr size);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_create_body(IntPtr world, lks_body_def* def, ulong* @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_destroy_body(IntPtr world, ulong body);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_teleport(IntPtr world, ulong body, lks_pose* pose);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_set_velocity(IntPtr world, ulong body, lks_i64x3* velocity);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_set_angular_velocity(IntPtr world, ulong body, lks_i64x3* velocity);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_apply_impulse(IntPtr world, ulong body, lks_i64x3* impulse, uint frame);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_apply_impulse_at(IntPtr world, ulong body, lks_i64x3* impulse, lks_i32x3* point, uint frame);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_apply_angular_impulse(IntPtr world, ulong body, lks_i64x3* impulse, uint frame);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_apply_force(IntPtr world, ulong body, lks_i64x3* force, uint frame);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_apply_force_at(IntPtr world, ulong body, lks_i64x3* force, lks_i32x3* point, uint frame);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_apply_torque(IntPtr world, ulong body, lks_i64x3* torque, uint frame);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_move_kinematic(IntPtr world, ulong body, lks_pose* pose);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_set_material(IntPtr world, ulong body, lks_surface* surface);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_set_surface_motion(IntPtr world, ulong body, lks_surface_motion* motion);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_set_gravity_scale(IntPtr world, ulong body, int scale);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_set_damping(IntPtr world, ulong body, int linear, int angular);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_set_axis_locks(IntPtr world, ulong body, uint locks);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_set_speed_limit(IntPtr world, ulong body, long linear, long angular);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_set_filter(IntPtr world, ulong body, lks_filter* filter);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_set_events(IntPtr world, ulong body, uint events, int hit_speed);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_set_user_data(IntPtr world, ulong body, ulong user_data);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_set_motion_type(IntPtr world, ulong body, uint motion, long mass);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_set_shape(IntPtr world, ulong body, lks_shape* shape, long mass);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_set_mass_data(IntPtr world, ulong body, long mass, lks_i64x3* inertia);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_set_enabled(IntPtr world, ulong body, uint enabled);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_wake_body(IntPtr world, ulong body);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_sleep_body(IntPtr world, ulong body);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_set_allow_sleep(IntPtr world, ulong body, uint allow);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_set_gravity(IntPtr world, lks_i64x3* gravity);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_fluid_init(lks_fluid* fluid, UIntPtr size);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_set_fluid(IntPtr world, uint number, lks_fluid* fluid);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_fluid_get(IntPtr world, uint number, lks_fluid* @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_set_pair_rule(IntPtr world, ulong a, ulong b, uint collides, lks_pair_surface* surface);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_pair_rule_get(IntPtr world, ulong a, ulong b, uint* collides, uint* has_surface, lks_pair_surface* surface);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_set_surface_rule(IntPtr world, uint tag_a, uint tag_b, lks_pair_surface* surface);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_surface_rule_get(IntPtr world, uint tag_a, uint tag_b, uint* has_surface, lks_pair_surface* surface);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_set_one_way(IntPtr world, ulong body, lks_i32x3* direction, uint tolerance);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_one_way_get(IntPtr world, ulong body, lks_i32x3* direction, uint* tolerance);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_set_name(IntPtr world, ulong body, byte* name);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_body_exists(IntPtr world, ulong body, uint* @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_body_get(IntPtr world, ulong body, lks_body_view* @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_body_pose(IntPtr world, ulong body, lks_pose* @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_body_velocity(IntPtr world, ulong body, lks_i64x3* @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_bodies(IntPtr world, ulong* bodies, lks_pose* poses, lks_i64x3* velocities, UIntPtr capacity, UIntPtr* count);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_client_def_init(lks_client_def* def, UIntPtr size);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_client_create(lks_client_def* def, IntPtr game, IntPtr transport, uint connection, IntPtr* @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern void lks_client_destroy(IntPtr client);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_client_set_input(IntPtr client, void* input, UIntPtr bytes);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_client_on_sample(IntPtr client, IntPtr sample, void* user);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_client_on_predict(IntPtr client, IntPtr predict, void* user);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_client_update(IntPtr client, long now_us);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_client_events(IntPtr client, lks_session_event* @out, UIntPtr capacity, UIntPtr* count);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_client_event_text(IntPtr client, UIntPtr index, byte* @out, UIntPtr capacity);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_client_event_bytes(IntPtr client, UIntPtr index, void* @out, UIntPtr capacity, UIntPtr* count);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_client_send_command(IntPtr client, void* bytes, UIntPtr count, ulong* number);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_client_get(IntPtr client, lks_client_view* view);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_client_reason(IntPtr client, byte* @out, UIntPtr capacity);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_client_player_name(IntPtr client, uint slot, byte* @out, UIntPtr capacity);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_client_simulation(IntPtr client, IntPtr* @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_client_stats(IntPtr client, lks_session_stats* stats);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_client_ask(IntPtr client, uint kind, uint topic, uint choice);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_client_reconnect(IntPtr client, uint connection);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_client_leave(IntPtr client);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_client_record(IntPtr client, lks_recorder_def* def, IntPtr* @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_events(IntPtr world, lks_event* @out, UIntPtr capacity, UIntPtr* count);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_joint_events(IntPtr world, lks_joint_event* @out, UIntPtr capacity, UIntPtr* count);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_hit_events(IntPtr world, lks_hit_event* @out, UIntPtr capacity, UIntPtr* count);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_contacts_of(IntPtr world, ulong body, lks_body_contact* @out, UIntPtr capacity, UIntPtr* count);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_joints_of(IntPtr world, ulong body, ulong* @out, UIntPtr capacity, UIntPtr* count);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_touching(IntPtr world, ulong a, ulong b, uint* @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_game_create(lockstone_game_table* table, IntPtr* @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_game_builtin(IntPtr* @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern void lks_game_destroy(IntPtr game);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_simulation_create(IntPtr game, void* config, UIntPtr config_bytes, IntPtr* @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern void lks_simulation_destroy(IntPtr simulation);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_simulation_get_info(IntPtr simulation, lks_simulation_info* @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_simulation_tick(IntPtr simulation, ulong* @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_simulation_match(IntPtr simulation, void** @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_simulation_world(IntPtr simulation, IntPtr* @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_simulation_step(IntPtr simulation, void* inputs, UIntPtr bytes, uint* origins);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_simulation_command(IntPtr simulation, uint slot, void* bytes, UIntPtr count);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_simulation_hash(IntPtr simulation, ulong* @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_simulation_snapshot_bytes_max(IntPtr simulation, uint kind, UIntPtr* @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_simulation_save(IntPtr simulation, uint kind, void* @out, UIntPtr capacity, UIntPtr* bytes);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_simulation_load(IntPtr simulation, uint kind, void* bytes, UIntPtr count);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_set_allocator(IntPtr allocate, IntPtr release, void* user);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_set_log(IntPtr write, void* user);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_joint_def_init(lks_joint_def* def, UIntPtr size, uint kind, ulong a, ulong b);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_create_joint(IntPtr world, lks_joint_def* def, ulong* @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_destroy_joint(IntPtr world, ulong joint);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_set_linear_axis(IntPtr world, ulong joint, uint axis, lks_axis* settings);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_set_angular_axis(IntPtr world, ulong joint, uint axis, lks_axis* settings);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_joint_get(IntPtr world, ulong joint, lks_joint_view* @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_joints(IntPtr world, ulong* joints, UIntPtr capacity, UIntPtr* count);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_verify_log(byte* path, lks_log_report* report);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_verify_log_bytes(void* bytes, UIntPtr count, lks_log_report* report);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_log_open(byte* path, IntPtr* @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_log_open_bytes(void* bytes, UIntPtr count, IntPtr* @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern void lks_log_close(IntPtr log);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_log_get_info(IntPtr log, lks_log_info* info);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_log_player_name(IntPtr log, uint slot, byte* @out, UIntPtr capacity);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_log_config(IntPtr log, void* @out, UIntPtr capacity, UIntPtr* count);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_log_next(IntPtr log, ulong* tick, void* inputs, UIntPtr bytes, uint* origins, ulong* hash);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_log_command(IntPtr log, UIntPtr index, uint* slot, void* @out, UIntPtr capacity, UIntPtr* count);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_log_seek(IntPtr log, IntPtr game, ulong tick, IntPtr* @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_log_verify(IntPtr log, IntPtr game, lks_log_report* report);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_log_bisect(IntPtr here, IntPtr there, IntPtr game, lks_bisect_report* report);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_query_filter_init(lks_query_filter* filter, UIntPtr size);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_cast_ray(IntPtr world, lks_i64x3* origin, lks_i32x3* way, lks_query_filter* filter, lks_hit* @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_cast_ray_all(IntPtr world, lks_i64x3* origin, lks_i32x3* way, lks_query_filter* filter, lks_hit* @out, UIntPtr capacity, UIntPtr* count);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_is_ray_blocked(IntPtr world, lks_i64x3* origin, lks_i32x3* way, lks_query_filter* filter, uint* @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_cast_shape(IntPtr world, lks_shape* shape, lks_pose* start, lks_i32x3* way, lks_query_filter* filter, lks_hit* @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_overlap_sphere(IntPtr world, lks_i64x3* centre, int radius, lks_query_filter* filter, ulong* @out, UIntPtr capacity, UIntPtr* count);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_overlap_shape(IntPtr world, lks_shape* shape, lks_pose* pose, lks_query_filter* filter, ulong* @out, UIntPtr capacity, UIntPtr* count);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_bodies_in_box(IntPtr world, lks_i64x3* lower, lks_i64x3* upper, lks_query_filter* filter, ulong* @out, UIntPtr capacity, UIntPtr* count);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_closest_point(IntPtr world, lks_i64x3* point, int reach, lks_query_filter* filter, lks_closest* @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_bone_init(lks_bone* bone);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_ragdoll_def_init(lks_ragdoll_def* def, UIntPtr size);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_ragdoll_pose_init(lks_ragdoll_pose* pose);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_bone_drive_init(lks_bone_drive* drive);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_create_ragdoll(IntPtr world, lks_ragdoll_def* def, lks_bone* bones, UIntPtr bone_count, lks_ragdoll_pose* pose, lks_ragdoll* @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_destroy_ragdoll(IntPtr world, lks_ragdoll* ragdoll);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_drive_ragdoll(IntPtr world, lks_ragdoll_def* def, lks_bone* bones, UIntPtr bone_count, lks_ragdoll* ragdoll, lks_ragdoll_pose* from, lks_ragdoll_pose* to, lks_bone_drive* drives, UIntPtr drive_count);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_ragdoll_pose_get(IntPtr world, lks_bone* bones, UIntPtr bone_count, lks_ragdoll* ragdoll, lks_ragdoll_pose* @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_bone_poses(lks_bone* bones, UIntPtr bone_count, lks_ragdoll_pose* pose, lks_pose* @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_drag_init(lks_drag* drag, UIntPtr size, ulong ground, ulong body);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_create_drag(IntPtr world, lks_drag* drag, lks_i64x3* target, ulong* @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_move_drag(IntPtr world, ulong joint, lks_drag* drag, lks_i64x3* target);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_recorder_def_init(lks_recorder_def* def, UIntPtr size);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_recorder_create(lks_recorder_def* def, IntPtr simulation, byte* path, IntPtr* @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_recorder_create_in_memory(lks_recorder_def* def, IntPtr simulation, IntPtr* @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern void lks_recorder_destroy(IntPtr recorder);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_recorder_step(IntPtr recorder, void* inputs, UIntPtr bytes, uint* origins);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_recorder_note(IntPtr recorder, byte* text);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_recorder_finish(IntPtr recorder, byte* reason);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_recorder_bytes(IntPtr recorder, void* @out, UIntPtr capacity, UIntPtr* count);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_server_def_init(lks_server_def* def, UIntPtr size);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_server_create(lks_server_def* def, IntPtr simulation, IntPtr transport, IntPtr* @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern void lks_server_destroy(IntPtr server);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_server_update(IntPtr server, long now_us);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_server_events(IntPtr server, lks_session_event* @out, UIntPtr capacity, UIntPtr* count);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_server_event_text(IntPtr server, UIntPtr index, byte* @out, UIntPtr capacity);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_server_event_bytes(IntPtr server, UIntPtr index, void* @out, UIntPtr capacity, UIntPtr* count);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_server_send_command(IntPtr server, void* bytes, UIntPtr count);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_server_record(IntPtr server, IntPtr recorder);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_server_stop(IntPtr server);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_server_pause(IntPtr server, uint paused);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_server_get(IntPtr server, lks_server_view* view);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_server_player_name(IntPtr server, uint slot, byte* @out, UIntPtr capacity);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_server_stats(IntPtr server, uint slot, lks_session_stats* stats);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_hash(IntPtr world, ulong* @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_part_hashes(IntPtr world, lks_hashes* @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_snapshot_bytes_max(IntPtr world, uint kind, UIntPtr* @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_save(IntPtr world, uint kind, void* @out, UIntPtr capacity, UIntPtr* bytes);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_load(IntPtr world, uint kind, void* bytes, UIntPtr count);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_describe_difference(IntPtr world, void* here, UIntPtr here_bytes, void* there, UIntPtr there_bytes, uint* differs, byte* text, UIntPtr capacity);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_set_heights(IntPtr world, ulong body, lks_height_rectangle* rectangle, int* heights, byte* holes, byte* surfaces);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_terrain_sample_get(IntPtr world, ulong body, uint column, uint row, int* height, uint* is_hole, uint* surface);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_set_mesh_group(IntPtr world, ulong body, uint group, uint is_on);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_mesh_group_get(IntPtr world, ulong body, uint group, uint* is_on);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_terrain_tile_count(IntPtr world, uint* @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern void lks_transport_destroy(IntPtr transport);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_enet_def_init(lks_enet_def* def, UIntPtr size);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_enet_listen(lks_enet_def* def, byte* address, void* key, IntPtr* @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_enet_connect(byte* address, uint port, IntPtr* @out, uint* connection);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_enet_join(byte* token, IntPtr* @out, uint* connection);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_enet_connect_again(IntPtr transport, uint* connection);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_enet_port(IntPtr transport, uint* @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_enet_wait(IntPtr transport, long limit_us);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_issue_token(void* key, ulong match_id, ulong player, uint slot, ulong expires_unix_s, byte* address, uint port, byte* @out, UIntPtr capacity);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_carried_create(byte* token, IntPtr* @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_carried_call(IntPtr transport, uint* connection);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_carried_opened(IntPtr transport);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_carried_receive(IntPtr transport, void* message, UIntPtr bytes);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_carried_take(IntPtr transport, void* @out, UIntPtr capacity, UIntPtr* bytes);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_carried_closed(IntPtr transport, uint code);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_carried_is_open(IntPtr transport, uint* @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_network_create(ulong seed, IntPtr* @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern void lks_network_destroy(IntPtr network);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_network_add(IntPtr network, IntPtr* @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_network_connect(IntPtr network, IntPtr from, IntPtr to, lks_link_faults* faults, uint* connection);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern long lks_now_us();

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_quat_from_axis_angle(lks_i32x3* axis, int angle, lks_quat* @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_from_ratio(long numerator, long denominator, int bits, long* @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_from_decimal(byte* text, int bits, long* @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_to_decimal(long raw, int bits, byte* @out, UIntPtr capacity);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_vehicle_controls_init(lks_vehicle_controls* controls, UIntPtr size);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_make_car(int length, int half_track, int height, long torque, lks_vehicle_def* @out, UIntPtr size);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_make_motorcycle(int length, int height, long torque, lks_vehicle_def* @out, UIntPtr size);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_make_tank(int length, int half_track, int height, long torque, lks_vehicle_def* @out, UIntPtr size);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_set_vehicle(IntPtr world, ulong chassis, lks_vehicle_def* def);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_drive_vehicle(IntPtr world, ulong chassis, lks_vehicle_controls* controls);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_vehicle_get(IntPtr world, ulong chassis, lks_vehicle_view* @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_world_def_init(lks_world_def* def, UIntPtr size);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_world_create(lks_world_def* def, IntPtr assets, IntPtr* @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_world_create_scene(byte* name, ulong seed, IntPtr* @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern uint lks_scene_count();

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern byte* lks_scene_name(uint index);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern void lks_world_destroy(IntPtr world);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_world_get_def(IntPtr world, lks_world_def* def);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_config_hash(lks_world_def* def, IntPtr assets, ulong* @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_world_set_threads(IntPtr world, uint threads);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_step(IntPtr world, lks_step_report* report);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_world_keep_history(IntPtr world, uint ticks);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_world_forget_history(IntPtr world);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int lks_tick(IntPtr world, ulong* @out);
    }
}
