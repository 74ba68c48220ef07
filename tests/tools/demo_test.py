"""The lockstone command over the loopback network: demo, serve and join.

usage: demo_test.py LOCKSTONE
"""

import json
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import time
import unittest

LOCKSTONE = ""


class Network(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.temporary.name)
        self.addCleanup(self.temporary.cleanup)

    def start(self, *arguments):
        process = subprocess.Popen([LOCKSTONE, *map(str, arguments)], cwd=self.folder, text=True,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.addCleanup(self.end, process)
        return process

    @staticmethod
    def end(process):
        if process.poll() is None:
            process.kill()
        process.communicate()

    def expect(self, code, process):
        out, err = process.communicate(timeout=120)
        self.assertEqual(process.returncode, code, out + err)
        return out

    def verify(self, name):
        done = subprocess.run([LOCKSTONE, "verify", "--strict", "--json", self.folder / name],
                              capture_output=True, text=True, timeout=120)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return json.loads(done.stdout)[0]

    def test_a_demo_plays_and_verifies(self):
        out = self.expect(0, self.start("demo", "--fast", "--players", 3, "--ticks", 240,
                                        "--bodies", 60))
        self.assertRegex(out, r"hashes +720 compared, 720 equal, 0 different")
        self.assertRegex(out, r"verify +same")
        self.assertEqual(self.verify("demo.lks")["ticks_verified"], 240)
        self.assertTrue((self.folder / "demo.svg").read_text().endswith("</svg>\n"))

    def test_a_demo_finds_one_wrong_bit(self):
        out = self.expect(1, self.start("demo", "--fast", "--players", 3, "--ticks", 240,
                                        "--bodies", 30, "--flip-bit-at", 77))
        self.assertRegex(out, r'desync: tick 77, player 2, body \d+ "[a-z]+ \d+", velocity\.y: '
                              r"0x[0-9a-f]+ here, 0x[0-9a-f]+ there")

    def test_an_interrupted_demo_leaves_a_good_log(self):
        demo = self.start("demo", "--players", 2, "--ticks", 100000, "--bodies", 20)
        for line in demo.stdout:
            if "begins" in line:
                break
        time.sleep(1)
        demo.send_signal(signal.SIGINT)
        out = self.expect(0, demo)
        self.assertIn("stopped", out)
        self.assertGreater(self.verify("demo.lks")["ticks_verified"], 20)

    def serve(self, *arguments):
        server = self.start("serve", "--insecure", *arguments)
        port = re.search(r":(\d+)", server.stdout.readline())[1]
        return server, port

    def test_serve_and_join_agree(self):
        server, port = self.serve("--players", 2, "--ticks", 200, "--fast", "--record", "match.lks",
                                  "--bodies", 40, "--policy", "strict")
        players = [self.start("join", "--insecure", "--port", port, "--bot-seed", seed, "--json")
                   for seed in (5, 6)]
        answers = [json.loads(self.expect(0, player)) for player in players]
        out = self.expect(0, server)
        final_hash = re.search(r"final hash ([0-9a-f]{16})", out)[1]
        self.assertEqual([answer["final_hash"] for answer in answers], [final_hash] * 2)
        self.assertEqual(self.verify("match.lks")["final_hash"], final_hash)

    def test_a_scene_without_players_can_be_served(self):
        server, port = self.serve("--scene", "pile", "--players", 1, "--ticks", 60, "--fast")
        self.expect(0, self.start("join", "--insecure", "--port", port))
        self.expect(0, server)

    def test_a_terminated_server_finishes_its_log(self):
        server, port = self.serve("--players", 1, "--ticks", 0, "--record", "match.lks",
                                  "--bodies", 10)
        player = self.start("join", "--insecure", "--port", port)
        time.sleep(1)
        server.terminate()
        self.expect(0, server)
        self.expect(0, player)
        self.verify("match.lks")

    def run_command(self, code, *arguments):
        done = subprocess.run([LOCKSTONE, *map(str, arguments)], cwd=self.folder, text=True,
                              capture_output=True, timeout=120)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done.stdout + done.stderr

    def issue(self, name, slot, *more, match=5):
        self.run_command(0, "token", "issue", "--key", "key", "--match", match, "--slot", slot,
                         "--player", 70 + slot, "--out", name, *more)

    def serve_for_tokens(self, *arguments):
        self.run_command(0, "token", "key", "key")
        server = self.start("serve", "--key", "key", "--match", 5, *arguments)
        return server, re.search(r":(\d+)", server.stdout.readline())[1]

    def test_tokens_let_their_players_in_and_nobody_else(self):
        server, port = self.serve_for_tokens("--players", 2, "--ticks", 120, "--fast", "--bodies", 20)
        self.issue("late", 0, "--minutes", 0)
        self.assertIn("token expired", self.run_command(
            69, "join", "--port", port, "--token", "late"))
        self.assertIn("insecure not allowed", self.run_command(
            69, "join", "--port", port, "--insecure"))
        self.issue("first", 0, "--server", f"127.0.0.1:{port}")
        self.issue("second", 1)
        self.assertIn("token of another slot", self.run_command(
            69, "join", "--port", port, "--token", "second", "--slot", 0))
        players = [self.start("join", "--token", "first", "--json"),
                   self.start("join", "--token", "second", "--port", port, "--json")]
        answers = [json.loads(self.expect(0, player)) for player in players]
        self.assertEqual([answer["slot"] for answer in answers], [0, 1])
        final_hash = re.search(r"final hash ([0-9a-f]{16})", self.expect(0, server))[1]
        self.assertEqual([answer["final_hash"] for answer in answers], [final_hash] * 2)

    def test_tokens_can_be_looked_at(self):
        self.run_command(0, "token", "key", "key")
        self.run_command(69, "token", "key", "key")  # not overwritten
        self.run_command(0, "token", "key", "other")
        self.issue("token", 3, "--server", "10.0.0.1:7777")
        self.assertEqual((self.folder / "token").stat().st_mode & 0o777, 0o600)
        out = self.run_command(0, "token", "show", "token", "--key", "key")
        self.assertRegex(out, r"match +5\nplayer +73\nslot +3\n")
        self.assertRegex(out, r"server +10\.0\.0\.1:7777\nseal +good")
        self.assertIn("not of this key", self.run_command(
            1, "token", "show", "token", "--key", "other"))
        text = (self.folder / "token").read_text()
        (self.folder / "token").write_text("00" + text[2:])
        self.run_command(2, "token", "show", "token")

    def test_a_stopped_player_slows_nobody_and_comes_back(self):
        server, port = self.serve_for_tokens("--players", 2, "--ticks", 240, "--bodies", 20)
        relay = self.start("lossy", "--to", port, "--loss", 5, "--burst", 4, "--delay", 10,
                           "--jitter", 5, "--seed", 3)
        near = re.search(r":(\d+)", relay.stdout.readline())[1]
        players = []
        for slot in (0, 1):
            self.issue(f"token{slot}", slot)
            players.append(self.start("join", "--port", near, "--token", f"token{slot}", "--json"))
        for line in server.stdout:
            if "begins" in line:
                break
        begun = time.monotonic()
        time.sleep(1)
        players[1].send_signal(signal.SIGSTOP)
        time.sleep(1.5)
        players[1].send_signal(signal.SIGCONT)
        answers = [json.loads(self.expect(0, player)) for player in players]
        self.assertLess(time.monotonic() - begun, 8)  # of 4 s of play
        out = self.expect(0, server)
        final_hash = re.search(r"final hash ([0-9a-f]{16})", out)[1]
        self.assertEqual([answer["final_hash"] for answer in answers], [final_hash] * 2)
        self.assertLess(answers[0]["substituted_inputs"], 60)
        self.assertGreater(answers[1]["substituted_inputs"], 60)
        relay.terminate()
        self.assertRegex(self.expect(0, relay), r"relayed: \d+ datagrams, .* [1-9]\d* lost")

    def test_insecure_must_be_asked_for(self):
        self.expect(64, self.start("serve", "--players", 1))
        self.expect(64, self.start("join", "--port", 9))


if __name__ == "__main__":
    LOCKSTONE = str(pathlib.Path(sys.argv[1]).resolve())
    unittest.main(argv=sys.argv[:1], verbosity=2)
