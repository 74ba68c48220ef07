"""Worlds and bodies. Quantities are in SI units and exact: 1, "9.81", Fraction(1, 3), Raw(…)."""

from __future__ import annotations

import ctypes
from ctypes import byref, sizeof
from fractions import Fraction
from typing import Any, Dict, List, NamedTuple, Optional, Sequence, Tuple

from . import units
from ._library import (BodyDef, BodyView, Event, Filter, Fluid, Hit, HitEvent, I32x3, I64x3, JointDef, PairSurface, Pose, Quat, Shape, WorldDef, lib)
from ._declarations import (lks_vehicle_controls as VehicleControls, lks_vehicle_def as VehicleDef,
                            lks_vehicle_view as VehicleView)
from .shapes import Assets, lengths
from .units import Quantity, Rotation, Vector

STATIC, KINEMATIC, DYNAMIC = 1, 2, 3
(DISTANCE, BALL, HINGE, SLIDER, WELD, WHEEL, MOTOR, SIX_AXIS, PULLEY, GEAR, RACK, RATCHET, PATH) = range(1, 14)
(CONTACT_BEGIN, CONTACT_END, TRIGGER_ENTER, TRIGGER_STAY, TRIGGER_EXIT, IMPACT, SLEEP, WAKE,
 CONTACT_PERSIST) = range(9)
TRIGGER, FIXED_ROTATION, BULLET, ALLOW_SLEEP = 1, 2, 4, 8

Exact = Tuple[Fraction, Fraction, Fraction]


def _wide(vector: Vector, bits: int) -> I64x3:
    return I64x3(*(units.raw(value, bits) for value in vector))


def _narrow(vector: Vector, bits: int) -> I32x3:
    return I32x3(*(units.raw(value, bits, 32) for value in vector))


def _pair_surface(surface: Optional[Tuple[Quantity, ...]]) -> Any:
    if surface is None:
        return None
    return byref(PairSurface(*(units.raw(value, units.UNIT, 32) for value in surface)))


def _quat(rotation: Rotation) -> Quat:
    return Quat(*(units.raw(value, units.UNIT, 32) for value in rotation))


def _exact(vector: Any, bits: int) -> Exact:
    return (units.exact(vector.x, bits), units.exact(vector.y, bits), units.exact(vector.z, bits))


class Contact(NamedTuple):
    """An event of the last step; `b` is None for sleep and wake."""

    kind: int
    a: "Body"
    b: Optional["Body"]
    approach_speed: Fraction


class Impact(NamedTuple):
    """A hit of the last step: an impact that was faster than a hit speed of its bodies."""

    a: "Body"
    b: "Body"
    point: Exact
    normal: Exact
    normal_impulse: Fraction
    friction_impulse: Exact
    approach_speed: Fraction


class RayHit(NamedTuple):
    body: "Body"
    fraction: Fraction
    point: Exact
    normal: Exact


class Poses:
    """Where all bodies are, in raw integers: views of memory that the next `World.poses` overwrites.

    `bodies[i]` is the number of a body, `positions[i, axis]` a place in 2^-32 m (axis 0 … 2), and
    `orientations[i, k]` a part of its quaternion in 2^-30 (k = 6 … 9: x, y, z, w).
    """

    def __init__(self, bodies: memoryview, poses: memoryview, count: int) -> None:
        rows = poses[:count * sizeof(Pose)]
        self.bodies = bodies[:count]
        self.positions = rows.cast("q", [count, 5]) if count else rows
        self.orientations = rows.cast("i", [count, 10]) if count else rows
        self._rows, self._count = rows, count

    def __len__(self) -> int:
        return self._count

    def numpy(self) -> Any:
        """The same memory as an array with the fields `position` (n × 3) and `orientation` (n × 4)."""
        import numpy  # only where it is wanted

        kind = numpy.dtype([("position", "i8", 3), ("orientation", "i4", 4)])
        return numpy.frombuffer(self._rows, dtype=kind, count=self._count)


class Body:
    """Names a body of a world. That of a destroyed body never names another one."""

    def __init__(self, world: "World", number: int) -> None:
        self.world, self.number = world, number

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Body) and (self.world, self.number) == (other.world, other.number)

    def __hash__(self) -> int:
        return hash(self.number)

    def _call(self, name: str, *arguments: Any) -> None:
        getattr(lib, name)(self.world.handle, self.number, *arguments)

    @property
    def exists(self) -> bool:
        flag = ctypes.c_uint32()
        self._call("lks_body_exists", byref(flag))
        return flag.value == 1

    @property
    def raw(self) -> BodyView:
        """Everything that the library tells of it, in raw integers."""
        view = BodyView(size=sizeof(BodyView))
        self._call("lks_body_get", byref(view))
        return view

    @property
    def position(self) -> Exact:
        """In metres."""
        return _exact(self.raw.position, units.POSITION)

    @property
    def velocity(self) -> Exact:
        """Of the centre of mass, in metres per second."""
        return _exact(self.raw.velocity, units.VELOCITY)

    def destroy(self) -> None:
        self._call("lks_destroy_body")

    def teleport(self, position: Vector, orientation: Rotation = (0, 0, 0, 1)) -> None:
        self._call("lks_teleport", byref(Pose(_wide(position, units.POSITION), _quat(orientation))))

    def move_kinematic(self, position: Vector, orientation: Rotation = (0, 0, 0, 1)) -> None:
        """Gives a kinematic body the velocities that take it there in one tick."""
        self._call("lks_move_kinematic", byref(Pose(_wide(position, units.POSITION), _quat(orientation))))

    def set_velocity(self, velocity: Vector) -> None:
        self._call("lks_set_velocity", byref(_wide(velocity, units.VELOCITY)))

    def set_angular_velocity(self, velocity: Vector) -> None:
        self._call("lks_set_angular_velocity", byref(_wide(velocity, units.ANGULAR_VELOCITY)))

    def apply_impulse(self, impulse: Vector, point: Optional[Vector] = None, own_frame: bool = False) -> None:
        """In N·s at the centre of mass or at a point, in the world's axes or the body's own frame."""
        wide = byref(_wide(impulse, units.IMPULSE))
        if point is None:
            self._call("lks_apply_impulse", wide, own_frame)
        else:
            self._call("lks_apply_impulse_at", wide, byref(lengths(point)), own_frame)

    def apply_angular_impulse(self, impulse: Vector, own_frame: bool = False) -> None:
        self._call("lks_apply_angular_impulse", byref(_wide(impulse, units.IMPULSE)), own_frame)

    def apply_force(self, force: Vector, point: Optional[Vector] = None, own_frame: bool = False) -> None:
        """In N over the coming tick."""
        wide = byref(_wide(force, units.FORCE))
        if point is None:
            self._call("lks_apply_force", wide, own_frame)
        else:
            self._call("lks_apply_force_at", wide, byref(lengths(point)), own_frame)

    def apply_torque(self, torque: Vector, own_frame: bool = False) -> None:
        self._call("lks_apply_torque", byref(_wide(torque, units.FORCE)), own_frame)

    def set_gravity_scale(self, scale: Quantity) -> None:
        self._call("lks_set_gravity_scale", units.raw(scale, units.NUMBER, 32))

    def set_damping(self, linear: Quantity, angular: Quantity) -> None:
        self._call("lks_set_damping", units.raw(linear, units.RATE, 32), units.raw(angular, units.RATE, 32))

    def set_filter(self, category: int = 1, mask: int = 0xffffffff, group: int = 0) -> None:
        self._call("lks_set_filter", byref(Filter(category, mask, group)))

    def set_events(self, *, contacts: bool = True, hit_speed: Quantity = 0, persist: bool = False) -> None:
        self._call("lks_set_events", int(contacts) | int(persist) << 1, units.raw(hit_speed, units.SPEED, 32))

    def set_one_way(self, direction: Vector, tolerance: int = 60) -> None:
        """A static or kinematic body stops others from the side of the direction only, in the axes of its shape."""
        self._call("lks_set_one_way", byref(_narrow(direction, units.UNIT)), tolerance)

    def set_car(self, length: Quantity, half_track: Quantity, height: Quantity, torque: Quantity) -> None:
        """Wheels, an engine and a gearbox for a dynamic body; ahead is x in the axes of its shape."""
        definition = VehicleDef()
        lib.lks_make_car(*(units.raw(value, units.LENGTH, 32) for value in (length, half_track, height)),
                         units.raw(torque, units.FORCE), byref(definition), sizeof(definition))
        self._call("lks_set_vehicle", byref(definition))

    def set_motorcycle(self, length: Quantity, height: Quantity, torque: Quantity) -> None:
        """A wheel ahead and one behind, for a dynamic body that leans into its turns."""
        definition = VehicleDef()
        lib.lks_make_motorcycle(*(units.raw(value, units.LENGTH, 32) for value in (length, height)),
                                units.raw(torque, units.FORCE), byref(definition), sizeof(definition))
        self._call("lks_set_vehicle", byref(definition))

    def set_tank(self, length: Quantity, half_track: Quantity, height: Quantity, torque: Quantity) -> None:
        """Three wheels a side on two tracks, for a dynamic body."""
        definition = VehicleDef()
        lib.lks_make_tank(*(units.raw(value, units.LENGTH, 32) for value in (length, half_track, height)),
                          units.raw(torque, units.FORCE), byref(definition), sizeof(definition))
        self._call("lks_set_vehicle", byref(definition))

    def drive(self, *, throttle: Quantity = 0, brake: Quantity = 0, handbrake: Quantity = 0, steer: Quantity = 0,
              clutch: Quantity = 0, gear: int = 1) -> None:
        controls = VehicleControls()
        lib.lks_vehicle_controls_init(byref(controls), sizeof(controls))
        controls.gear = gear
        (controls.throttle, controls.brake, controls.handbrake, controls.steer, controls.clutch) = (
            units.raw(value, units.UNIT, 32) for value in (throttle, brake, handbrake, steer, clutch))
        self._call("lks_drive_vehicle", byref(controls))

    def vehicle(self) -> VehicleView:
        view = VehicleView()
        view.size = sizeof(view)
        lib.lks_vehicle_get(self.world.handle, self.number, byref(view))
        return view

    def set_heights(self, column: int, row: int, columns: int, rows: int, heights: Optional[Sequence[Quantity]] = None,
                    holes: Optional[Sequence[int]] = None, surfaces: Optional[Sequence[int]] = None) -> None:
        """Changes samples of the body's height field, and the (columns - 1) * (rows - 1) cells between them."""
        cells = max(columns - 1, 0) * max(rows - 1, 0)
        for values, count in ((heights, columns * rows), (holes, cells), (surfaces, cells)):
            if values is not None and len(values) != count:
                raise ValueError(f"{len(values)} values for a rectangle that takes {count}")
        raw = [units.raw(height, units.LENGTH, 32) for height in heights or ()]
        self._call("lks_set_heights", byref((ctypes.c_uint32 * 4)(column, row, columns, rows)),
                   (ctypes.c_int32 * len(raw))(*raw) if heights is not None else None,
                   bytes(holes) if holes is not None else None, bytes(surfaces) if surfaces is not None else None)

    def set_mesh_group(self, group: int, is_on: bool) -> None:
        """Switches a group of triangles of the body's mesh on or off."""
        self._call("lks_set_mesh_group", group, int(is_on))

    def is_mesh_group_on(self, group: int) -> bool:
        flag = ctypes.c_uint32()
        lib.lks_mesh_group_get(self.world.handle, self.number, group, byref(flag))
        return bool(flag.value)

    def terrain_sample(self, column: int, row: int) -> Tuple[float, bool, int]:
        """Height in metres in the frame of the asset, whether the cell from there is a hole, and its surface."""
        height, hole, surface = ctypes.c_int32(), ctypes.c_uint32(), ctypes.c_uint32()
        lib.lks_terrain_sample_get(self.world.handle, self.number, column, row, byref(height), byref(hole),
                                   byref(surface))
        return height.value / (1 << 20), bool(hole.value), surface.value

    def set_motion_type(self, motion: int, mass: Quantity = 0) -> None:
        """A body that becomes dynamic gets the mass, in kg; 0: that of its solid at 1000 kg/m³."""
        self._call("lks_set_motion_type", motion, units.raw(mass, units.MASS, 64))

    def set_shape(self, shape: Shape, mass: Quantity = 0) -> None:
        """In the frame of the old shape; with mass 0 a dynamic body keeps its own."""
        self._call("lks_set_shape", byref(shape), units.raw(mass, units.MASS, 64))

    def set_mass_data(self, mass: Quantity = 0, inertia: Vector = (0, 0, 0)) -> None:
        """In kg, and principal moments in kg·m²; 0: its own mass, and the moments of its solid."""
        self._call("lks_set_mass_data", units.raw(mass, units.MASS, 64), byref(_wide(inertia, units.INERTIA)))

    def set_enabled(self, enabled: bool) -> None:
        """A disabled body stays as it is until it is enabled: nothing meets or finds it."""
        self._call("lks_set_enabled", int(enabled))

    def set_user_data(self, number: int) -> None:
        self._call("lks_set_user_data", number)

    def set_name(self, name: str) -> None:
        self._call("lks_set_name", name.encode())

    def wake(self) -> None:
        self._call("lks_wake_body")

    def sleep(self) -> None:
        self._call("lks_sleep_body")


def _definition(gravity: Optional[Vector], rules: Dict[str, int]) -> WorldDef:
    definition = WorldDef()
    lib.lks_world_def_init(byref(definition), sizeof(definition))
    for name, value in rules.items():
        if name not in dict(WorldDef._fields_):
            raise TypeError(f"a world has no rule {name}")
        setattr(definition, name, value)
    if gravity is not None:
        definition.gravity = _wide(gravity, units.ACCELERATION)
    return definition


class World:
    """A world, or a built-in scene. `rules` are the fields of lks_world_def, in raw integers; gravity
    is in m/s²."""

    def __init__(self, *, gravity: Optional[Vector] = None, assets: Optional[Assets] = None,
                 **rules: int) -> None:
        handle = ctypes.c_void_p()
        lib.lks_world_create(byref(_definition(gravity, rules)), assets.handle if assets else None, byref(handle))
        self._take(handle)

    @staticmethod
    def config_hash(*, gravity: Optional[Vector] = None, assets: Optional[Assets] = None, **rules: int) -> int:
        """Over everything in the arguments that can change a result: peers compare it before they play."""
        value = ctypes.c_uint64()
        lib.lks_config_hash(byref(_definition(gravity, rules)), assets.handle if assets else None, byref(value))
        return value.value

    @classmethod
    def scene(cls, name: str, seed: int = 1) -> "World":
        """A built-in scene, which plays by itself and takes no command."""
        world = cls.__new__(cls)
        handle = ctypes.c_void_p()
        lib.lks_world_create_scene(name.encode(), seed, byref(handle))
        world._take(handle)
        return world

    def _take(self, handle: ctypes.c_void_p) -> None:
        self.handle = handle
        definition = WorldDef(size=sizeof(WorldDef))
        lib.lks_world_get_def(handle, byref(definition))
        self.definition = definition
        self._bodies = (ctypes.c_uint64 * definition.body_capacity)()
        self._poses = (Pose * definition.body_capacity)()

    def __del__(self) -> None:
        if hasattr(self, "handle"):
            lib.lks_world_destroy(self.handle)

    def keep_history(self, ticks: int) -> None:
        """Remembers the last ticks, at most 256, so that stepping them again after `load` costs as much as differs."""
        lib.lks_world_keep_history(self.handle, ticks)

    def forget_history(self) -> None:
        lib.lks_world_forget_history(self.handle)

    def step(self, ticks: int = 1) -> None:
        for _ in range(ticks):
            lib.lks_step(self.handle, None)

    @property
    def tick(self) -> int:
        tick = ctypes.c_uint64()
        lib.lks_tick(self.handle, byref(tick))
        return tick.value

    @property
    def hash(self) -> int:
        """Over everything that can change the future."""
        value = ctypes.c_uint64()
        lib.lks_hash(self.handle, byref(value))
        return value.value

    def set_threads(self, threads: int) -> None:
        lib.lks_world_set_threads(self.handle, threads)

    def set_gravity(self, gravity: Vector) -> None:
        lib.lks_set_gravity(self.handle, byref(_wide(gravity, units.ACCELERATION)))

    def set_fluid(self, number: int, surface: Vector, extents: Vector, *, density: Quantity = 1000,
                  drag: Quantity = 0, linear_drag: Quantity = 0, flow: Vector = (0, 0, 0)) -> None:
        """A box of fluid below its surface: half its width, its depth, half its length, in m; density 0 removes it."""
        fluid = Fluid()
        lib.lks_fluid_init(byref(fluid), sizeof(fluid))
        fluid.surface, fluid.extents = _wide(surface, units.POSITION), _wide(extents, units.POSITION)
        fluid.flow = _wide(flow, units.VELOCITY)
        fluid.density = units.raw(density, units.DENSITY, 32)
        fluid.drag = units.raw(drag, units.NUMBER, 32)
        fluid.linear_drag = units.raw(linear_drag, units.RATE, 32)
        lib.lks_set_fluid(self.handle, number, byref(fluid))

    def set_pair_rule(self, a: "Body", b: "Body", *, collides: bool = True,
                      surface: Optional[Tuple[Quantity, ...]] = None) -> None:
        """Whether two bodies meet, and friction, restitution, rolling resistance of their contacts."""
        lib.lks_set_pair_rule(self.handle, a.number, b.number, int(collides), _pair_surface(surface))

    def set_surface_rule(self, tag_a: int, tag_b: int, surface: Optional[Tuple[Quantity, ...]]) -> None:
        """Friction, restitution, rolling resistance of all contacts between two tags; None takes the rule back."""
        lib.lks_set_surface_rule(self.handle, tag_a, tag_b, _pair_surface(surface))

    def create_body(self, shape: Shape, *, motion: int = DYNAMIC, position: Vector = (0, 0, 0),
                    orientation: Rotation = (0, 0, 0, 1), velocity: Vector = (0, 0, 0),
                    angular_velocity: Vector = (0, 0, 0), density: Quantity = 1000,
                    friction: Quantity = Fraction(1, 2), restitution: Quantity = 0,
                    flags: int = ALLOW_SLEEP, user_data: int = 0) -> Body:
        definition = BodyDef()
        lib.lks_body_def_init(byref(definition), sizeof(definition))
        definition.motion, definition.shape = motion, shape
        definition.position = _wide(position, units.POSITION)
        definition.orientation = _quat(orientation)
        definition.velocity = _wide(velocity, units.VELOCITY)
        definition.angular_velocity = _wide(angular_velocity, units.ANGULAR_VELOCITY)
        definition.density = units.raw(density, units.DENSITY, 32)
        definition.surface.friction = units.raw(friction, units.UNIT, 32)
        definition.surface.restitution = units.raw(restitution, units.UNIT, 32)
        definition.flags, definition.user_data = flags, user_data
        return self.create_raw_body(definition)

    def create_raw_body(self, definition: BodyDef) -> Body:
        number = ctypes.c_uint64()
        lib.lks_create_body(self.handle, byref(definition), byref(number))
        return Body(self, number.value)

    def create_joint(self, kind: int, a: Body, b: Body, *, at_a: Vector = (0, 0, 0),
                     at_b: Vector = (0, 0, 0)) -> int:
        """A joint with its axes as the kind says, between a point of each body; its number."""
        definition = JointDef()
        lib.lks_joint_def_init(byref(definition), sizeof(definition), kind, a.number, b.number)
        definition.frame_a.position, definition.frame_b.position = lengths(at_a), lengths(at_b)
        return self.create_raw_joint(definition)

    def create_raw_joint(self, definition: JointDef) -> int:
        number = ctypes.c_uint64()
        lib.lks_create_joint(self.handle, byref(definition), byref(number))
        return number.value

    def destroy_joint(self, joint: int) -> None:
        lib.lks_destroy_joint(self.handle, joint)

    def bodies(self) -> List[Body]:
        """By ascending index."""
        return [Body(self, number) for number in self.poses().bodies]

    def poses(self) -> Poses:
        count = ctypes.c_size_t()
        lib.lks_bodies(self.handle, self._bodies, self._poses, None, len(self._poses), byref(count))
        return Poses(memoryview(self._bodies).cast("B").cast("Q"), memoryview(self._poses).cast("B"),
                     count.value)

    def events(self) -> List[Contact]:
        """Of the last step."""
        most = 2 * (self.definition.contact_capacity + self.definition.body_capacity)
        room = (Event * most)()
        count = ctypes.c_size_t()
        lib.lks_events(self.handle, room, most, byref(count))
        return [Contact(event.kind, Body(self, event.a), Body(self, event.b) if event.b else None,
                        units.exact(event.approach_speed, units.VELOCITY)) for event in room[:count.value]]

    def hit_events(self) -> List[Impact]:
        """Of the last step."""
        room = (HitEvent * (self.definition.contact_capacity + self.definition.body_capacity))()
        count = ctypes.c_size_t()
        lib.lks_hit_events(self.handle, room, len(room), byref(count))
        return [Impact(Body(self, hit.a), Body(self, hit.b), _exact(hit.point, units.POSITION),
                       _exact(hit.normal, units.UNIT), units.exact(hit.normal_impulse, units.IMPULSE),
                       _exact(hit.friction_impulse, units.IMPULSE),
                       units.exact(hit.approach_speed, units.VELOCITY)) for hit in room[:count.value]]

    def cast_ray(self, origin: Vector, way: Vector) -> Optional[RayHit]:
        """The first body on the way, which is at most 512 m along each axis."""
        hit = Hit()
        lib.lks_cast_ray(self.handle, byref(_wide(origin, units.POSITION)), byref(lengths(way)), None,
                         byref(hit))
        if hit.body == 0:
            return None
        return RayHit(Body(self, hit.body), units.exact(hit.fraction, units.UNIT),
                      _exact(hit.point, units.POSITION), _exact(hit.normal, units.UNIT))

    def overlap_sphere(self, centre: Vector, radius: Quantity) -> List[Body]:
        """By ascending index."""
        room = (ctypes.c_uint64 * self.definition.body_capacity)()
        count = ctypes.c_size_t()
        lib.lks_overlap_sphere(self.handle, byref(_wide(centre, units.POSITION)),
                               units.raw(radius, units.LENGTH, 32), None, room, len(room), byref(count))
        return [Body(self, number) for number in room[:count.value]]

    def bodies_in_box(self, lower: Vector, upper: Vector) -> List[Body]:
        """Those whose bounds along the world's axes overlap a box, by ascending index."""
        room = (ctypes.c_uint64 * self.definition.body_capacity)()
        count = ctypes.c_size_t()
        lib.lks_bodies_in_box(self.handle, byref(_wide(lower, units.POSITION)),
                              byref(_wide(upper, units.POSITION)), None, room, len(room), byref(count))
        return [Body(self, number) for number in room[:count.value]]

    def part_hashes(self) -> Dict[str, int]:
        """Of the header, bodies, contacts and joints."""
        parts = (ctypes.c_uint64 * 5)()
        lib.lks_part_hashes(self.handle, parts)
        return dict(zip(("header", "bodies", "contacts", "joints"), parts[1:]))

    def snapshot_bytes_max(self, kind: int = 1) -> int:
        most = ctypes.c_size_t()
        lib.lks_snapshot_bytes_max(self.handle, kind, byref(most))
        return most.value

    def save(self, kind: int = 1) -> bytes:
        """The state, for files and other machines; of kind 0 for this process alone, as rollback needs it."""
        most = self.snapshot_bytes_max(kind)
        room = ctypes.create_string_buffer(most)
        written = ctypes.c_size_t()
        lib.lks_save(self.handle, kind, room, most, byref(written))
        return room.raw[:written.value]

    def load(self, state: bytes, kind: int = 1) -> None:
        """Replaces the state. The bytes may come from anywhere: they are checked first. Those of kind 0 are not: they
        must be those that `save` gave in this process."""
        lib.lks_load(self.handle, kind, state, len(state))

    def describe_difference(self, here: bytes, there: bytes) -> Optional[str]:
        """The first difference between two states that `save` gave, for people."""
        differs, text = ctypes.c_uint32(), ctypes.create_string_buffer(512)
        lib.lks_describe_difference(self.handle, here, len(here), there, len(there), byref(differs), text, len(text))
        return text.value.decode(errors="replace") if differs.value else None
