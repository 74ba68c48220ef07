"""`lockstone serve --rooms`: many matches on one port; and the calls to Agones' sidecar.

usage: rooms_test.py LOCKSTONE
"""

import http.server
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest

from http_requests import ask

LOCKSTONE = sys.argv.pop(1)


class Sidecar:
    """Stands in for Agones' sidecar: notes the calls of a game server, and that they are well formed."""

    def __init__(self, port=0):
        calls = self.calls = []

        class Handler(http.server.BaseHTTPRequestHandler):
            def do_POST(self):
                body = self.rfile.read(int(self.headers["Content-Length"]))
                good = body == b"{}" and self.headers["Content-Type"] == "application/json"
                calls.append(self.path if good else f"malformed {self.path}")
                self.send_response(200)
                self.end_headers()
                self.wfile.write(b"{}")

            def log_message(self, *_):
                pass

        self.server = http.server.ThreadingHTTPServer(("127.0.0.1", port), Handler)
        self.port = self.server.server_address[1]
        self.thread = threading.Thread(target=self.server.serve_forever)
        self.thread.start()

    def close(self):
        self.server.shutdown()
        self.server.server_close()
        self.thread.join()

    def orders(self):
        return [call for call in self.calls if call != "/health"]


class Serving(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()) if hasattr(self, "enterContext")
                                   else tempfile.mkdtemp())
        self.key = self.folder / "key"
        subprocess.run([LOCKSTONE, "token", "key", self.key], check=True, stdout=subprocess.DEVNULL)

    def start(self, *options, env=None):
        """A server whose metrics port is tried until one is free; its port and that of its metrics."""
        for metrics in range(20000 + time.time_ns() % 20000, 65000, 97):
            server = subprocess.Popen(
                [LOCKSTONE, "serve", "--players", "1", "--metrics-port", str(metrics), "--log-format", "json", *map(str, options)],
                stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env={**os.environ, **(env or {})})
            lines = []
            while line := server.stdout.readline():
                lines.append(json.loads(line))
                if lines[-1]["event"] == "listening":
                    break
            if line:
                break
            complaint = server.communicate()[1]
            self.assertIn("no metrics", complaint)
        for pipe in (server.stdout, server.stderr):
            self.addCleanup(pipe.close)
        self.addCleanup(server.wait)
        self.addCleanup(server.kill)
        return server, lines[-1]["match"], metrics

    def join(self, port, match, slot=0):
        token = self.folder / f"token{match}.{time.time_ns()}"
        subprocess.run([LOCKSTONE, "token", "issue", "--key", self.key, "--match", str(match), "--slot", str(slot), "--out", token],
                       check=True, stdout=subprocess.DEVNULL)
        player = subprocess.Popen([LOCKSTONE, "join", "--token", token, "--port", str(port), "--quiet"],
                                  stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        for pipe in (player.stdout, player.stderr):
            self.addCleanup(pipe.close)
        self.addCleanup(player.wait)
        self.addCleanup(player.kill)
        return player

    def await_stats(self, metrics, done):
        for _ in range(1000):
            stats = json.loads(ask(metrics, "/stats.json")[1])
            if done(stats):
                return stats
            time.sleep(0.02)
        self.fail(f"this never comes: {stats}")

    def events(self, server):
        printed, complaints = server.communicate(timeout=60)
        self.assertEqual(complaints, "")
        return list(map(json.loads, printed.splitlines()))


class Rooms(Serving):
    def rooms(self, *options):
        return self.start("--key", self.key, "--rooms", 2, "--workers", 2, *options)

    def test_a_match_that_ends_makes_place_for_the_next(self):
        log = self.folder / "log"
        server, port, metrics = self.rooms("--match", 5, "--matches", 3, "--ticks", 120, "--record", log)
        stats = self.await_stats(metrics, lambda stats: len(stats["matches"]) == 2)
        self.assertEqual(sorted(match["match"] for match in stats["matches"]), [5, 6])
        players = [self.join(port, match) for match in (5, 6)]
        stats = self.await_stats(metrics, lambda stats: stats["matches_running"] == 2)
        prometheus = ask(metrics, "/metrics")[1]
        self.assertIn("lockstone_host_matches_running 2\n", prometheus)
        self.assertIn('lockstone_ticks{match="5"} ', prometheus)
        self.assertIn('lockstone_ticks{match="6"} ', prometheus)
        self.assertEqual(ask(metrics, "/livez"), (200, "ok\n"))
        self.assertEqual([player.wait(timeout=60) for player in players], [0, 0])
        stats = self.await_stats(metrics, lambda stats: stats["matches_ended"] == 2)
        self.assertEqual(stats["sum"]["ticks"], 240)
        self.assertEqual(stats["sum"]["handshakes_completed"], 2)
        self.assertGreater(stats["sum"]["player_bytes_sent"], 1000)
        self.await_stats(metrics, lambda stats: [match["match"] for match in stats["matches"]] == [7])
        self.assertEqual(self.join(port, 7).wait(timeout=60), 0)
        events = self.events(server)
        self.assertEqual(server.returncode, 0)
        over = {event["match"]: event["tick"] for event in events if event["event"] == "match_over"}
        self.assertEqual(over, {5: 120, 6: 120, 7: 120})
        for match in over:
            subprocess.run([LOCKSTONE, "verify", f"{log}.{match}"], check=True, stdout=subprocess.DEVNULL)

    def test_a_token_of_another_match_is_refused(self):
        server, port, _ = self.rooms("--match", 5)
        stranger = self.join(port, 99)
        self.assertNotEqual(stranger.wait(timeout=60), 0)
        self.assertIn("match", stranger.stderr.read())
        server.send_signal(signal.SIGINT)
        self.events(server)

    def test_a_drained_server_plays_on_and_opens_no_more(self):
        server, port, metrics = self.rooms("--match", 1, "--drain", "--ticks", 150)
        player = self.join(port, 1)
        self.await_stats(metrics, lambda stats: stats["matches_running"] == 1)
        self.assertEqual(ask(metrics, "/readyz"), (200, "open\n"))
        server.send_signal(signal.SIGTERM)
        self.await_stats(metrics, lambda stats: not stats["ready"])
        self.assertEqual(ask(metrics, "/readyz"), (503, "draining\n"))
        events = self.events(server)
        self.assertEqual((server.returncode, player.wait(timeout=60)), (0, 0))
        over = {event["match"]: event["tick"] for event in events if event["event"] == "match_over"}
        self.assertEqual(over, {1: 150, 2: 0})

    def test_rooms_need_tokens(self):
        tried = subprocess.run([LOCKSTONE, "serve", "--rooms", "2", "--insecure"], capture_output=True, text=True)
        self.assertEqual(tried.returncode, 64)
        self.assertIn("--rooms needs --key", tried.stderr)


class Agones(Serving):
    def sidecar(self, port=0):
        sidecar = Sidecar(port)
        self.addCleanup(sidecar.close)
        return sidecar, {"AGONES_SDK_HTTP_PORT": str(sidecar.port)}

    def test_a_match_is_ready_healthy_allocated_and_over(self):
        sidecar, env = self.sidecar()
        server, port, _ = self.start("--key", self.key, "--ticks", 240, "--agones", env=env)
        for _ in range(500):
            if "/health" in sidecar.calls:
                break
            time.sleep(0.02)
        self.assertEqual(sidecar.calls[:2], ["/ready", "/health"])
        self.assertEqual(self.join(port, 0).wait(timeout=60), 0)
        self.events(server)
        self.assertEqual(sidecar.orders(), ["/ready", "/allocate", "/shutdown"])
        self.assertEqual(sidecar.calls[-1], "/shutdown")
        self.assertGreaterEqual(sidecar.calls.count("/health"), 2)

    def test_rooms_are_ready_again_after_the_last_match(self):
        sidecar, env = self.sidecar()
        server, port, metrics = self.start("--key", self.key, "--rooms", 2, "--match", 1, "--ticks", 60, "--drain", "--agones", env=env)
        for match in (1, 2):
            self.assertEqual(self.join(port, match).wait(timeout=60), 0)
            self.await_stats(metrics, lambda stats: stats["matches_ended"] == match)
        server.send_signal(signal.SIGTERM)
        self.events(server)
        self.assertEqual(sidecar.orders(), ["/ready", "/allocate", "/ready", "/allocate", "/ready", "/shutdown"])

    def test_a_sidecar_may_come_later(self):
        sidecar, env = self.sidecar()
        sidecar.close()
        server, _, _ = self.start("--key", self.key, "--agones", "--drain", env=env)
        time.sleep(0.3)
        late, _ = self.sidecar(sidecar.port)
        for _ in range(500):
            if late.calls:
                break
            time.sleep(0.02)
        server.send_signal(signal.SIGTERM)
        _, complaints = server.communicate(timeout=60)
        self.assertIn("sidecar", complaints)
        self.assertEqual(late.orders(), ["/ready", "/shutdown"])

    def test_a_port_that_is_none_is_refused(self):
        tried = subprocess.run([LOCKSTONE, "serve", "--insecure", "--agones"], capture_output=True, text=True,
                               env={**os.environ, "AGONES_SDK_HTTP_PORT": "no port"})
        self.assertEqual(tried.returncode, 64)
        self.assertIn("it must be 1 … 65535", tried.stderr)


if __name__ == "__main__":
    unittest.main()
