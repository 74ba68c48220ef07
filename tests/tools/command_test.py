"""The lockstone command, without a network.

usage: command_test.py LOCKSTONE SAMPLE_LOGS
"""

import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

LOCKSTONE = SAMPLE_LOGS = ""
GOLDEN = json.loads(
    (pathlib.Path(__file__).resolve().parents[1] / "golden" / "scenes.json").read_text())
OK, DIFFERENT, CORRUPT, INCOMPATIBLE, USAGE, UNAVAILABLE = 0, 1, 2, 3, 64, 69
MODELS = pathlib.Path(__file__).resolve().parent / "models"


def run(*arguments):
    return subprocess.run([LOCKSTONE, *map(str, arguments)], capture_output=True, text=True,
                          timeout=120)


class Case(unittest.TestCase):
    def expect(self, code, *arguments):
        done = run(*arguments)
        self.assertEqual(done.returncode, code, f"{arguments}\n{done.stdout}{done.stderr}")
        return done


class Scenes(Case):
    def test_are_listed_with_what_a_script_needs(self):
        scenes = json.loads(self.expect(OK, "scenes", "--json").stdout)
        for scene in scenes:
            self.assertEqual(set(scene), {"name", "description", "golden_ticks", "bodies"})
            self.assertLessEqual(scene["golden_ticks"], 300)
        names = {scene["name"] for scene in scenes}
        self.assertLessEqual({"stack", "rolling", "capsule", "pyramid", "pile", "bounce", "friction",
                              "kinematic", "trigger", "spawn", "far", "spin", "commands", "arena"},
                             names)

    def test_are_chosen_by_name(self):
        chosen = json.loads(self.expect(OK, "scenes", "--json", "--scene", "stack", "--scene", "arena").stdout)
        self.assertEqual(sorted(scene["name"] for scene in chosen), ["arena", "stack"])
        self.expect(USAGE, "scenes", "--scene", "nothing")

    def test_are_listed_as_text(self):
        self.assertIn("stack", self.expect(OK, "scenes").stdout)


class Run(Case):
    def run_json(self, *arguments):
        return json.loads(self.expect(OK, "run", "--json", *arguments).stdout)

    def test_repeats_itself(self):
        first = self.run_json("--scene", "arena", "--ticks", 60, "--seed", 7, "--hash-every", 5)
        again = self.run_json("--scene", "arena", "--ticks", 60, "--seed", 7, "--hash-every", 5)
        self.assertEqual(first, again)
        self.assertEqual([entry["tick"] for entry in first["chain"]], list(range(5, 61, 5)))
        self.assertEqual(first["final_hash"], first["chain"][-1]["hash"])
        self.assertRegex(first["final_hash"], re.compile(r"^[0-9a-f]{16}$"))
        self.assertEqual((first["scene"], first["seed"], first["ticks"]), ("arena", 7, 60))

    def test_goes_the_way_on_record(self):
        for scene in ("stack", "commands"):
            golden = GOLDEN[scene]
            done = self.run_json("--scene", scene, "--ticks", golden["ticks"])
            self.assertEqual([entry["hash"] for entry in done["chain"]], golden["chain"])
            self.assertEqual(done["final_hash"], golden["final_hash"])

    def test_differs_with_the_seed(self):
        hashes = {self.run_json("--scene", "pile", "--ticks", 10, "--seed", seed)["final_hash"]
                  for seed in (1, 2)}
        self.assertEqual(len(hashes), 2)

    def test_heavy_gives_the_same_hashes(self):
        plain = self.run_json("--scene", "spawn", "--ticks", 80)
        for kind in ("tree", "sweep"):
            self.assertEqual(plain, self.run_json("--scene", "spawn", "--ticks", 80,
                                                  "--broad-phase", kind))
        self.assertEqual(plain, self.run_json("--scene", "spawn", "--ticks", 80, "--heavy"))

    def test_prints_the_chain_as_text(self):
        lines = self.expect(OK, "run", "--scene", "spin", "--ticks", 20).stdout.splitlines()
        self.assertEqual([line.split()[0] for line in lines], ["10", "20", "final"])
        self.assertEqual(lines[-1].split()[1], lines[-2].split()[1])

    def test_draws(self):
        with tempfile.TemporaryDirectory() as folder:
            for frames in (1, 4):
                path = pathlib.Path(folder) / "picture.svg"
                self.expect(OK, "run", "--scene", "pile", "--ticks", 20, "--svg", path,
                            "--frames", frames, "--force")
                text = path.read_text()
                self.assertTrue(text.startswith("<svg") and text.endswith("</svg>\n"))

    def test_draws_all_moments_with_one_camera(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "picture.svg"
            self.expect(OK, "run", "--scene", "bounce", "--ticks", 60, "--svg", path, "--frames", 3)
            moments = path.read_text().split("<svg x=")[1:]
            boxes = [moment.count("<polygon points=") for moment in moments]
            ground = {re.search(r"<polygon points='([^']+)'", moment)[1] for moment in moments}
            self.assertEqual(len(moments), 3)
            self.assertEqual(len(ground), 1, "the ground stands still")
            self.assertGreater(min(boxes), 0)

    def test_writes_a_page_with_a_picture_of_each_scene(self):
        with tempfile.TemporaryDirectory() as folder:
            page = pathlib.Path(folder) / "scenes.md"
            self.expect(OK, "scenes", "--page", page, "--scene", "stack", "arena")
            names = re.findall(r"^## (\w+)$", page.read_text(), re.MULTILINE)
            pictures = sorted(path.stem for path in (pathlib.Path(folder) / "scenes").iterdir())
            self.assertEqual([sorted(names), pictures], [["arena", "stack"]] * 2)
            self.expect(UNAVAILABLE, "scenes", "--page", page, "--scene", "stack")

    def test_refuses_wrong_usage(self):
        self.expect(USAGE, "run", "--scene", "nothing", "--ticks", 10)
        self.expect(USAGE, "run", "--scene", "stack")
        self.expect(USAGE, "run", "--scene", "stack", "--ticks", "many")
        self.expect(USAGE, "run", "--scene", "stack", "--ticks", 0)
        self.expect(USAGE, "run", "--scene", "stack", "--ticks", 9, "--simd", "nothing")
        self.expect(USAGE, "run", "--scene", "stack", "--ticks", 9, "--broad-phase", "nothing")
        self.expect(USAGE, "run", "--scene", "stack", "--ticks", 9, "--overlay")


class Usage(Case):
    def test_an_unknown_command_is_named_and_the_nearest_proposed(self):
        for wrong, right in (("verfy", "verify"), ("rnu", "run"), ("biscet", "bisect"),
                             ("scene", "scenes"), ("kegen", "keygen")):
            done = self.expect(USAGE, wrong, "file")
            self.assertIn(f"unknown command '{wrong}'; did you mean '{right}'?", done.stderr)
        done = self.expect(USAGE, "teleport")
        self.assertIn("unknown command 'teleport'", done.stderr)
        self.assertNotIn("did you mean", done.stderr)

    def test_an_unknown_command_of_a_command_is_named(self):
        self.assertIn("unknown command 'bild'; did you mean 'build'?",
                      self.expect(USAGE, "asset", "bild", "file").stderr)

    def test_an_unknown_option_is_named_and_the_nearest_proposed(self):
        done = self.expect(USAGE, "run", "--scene", "stack", "--tick", 5)
        self.assertIn("unknown option '--tick'; did you mean '--ticks'?", done.stderr)
        done = self.expect(USAGE, "run", "--scene", "stack", "--ticks", 5, "--sede=7")
        self.assertIn("unknown option '--sede'; did you mean '--seed'?", done.stderr)
        self.assertNotIn("did you mean", self.expect(USAGE, "scenes", "--teleport").stderr)


class State(Case):
    def test_a_forgotten_field_is_caught(self):
        for field in ("body.velocity.y", "body.orientation.w", "contact.point[0].normal_impulse",
                      "contact.flags"):
            done = self.expect(DIFFERENT, "run", "--scene", "stack", "--ticks", 40, "--forget", field)
            self.assertIn("went another way", done.stderr)

    def test_flipped_bits_are_found_and_named(self):
        for scene in ("arena", "stack"):
            tally = json.loads(self.expect(OK, "flips", "--scene", scene, "--ticks", 60, "--count", 60,
                                           "--json").stdout)
            self.assertEqual(tally["named"], 60)
            self.assertEqual(tally["hashed"], 60)

    def test_hashes_of_two_machines_are_compared(self):
        # The output of `hash` for scenes; golden_scenes.py runs it.
        hashes = {"name": "one", "abi": 1, "canary": "0" * 16,
                  "scenes": {name: scene["chain"] for name, scene in GOLDEN.items()}}
        with tempfile.TemporaryDirectory() as folder:
            one, two = pathlib.Path(folder) / "one.json", pathlib.Path(folder) / "two.json"
            one.write_text(json.dumps(hashes))
            two.write_text(json.dumps(hashes))
            self.assertIn("all equal", self.expect(OK, "compare-hashes", one, two).stdout)
            hashes["scenes"]["stack"][3] = "0" * 16
            two.write_text(json.dumps(hashes))
            self.assertIn("stack: differs by tick 40",
                          self.expect(DIFFERENT, "compare-hashes", one, two).stdout)
            for nothing in ({}, {"scenes": {}}):
                two.write_text(json.dumps(nothing))
                self.expect(CORRUPT, "compare-hashes", one, two)
            self.expect(CORRUPT, "compare-hashes", one, pathlib.Path(folder) / "missing.json")
            self.expect(USAGE, "compare-hashes", one)

    def test_rollback_is_measured(self):
        figures = json.loads(self.expect(OK, "bench", "rollback", "--bodies", 60, "--settle", 30,
                                         "--repeats", 3, "--guess-repeats", 1, "--ticks", 2, "--json").stdout)
        self.assertLessEqual(figures["bytes_per_body"], 256)
        self.assertLessEqual(figures["bytes_per_contact"], 96)
        guesses = figures["wrong_guesses"]["guesses"]
        self.assertEqual([guess["touched_islands"] for guess in guesses], [0, 1, 2, 8, 40])
        self.assertEqual([guess["computed_islands"] for guess in guesses], [0, 2, 4, 16, 80])
        self.assertTrue(all(guess["equal"] for guess in guesses))


class Usage(Case):
    def test_is_explained(self):
        self.assertIn("Exit codes", self.expect(OK, "--help").stdout)
        self.assertIn("Exit codes", self.expect(OK, "verify", "--help").stdout)
        for command in ("run", "serve", "lossy", "simnet", "bench speed", "bench skip"):
            text = self.expect(OK, *command.split(), "--help").stdout
            self.assertTrue(text.replace("\n", "").isprintable(), f"{command}: {text!r}")
        self.expect(OK, "--version")

    def test_errors_have_their_own_code(self):
        for arguments in ([], ["nonsense"], ["verify"], ["info"], ["scenes", "--nonsense"]):
            self.expect(USAGE, *arguments)


class Files(Case):
    """Files that the command reads and writes."""

    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)
        self.log = self.folder / "log.lks"
        self.expect(OK, "record", self.log, "--scene", "spin", "--ticks", 20)

    def writers(self):
        """The commands that write, each without its file, which comes last."""
        return [("record", "--scene", "spin", "--ticks", 3), ("cut", "--from", 3, self.log),
                ("repair", self.log), ("seek", self.log, 9, "--state"),
                ("seek", self.log, 9, "--svg"), ("run", "--scene", "spin", "--ticks", 3, "--svg"),
                ("numerics", "--write"), ("serve", "--insecure", "--record"),
                ("serve", "--insecure", "--bundle"), ("demo", "--ticks", 1, "--svg"),
                ("demo", "--ticks", 1, "--record"), ("bench", "accuracy", "--rows", 3, "--page"),
                ("bench", "accuracy", "--plot"), ("bench", "stability", "--rows", "stack-10", "--page"),
                ("bench", "speed", "--csv"), ("bench", "speed", "--instructions"),
                ("bench", "speed", "--islands", "--page"), ("bench", "speed", "--islands", "--chart"),
                ("asset", "build", MODELS / "cube.obj", "-o")]

    def refuse(self, command, path):
        done = run(*command, path)
        self.assertEqual(done.returncode, UNAVAILABLE, f"{command} {path}\n{done.stdout}{done.stderr}")
        self.assertIn(f"cannot write {path}", done.stderr)

    def test_are_not_replaced_without_force(self):
        there = self.folder / "there.svg"
        for command in self.writers():
            if not self.has(command):
                continue
            there.write_text("precious")
            self.refuse(command, there)
            self.assertEqual(there.read_text(), "precious")
        self.assertEqual(set(self.folder.iterdir()), {self.log, there})

    def test_are_replaced_with_force(self):
        there = self.folder / "there.svg"
        for command in self.writers()[:7]:
            there.write_text("precious")
            self.expect(OK, *command, there, "--force")
            self.assertNotIn(b"precious", there.read_bytes())
        self.assertEqual(set(self.folder.iterdir()), {self.log, there})

    def test_fifos_and_devices_are_refused_at_once(self):
        fifo = self.folder / "fifo.svg"
        os.mkfifo(fifo)
        for command in self.writers():
            if not self.has(command):
                continue
            for path in (fifo, "/dev/null"):
                if path == fifo or "--plot" not in command:
                    self.refuse(command, path)
        self.refuse(("record", "--force"), fifo)
        for path in (fifo, self.folder, "/dev/zero"):
            for command in (("verify",), ("info",), ("trace",), ("repair",), ("cut",), ("seek",)):
                rest = {"repair": [self.folder / "o"], "cut": [self.folder / "o"], "seek": [1]}
                done = run(*command, path, *rest.get(command[0], []))
                self.assertEqual(done.returncode, CORRUPT, f"{command} {path} {done.stderr}")
            for arguments in (["diff", path, self.log], ["verify", self.log, "--key", path],
                              ["numerics", "--check", path], ["asset", "info", path],
                              ["compare-hashes", path, path], ["record", self.folder / "o", "--sign", path]):
                self.assertNotEqual(run(*arguments).returncode, OK, arguments)

    @staticmethod
    def has(command):
        """Whether this build has the command: an absent one says so."""
        words = [word for word in command[:2] if not str(word).startswith("-") and word in
                 ("serve", "demo", "bench", "accuracy", "stability", "speed", "asset", "build")]
        return "ot in this build" not in run(*words, "--help").stdout


class Logs(Case):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.temporary.name)
        subprocess.run([SAMPLE_LOGS, cls.folder], check=True, timeout=120)
        damaged = bytearray((cls.folder / "good.lks").read_bytes())
        cls.damaged_at = len(damaged) // 2
        damaged[cls.damaged_at] ^= 0x10
        (cls.folder / "damaged.lks").write_bytes(damaged)
        (cls.folder / "empty.lks").write_bytes(b"")
        (cls.folder / "text.lks").write_text("this is not a log\n" * 50)

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def record(self, name, *options):
        path = self.folder / name
        self.expect(OK, "record", path, "--ticks", 90, "--keyframes", 40, *options)
        return path

    def test_are_recorded_and_read_from_the_middle(self):
        path = self.record("recorded.lks")
        self.expect(OK, "verify", "--strict", path, "--jobs", 3)
        info = json.loads(self.expect(OK, "info", "--json", path).stdout)
        self.assertTrue(info["index"])
        seek = json.loads(self.expect(OK, "seek", path, 85, "--json").stdout)
        trace = json.loads(self.expect(OK, "trace", path).stdout)
        self.assertEqual(seek["loaded_tick"], 80)
        self.assertEqual(seek["hash"], trace["hashes"][84])
        self.assertEqual(info["last_hash"], trace["hashes"][89])
        self.expect(CORRUPT, "seek", path, 91)

    def test_of_a_race_of_bots_have_a_car_for_each_player(self):
        path = self.record("race.lks", "--scene", "race")
        self.expect(OK, "verify", "--strict", path)
        info = json.loads(self.expect(OK, "info", "--json", path).stdout)
        trace = json.loads(self.expect(OK, "trace", path).stdout)
        run = json.loads(self.expect(OK, "run", "--scene", "race", "--ticks", 90, "--json").stdout)
        self.assertEqual(info["header"]["players"], 16)
        self.assertEqual(trace["hashes"][89], run["final_hash"])
        played = self.expect(OK, "simnet", "--scene", "race", "--seeds", 1, "--ticks", 60, "--json")
        self.assertEqual(json.loads(played.stdout)["failures"], [])

    def test_are_cut_and_repaired(self):
        path = self.record("whole.lks")
        part, torn, saved = (self.folder / name for name in ("part.lks", "torn.lks", "saved.lks"))
        self.expect(OK, "cut", path, part, "--from", 50, "--to", 70)
        self.assertEqual(json.loads(self.expect(OK, "verify", "--strict", "--json", part).stdout)[0]
                         ["ticks_verified"], 20)
        torn.write_bytes(path.read_bytes()[:-300])
        self.expect(CORRUPT, "verify", "--strict", torn)
        self.expect(OK, "repair", torn, saved)
        self.expect(OK, "verify", "--strict", saved)

    def test_a_refused_cut_leaves_no_file(self):
        path, out = self.record("to_cut.lks"), self.folder / "no_part.lks"
        before = set(self.folder.iterdir())
        self.expect(USAGE, "cut", path, out, "--from", 60, "--to", 30)
        self.expect(USAGE, "cut", path, out, "--from", 60, "--to", 60)
        self.expect(CORRUPT, "cut", path, out, "--from", 500)
        self.expect(CORRUPT, "cut", self.folder / "text.lks", out)
        self.expect(INCOMPATIBLE, "cut", self.folder / "foreign.lks", out)
        self.expect(CORRUPT, "repair", self.folder / "text.lks", out)
        self.assertEqual(set(self.folder.iterdir()), before)

    def test_have_a_random_match_number(self):
        def number(path):
            return json.loads(self.expect(OK, "info", "--json", path).stdout)["header"]["match_id"]
        self.assertNotEqual(number(self.record("one.lks")), number(self.record("two.lks")))
        self.assertEqual(number(self.record("seven.lks", "--match-id", 7)), f"{7:016x}")

    def test_what_is_not_proved_is_said_of_unsigned_ones(self):
        path = self.record("not_proved.lks")
        lines = self.expect(OK, "verify", path).stdout.splitlines()
        self.assertEqual(lines[0], f"{path}: same; 90 ticks verified")
        self.assertIn("not signed", lines[1])
        self.assertIn("transcript", lines[2])
        report = json.loads(self.expect(OK, "verify", "--json", path).stdout)[0]
        self.assertEqual(report["signature"], "none")
        self.assertIn("not signed", report["not_proved"][0])
        self.assertIn(report["transcript"], lines[2])

    def test_that_were_cut_say_so_in_their_first_line(self):
        path, part, torn = self.record("uncut.lks"), self.folder / "a_part.lks", self.folder / "cut.lks"
        self.expect(OK, "cut", path, part, "--from", 0, "--to", 70)
        torn.write_bytes(path.read_bytes()[:-100])
        for log, ticks in ((part, 70), (torn, 90)):
            line = self.expect(OK, "verify", log).stdout.splitlines()[0]
            self.assertIn(f"cut at tick {ticks}: only the first {ticks} ticks are proved", line)

    def test_that_differ_are_bisected_to_the_field(self):
        good, plain = self.record("good_one.lks"), self.record("plain.lks", "--plain")
        wrong = self.record("wrong.lks", "--flip-bit-at", 57)
        self.expect(OK, "diff", good, plain)
        diff = json.loads(self.expect(DIFFERENT, "diff", "--json", good, wrong).stdout)
        self.assertTrue(diff["hash"].startswith("tick 57:"))
        found = json.loads(self.expect(DIFFERENT, "bisect", "--json", good, wrong).stdout)
        self.assertEqual((found["tick"], found["state_at"]), (57, 58))
        self.assertEqual((found["store"], found["field"]), ("body", "position.x"))
        self.assertIn("one bit flipped", found["note"])
        self.assertIn("no difference", self.expect(OK, "bisect", good, plain).stdout)
        self.assertIn("no difference", self.expect(OK, "bisect", good, "--with", LOCKSTONE).stdout)
        self.expect(USAGE, "bisect", good)

    def test_are_signed(self):
        key = self.folder / "key"
        made = run("keygen", key)
        if made.returncode != OK:
            self.skipTest("built without libsodium")
        self.expect(USAGE, "keygen", key)
        signed, plain = self.record("signed.lks", "--sign", key), self.record("unsigned.lks")
        self.expect(OK, "verify", signed, "--key", f"{key}.pub")
        self.expect(CORRUPT, "verify", plain, "--key", f"{key}.pub")
        info = json.loads(self.expect(OK, "info", "--json", signed).stdout)
        self.assertEqual(info["signature"]["state"], "good")
        self.assertTrue(info["signature"]["covers_end"])
        self.assertEqual(len(self.expect(OK, "verify", signed, "--key", f"{key}.pub").stdout.splitlines()), 1)
        self.assertIn("who signed", self.expect(OK, "verify", signed).stdout)
        longer = self.folder / "longer.lks"
        longer.write_bytes(signed.read_bytes() + plain.read_bytes()[-200:])
        self.expect(CORRUPT, "verify", longer, "--key", f"{key}.pub")
        self.expect(CORRUPT, "verify", longer)

    def verify(self, code, name, *options):
        done = self.expect(code, "verify", "--json", *options, self.folder / name)
        (report,) = json.loads(done.stdout)
        self.assertEqual(report["exit_code"], code)
        return report

    def test_a_good_one_verifies(self):
        report = self.verify(OK, "good.lks")
        self.assertEqual(report["ticks_verified"], 700)
        self.assertTrue(report["complete"])
        self.expect(OK, "verify", self.folder / "good.lks")

    def test_a_flipped_byte_is_found_and_placed(self):
        report = self.verify(CORRUPT, "damaged.lks")
        self.assertLessEqual(report["damage"]["offset"], self.damaged_at)
        self.assertIn(str(report["damage"]["offset"]), report["line"])

    def test_an_altered_input_with_right_checksums_diverges_at_its_tick(self):
        report = self.verify(DIFFERENT, "altered.lks")
        self.assertEqual(report["divergence"]["tick"], 300)
        self.assertIn("difference", report["divergence"])  # the keyframe at 600 explains it

    def test_another_configuration_is_incompatible(self):
        report = self.verify(INCOMPATIBLE, "foreign.lks")
        self.assertEqual([mismatch["field"] for mismatch in report["mismatches"]], ["config hash"])

    def test_one_of_an_unknown_game_is_refused_by_name(self):
        line = "this log is of game 'sumo' 1.2; this tool knows arena, scenes; use --game"
        done = self.expect(INCOMPATIBLE, "verify", self.folder / "sumo.lks", self.folder / "good.lks")
        self.assertIn(f"sumo.lks: incompatible: {line}", done.stdout)
        self.assertIn("good.lks: same", done.stdout)
        self.assertIn(line, self.expect(INCOMPATIBLE, "trace", self.folder / "sumo.lks").stderr)

    def test_a_game_that_is_not_there_is_refused(self):
        done = self.expect(UNAVAILABLE, "--game", self.folder / "none.so", "verify", self.folder / "good.lks")
        self.assertIn("none.so", done.stderr)

    def test_hashes_of_a_log_are_those_of_its_ticks(self):
        log = self.folder / "good.lks"
        files = []
        for name in ("one", "other"):
            files.append(self.folder / f"{name}.json")
            self.expect(OK, "hash", "--log", log, "--json", "--name", name, "--out", files[-1], "--force")
        chain = json.loads(files[0].read_text())["chain"]
        trace = json.loads(self.expect(OK, "trace", log).stdout)
        self.assertEqual(chain, [[tick + 1, hash] for tick, hash in enumerate(trace["hashes"])])
        self.assertIn("all equal, 700 ticks", self.expect(OK, "compare-hashes", *files).stdout)
        scenes = self.folder / "scenes.json"
        scenes.write_text(json.dumps({"scenes": {"stack": ["0"]}}))
        self.expect(INCOMPATIBLE, "compare-hashes", files[0], scenes)

    def test_one_without_an_end_is_good_unless_strict(self):
        self.assertFalse(self.verify(OK, "open.lks")["complete"])
        self.verify(CORRUPT, "open.lks", "--strict")

    def test_what_is_no_log_is_corrupt(self):
        for name in ("empty.lks", "text.lks", "missing.lks"):
            self.expect(CORRUPT, "verify", self.folder / name)
            self.expect(CORRUPT, "info", self.folder / name)

    def test_whose_name_is_no_utf_8_makes_json_all_the_same(self):
        odd = pathlib.Path(os.fsdecode(os.fsencode(self.folder) + b"/\xff.lks"))
        odd.write_bytes((self.folder / "good.lks").read_bytes())
        (report,) = json.loads(self.expect(OK, "verify", "--json", odd).stdout)
        self.assertTrue(report["file"].endswith("\ufffd.lks"))

    def test_the_worst_of_several_decides(self):
        self.expect(CORRUPT, "verify", *(self.folder / name for name in
                                         ("good.lks", "damaged.lks", "altered.lks")))

    def test_info_sums_up(self):
        info = json.loads(self.expect(OK, "info", "--json", self.folder / "good.lks").stdout)
        self.assertEqual(info["ticks"], 700)
        self.assertEqual(info["keyframe_ticks"], [150, 300, 450, 600])
        self.assertEqual(info["header"]["players"], 2)
        self.assertIn("700", self.expect(OK, "info", self.folder / "good.lks").stdout)
        self.expect(CORRUPT, "info", self.folder / "damaged.lks")


if __name__ == "__main__":
    LOCKSTONE, SAMPLE_LOGS = sys.argv[1:3]
    unittest.main(argv=sys.argv[:1], verbosity=2)
