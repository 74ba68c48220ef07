"""The lockstone command over the loopback network: demo, serve and join.

usage: demo_test.py LOCKSTONE

Nothing here depends on how fast the machine is: the tests wait for the traces of slow work, the
lines that a server prints and the ticks in its log.
"""

import json
import pathlib
import re
import socket
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest

LOCKSTONE = ""
PATIENCE_SECONDS = 120


def has_ipv6():
    """Whether ::1 can be bound."""
    try:
        with socket.socket(socket.AF_INET6, socket.SOCK_DGRAM) as probe:
            probe.bind(("::1", 0))
        return True
    except OSError:
        return False


class Network(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.temporary.name)
        self.addCleanup(self.temporary.cleanup)

    def start(self, *arguments):
        errors = tempfile.TemporaryFile("w+", dir=self.folder)
        self.addCleanup(errors.close)
        process = subprocess.Popen([LOCKSTONE, *map(str, arguments)], cwd=self.folder, text=True,
                                   stdout=subprocess.PIPE, stderr=errors)
        process.errors = errors
        watchdog = threading.Timer(2 * PATIENCE_SECONDS, process.kill)
        watchdog.start()
        self.addCleanup(watchdog.cancel)
        self.addCleanup(self.end, process)
        return process

    @staticmethod
    def end(process):
        if process.poll() is None:
            process.kill()
        process.stdout.close()
        process.wait()

    def expect(self, code, process):
        out = process.stdout.read()
        process.wait()
        process.errors.seek(0)
        self.assertEqual(process.returncode, code, out + process.errors.read())
        return out

    def read_until(self, text, process):
        for line in process.stdout:
            if text in line:
                return line
        self.fail(f"no line with {text}: {self.expect(0, process)}")

    def ticks_in(self, name):
        done = subprocess.run([LOCKSTONE, "info", "--json", self.folder / name],
                              capture_output=True, text=True, timeout=PATIENCE_SECONDS)
        return json.loads(done.stdout)["ticks"] if done.returncode == 0 else 0

    def wait_for_ticks(self, count, name):
        """Of a match that is being recorded."""
        end = time.monotonic() + PATIENCE_SECONDS
        while (ticks := self.ticks_in(name)) < count:
            self.assertLess(time.monotonic(), end, f"{ticks} of {count} ticks")
            time.sleep(0.1)
        return ticks

    def verify(self, name):
        done = subprocess.run([LOCKSTONE, "verify", "--strict", "--json", self.folder / name],
                              capture_output=True, text=True, timeout=PATIENCE_SECONDS)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return json.loads(done.stdout)[0]

    def test_a_demo_plays_and_verifies(self):
        out = self.expect(0, self.start("demo", "--fast", "--players", 3, "--ticks", 240,
                                        "--bodies", 60))
        self.assertRegex(out, r"hashes +720 compared, 720 equal, 0 different")
        self.assertRegex(out, r"verify +same")
        self.assertEqual(self.verify("demo.lks")["ticks_verified"], 240)
        self.assertTrue((self.folder / "demo.svg").read_text().endswith("</svg>\n"))

    def test_a_demo_plays_for_fifteen_seconds_unless_told(self):
        self.assertRegex(self.expect(0, self.start("demo", "--help")), r"--ticks UINT=900\b")

    def test_a_demo_finds_one_wrong_bit(self):
        out = self.expect(1, self.start("demo", "--fast", "--players", 3, "--ticks", 240,
                                        "--bodies", 30, "--flip-bit-at", 77))
        self.assertRegex(out, r'desync: tick 77, player 2 "bot 2", body \d+ "[a-z]+ \d+", position\.x: '
                              r"0x[0-9a-f]+ \(\S+ m\) here, 0x[0-9a-f]+ \(\S+ m\) there")

    def test_an_interrupted_demo_leaves_a_good_log(self):
        demo = self.start("demo", "--players", 2, "--ticks", 100000, "--bodies", 20)
        self.read_until("begins", demo)
        self.wait_for_ticks(21, "demo.lks")
        demo.send_signal(signal.SIGINT)
        out = self.expect(0, demo)
        self.assertIn("stopped", out)
        self.assertGreater(self.verify("demo.lks")["ticks_verified"], 20)

    def serve(self, *arguments):
        server = self.start("serve", "--insecure", *arguments)
        return server, re.search(r":(\d+)", self.read_until("listening", server))[1]

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

    def test_a_server_signs_its_log(self):
        if subprocess.run([LOCKSTONE, "keygen", self.folder / "key"], capture_output=True).returncode != 0:
            self.skipTest("built without libsodium")
        self.run_command(64, "serve", "--insecure", "--sign", "key")
        server, port = self.serve("--players", 1, "--ticks", 60, "--fast", "--record", "match.lks",
                                  "--bodies", 10, "--sign", "key")
        self.expect(0, self.start("join", "--insecure", "--port", port))
        self.expect(0, server)
        self.run_command(0, "verify", "match.lks", "--key", "key.pub")

    def test_a_scene_without_players_can_be_served(self):
        server, port = self.serve("--scene", "pile", "--players", 1, "--ticks", 60, "--fast")
        self.expect(0, self.start("join", "--insecure", "--port", port))
        self.expect(0, server)

    def test_a_terminated_server_finishes_its_log(self):
        server, port = self.serve("--players", 1, "--ticks", 0, "--record", "match.lks",
                                  "--bodies", 10)
        player = self.start("join", "--insecure", "--port", port)
        self.wait_for_ticks(1, "match.lks")
        server.terminate()
        self.expect(0, server)
        self.expect(0, player)
        self.verify("match.lks")

    def run_command(self, code, *arguments):
        done = subprocess.run([LOCKSTONE, *map(str, arguments)], cwd=self.folder, text=True,
                              capture_output=True, timeout=PATIENCE_SECONDS)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done.stdout + done.stderr

    def issue(self, name, slot, *more, match=5):
        self.run_command(0, "token", "issue", "--key", "key", "--match", match, "--slot", slot,
                         "--player", 70 + slot, "--out", name, *more)

    def serve_for_tokens(self, *arguments):
        self.run_command(0, "token", "key", "key")
        server = self.start("serve", "--key", "key", "--match", 5, *arguments)
        return server, re.search(r":(\d+)", self.read_until("listening", server))[1]

    def test_tokens_let_their_players_in_and_nobody_else(self):
        server, port = self.serve_for_tokens("--players", 2, "--ticks", 120, "--fast", "--bodies", 20)
        self.issue("late", 0, "--minutes", 0)
        self.assertIn("token expired", self.run_command(
            69, "join", "--port", port, "--token", "late"))
        self.assertIn("insecure not allowed", self.run_command(
            69, "join", "--port", port, "--insecure"))
        self.issue("elsewhere", 0, match=6)
        self.assertIn("token of another match", self.run_command(
            69, "join", "--port", port, "--token", "elsewhere"))
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

    @unittest.skipUnless(has_ipv6(), "no address ::1: this machine has no IPv6")
    def test_an_address_to_listen_at_may_have_brackets(self):
        server = self.start("serve", "--bind", "[::1]", "--insecure")
        self.assertIn("listening on [::1]:", self.read_until("listening", server))

    def test_a_server_can_be_named_and_called_over_ipv6(self):
        bind, calls = ("::", ["localhost", "[::1]"]) if has_ipv6() else ("0.0.0.0", ["localhost", "127.0.0.1"])
        server = self.start("serve", "--bind", bind, "--players", 2, "--ticks", 60, "--fast",
                            "--bodies", 20, "--insecure")
        line = self.read_until("listening", server)
        self.assertIn("listening on [::]:" if has_ipv6() else "listening on 0.0.0.0:", line)
        port = re.search(r":(\d+)\s*$", line)[1]
        players = [self.start("join", "--server", f"{host}:{port}", "--insecure", "--json")
                   for host in calls]
        hashes = {json.loads(self.expect(0, player))["final_hash"] for player in players}
        self.assertEqual(hashes, {re.search(r"final hash ([0-9a-f]{16})", self.expect(0, server))[1]})

    def test_the_servers_of_a_token_are_tried_in_turn(self):
        server, port = self.serve_for_tokens("--players", 1, "--ticks", 60, "--fast", "--bodies", 20)
        self.issue("token", 0, "--server", "127.0.0.1:9", "--server", f"localhost:{port}")
        self.assertIn(f"server   127.0.0.1:{port}", self.run_command(0, "token", "show", "token"))
        player = self.run_command(0, "join", "--token", "token")
        self.assertIn(f"calling 127.0.0.1:{port}", player)
        self.assertIn("the match is over", player)
        self.expect(0, server)

    def test_what_is_no_server_is_refused(self):
        for server in ["::1:7", "[::1]", "localhost", "localhost:0", "a b:7"]:
            self.assertIn("is no server like", self.run_command(
                64, "join", "--insecure", "--server", server))
        self.assertIn("not a numeric address", self.run_command(
            69, "serve", "--insecure", "--bind", "localhost"))

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
        server, port = self.serve_for_tokens("--players", 2, "--ticks", 0, "--bodies", 20,
                                             "--record", "match.lks")
        relay = self.start("lossy", "--to", port, "--loss", 5, "--burst", 4, "--delay", 10,
                           "--jitter", 5, "--seed", 3)
        near = re.search(r":(\d+)", self.read_until("listening", relay))[1]
        players = []
        for slot in (0, 1):
            self.issue(f"token{slot}", slot)
            players.append(self.start("join", "--port", near, "--token", f"token{slot}", "--json"))
        ticks = self.wait_for_ticks(30, "match.lks")
        players[1].send_signal(signal.SIGSTOP)
        ticks = self.wait_for_ticks(ticks + 90, "match.lks")  # the match goes on without it
        players[1].send_signal(signal.SIGCONT)
        self.wait_for_ticks(ticks + 120, "match.lks")
        server.terminate()
        answers = [json.loads(self.expect(0, player)) for player in players]
        out = self.expect(0, server)
        final_hash = re.search(r"final hash ([0-9a-f]{16})", out)[1]
        self.assertEqual([answer["final_hash"] for answer in answers], [final_hash] * 2)
        absent = answers[1]["substituted_inputs"] + 60 * answers[1]["reconnects"]
        self.assertGreaterEqual(absent, 60)
        self.assertLess(answers[0]["substituted_inputs"], absent)
        self.verify("match.lks")
        relay.terminate()
        self.assertRegex(self.expect(0, relay), r"relayed: \d+ datagrams, .* [1-9]\d* lost")

    def test_names_and_chat_are_shown_and_logged(self):
        server, port = self.serve("--players", 2, "--ticks", 120, "--bodies", 20, "--record", "match.lks")
        players = [self.start("join", "--insecure", "--port", port, "--slot", slot, "--name", name, "--say", "hello")
                   for slot, name in ((0, "Zo\u00eb"), (1, "Ben"))]
        for player in players:
            self.expect(0, player)
        out = self.expect(0, server)
        self.assertIn('player 0 "Zo\u00eb": hello\n', out)
        self.assertIn('player 1 "Ben": hello\n', out)
        players[0].errors.seek(0)
        heard = players[0].errors.read()
        self.assertIn("player 1 is Ben\n", heard)
        self.assertIn("player 1: hello\n", heard)
        self.verify("match.lks")
        done = subprocess.run([LOCKSTONE, "info", "--json", self.folder / "match.lks"], capture_output=True, text=True,
                              timeout=PATIENCE_SECONDS)
        info = json.loads(done.stdout)
        self.assertEqual((info["player_names"], info["commands"]), (["Zo\u00eb", "Ben"], 2))

    def test_a_player_that_was_dropped_calls_again_by_itself(self):
        server, port = self.serve("--players", 2, "--ticks", 0, "--bodies", 20,
                                  "--record", "match.lks", "--drop-after", 2)
        players = [self.start("join", "--insecure", "--port", port, "--slot", slot, "--json")
                   for slot in (0, 1)]
        self.read_until("begins", server)
        players[1].send_signal(signal.SIGSTOP)
        self.read_until('player 1 "bot" left: timed out', server)
        players[1].send_signal(signal.SIGCONT)
        self.read_until('player 1 "bot" plays from tick', server)
        self.wait_for_ticks(self.ticks_in("match.lks") + 60, "match.lks")
        server.terminate()
        answers = [json.loads(self.expect(0, player)) for player in players]
        final_hash = re.search(r"final hash ([0-9a-f]{16})", self.expect(0, server))[1]
        self.assertEqual([answer["final_hash"] for answer in answers], [final_hash] * 2)
        self.assertEqual([answer["slot"] for answer in answers], [0, 1])
        self.assertGreaterEqual(answers[1]["reconnects"], 1)

    def test_killed_processes_leave_a_log_that_verifies(self):
        server, port = self.serve("--players", 2, "--ticks", 0, "--bodies", 20,
                                  "--record", "match.lks")
        players = [self.start("join", "--insecure", "--port", port) for _ in range(2)]
        ticks = self.wait_for_ticks(30, "match.lks")
        players[0].kill()
        ticks = self.wait_for_ticks(ticks + 90, "match.lks")
        server.kill()
        server.wait()
        done = subprocess.run([LOCKSTONE, "verify", "--json", self.folder / "match.lks"],
                              capture_output=True, text=True, timeout=PATIENCE_SECONDS)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertGreaterEqual(json.loads(done.stdout)[0]["ticks_verified"], ticks)

    def test_a_killed_server_goes_on_from_its_log(self):
        options = ["--players", 2, "--ticks", 400, "--bodies", 10]
        server, port = self.serve(*options, "--record", "match.lks")
        players = [self.start("join", "--insecure", "--port", port, "--slot", slot, "--json")
                   for slot in (0, 1)]
        self.wait_for_ticks(60, "match.lks")
        server.kill()
        server.wait()
        again, _ = self.serve("--ticks", 400, "--port", port, "--resume", "match.lks")
        answers = [json.loads(self.expect(0, player)) for player in players]
        out = self.expect(0, again)
        final_hash = re.search(r"completed, 400 ticks, final hash ([0-9a-f]{16})", out)[1]
        self.assertEqual([answer["final_hash"] for answer in answers], [final_hash] * 2)
        self.assertEqual([answer["slot"] for answer in answers], [0, 1])
        done = self.verify("match.lks")
        self.assertEqual((done["ticks_verified"], done["final_hash"]), (400, final_hash))
        out = self.run_command(69, "serve", "--insecure", "--resume", "match.lks")
        self.assertIn("its match is over", out)

    def test_ports_that_do_not_exist_are_refused_before_anything_starts(self):
        for option in ("--port", "--metrics-port"):
            out = self.run_command(64, "serve", "--insecure", "--matches", 3, option, 65534)
            self.assertIn("none above 65535", out)
            self.assertNotIn("listening", out)

    def test_insecure_must_be_asked_for(self):
        self.expect(64, self.start("serve", "--players", 1))
        self.expect(64, self.start("join", "--port", 9))

    def test_a_key_or_token_that_cannot_be_read_is_bad_input(self):
        made = self.start("token", "key", "backend.key")
        code = 2 if made.wait() == 0 else 69  # built without libsodium
        self.expect(code, self.start("serve", "--key", "missing", "--match", 1))
        self.expect(code, self.start("join", "--token", "missing"))


if __name__ == "__main__":
    LOCKSTONE = str(pathlib.Path(sys.argv[1]).resolve())
    unittest.main(argv=sys.argv[:1], verbosity=2)
