"""lockstone asset: building from OBJ and PNG files, and describing assets.

usage: asset_command_test.py LOCKSTONE import|none
"""

import json
import pathlib
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib

LOCKSTONE = ""
MODELS = pathlib.Path(__file__).with_name("models")
OK, CORRUPT, INCOMPATIBLE, USAGE, UNAVAILABLE = 0, 2, 3, 64, 69

# OBJ files that are refused: text, line, a part of the reason.
VERTICES = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\n"
BAD_LINES = [
    ("v 0 0 0\nv 1 2 x\n", 2, "'x' is no number"),
    ("v 0 0 0\r\n\r\n# a comment\r\nv 1 2\r\n", 4, "three coordinates"),
    ("v 0 0 600\n", 1, "beyond 512 m"),
    ("v nan 0 0\n", 1, "'nan' is no number"),
    (VERTICES + "f 1 2 9\n", 5, "vertex 9 of 4 so far"),
    (VERTICES + "\nf 1 2 -5\n", 6, "vertex -5 of 4 so far"),
    (VERTICES + "f 0 1 2\n", 5, "'0' is no vertex number"),
    (VERTICES + "f 1 2 three\n", 5, "'three' is no vertex number"),
    (VERTICES + "f 1 2 3x\n", 5, "'3x' is no vertex number"),
    (VERTICES + "f 1 2\n", 5, "three corners"),
    (VERTICES + "f 1 2 3 \\\n4\n", 5, "no vertex number"),
    (VERTICES + "f 1 4 2 3\n", 5, "crosses itself"),
    (VERTICES + "f 1 2 4 3\ncurv 0 1 1 2\n", 6, "'curv' is no statement"),
    ("<html>\n", 1, "no statement"),
    ("v 0 0 0\n\0\n", 2, "zero byte"),
    ("", 0, "no vertices"),
    ("v 0 0 0\n", 0, "no faces"),
]


def run(*arguments):
    return subprocess.run([LOCKSTONE, "asset", *map(str, arguments)], capture_output=True, text=True,
                          timeout=120)


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def png(columns, rows, sample, depth=16, colour=0):
    """A picture whose sample (x, y) is sample(x, y)."""
    form = ">H" if depth == 16 else ">B"
    channels = {0: 1, 2: 3, 4: 2}[colour]
    data = b"".join(b"\0" + b"".join(struct.pack(form, sample(x, y)) * channels for x in range(columns))
                    for y in range(rows))
    head = struct.pack(">IIBBBBB", columns, rows, depth, colour, 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(data))
            + chunk(b"IEND", b""))


class Case(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)

    def expect(self, code, *arguments):
        done = run(*arguments)
        self.assertEqual(done.returncode, code, f"{arguments}\n{done.stdout}{done.stderr}")
        return done

    def build(self, source, *options, name="out.lka"):
        """The command's description of the one file that it made."""
        path = self.folder / name
        done = self.expect(OK, "build", source, "-o", path, "--force", "--json", *options)
        made = json.loads(done.stdout)
        self.assertEqual(path.stat().st_size, made[0]["bytes"])
        self.assertEqual(json.loads(self.expect(OK, "info", "--json", path).stdout), made)
        return made[0]

    def write(self, name, data):
        path = self.folder / name
        path.write_bytes(data if isinstance(data, bytes) else data.encode())
        return path

    def refuse(self, source, *options):
        done = self.expect(CORRUPT, "build", source, "-o", self.folder / "none.lka", *options)
        self.assertFalse((self.folder / "none.lka").exists())
        return done.stderr


@unittest.skipUnless("import" in sys.argv, "this build has no import libraries")
class Models(Case):
    def test_a_cube_is_a_hull_or_a_mesh(self):
        hull = self.build(MODELS / "cube.obj", "--as", "hull")
        self.assertEqual((hull["kind"], hull["vertices"], hull["faces"]), ("hull", 8, 6))
        self.assertEqual((hull["lower"], hull["upper"]), ([-1, -1, -1], [1, 1, 1]))
        self.assertAlmostEqual(hull["mass"], 8000, places=4)
        for moment in hull["principal_moments"]:  # m·(2² + 2²)/12
            self.assertAlmostEqual(moment, 16000 / 3, places=3)
        mesh = self.build(MODELS / "cube.obj")
        self.assertEqual((mesh["kind"], mesh["vertices"], mesh["triangles"]), ("mesh", 8, 12))

    def test_vertices_are_a_path_in_their_order(self):
        square = self.write("square.obj", "v 0 0 0\nv 4 0 0\nv 4 0 4\nv 0 0 4\nl 1 2 3 4 1\n")
        path = self.build(square, "--as", "path", "--closed")
        self.assertEqual((path["kind"], path["points"], path["closed"]), ("path", 4, True))
        self.assertTrue(16 < path["length"] < 4 * 3.1416 * 2 ** 0.5)  # between the square and its circle
        self.assertFalse(self.build(square, "--as", "path")["closed"])
        banked = self.write("banked.obj", "v 0 0 0 0\nv 5 0 0 30\nv 10 0 0 -22.5\n")
        level = self.write("level.obj", "v 0 0 0 0\nv 5 0 0 0\nv 10 0 0 0\n")
        self.assertEqual(self.build(level, "--as", "path", "--banks")["id"], self.build(banked, "--as", "path")["id"])
        self.assertNotEqual(self.build(banked, "--as", "path", "--banks")["id"], self.build(level, "--as", "path")["id"])
        steep = self.write("steep.obj", "v 0 0 0 0\nv 5 0 0 361\n")
        self.assertIn("steep.obj:2: '361' is beyond 360 degrees", self.refuse(steep, "--as", "path", "--banks"))
        self.assertIn("four numbers", self.refuse(self.write("few.obj", "v 0 0 0\n"), "--as", "path", "--banks"))
        self.assertIn("close.obj:1: ", self.refuse(self.write("close.obj", "v 0 0 0\nv 0.01 0 0\n"), "--as", "path"))

    def test_the_same_file_gives_the_same_bytes(self):
        for kind in ("hull", "mesh"):
            names = ("one.lka", "two.lka")
            ids = {self.build(MODELS / "cube.obj", "--as", kind, name=name)["id"] for name in names}
            self.assertEqual(len(ids), 1)
            self.assertEqual(*[(self.folder / name).read_bytes() for name in names])

    def test_order_and_way_of_writing_do_not_matter(self):
        cube = self.build(MODELS / "cube.obj", "--as", "hull")["id"]
        corners = [f"v {x} {y} {z}" for x in (".01e2", -1) for z in (-1, "+1.") for y in (1, "-100e-2")]
        other = self.build(self.write("other.obj", "\n".join(corners)), "--as", "hull")["id"]
        self.assertEqual(cube, other)

    def test_a_tetrahedron_has_its_volume(self):
        made = self.build(MODELS / "tetrahedron.obj", "--as", "hull", "--scale", "3e0")
        self.assertAlmostEqual(made["volume"], 27 / 6, places=6)
        self.assertEqual(made["centre_of_mass"], [0.75, 0.75, 0.75])

    def test_scale_and_z_up_turn_to_the_worlds_frame(self):
        made = self.build(MODELS / "table.obj", "--scale", "0.01", "--z-up")
        for found, expected in zip(made["lower"] + made["upper"], [-0.6, 0, -0.4, 0.6, 0.75, 0.4]):
            self.assertAlmostEqual(found, expected, delta=2**-21)

    def test_materials_become_surfaces(self):
        plain = self.build(MODELS / "cube.obj")
        icy = self.build(MODELS / "cube.obj", "--surface", "ice=0.02,0.1", "--surface", "stone=0.8")
        self.assertNotEqual(plain["id"], icy["id"])
        self.assertEqual(icy["bytes"], plain["bytes"] + 12 + 2 * 19)
        self.assertIn("no material 'mud'", self.refuse(MODELS / "cube.obj", "--surface", "mud=1"))
        self.assertIn("surface", self.refuse(MODELS / "cube.obj", "--surface", "ice=1.995").lower())

    def test_objects_become_a_compound_with_its_hulls_beside(self):
        table = ["build", MODELS / "table.obj", "--as", "compound", "--scale", "0.01", "--z-up"]
        made = json.loads(self.expect(OK, *table, "-o", self.folder / "t.lka", "--json",
                                      "--surface", "steel=0.3").stdout)
        self.assertEqual([m["kind"] for m in made], ["compound"] + 3 * ["hull"])
        self.assertEqual(made[0]["children"], 3)
        self.assertEqual(set(made[0]["hulls"]), {m["id"] for m in made[1:]})
        self.assertAlmostEqual(made[0]["volume"], 1.2 * 0.8 * 0.03 + 2 * 0.05 * 0.6 * 0.72, places=5)
        files = [m["file"] for m in made]
        self.assertEqual(json.loads(self.expect(OK, "info", "--json", *files).stdout), made)
        alone = self.expect(CORRUPT, "info", files[0])
        self.assertIn("hull or mesh of this compound", alone.stderr)

    def test_named_objects_of_a_compound_stay_meshes(self):
        level = self.write("level.obj", "o floor\nv -4 0 -4\nv -4 0 4\nv 4 0 4\nv 4 0 -4\nf 1 2 3 4\n"
                           "o post\nv 0 0 0\nv 1 0 0\nv 0 0 1\nv 0 2 0\nf 5 6 7\nf 5 6 8\nf 6 7 8\nf 5 7 8\n")
        done = self.expect(OK, "build", level, "--as", "compound", "--mesh", "floor", "--json")
        compound, *children = json.loads(done.stdout)
        self.assertEqual((compound["kind"], compound["children"]), ("compound", 2))
        self.assertNotIn("mass", compound)
        by_kind = {child["kind"]: child["id"] for child in children}
        self.assertEqual((compound["meshes"], compound["hulls"]), ([by_kind["mesh"]], [by_kind["hull"]]))
        files = [compound["file"]] + [child["file"] for child in children]
        self.assertEqual(json.loads(self.expect(OK, "info", "--json", *files).stdout), [compound] + children)
        self.assertIn("no object 'roof'", self.refuse(level, "--as", "compound", "--mesh", "roof"))
        self.assertIn("'floor': ", self.refuse(level, "--as", "compound"))  # flat: no hull
        self.expect(USAGE, "build", level, "--mesh", "floor")

    def test_factors_scale_along_the_axes(self):
        for kind in ("hull", "mesh"):
            made = self.build(MODELS / "cube.obj", "--as", kind, "--factors", "2,0.5,3")
            self.assertEqual((made["lower"], made["upper"]), ([-2, -0.5, -3], [2, 0.5, 3]))
            twice = self.build(MODELS / "cube.obj", "--as", kind, "--factors", "2", name="twice.lka")
            self.assertEqual(twice["id"], self.build(MODELS / "cube.obj", "--as", kind, "--scale", "2")["id"])
            half = self.build(self.folder / "twice.lka", "--factors", "0.5", name="half.lka")
            self.assertEqual(half["id"], self.build(MODELS / "cube.obj", "--as", kind)["id"])
        mirrored = self.build(MODELS / "tetrahedron.obj", "--as", "hull", "--factors=-1,1,1")
        self.assertEqual((mirrored["lower"], mirrored["upper"]), ([-1, 0, 0], [0, 1, 1]))
        slope = self.write("slope.png", png(3, 3, lambda x, y: 20000 * x))
        scaled = self.build(slope, "--height", "10", "--factors", "2,3,4")
        for found, expected in zip(scaled["upper"], [2, 30 * 40000 / 65535, 4]):
            self.assertAlmostEqual(found, expected, delta=3 * 2**-21)

    def test_factors_that_cannot_be_are_refused(self):
        cube = MODELS / "cube.obj"
        self.assertIn("out of range", self.refuse(cube, "--factors", "600,1,1"))
        self.assertIn("scaled: ", self.refuse(cube, "--factors", "1,0,1"))
        self.assertIn("only a hull, mesh or height field",
                      self.refuse(MODELS / "table.obj", "--as", "compound", "--factors", "2"))
        made = self.folder / "made.lka"
        self.expect(OK, "build", cube, "-o", made)
        for bad in (["build", cube, "--factors", "1,2"], ["build", cube, "--factors", "1,2,3,4"],
                    ["build", cube, "--factors", "one"],
                    ["build", made, "-o", "b.lka"], ["build", made, "--factors", "2"],
                    ["build", made, "--factors", "2", "-o", "b.lka", "--as", "hull"]):
            self.expect(USAGE, *bad)
        self.refuse(self.write("bad.lka", b"LKSA"), "--factors", "2")

    def test_dropped_triangles_are_told(self):
        text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 2 3 1\nf 1 1 2\n"
        done = self.expect(OK, "build", self.write("a.obj", text))
        self.assertIn("dropped 1 triangles without area", done.stderr)
        self.assertIn("dropped 1 repeated triangles", done.stderr)
        self.assertTrue((self.folder / "a.lka").exists())

    def test_bad_lines_are_named_with_the_reason(self):
        for text, line, reason in BAD_LINES:
            path = self.write("bad.obj", text)
            found = self.refuse(path)
            place = f"{path}:{line}: " if line else f"{path}: "
            self.assertTrue(found.startswith(place), f"{text!r}: {found}")
            self.assertIn(reason, found)

    def test_geometry_that_is_refused_is_named(self):
        flat = self.write("flat.obj", VERTICES + "o plate\nf 1 2 4 3\n")
        self.assertIn("flat", self.refuse(flat, "--as", "hull"))
        found = self.refuse(flat, "--as", "compound")
        self.assertTrue(found.startswith(f"{flat}:6: 'plate': "), found)


@unittest.skipUnless("import" in sys.argv, "this build has no import libraries")
class Terrains(Case):
    def terrain(self, *options, **changes):
        picture = {"columns": 5, "rows": 3, "sample": lambda x, y: 65535 if x == 4 else 0} | changes
        return self.build(self.write("a.png", png(**picture)), *options)

    def test_the_middle_is_the_origin_and_white_is_high(self):
        made = self.terrain("--cell", "2", "--height", "10.5", "--base", "-3")
        self.assertEqual((made["kind"], made["columns"], made["rows"]), ("height-field", 5, 3))
        self.assertEqual((made["lower"], made["upper"]), ([-4, -3, -2], [4, 7.5, 2]))

    def test_the_same_picture_gives_the_same_id(self):
        slope = {"columns": 70, "rows": 60, "sample": lambda x, y: 900 * x + 13 * y}
        ids = {self.terrain("--height", "30", **slope)["id"] for _ in range(2)}
        self.assertEqual(len(ids), 1)
        self.assertNotEqual(ids, {self.terrain("--height", "30.1", **slope)["id"]})

    def test_other_pictures_are_refused(self):
        flat = lambda x, y: 7
        for data, reason in [(png(4, 4, flat, depth=8), "8 bits a sample"),
                             (png(4, 4, flat, colour=2), "not greyscale"),
                             (png(4, 4, flat, colour=4), "not greyscale"),
                             (png(1, 4, flat), "1 by 4 samples"),
                             (png(4097, 2, flat), "4097 by 2 samples"),
                             (png(4, 4, flat)[:-20], "damaged PNG"),
                             (png(4, 4, flat).replace(b"IDAT", b"iDAT"), "damaged PNG"),
                             (b"GIF89a", "damaged PNG"), (b"", "damaged PNG")]:
            self.assertIn(reason, self.refuse(self.write("bad.png", data), "--height", "1"))

    def test_a_field_too_wide_is_refused(self):
        wide = self.write("wide.png", png(1026, 2, lambda x, y: 0))
        self.assertIn("out of range", self.refuse(wide, "--height", "1"))
        self.assertIn("out of range", self.refuse(wide, "--height", "1", "--cell", "2000"))


@unittest.skipUnless("import" in sys.argv, "this build has no import libraries")
class Usage(Case):
    def test_errors_have_their_own_code(self):
        cube, picture = MODELS / "cube.obj", self.write("a.png", png(2, 2, lambda x, y: 0))
        for arguments in ([], ["build"], ["info"], ["build", "a.fbx"], ["build", picture],
                          ["build", cube, "--as", "height-field"], ["build", cube, "--as", "cloud"],
                          ["build", picture, "--height", "1", "--as", "hull"],
                          ["build", picture, "--height", "tall"],
                          ["build", cube, "--scale", "0"], ["build", cube, "--scale", "1.0000000001"],
                          ["build", cube, "--surface", "ice"], ["build", cube, "--max-vertices", "3"]):
            self.expect(USAGE, *arguments)

    def test_files_that_cannot_be_read_or_written(self):
        self.refuse(self.folder / "missing.obj")
        self.expect(UNAVAILABLE, "build", MODELS / "cube.obj", "-o", self.folder / "no" / "where.lka")


class Info(Case):
    # A hull by hand: head, tolerance, the corners of a tetrahedron in ascending order.
    CORNERS = [(0, 0, 0), (0, 0, 1), (0, 1, 0), (1, 0, 0)]
    HULL = (b"LKSA" + struct.pack("<HBB", 1, 3, 0) + struct.pack("<iH", 0, 4)
            + b"".join(struct.pack("<3i", *(c << 20 for c in corner)) for corner in CORNERS))

    def test_reads_the_documented_bytes(self):
        (made,) = json.loads(self.expect(OK, "info", "--json", self.write("a.lka", self.HULL)).stdout)
        self.assertEqual((made["kind"], made["vertices"], made["bytes"]), ("hull", 4, 62))
        self.assertAlmostEqual(made["mass"], 1000 / 6, places=5)
        text = self.expect(OK, "info", self.folder / "a.lka").stdout
        self.assertIn(made["id"], text)

    def test_the_worst_file_decides(self):
        good = self.write("good.lka", self.HULL)
        for data, code in [(self.HULL[:-1], CORRUPT), (self.HULL + b"\0", CORRUPT), (b"", CORRUPT),
                           (b"LKSA\3" + self.HULL[5:], INCOMPATIBLE)]:
            done = self.expect(code, "info", "--json", good, self.write("bad.lka", data))
            first, second = json.loads(done.stdout)
            self.assertEqual(first["vertices"], 4)
            self.assertIn("error", second)
            self.assertTrue(done.stderr.startswith(f"{self.folder / 'bad.lka'}: "))
        self.expect(CORRUPT, "info", self.folder / "missing.lka")

    @unittest.skipIf("import" in sys.argv, "this build has the import libraries")
    def test_a_build_without_libraries_says_so(self):
        self.assertIn("libpng-dev", self.expect(UNAVAILABLE, "build", "a.obj").stderr)


if __name__ == "__main__":
    LOCKSTONE = sys.argv[1]
    unittest.main(argv=sys.argv[:1])
