"""liblockstone_c by ctypes: structures and functions as lockstone.h declares them."""

from __future__ import annotations

import ctypes
import os
import pathlib
from ctypes import POINTER, c_char, c_char_p, c_int32, c_int64, c_size_t, c_uint32, c_uint64, c_void_p

C_ABI = 0


class I64x3(ctypes.Structure):
    _fields_ = [("x", c_int64), ("y", c_int64), ("z", c_int64)]


class I32x3(ctypes.Structure):
    _fields_ = [("x", c_int32), ("y", c_int32), ("z", c_int32)]


class PathPoint(ctypes.Structure):
    _fields_ = [("position", I32x3), ("up", I32x3)]


class Quat(ctypes.Structure):
    _fields_ = [("x", c_int32), ("y", c_int32), ("z", c_int32), ("w", c_int32)]


class Pose(ctypes.Structure):
    _fields_ = [("position", I64x3), ("orientation", Quat)]


class Shape(ctypes.Structure):
    _fields_ = [("kind", c_uint32), ("size", I32x3), ("asset", c_uint64)]


class WorldDef(ctypes.Structure):
    _fields_ = [("size", c_uint32), ("body_capacity", c_uint32), ("pair_capacity", c_uint32),
                ("contact_capacity", c_uint32), ("joint_capacity", c_uint32), ("tick_rate", c_uint32),
                ("substeps", c_uint32), ("sleep_ms", c_uint32), ("sleep_distance", c_int32),
                ("broad_phase", c_uint32), ("gravity", I64x3), ("speed_limit", c_int64),
                ("converged_contacts", c_uint32), ("vehicle_capacity", c_uint32),
                ("terrain_tile_capacity", c_uint32), ("reserved", c_uint32)]


class Surface(ctypes.Structure):
    _fields_ = [("friction", c_int32), ("restitution", c_int32), ("rolling_resistance", c_int32),
                ("friction_rule", c_uint32), ("restitution_rule", c_uint32), ("rolling_rule", c_uint32),
                ("tag", c_uint32)]


class SurfaceMotion(ctypes.Structure):
    _fields_ = [("velocity", I32x3), ("turning", I32x3)]


class Filter(ctypes.Structure):
    _fields_ = [("category", c_uint32), ("mask", c_uint32), ("group", c_int32)]


class BodyDef(ctypes.Structure):
    _fields_ = [("size", c_uint32), ("motion", c_uint32), ("shape", Shape), ("position", I64x3),
                ("velocity", I64x3), ("angular_velocity", I64x3), ("orientation", Quat),
                ("surface", Surface), ("density", c_int32), ("surface_motion", SurfaceMotion),
                ("filter", Filter), ("gravity_scale", c_int32), ("linear_damping", c_int32),
                ("angular_damping", c_int32), ("flags", c_uint32), ("locks", c_uint32),
                ("speed_limit", c_int64), ("angular_speed_limit", c_int64), ("user_data", c_uint64),
                ("events", c_uint32), ("hit_speed", c_int32), ("mass", c_int64), ("inertia", I64x3)]


class BodyView(ctypes.Structure):
    _fields_ = [("size", c_uint32), ("motion", c_uint32), ("shape", Shape), ("position", I64x3),
                ("centre_of_mass", I64x3), ("velocity", I64x3), ("angular_velocity", I64x3),
                ("orientation", Quat), ("surface", Surface), ("filter", Filter), ("flags", c_uint32),
                ("locks", c_uint32), ("mass", c_int64), ("user_data", c_uint64), ("events", c_uint32),
                ("hit_speed", c_int32), ("inertia", I64x3), ("principal_axes", Quat),
                ("surface_motion", SurfaceMotion), ("gravity_scale", c_int32), ("linear_damping", c_int32),
                ("angular_damping", c_int32), ("reserved", c_uint32), ("speed_limit", c_int64),
                ("angular_speed_limit", c_int64)]


class PairSurface(ctypes.Structure):
    _fields_ = [("friction", c_int32), ("restitution", c_int32), ("rolling_resistance", c_int32)]


class Fluid(ctypes.Structure):
    _fields_ = [("size", c_uint32), ("mask", c_uint32), ("surface", I64x3), ("extents", I64x3), ("flow", I64x3),
                ("orientation", Quat), ("density", c_int32), ("drag", c_int32), ("linear_drag", c_int32),
                ("reserved", c_uint32)]


class Axis(ctypes.Structure):
    _fields_ = [("mode", c_uint32), ("lower", c_int32), ("upper", c_int32), ("target", c_int32),
                ("speed", c_int32), ("hertz", c_int32), ("damping_ratio", c_int32), ("reserved", c_uint32),
                ("max_effort", c_int64)]


class JointFrame(ctypes.Structure):
    _fields_ = [("position", I32x3), ("orientation", Quat)]


class JointDef(ctypes.Structure):
    _fields_ = [("size", c_uint32), ("kind", c_uint32), ("body_a", c_uint64), ("body_b", c_uint64),
                ("frame_a", JointFrame), ("frame_b", JointFrame), ("linear", Axis * 3), ("angular", Axis * 3),
                ("ground_a", I64x3), ("ground_b", I64x3), ("ratio", c_int32), ("collide", c_uint32),
                ("break_force", c_int64), ("break_torque", c_int64), ("user_data", c_uint64), ("path", c_uint64)]


class Event(ctypes.Structure):
    _fields_ = [("kind", c_uint32), ("reserved", c_uint32), ("a", c_uint64), ("b", c_uint64),
                ("approach_speed", c_int64), ("tag_a", c_uint32), ("tag_b", c_uint32)]


class HitEvent(ctypes.Structure):
    _fields_ = [("a", c_uint64), ("b", c_uint64), ("point", I64x3), ("normal_impulse", c_int64),
                ("friction_impulse", I64x3), ("approach_speed", c_int64), ("normal", I32x3),
                ("was_stopped", c_uint32), ("part_a", c_uint32), ("part_b", c_uint32), ("tag_a", c_uint32),
                ("tag_b", c_uint32)]


class Hit(ctypes.Structure):
    _fields_ = [("body", c_uint64), ("fraction", c_int32), ("normal", I32x3), ("point", I64x3),
                ("part", c_uint32), ("reserved", c_uint32)]


class LogReport(ctypes.Structure):
    _fields_ = [("size", c_uint32), ("outcome", c_uint32), ("start_tick", c_uint64),
                ("ticks_verified", c_uint64), ("final_hash", c_uint64), ("diverged_tick", c_uint64),
                ("expected", c_uint64), ("actual", c_uint64), ("complete", c_uint32), ("torn_tail", c_uint32),
                ("line", c_char * 512)]


_WORLD, _BODY, _COUNT = c_void_p, c_uint64, POINTER(c_size_t)
_FLAG, _NUMBER = POINTER(c_uint32), POINTER(c_uint64)

# Functions that return a status, by their arguments.
_CALLS = {
    "lks_world_def_init": [POINTER(WorldDef), c_size_t],
    "lks_world_create": [POINTER(WorldDef), c_void_p, POINTER(c_void_p)],
    "lks_world_create_scene": [c_char_p, c_uint64, POINTER(c_void_p)],
    "lks_world_get_def": [_WORLD, POINTER(WorldDef)],
    "lks_world_set_threads": [_WORLD, c_uint32],
    "lks_config_hash": [POINTER(WorldDef), c_void_p, _NUMBER],
    "lks_part_hashes": [_WORLD, c_void_p],
    "lks_describe_difference": [_WORLD, c_char_p, c_size_t, c_char_p, c_size_t, _FLAG, c_void_p, c_size_t],
    "lks_assets_create": [POINTER(c_void_p)],
    "lks_assets_add_scaled": [c_void_p, c_uint64, POINTER(I32x3), _NUMBER],
    "lks_assets_add_hull": [c_void_p, POINTER(I32x3), c_size_t, c_int32, _NUMBER],
    "lks_assets_add_path": [c_void_p, c_void_p, c_size_t, c_uint32, _NUMBER],
    "lks_assets_add_banked_path": [c_void_p, c_void_p, c_void_p, c_size_t, c_uint32, _NUMBER],
    "lks_assets_add_rounded_hull": [c_void_p, POINTER(I32x3), c_size_t, c_int32, c_int32, _NUMBER],
    "lks_assets_add_bytes": [c_void_p, c_char_p, c_size_t, _NUMBER],
    "lks_assets_find_part": [c_void_p, c_uint64, c_uint32, POINTER(c_uint32), POINTER(c_uint32)],
    "lks_world_keep_history": [_WORLD, c_uint32],
    "lks_world_forget_history": [_WORLD],
    "lks_step": [_WORLD, c_void_p],
    "lks_tick": [_WORLD, _NUMBER],
    "lks_hash": [_WORLD, _NUMBER],
    "lks_body_def_init": [POINTER(BodyDef), c_size_t],
    "lks_create_body": [_WORLD, POINTER(BodyDef), _NUMBER],
    "lks_destroy_body": [_WORLD, _BODY],
    "lks_teleport": [_WORLD, _BODY, POINTER(Pose)],
    "lks_move_kinematic": [_WORLD, _BODY, POINTER(Pose)],
    "lks_set_velocity": [_WORLD, _BODY, POINTER(I64x3)],
    "lks_set_angular_velocity": [_WORLD, _BODY, POINTER(I64x3)],
    "lks_apply_impulse": [_WORLD, _BODY, POINTER(I64x3), c_uint32],
    "lks_apply_impulse_at": [_WORLD, _BODY, POINTER(I64x3), POINTER(I32x3), c_uint32],
    "lks_apply_angular_impulse": [_WORLD, _BODY, POINTER(I64x3), c_uint32],
    "lks_apply_force": [_WORLD, _BODY, POINTER(I64x3), c_uint32],
    "lks_apply_force_at": [_WORLD, _BODY, POINTER(I64x3), POINTER(I32x3), c_uint32],
    "lks_apply_torque": [_WORLD, _BODY, POINTER(I64x3), c_uint32],
    "lks_set_material": [_WORLD, _BODY, POINTER(Surface)],
    "lks_set_surface_motion": [_WORLD, _BODY, POINTER(SurfaceMotion)],
    "lks_set_gravity_scale": [_WORLD, _BODY, c_int32],
    "lks_set_damping": [_WORLD, _BODY, c_int32, c_int32],
    "lks_set_axis_locks": [_WORLD, _BODY, c_uint32],
    "lks_set_speed_limit": [_WORLD, _BODY, c_int64, c_int64],
    "lks_set_filter": [_WORLD, _BODY, POINTER(Filter)],
    "lks_set_events": [_WORLD, _BODY, c_uint32, c_int32],
    "lks_set_user_data": [_WORLD, _BODY, c_uint64],
    "lks_set_motion_type": [_WORLD, _BODY, c_uint32, c_int64],
    "lks_set_shape": [_WORLD, _BODY, POINTER(Shape), c_int64],
    "lks_set_mass_data": [_WORLD, _BODY, c_int64, POINTER(I64x3)],
    "lks_set_enabled": [_WORLD, _BODY, c_uint32],
    "lks_wake_body": [_WORLD, _BODY],
    "lks_sleep_body": [_WORLD, _BODY],
    "lks_set_allow_sleep": [_WORLD, _BODY, c_uint32],
    "lks_set_gravity": [_WORLD, POINTER(I64x3)],
    "lks_make_car": [c_int32, c_int32, c_int32, c_int64, c_void_p, c_size_t],
    "lks_make_motorcycle": [c_int32, c_int32, c_int64, c_void_p, c_size_t],
    "lks_make_tank": [c_int32, c_int32, c_int32, c_int64, c_void_p, c_size_t],
    "lks_set_vehicle": [_WORLD, _BODY, c_void_p],
    "lks_vehicle_controls_init": [c_void_p, c_size_t],
    "lks_drive_vehicle": [_WORLD, _BODY, c_void_p],
    "lks_vehicle_get": [_WORLD, _BODY, c_void_p],
    "lks_set_mesh_group": [_WORLD, _BODY, c_uint32, c_uint32],
    "lks_mesh_group_get": [_WORLD, _BODY, c_uint32, POINTER(c_uint32)],
    "lks_set_heights": [_WORLD, _BODY, c_void_p, c_void_p, c_void_p, c_void_p],
    "lks_terrain_sample_get": [_WORLD, _BODY, c_uint32, c_uint32, c_void_p, c_void_p, c_void_p],
    "lks_set_pair_rule": [_WORLD, _BODY, _BODY, c_uint32, POINTER(PairSurface)],
    "lks_set_surface_rule": [_WORLD, c_uint32, c_uint32, POINTER(PairSurface)],
    "lks_set_one_way": [_WORLD, _BODY, POINTER(I32x3), c_uint32],
    "lks_fluid_init": [POINTER(Fluid), c_size_t],
    "lks_set_fluid": [_WORLD, c_uint32, POINTER(Fluid)],
    "lks_fluid_get": [_WORLD, c_uint32, POINTER(Fluid)],
    "lks_set_name": [_WORLD, _BODY, c_char_p],
    "lks_body_exists": [_WORLD, _BODY, _FLAG],
    "lks_body_get": [_WORLD, _BODY, POINTER(BodyView)],
    "lks_bodies": [_WORLD, c_void_p, c_void_p, c_void_p, c_size_t, _COUNT],
    "lks_joint_def_init": [POINTER(JointDef), c_size_t, c_uint32, _BODY, _BODY],
    "lks_create_joint": [_WORLD, POINTER(JointDef), _NUMBER],
    "lks_destroy_joint": [_WORLD, c_uint64],
    "lks_set_linear_axis": [_WORLD, c_uint64, c_uint32, POINTER(Axis)],
    "lks_set_angular_axis": [_WORLD, c_uint64, c_uint32, POINTER(Axis)],
    "lks_hit_events": [_WORLD, c_void_p, c_size_t, _COUNT],
    "lks_events": [_WORLD, c_void_p, c_size_t, _COUNT],
    "lks_touching": [_WORLD, _BODY, _BODY, _FLAG],
    "lks_cast_ray": [_WORLD, POINTER(I64x3), POINTER(I32x3), c_void_p, POINTER(Hit)],
    "lks_overlap_sphere": [_WORLD, POINTER(I64x3), c_int32, c_void_p, c_void_p, c_size_t, _COUNT],
    "lks_bodies_in_box": [_WORLD, POINTER(I64x3), POINTER(I64x3), c_void_p, c_void_p, c_size_t, _COUNT],
    "lks_snapshot_bytes_max": [_WORLD, c_uint32, _COUNT],
    "lks_save": [_WORLD, c_uint32, c_void_p, c_size_t, _COUNT],
    "lks_load": [_WORLD, c_uint32, c_char_p, c_size_t],
    "lks_verify_log": [c_char_p, POINTER(LogReport)],
}
# The others: types of the result and of the arguments.
_OTHERS = {
    "lks_status_name": (c_char_p, [c_int32]),
    "lks_last_error": (c_char_p, []),
    "lks_c_abi": (c_uint32, []),
    "lks_version": (c_char_p, []),
    "lks_simulation_abi": (c_uint32, []),
    "lks_canary_hash": (c_uint64, []),
    "lks_world_destroy": (None, [_WORLD]),
    "lks_assets_destroy": (None, [c_void_p]),
    "lks_scene_count": (c_uint32, []),
    "lks_scene_name": (c_char_p, [c_uint32]),
}


class LockstoneError(Exception):
    """A call that did nothing: `status` is the code of lockstone.h, `name` its short name."""

    def __init__(self, status: int, name: str, message: str) -> None:
        super().__init__(message or name)
        self.status, self.name = status, name


def _check(status: int, function: object, arguments: tuple) -> int:
    if status != 0:
        raise LockstoneError(status, lib.lks_status_name(status).decode(), lib.lks_last_error().decode())
    return status


def _open() -> ctypes.CDLL:
    """The library that LOCKSTONE_LIBRARY names, else that of the wheel, else the system's."""
    name = f"liblockstone_c.so.{C_ABI}"
    bundled = pathlib.Path(__file__).with_name(name)
    library = ctypes.CDLL(os.environ.get("LOCKSTONE_LIBRARY", str(bundled) if bundled.exists() else name))
    for name, (result, arguments) in _OTHERS.items():
        function = getattr(library, name)
        function.restype, function.argtypes = result, arguments
    for name, arguments in _CALLS.items():
        function = getattr(library, name)
        function.restype, function.argtypes, function.errcheck = c_int32, arguments, _check
    if library.lks_c_abi() != C_ABI:
        raise ImportError(f"liblockstone_c has the ABI {library.lks_c_abi()}, this package needs {C_ABI}")
    return library


lib = _open()
