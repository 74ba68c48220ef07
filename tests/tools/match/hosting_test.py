"""`lockstone serve` as a service: readiness and liveness, the end on SIGTERM, lines in JSON.

usage: hosting_test.py LOCKSTONE
"""

import json
import signal
import subprocess
import sys
import time
import unittest

from http_requests import ask

LOCKSTONE = sys.argv.pop(1)


class Hosting(unittest.TestCase):
    def serve(self, *options):
        """A server of one player; its port and that of its metrics, which is tried until one is free."""
        for metrics in range(20000 + time.time_ns() % 20000, 65000, 97):
            server = subprocess.Popen(
                [LOCKSTONE, "serve", "--insecure", "--players", "1", "--metrics-port", str(metrics), "--log-format", "json",
                 *options], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
            line = server.stdout.readline()
            if line:
                break
            server.communicate()
        self.addCleanup(server.stdout.close)
        self.addCleanup(server.stderr.close)
        self.addCleanup(server.wait)
        self.addCleanup(server.kill)
        listening = json.loads(line)
        self.assertEqual(listening["event"], "listening")
        return server, listening["match"], metrics

    def join(self, port):
        player = subprocess.Popen([LOCKSTONE, "join", "--insecure", "--port", str(port), "--json"],
                                  stdout=subprocess.PIPE, text=True)
        self.addCleanup(player.stdout.close)
        self.addCleanup(player.wait)
        self.addCleanup(player.kill)
        return player

    def await_state(self, metrics, state):
        for _ in range(500):
            if ask(metrics, "/readyz")[1].strip() == state:
                return
            time.sleep(0.02)
        self.fail(f"the match is never {state}")

    def events(self, server):
        printed, complaints = server.communicate(timeout=60)
        self.assertEqual(complaints, "")
        return {entry["event"]: entry for entry in map(json.loads, printed.splitlines())}

    def test_a_match_that_waits_is_ready_and_ends_when_it_is_drained(self):
        server, _, metrics = self.serve("--drain")
        self.assertEqual(ask(metrics, "/readyz"), (200, "lobby\n"))
        self.assertEqual(ask(metrics, "/livez"), (200, "ok\n"))
        server.send_signal(signal.SIGTERM)
        events = self.events(server)
        self.assertEqual(server.returncode, 0)
        self.assertIn("has not begun", events["draining"]["text"])
        self.assertIn("stopped, 0 ticks", events["match_over"]["text"])

    def test_a_match_that_runs_is_drained_to_its_end(self):
        server, port, metrics = self.serve("--drain", "--ticks", "150")
        player = self.join(port)
        self.await_state(metrics, "running")
        server.send_signal(signal.SIGTERM)
        for _ in range(100):
            if ask(metrics, "/readyz")[0] == 503:
                break
            time.sleep(0.01)
        self.assertEqual(ask(metrics, "/readyz"), (503, "running\n"))
        self.assertEqual(ask(metrics, "/livez"), (200, "ok\n"))
        self.assertFalse(json.loads(ask(metrics, "/stats.json")[1])["ready"])
        events = self.events(server)
        self.assertEqual((server.returncode, player.wait(timeout=60)), (0, 0))
        self.assertEqual(events["match_over"]["tick"], 150)
        self.assertIn("completed", events["match_over"]["text"])
        self.assertEqual(events["player_joined"]["player"], 0)
        for entry in events.values():
            self.assertRegex(entry["time"], r"^20\d\d-\d\d-\d\dT\d\d:\d\d:\d\d\.\d{3}Z$")
            self.assertEqual((entry["level"], entry["match"]), ("info", port))

    def test_a_second_signal_stops_it(self):
        server, port, metrics = self.serve("--drain", "--ticks", "0")
        self.join(port)
        self.await_state(metrics, "running")
        server.send_signal(signal.SIGTERM)
        while ask(metrics, "/readyz")[0] != 503:
            time.sleep(0.01)
        server.send_signal(signal.SIGTERM)
        self.assertIn("stopped", self.events(server)["match_over"]["text"])

    def test_without_the_option_one_signal_stops_it(self):
        server, port, metrics = self.serve("--ticks", "0")
        self.join(port)
        self.await_state(metrics, "running")
        server.send_signal(signal.SIGTERM)
        events = self.events(server)
        self.assertNotIn("draining", events)
        self.assertIn("stopped", events["match_over"]["text"])


if __name__ == "__main__":
    unittest.main()
