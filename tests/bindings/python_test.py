"""The Python binding. LOCKSTONE_LIBRARY names the library, PYTHONPATH the package.

python_test.py (SCENE TICKS)… prints the hashes of scenes, as golden_scenes.c does.
"""

import ctypes
import pathlib
import re
import sys
import unittest
from ctypes import byref, sizeof
from decimal import Decimal
from fractions import Fraction

import lockstone
from lockstone import _library, units

ROOT = pathlib.Path(__file__).resolve().parents[2]


def small_world(**rules):
    return lockstone.World(body_capacity=16, pair_capacity=64, contact_capacity=32, joint_capacity=4, **rules)


def drop_ball(world):
    ground = world.create_body(lockstone.half_space(), motion=lockstone.STATIC)
    return ground, world.create_body(lockstone.sphere("0.25"), position=(0, 10, 0))


class Worlds(unittest.TestCase):
    def test_a_ball_falls_and_rests(self):
        world = small_world()
        ground, ball = drop_ball(world)
        kinds = []
        for _ in range(180):
            world.step()
            kinds += [(event.kind, {event.a, event.b}) for event in world.events()]
        self.assertAlmostEqual(float(ball.position[1]), 0.25, places=3)
        self.assertIn((lockstone.CONTACT_BEGIN, {ground, ball}), kinds)
        self.assertNotIn(lockstone.CONTACT_PERSIST, [kind for kind, _ in kinds])
        ball.set_events(persist=True)
        ball.set_velocity((0, 0, 0))
        world.step()
        self.assertIn(lockstone.CONTACT_PERSIST, [event.kind for event in world.events()])
        self.assertEqual(world.tick, 181)

    def test_a_hit_tells_where_and_how_hard(self):
        world = small_world()
        ground, ball = drop_ball(world)
        ball.set_events(hit_speed=1)
        ball.set_mass_data(2, ("0.05", "0.05", "0.05"))
        ball.set_shape(lockstone.sphere("0.25"))
        hits = []
        for _ in range(180):
            world.step()
            hits += world.hit_events()
        self.assertEqual((hits[0].a, hits[0].b), (ball, ground))
        self.assertAlmostEqual(float(hits[0].approach_speed), (2 * 9.81 * 9.75) ** 0.5, delta=0.2)
        self.assertAlmostEqual(float(hits[0].point[1]), 0, places=2)
        self.assertGreater(hits[0].normal_impulse, 0)

    def test_a_snapshot_brings_a_world_back(self):
        world = small_world()
        _, ball = drop_ball(world)
        state, before = world.save(), world.hash
        ball.apply_impulse((1, "2.5", Fraction(1, 3)))
        self.assertNotEqual(world.hash, before)
        world.load(state)
        self.assertEqual(world.hash, before)
        with self.assertRaises(lockstone.LockstoneError):
            world.load(state[:-1])

    def test_commands_do_what_they_say(self):
        world = small_world(gravity=(0, 0, 0))
        body = world.create_body(lockstone.box(1, 1, 1), density=500)
        body.set_velocity((1, 2, "-0.5"))
        self.assertEqual(body.velocity, (1, 2, Fraction(-1, 2)))
        body.teleport((3, 4, 5))
        self.assertEqual(body.position, (3, 4, 5))
        body.apply_impulse((4000, 0, 0))  # 4 t
        self.assertAlmostEqual(float(body.velocity[0]), 2)
        for command in (body.wake, body.sleep, body.destroy):
            command()
        self.assertFalse(body.exists)

    def test_joints_and_hulls(self):
        assets = lockstone.Assets()
        hull = assets.add_hull([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)])
        self.assertEqual(assets.add_scaled(hull.asset, (1, 1, 1)), hull.asset)
        self.assertNotEqual(assets.add_scaled(hull.asset, (2, "0.5", -1)), hull.asset)
        with self.assertRaises(lockstone.LockstoneError):
            assets.add_scaled(hull.asset, (1, 0, 1))
        rounded = assets.add_hull([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], radius="0.1")
        self.assertNotEqual(rounded.asset, hull.asset)
        world = lockstone.World(body_capacity=4, assets=assets)
        anchor = world.create_body(hull, motion=lockstone.STATIC)
        weight = world.create_body(hull, position=(0, -2, 0))
        joint = world.create_joint(lockstone.BALL, anchor, weight, at_b=(0, 2, 0))
        world.step(30)
        self.assertGreater(weight.position[1], -3)
        world.destroy_joint(joint)

    def test_ratchets_and_paths(self):
        assets = lockstone.Assets()
        bend = assets.add_path([((0, 0, 0), (0, 1, 0)), ((4, -1, 0), (0, 1, 0)), ((8, 0, 2), (0, 1, 0))])
        track = [((0, 0, 0), (0, 1, 0)), ((4, 0, 0), (0, 1, 0))]
        self.assertEqual(assets.add_path(track, banks=[0, 0]), assets.add_path(track))
        self.assertNotEqual(assets.add_path(track, banks=[0, "0.5"]), assets.add_path(track))
        with self.assertRaises(ValueError):
            assets.add_path(track, banks=[0])
        world = lockstone.World(body_capacity=4, assets=assets)
        anchor = world.create_body(lockstone.sphere("0.1"), motion=lockstone.STATIC)
        bead = world.create_body(lockstone.sphere("0.2"), position=(1, 0, 0))
        definition = lockstone.world.JointDef()
        lib = lockstone.world.lib
        lib.lks_joint_def_init(byref(definition), sizeof(definition), lockstone.PATH, anchor.number, bead.number)
        definition.path = bend
        world.create_raw_joint(definition)
        world.create_joint(lockstone.RATCHET, anchor, world.create_body(lockstone.box(1, 1, 1)))
        world.step(600)
        self.assertTrue(-1.1 < bead.position[1] < 0)

    def test_queries_find_bodies(self):
        world = small_world()
        _, ball = drop_ball(world)
        hit = world.cast_ray((0, 20, 0), (0, -15, 0))
        self.assertEqual(hit.body, ball)
        self.assertAlmostEqual(float(hit.point[1]), 10.25)
        self.assertIsNone(world.cast_ray((5, 20, 0), (0, 15, 0)))
        self.assertEqual(world.overlap_sphere((0, 10, 0), 1), [ball])
        self.assertEqual(world.bodies_in_box((-1, 9, -1), (1, 11, 1)), [ball])
        self.assertEqual(world.bodies_in_box((5, 9, -1), (6, 11, 1)), [])

    def test_poses_are_views_of_the_world(self):
        world = small_world()
        ground, ball = drop_ball(world)
        world.step(10)
        poses = world.poses()
        self.assertEqual(list(poses.bodies), [ground.number, ball.number])
        self.assertEqual(poses.positions[1, 1], ball.raw.position.y)
        self.assertEqual(poses.orientations[1, 9], ball.raw.orientation.w)
        self.assertEqual(world.bodies(), [ground, ball])
        self.assertEqual(len(small_world().poses()), 0)

    def test_numpy_sees_the_same_memory(self):
        try:
            import numpy
        except ImportError:
            self.skipTest("numpy is not there")
        world = small_world()
        _, ball = drop_ball(world)
        seen = world.poses().numpy()
        world.step(10)
        world.poses()
        self.assertEqual(seen["position"].shape, (2, 3))
        self.assertEqual(int(seen["position"][1, 1]), ball.raw.position.y)
        self.assertIs(seen["orientation"].dtype.type, numpy.int32)

    def test_refusals_are_exceptions_with_a_reason(self):
        world = small_world()
        with self.assertRaisesRegex(lockstone.LockstoneError, "body.shape.radius") as caught:
            world.create_body(lockstone.sphere(0))
        self.assertEqual(caught.exception.name, "invalid argument")
        with self.assertRaisesRegex(TypeError, "no rule bodies"):
            lockstone.World(bodies=3)
        with self.assertRaisesRegex(lockstone.LockstoneError, "world.tick_rate"):
            lockstone.World(tick_rate=7)
        with self.assertRaises(lockstone.LockstoneError):
            lockstone.World.scene("stack").bodies()[0].wake()
        with self.assertRaises(lockstone.LockstoneError):
            lockstone.verify_log("/no/such/file.lks")


class Units(unittest.TestCase):
    def test_quantities_are_exact(self):
        self.assertEqual(units.raw("-9.81", units.ACCELERATION), round(Fraction("-9.81") * 2**32))
        self.assertEqual(units.raw(Decimal("0.5"), units.UNIT), 1 << 29)
        self.assertEqual(units.raw(lockstone.Raw(7), units.UNIT), 7)
        self.assertEqual([units.raw(Fraction(n, 2), 0) for n in (-3, -1, 1, 3)], [-2, -1, 1, 2])
        self.assertEqual(units.exact(3 << 31, units.POSITION), Fraction(3, 2))

    def test_floats_and_what_does_not_fit_are_refused(self):
        with self.assertRaises(TypeError):
            units.raw(0.5, units.POSITION)
        with self.assertRaises(OverflowError):
            lockstone.sphere(2048)


class Declarations(unittest.TestCase):
    """The structures are those of the header: same fields in the same order."""

    def test_structures_have_the_fields_of_the_header(self):
        folder = ROOT / "tools/bindings/c/lockstone_c"
        text = re.sub(r"/\*.*?\*/", "", "".join(path.read_text() for path in sorted(folder.glob("*.h"))), flags=re.DOTALL)
        bodies = dict((name, body) for body, name in re.findall(r"typedef struct \w+ \{(.*?)\} lks_(\w+);", text, re.DOTALL))
        checked = 0
        for kind in vars(_library).values():
            if not (isinstance(kind, type) and issubclass(kind, ctypes.Structure) and kind is not ctypes.Structure):
                continue
            name = re.sub(r"(?<=[a-z])([A-Z])", r"_\1", kind.__name__).lower()
            fields = [re.sub(r"\[\w+\]", "", part.split()[-1])
                      for line in bodies[name].split(";") if line.strip() for part in line.split(",")]
            self.assertEqual([field[0] for field in kind._fields_], fields, name)
            checked += 1
        self.assertEqual(checked, 21)


def play(arguments):
    for name, ticks in zip(arguments[::2], map(int, arguments[1::2])):
        world, hashes = lockstone.World.scene(name), []
        while world.tick < ticks:
            world.step()
            if world.tick % 10 == 0 or world.tick == ticks:
                hashes.append(f"{world.hash:016x}")
        print(name, *hashes)


if __name__ == "__main__":
    if len(sys.argv) > 1:
        play(sys.argv[1:])
    else:
        unittest.main()
