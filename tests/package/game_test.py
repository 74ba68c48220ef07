"""The example game, built against the installed package: its own tool, and `lockstone --game`.

usage: game_test.py ROLLING LOCKSTONE LIBRARY BAD_FOLDER network|none C_LIBRARY|none C_TOOL|none

ROLLING and LIBRARY are the game's tool and shared library; BAD_FOLDER holds libraries to refuse; C_LIBRARY and
C_TOOL are those of the game in C.
"""

import json
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import unittest

ROLLING = LOCKSTONE = LIBRARY = BAD = NETWORK = IN_C = TOOL_IN_C = ""
OK, DIFFERENT, CORRUPT, INCOMPATIBLE, USAGE, UNAVAILABLE = 0, 1, 2, 3, 64, 69


def own():
    return [ROLLING]


def loaded():
    return [LOCKSTONE, "--game", LIBRARY]


class Case(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def expect(self, code, command, *arguments):
        done = subprocess.run([*command, *map(str, arguments)], capture_output=True, text=True,
                              timeout=120)
        self.assertEqual(done.returncode, code, f"{command} {arguments}\n{done.stdout}{done.stderr}")
        return done

    def record(self, command, name, *options):
        log = self.folder / name
        self.expect(OK, command, "record", log, "--players", 3, "--ticks", 300, "--keyframes", 100,
                    "--match-id", 7, *options)
        return log


class Logs(Case):
    def test_the_tool_and_the_library_write_the_same_bytes(self):
        here, there = self.record(own(), "a.lks"), self.record(loaded(), "b.lks")
        self.assertEqual(here.read_bytes(), there.read_bytes())

    def test_carry_the_games_name_and_version(self):
        log = self.record(own(), "a.lks")
        header = json.loads(self.expect(OK, own(), "info", log, "--json").stdout)["header"]
        self.assertEqual((header["game"], header["game_version"]), ("rolling", "1.0"))
        self.assertIn("rolling 1.0", self.expect(OK, [LOCKSTONE], "info", log).stdout)

    def test_are_verified_by_both(self):
        log = self.record(own(), "a.lks")
        for command in (own(), loaded()):
            self.assertIn("same; 300 ticks verified", self.expect(OK, command, "verify", log).stdout)

    def test_of_a_foreign_game_are_refused_by_name(self):
        log = self.record(own(), "a.lks")
        line = "this log is of game 'rolling' 1.0; this tool knows arena, scenes; use --game"
        self.assertIn(line, self.expect(INCOMPATIBLE, [LOCKSTONE], "verify", log).stdout)
        for command in (["trace", log], ["seek", log, 10], ["cut", log, self.folder / "c.lks"],
                        ["bisect", log, log], ["hash", "--log", log]):
            self.assertIn(line, self.expect(INCOMPATIBLE, [LOCKSTONE], *command).stderr)
        arena = self.folder / "arena.lks"
        self.expect(OK, [LOCKSTONE], "record", arena, "--ticks", 10)
        done = self.expect(INCOMPATIBLE, own(), "verify", arena)
        self.assertIn("this log is of game 'arena' 0.1; this tool knows rolling", done.stdout)

    def test_that_differ_are_bisected_to_the_field(self):
        good = self.record(own(), "a.lks")
        wrong = self.record(own(), "b.lks", "--flip-bit-at", 200)
        # The tool knows the world, and finds the bit at its tick; the library shows only states, so the
        # field is that of the next keyframe.
        for command, state_at, field in ((own(), 201, "position.x"), (loaded(), 300, "position.x")):
            done = self.expect(DIFFERENT, command, "bisect", good, wrong, "--json")
            report = json.loads(done.stdout)
            self.assertEqual((report["tick"], report["store"], report["state_at"], report["field"]),
                             (200, "body", state_at, field))

    def test_are_traced_and_sought_alike(self):
        log = self.record(own(), "a.lks")
        for arguments in (["trace", log], ["trace", log, "--stages", 40], ["seek", log, 250, "--json"]):
            ours = self.expect(OK, own(), *arguments).stdout
            self.assertEqual(ours, self.expect(OK, loaded(), *arguments).stdout)
        self.assertIn('"rules"', self.expect(OK, own(), "trace", log, "--stages", 40).stdout)

    def test_are_cut_diffed_and_repaired(self):
        log = self.record(own(), "a.lks")
        cut = self.folder / "cut.lks"
        self.expect(OK, own(), "cut", log, cut, "--from", 50, "--to", 150)
        self.assertIn("100 ticks verified", self.expect(OK, loaded(), "verify", cut).stdout)
        self.expect(OK, own(), "diff", log, log)
        torn = self.folder / "torn.lks"
        torn.write_bytes(log.read_bytes()[:-200])
        repaired = self.folder / "repaired.lks"
        self.expect(OK, own(), "repair", torn, repaired)
        self.expect(OK, own(), "verify", "--strict", repaired)

    def test_a_damaged_one_is_corrupt(self):
        log = self.record(own(), "a.lks")
        bytes = bytearray(log.read_bytes())
        bytes[len(bytes) // 2] ^= 1
        log.write_bytes(bytes)
        self.expect(CORRUPT, own(), "verify", log)
        self.expect(CORRUPT, loaded(), "verify", log)


class Hashes(Case):
    def hash(self, command, log, name, *options):
        out = self.folder / f"{name}.json"
        self.expect(OK, command, "hash", "--log", log, "--json", "--name", name, "--out", out, *options)
        return out

    def test_of_a_log_are_equal_by_both(self):
        log = self.record(own(), "a.lks")
        files = [self.hash(own(), log, "own"), self.hash(loaded(), log, "loaded")]
        self.assertIn("all equal, 300 ticks", self.expect(OK, own(), "compare-hashes", *files).stdout)
        chain = json.loads(files[0].read_text())
        self.assertEqual([entry[0] for entry in chain["chain"]], list(range(1, 301)))
        self.assertEqual([entry["tick"] for entry in chain["parts"]], [64, 128, 192, 256, 300])
        self.assertEqual(set(chain["parts"][0]), {"tick", "jumps", "bodies", "contacts"})

    def test_and_states_are_not_replaced_without_force(self):
        log, states = self.record(own(), "a.lks"), self.folder / "x.states"
        self.hash(own(), log, "x", "--states", states)
        self.expect(UNAVAILABLE, own(), "hash", "--log", log, "--states", states)
        self.expect(OK, own(), "hash", "--log", log, "--states", states, "--force")

    def test_of_a_damaged_log_are_none(self):
        log = self.record(own(), "a.lks")
        log.write_bytes(log.read_bytes()[:-300])
        bytes = bytearray(log.read_bytes())
        bytes[len(bytes) * 3 // 4] ^= 1
        log.write_bytes(bytes)
        self.expect(CORRUPT, own(), "hash", "--log", log)

    def test_that_differ_are_grouped_and_located(self):
        log = self.record(own(), "a.lks")
        first = self.hash(own(), log, "x86", "--states", self.folder / "x86.states")
        second = self.hash(own(), log, "arm", "--states", self.folder / "arm.states")
        third = self.hash(own(), log, "odd", "--states", self.folder / "odd.states",
                          "--flip-bit-at", 200)
        done = self.expect(DIFFERENT, loaded(), "compare-hashes", first, third, second, "--json")
        report = json.loads(done.stdout)
        self.assertEqual([group["machines"] for group in report["groups"]], [["x86", "arm"], ["odd"]])
        self.assertEqual(report["part"], "bodies")
        self.assertEqual((report["tick"], report["store"], report["state_at"]), (200, "body", 256))
        self.assertEqual(report["equal_ticks"], 200)
        self.assertRegex(report["line"], r" in A, .* in B \(state at 256\)$")
        self.assertIn(f"{report['a']} in A, {report['b']} in B", report["line"])
        table = self.expect(DIFFERENT, own(), "compare-hashes", first, third, "--markdown").stdout
        self.assertIn("| odd |", table)
        self.assertRegex(table, r"tick 200, part bodies \(state at 256\), body \d+, \S+: .* in A, .* in B \(state at 256\)")

    def test_of_an_expected_machine_that_are_missing_are_an_error(self):
        log = self.record(own(), "a.lks")
        x86, arm = self.hash(own(), log, "x86"), self.hash(own(), log, "arm")
        self.expect(OK, own(), "compare-hashes", x86, arm, "--expect", "arm", "x86")
        done = self.expect(CORRUPT, own(), "compare-hashes", x86, arm, "--expect", "arm", "mac", "--json")
        self.assertIn("--expect mac: no file is of this machine", done.stderr)
        report = json.loads(done.stdout)
        self.assertEqual((report["same"], report["equal_ticks"], report["missing"]), (True, 300, ["mac"]))
        self.assertIn("--expect arm", self.expect(CORRUPT, own(), "compare-hashes", x86, "--expect", "arm").stderr)

    def test_of_other_matches_are_not_compared(self):
        files = [self.hash(own(), self.record(own(), f"{seed}.lks", "--seed", seed), f"m{seed}")
                 for seed in (1, 2)]
        self.assertIn("another match", self.expect(INCOMPATIBLE, own(), "compare-hashes", *files).stderr)

    def test_malformed_files_are_refused(self):
        good = self.hash(own(), self.record(own(), "a.lks"), "good")
        json_text = json.loads(good.read_text())
        bad = self.folder / "bad.json"
        for change in ({"chain": []}, {"chain": 7}, {"chain": [[1]]}, {"chain": [[2, "a"], [1, "b"]]},
                       {"chain": [["1", "a"]]}, {"parts": 3}, {"parts": [{}]}, {"parts": [[]]},
                       {"parts": [{"tick": 64, "bodies": 1}]}):
            bad.write_text(json.dumps({**json_text, **change}))
            self.expect(CORRUPT, own(), "compare-hashes", good, bad)
        bad.write_text("[")
        self.expect(CORRUPT, own(), "compare-hashes", good, bad)


class Game(Case):
    def test_flips_are_found(self):
        for command in (own(), loaded()):
            done = self.expect(OK, command, "flips", "--count", 60, "--ticks", 60, "--json")
            self.assertEqual(json.loads(done.stdout)["named"], 60)

    def test_saves_its_whole_state(self):
        for command in (own(), loaded()):
            self.expect(OK, command, "sync-test", "--ticks", 100, "--players", 4)
        self.expect(DIFFERENT, own(), "sync-test", "--forget", "body.velocity.x")

    def test_takes_configuration_bytes_from_a_file(self):
        config = self.folder / "config"
        config.write_bytes(b"\x05")
        log = self.folder / "five.lks"
        self.expect(OK, own(), "record", log, "--config", config, "--ticks", 20)
        self.assertIn("players       5", self.expect(OK, own(), "info", log).stdout)
        config.write_bytes(b"\xff")
        done = self.expect(USAGE, own(), "record", log, "--config", config, "--force")
        self.assertIn("refuses the configuration", done.stderr)

    def test_speaks_of_itself(self):
        self.assertIn("rolling 1.0", self.expect(OK, own(), "--version").stdout)
        self.assertTrue(self.expect(USAGE, own(), "verfy").stderr.startswith("rolling: unknown command"))
        self.assertIn("floor", self.expect(USAGE, own(), "record", "x.lks", "--scene", "none").stderr)


class BadLibraries(Case):
    def refuse(self, code, name, text):
        path = next(iter(pathlib.Path(BAD).glob(f"**/lib{name}.*"))) if name else "nowhere.so"
        done = self.expect(code, [LOCKSTONE, "--game", path], "scenes")
        self.assertIn(text, done.stderr)

    def test_of_another_abi_are_refused(self):
        self.refuse(INCOMPATIBLE, "future_game", "it is a game of ABI 2; this tool loads ABI 1")

    def test_without_functions_are_refused(self):
        self.refuse(INCOMPATIBLE, "empty_game", "lacks a required one")

    def test_that_are_no_games_are_refused(self):
        self.refuse(UNAVAILABLE, "no_game", "it exports no lockstone_game")

    def test_that_are_not_there_are_refused(self):
        self.refuse(UNAVAILABLE, "", "nowhere.so")


class Matches(Case):
    def setUp(self):
        super().setUp()
        if NETWORK != "network":
            self.skipTest("this build has no network")

    def serve(self, command, *options):
        log = self.folder / "match.lks"
        server = subprocess.Popen(
            [*command, "serve", "--insecure", "--fast", "--players", "2", "--ticks", "240", "--record",
             str(log), *options], stdout=subprocess.PIPE, text=True)
        self.addCleanup(server.stdout.close)
        self.addCleanup(server.wait)
        self.addCleanup(server.send_signal, signal.SIGTERM)
        port = re.search(r":(\d+)$", server.stdout.readline().strip())[1]
        return server, port, log

    def play(self, host, clients):
        """A match of two clients: its log."""
        server, port, log = self.serve(host)
        players = [subprocess.Popen([*command, "join", "--insecure", "--port", port, "--json",
                                     "--bot-seed", str(seed)], stdout=subprocess.PIPE, text=True)
                   for seed, command in enumerate(clients)]
        results = [json.loads(player.communicate(timeout=60)[0]) for player in players]
        said = server.communicate(timeout=60)[0]
        self.assertEqual([player.returncode for player in players] + [server.returncode], [0, 0, 0])
        self.assertEqual(len({result["final_hash"] for result in results}), 1)
        self.assertRegex(said, r"player 0 \"bot\": (\d+) of \1 hashes equal")
        self.assertRegex(said, r"player 1 \"bot\": (\d+) of \1 hashes equal")
        return log

    def test_are_played_by_native_clients_with_equal_hashes(self):
        log = self.play(own(), (own(), loaded()))
        for command in (own(), loaded()):
            self.expect(OK, command, "verify", "--strict", log)
            self.expect(OK, command, "bisect", log, log)

    def test_of_a_game_in_c_are_played_with_equal_hashes(self):
        if IN_C == "none":
            self.skipTest("this build has no C library")
        pushers, tool = [LOCKSTONE, "--game", IN_C], [TOOL_IN_C]
        log = self.play(tool, (pushers, tool))
        for command in (pushers, tool):
            done = self.expect(OK, command, "verify", "--strict", log)
            self.assertIn("same; 240 ticks verified", done.stdout)
            self.expect(OK, command, "bisect", log, log)
        self.assertIn("game 'pushers' 0.1", self.expect(INCOMPATIBLE, own(), "verify", log).stdout)
        self.expect(OK, tool, "sync-test", "--ticks", 60)
        self.expect(OK, pushers, "flips", "--count", 20, "--ticks", 30)
        self.expect(OK, tool, "simnet", "--seeds", 1, "--ticks", 300, "--players", 3)

    def test_served_by_the_c_interface_are_played_by_the_tools(self):
        if IN_C == "none":
            self.skipTest("this build has no C library")
        play, pushers = [str(pathlib.Path(TOOL_IN_C).with_name("pushers_play"))], [LOCKSTONE, "--game", IN_C]
        log = self.folder / "match.lks"
        server = subprocess.Popen([*play, "serve", "2", "240", log], stdout=subprocess.PIPE, text=True)
        self.addCleanup(server.stdout.close)
        self.addCleanup(server.wait)
        self.addCleanup(server.kill)
        port = server.stdout.readline().split()[1]
        player = subprocess.Popen([*play, "join", port], stdout=subprocess.PIPE, text=True)
        result = json.loads(self.expect(OK, pushers, "join", "--insecure", "--port", port, "--json").stdout)
        ticks = player.communicate(timeout=60)[0]
        self.assertEqual(server.communicate(timeout=60)[0], ticks)
        self.assertEqual((player.returncode, server.returncode), (0, 0))
        self.assertEqual(ticks.splitlines()[-1], f"239 {result['final_hash'].removeprefix('0x')}")
        self.assertIn("same; 240 ticks verified", self.expect(OK, pushers, "verify", "--strict", log).stdout)

    def test_survive_bad_networks(self):
        for command in (own(), loaded()):
            done = self.expect(OK, command, "simnet", "--seeds", 2, "--ticks", 300, "--players", 3)
            self.assertIn("all as it must be", done.stdout)


if __name__ == "__main__":
    ROLLING, LOCKSTONE, LIBRARY, BAD, NETWORK, IN_C, TOOL_IN_C = sys.argv[1:8]
    unittest.main(argv=sys.argv[:1])
