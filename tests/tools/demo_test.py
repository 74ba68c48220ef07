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

    def test_insecure_must_be_asked_for(self):
        self.expect(64, self.start("serve", "--players", 1))
        self.expect(64, self.start("join", "--port", 9))


if __name__ == "__main__":
    LOCKSTONE = str(pathlib.Path(sys.argv[1]).resolve())
    unittest.main(argv=sys.argv[:1], verbosity=2)
