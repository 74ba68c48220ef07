"""lockstone bench: that it runs, that its output can be read, and that it computes the same state
every time. Times are not judged.

usage: bench_test.py LOCKSTONE
"""

import csv
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree

LOCKSTONE = ""
OK, DIFFERENT, CORRUPT, USAGE, UNAVAILABLE = 0, 1, 2, 64, 69
HASH = r"^[0-9a-f]{16}$"


class Case(unittest.TestCase):
    def expect(self, code, *arguments, **environment):
        done = subprocess.run([LOCKSTONE, "bench", *map(str, arguments)], capture_output=True, text=True,
                              timeout=240, env={**os.environ, **environment})
        self.assertEqual(done.returncode, code, f"{arguments}\n{done.stdout}{done.stderr}")
        return done.stdout

    def json_of(self, *arguments):
        return json.loads(self.expect(OK, *arguments, "--json"))


class General(Case):
    def test_replays_a_seed_to_the_same_state(self):
        row, = json.loads(self.expect(OK, "general", "--alone", "--family", "house", "--first-seed", 3, "--seeds", 1,
                                      "--json"))
        text = self.expect(OK, "general", "--alone", "--replay", "house:3")
        self.assertIn(row["seeds"][0]["hash"], text)

    def test_draws_and_writes(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder)
            self.expect(OK, "general", "--alone", "--replay", "ladder:1", "--svg", path / "a.svg")
            self.expect(OK, "general", "--alone", "--family", "arch,house", "--seeds", 2, "--plot", path / "plots",
                        "--page", path / "page.md")
            for svg in [path / "a.svg", path / "plots" / "arch.svg", path / "plots" / "house.svg"]:
                xml.etree.ElementTree.parse(svg)
            self.assertIn("| house | lockstone |", (path / "page.md").read_text(encoding="utf-8"))

    def test_names_the_settings_of_a_seed_that_fails(self):
        text = self.expect(DIFFERENT, "general", "--alone", "--iterated", "--substeps", 2, "--family", "tall-stack",
                           "--seeds", 1)
        command = re.search(r"^failed: lockstone (bench general --iterated --substeps 2 --replay tall-stack:\d)$", text, re.M)
        self.assertIn("FAILED", self.expect(DIFFERENT, *command[1].split()[1:], "--alone"))

    def test_refuses_what_is_no_seed(self):
        for seed in ("house", "house:", "house:x", "no:1"):
            self.expect(USAGE, "general", "--replay", seed)

    def test_lists_families(self):
        self.assertIn("four-bar", self.expect(OK, "general", "--list"))


class Speed(Case):
    @classmethod
    def setUpClass(cls):
        run = ("speed", "--scene", "mixed-pile", "--ticks", 50, "--threads", 1)
        cls.scene, = cls().json_of(*run, "--repeats", 2)["scenes"]
        cls.again, = cls().json_of(*run, "--repeats", 1, "--detail")["scenes"]
        cls.sweep, = cls().json_of(*run, "--repeats", 1, "--cpu", "--broad-phase", "sweep")["scenes"]

    def test_repeats_itself(self):
        self.assertRegex(self.scene["final_hash"], HASH)
        for key in ("final_hash", "bodies", "contacts", "contact_points", "saturations", "ticks"):
            self.assertEqual(self.scene[key], self.again[key], key)
            self.assertEqual(self.scene[key], self.sweep[key], key)
        self.assertTrue(self.scene["hashes_agree"] and self.again["hashes_agree"])
        self.assertEqual((self.scene["status"], self.scene["ticks"]), ("ok", 50))

    def test_the_stages_lie_within_the_tick(self):
        scene = self.again  # a single run: medians of several need not add up
        self.assertEqual(list(scene["stage_ns"])[:2], ["find_pairs", "collide"])
        self.assertLessEqual(sum(scene["stage_ns"].values()), scene["tick_ns"]["mean"])

    def test_the_detail_names_the_pairs(self):
        pairs = {row["kinds"]: row for row in self.again["pairs"]}
        self.assertLessEqual({"sphere-box", "capsule-box", "box-box"}, set(pairs))
        for row in pairs.values():
            self.assertLessEqual(row["in_contact"], row["pairs"])
            self.assertLessEqual(row["reused"], row["manifolds"])
            self.assertLessEqual(row["parted"], row["pairs"] - row["in_contact"])

    def test_commands_and_queries_before_a_step_repeat_themselves(self):
        run = ("speed", "--ticks", 3, "--repeats", 2, "--threads", 1)
        for name in ("storm", "ragdoll-rain"):
            scene, = self.json_of(*run, "--scene", name)["scenes"]
            self.assertTrue(scene["hashes_agree"], name)
            self.assertEqual(scene["status"], "ok", name)

    def test_lists_its_scenes(self):
        names = [line.split()[0] for line in self.expect(OK, "speed", "--list").splitlines()]
        self.assertLessEqual({"large-pyramid", "washer", "junkyard", "ragdoll-rain", "terrain", "storm", "city"}, set(names))
        self.assertEqual(len(names), len(set(names)))

    def test_writes_a_line_a_tick(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "ticks.csv"
            text = self.expect(OK, "speed", "--scene", "ball-rain", "--ticks", 12, "--repeats", 1,
                               "--threads", 1, "--csv", path)
            self.assertIn("ball-rain", text)
            with path.open() as file:
                rows = list(csv.DictReader(file))
        self.assertEqual([row["tick"] for row in rows], [str(tick) for tick in range(12)])
        self.assertTrue(all(int(row["ns"]) >= int(row["solve_ns"]) for row in rows))

    def test_refuses_wrong_usage(self):
        self.expect(USAGE, "speed", "--scene", "nothing")
        self.expect(USAGE, "speed", "--ticks", 0)

    def test_stands_beside_other_engines(self):
        """Ours first; the others are absent from most builds."""
        run = ("speed", "--ticks", 3, "--repeats", 1, "--peers", "--islands", "--most", 100)
        report = self.json_of(*run, "--scene", "ball-rain", "--scene", "storm")
        rain, storm = report["scenes"]
        self.assertEqual((rain["bodies"], rain["ticks"]), (4800, 3))
        self.assertIn("queries", storm["lacking"])
        self.assertEqual([row["scene"] for row in report["islands"]], ["stacks", "piles", "ragdolls"])
        for row in [rain] + report["islands"]:
            ours = row["engines"][0]
            self.assertEqual((ours["engine"], ours["ours_to_it"], ours["had_room"]), ("lockstone", 1, True))
            for engine in row["engines"]:
                self.assertAlmostEqual(engine["height_m"], ours["height_m"], delta=0.1)
        self.expect(USAGE, "speed", "--peers", "nobody")
        self.expect(USAGE, "speed", "--vectors", "nothing")

    def test_draws_the_ratios_of_islands(self):
        with tempfile.TemporaryDirectory() as folder:
            chart = pathlib.Path(folder) / "chart.svg"
            self.expect(OK, "speed", "--islands", "--most", 100, "--ticks", 1, "--chart", chart)
            self.assertIn("ragdolls: ten bodies", chart.read_text())

    def test_compares_with_counts_alone(self):
        self.expect(CORRUPT, "speed", "--compare", __file__)


class Size(Case):
    def test_measures_each_kind_of_world(self):
        sizes = self.json_of("size", "--most", 100)["sizes"]
        self.assertEqual([row["kind"] for row in sizes], ["asleep", "stacks", "pile", "ragdolls"])
        for row in sizes:
            self.assertEqual((row["bodies"], row["had_room"]), (100, True))
            self.assertRegex(row["hash"], HASH)
            self.assertGreater(row["highest_m"], 1)
        self.assertLess(sizes[0]["moving"], 10)
        self.assertEqual(self.json_of("size", "--most", 100, "--kinds", "pile")["sizes"][0]["hash"], sizes[2]["hash"])

    def test_takes_powers_of_ten_up_to_the_largest(self):
        sizes = self.json_of("size", "--most", 2000, "--kinds", "asleep")["sizes"]
        self.assertEqual([row["bodies"] for row in sizes], [100, 1000, 2000])

    def test_draws(self):
        with tempfile.TemporaryDirectory() as folder:
            chart = pathlib.Path(folder) / "chart.svg"
            self.expect(OK, "size", "--most", 100, "--kinds", "stacks", "--chart", chart)
            self.assertIn("memory of the world", chart.read_text())

    def test_refuses_wrong_usage(self):
        self.expect(USAGE, "size", "--kinds", "nothing")
        self.expect(USAGE, "size", "--most", 99)
        self.expect(USAGE, "size", "--vectors", "nothing")


class Queries(Case):
    @classmethod
    def setUpClass(cls):
        run = ("queries", "--bodies", 300, "--queries", 200, "--repeats", 1)
        cls.report = cls().json_of(*run)
        cls.again = cls().json_of(*run, "--broad-phase", "sweep")
        cls.other = cls().json_of(*run, "--seed", 2)

    def test_repeat_themselves(self):
        def hashes(report):
            return [report["world_hash"], *(row["answers_hash"] for row in report["rows"])]
        self.assertEqual(hashes(self.report), hashes(self.again))
        self.assertFalse(set(hashes(self.report)) & set(hashes(self.other)))
        for text in hashes(self.report):
            self.assertRegex(text, HASH)

    def test_are_answered_right(self):
        for row in self.report["rows"]:
            ours = row["engines"][0]
            self.assertEqual(ours["right"], 1, row["query"])
            # Where a cast grazes, the 1 µm that a hit may be apart is more along the way.
            bound = 2e-3 if row["query"].startswith("cast") else 2e-6
            self.assertLessEqual(ours["worst_metres"], bound, row["query"])
        judges = [row["judge"] for row in self.report["rows"]]
        self.assertGreater(judges.count("double"), judges.count("lockstone"))

    def test_are_of_all_kinds(self):
        names = {row["query"]: row["found"] for row in self.report["rows"]}
        self.assertLessEqual({"ray closest 5 m", "ray any 100 m", "ray all 100 m", "cast sphere 5 m", "cast box 20 m",
                              "overlap box 1 m", "point", "near point 10 m"},
                             set(names))
        self.assertTrue(all(found > 0 for found in names.values()), names)

    def test_a_peer_is_there_or_absent(self):
        engines = {engine["engine"].split()[0] for engine in self.report["rows"][0]["engines"]}
        self.assertEqual(engines | set(self.report["absent"]), {"lockstone", "Bullet"})

    def test_are_printed_as_text(self):
        text = self.expect(OK, "queries", "--bodies", 100, "--queries", 20, "--repeats", 1)
        self.assertIn("ray closest 5 m", text)
        self.assertIn("Bullet", text)

    def test_refuse_wrong_usage(self):
        self.expect(USAGE, "queries", "--bodies", 0)


class Pages(Case):
    def page_of(self, *arguments):
        with tempfile.TemporaryDirectory() as folder:
            page = pathlib.Path(folder) / "page.md"
            self.expect(OK, *arguments, "--page", page)
            lines = page.read_text().splitlines()
        return lines[0], [line.strip("| ").split(" | ") for line in lines if line.startswith("| ")]

    def test_figures_at_several_settings_share_a_line(self):
        title, lines = self.page_of("accuracy", "--rows", "3,6,38", "--sweep")
        self.assertEqual(title, "# Errors against exact references")
        sweep, rates, one = [i for i, line in enumerate(lines) if line[0] == "row"]
        self.assertEqual(lines[sweep][3:8], [f"60 Hz x {substeps}" for substeps in (1, 2, 4, 8, 16)])
        self.assertEqual(lines[rates][3:7], [f"{rate} Hz x 4" for rate in (30, 60, 120, 240)])
        self.assertEqual(lines[one][3], "worst")
        damping, = [line for line in lines if line[0] == "3"]
        self.assertEqual(len(damping), len(lines[sweep]))
        self.assertTrue(all(0 < float(error) < 1e-5 for error in damping[3:8]))
        self.assertEqual(damping[9], "met")
        self.assertRegex(damping[10], HASH)

    def test_each_figure_of_stability_has_its_verdict(self):
        with tempfile.TemporaryDirectory() as folder:
            page = pathlib.Path(folder) / "page.md"
            run = ("stability", "--rows", "stack-10", "--seconds", 1, "--page", page)
            self.expect(OK, *run)
            figures = [line for line in page.read_text().splitlines() if line.startswith("| ten boxes")]
        self.assertGreaterEqual(len(figures), 2)
        for figure in figures:
            self.assertIn("| met |", figure)

    def test_the_command_on_a_page_writes_it_again(self):
        runs = {"page.md": ("stability", "--rows", "stack-10", "--seconds", 1, "--page"),
                "accuracy.md": ("accuracy", "--rows", 3, "--tries", 2, "--page"),
                "speed.md": ("speed", "--scene", "ball-rain", "--ticks", 2, "--repeats", 1, "--peers", "--islands",
                             "--most", 100, "--vectors", "scalar", "--page"),
                "size.md": ("size", "--kinds", "pile", "--most", 100, "--cpu", "--page"),
                "general.md": ("general", "--alone", "--family", "arch", "--seeds", 1, "--substeps", 2, "--page"),
                "front": ("accuracy", "--scenes", "throw", "--settings", 1, "--repeats", 1, "--alone", "--plot")}
        with tempfile.TemporaryDirectory() as folder:
            for name, run in runs.items():
                path = pathlib.Path(folder) / name
                self.expect(OK, *run, path)
                page = path / "front.md" if path.is_dir() else path
                command = re.search("Made by `lockstone bench ([^`]*)`", page.read_text()).group(1).split()
                self.assertIn("--force", command)
                if path.is_dir():
                    continue
                self.assertLessEqual({word for word in run if str(word).startswith("--")}, set(command))
                self.expect(OK, *command)

    def test_a_page_that_cannot_be_written_is_a_failure(self):
        self.expect(UNAVAILABLE, "accuracy", "--rows", 3, "--page", "/nowhere/page.md")


class Front(Case):
    """Time against error, ours alone: peers and their versions differ between machines."""

    def test_scenes_are_described_for_anyone(self):
        described = self.json_of("scenes")
        self.assertEqual((described["format"], described["tick_rate"]), ("lockstone scenes 1", 60))
        scenes = {scene["name"]: scene for scene in described["scenes"]}
        self.assertLessEqual({"free-fall", "slide", "chain", "stack-20", "pendulum", "net"}, set(scenes))
        self.assertEqual(len(scenes), len(described["scenes"]))
        for scene in scenes.values():
            bodies = len(scene["bodies"])
            self.assertTrue(all(0 <= body < bodies for body in scene["watched"]), scene["name"])
            self.assertTrue(all(max(joint["a"], joint["b"]) < bodies for joint in scene["joints"]), scene["name"])

    def test_a_run_is_a_line_of_json_for_each_setting(self):
        lines = self.expect(OK, "scenes", "--run", "--alone", "--scenes", "free-fall", "--settings", "1,4",
                            "--repeats", 2).splitlines()
        runs = [json.loads(line) for line in lines]
        self.assertEqual([(run["scene"], run["setting"]) for run in runs], [("free-fall", 1), ("free-fall", 4)])
        for run in runs:
            self.assertEqual((len(run["cpu_seconds"]), len(run["samples"])), (2, 1))
            self.assertAlmostEqual(run["samples"][0][0][1], -490.5, places=6)

    def test_draws_charts_and_writes_pages(self):
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            run = ("accuracy", "--scenes", "bounce,throw", "--settings", "1,4", "--repeats", 1, "--alone", "--plot")
            self.expect(OK, *run, folder / "front")
            self.expect(OK, *run, folder / "all.svg")
            pictures = {path.stem for path in (folder / "front").glob("*.svg")}
            self.assertEqual(pictures, {"bounce", "throw-speed", "throw-way"})
            for picture in [*(folder / "front").glob("*.svg"), folder / "all.svg"]:
                xml.etree.ElementTree.parse(picture)
            with (folder / "front" / "front.csv").open() as file:
                rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
            self.assertIn("## Row 12", (folder / "front" / "front.md").read_text())
        self.assertEqual([(row["figure"], row["setting"]) for row in rows],
                         [(name, setting) for name in ("bounce", "throw-speed", "throw-way") for setting in "14"])
        for row in rows:
            self.assertRegex(row["hash"], HASH)
            self.assertLess(float(row["error"]), 1e-2)

    def play_under_node(self, code, change):
        """The page and the points of a run whose `node` prints our figures, changed."""
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            run = ("--scenes", "throw", "--settings", "1,4", "--repeats", 1, "--alone")
            lines = [json.loads(line) for line in self.expect(OK, "scenes", "--run", *run).splitlines()]
            said = ["no JSON", "{}", '{"engine": 1}', *map(json.dumps, change(lines))]
            (folder / "said").write_text("\n".join(said) + "\n")
            node = folder / "node"
            node.write_text(f"#!/bin/sh\ncat '{folder}/said'\n")
            node.chmod(0o755)
            self.expect(code, "accuracy", *run, "--plot", folder / "front", "--node", folder, "--wasm", "player",
                        PATH=f"{folder}:{os.environ['PATH']}")
            with (folder / "front" / "front.csv").open() as file:
                rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
            return (folder / "front" / "front.md").read_text(), rows

    def test_reads_what_engines_under_node_print(self):
        page, rows = self.play_under_node(OK, lambda lines: lines)
        self.assertIn("lockstone wasm ends 2 of 2 runs in the same state", page)
        errors = {engine: [row["error"] for row in rows if row["engine"] == engine]
                  for engine in ("lockstone", "lockstone wasm", "Rapier", "Jolt")}
        self.assertEqual(len(errors["lockstone"]), 4)
        for engine, found in errors.items():
            self.assertEqual(found, errors["lockstone"], engine)
        self.assertEqual({row["family"] for row in rows if row["engine"] != "lockstone"}, {"node"})

    def test_names_another_state_in_webassembly(self):
        page, _ = self.play_under_node(DIFFERENT, lambda lines: [{**line, "hash": 1} for line in lines])
        self.assertIn("lockstone wasm ends 0 of 2 runs in the same state", page)

    def test_an_engine_that_says_nothing_is_absent(self):
        page, rows = self.play_under_node(OK, lambda lines: [])
        self.assertIn("Absent: Rapier", page)
        self.assertEqual({row["engine"] for row in rows}, {"lockstone"})

    def test_refuses_unknown_scenes(self):
        self.expect(USAGE, "accuracy", "--plot", "nowhere", "--scenes", "nothing")


if __name__ == "__main__":
    LOCKSTONE = sys.argv[1]
    unittest.main(argv=sys.argv[:1], verbosity=2)
