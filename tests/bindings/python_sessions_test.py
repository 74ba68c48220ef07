"""Games, sessions and logs of the Python binding. LOCKSTONE_LIBRARY names the library, PYTHONPATH the package."""

import pathlib
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools/bindings/python/examples"))

import lockstone
from lockstone import _declarations as c
from lockstone import Client, GameLibrary, Log, LockstoneError, Network, Recorder, Server, ticks_of
from pushers import Pushers

TICKS = 100


def played(game, push):
    """The log of one player who pushes once."""
    simulation = game.simulation(b"\1")
    recorder = Recorder(simulation)
    for tick in range(60):
        inputs = bytes([push if tick == 40 else 1, 0])
        simulation.step(inputs)
        recorder.step(inputs)
    recorder.finish("over")
    return Log(recorder.bytes())


class Sessions(unittest.TestCase):
    def setUp(self):
        self.game = GameLibrary(Pushers)

    def client(self, network, end, prediction):
        def sample(tick, size):
            return bytes([tick // 4 * (31 + prediction) % 256] * size)
        link = network.connect(end, loss_ppm=50000, delay_us=30000)
        return Client(self.game, link, sample, insecure=1, prediction_ticks=prediction, name="player")

    def test_have_equal_hashes_and_a_log_that_verifies(self):
        network = Network(3)
        end = network.add()
        clients = [self.client(network, end, 0), self.client(network, end, 6)]
        simulation = self.game.simulation(b"\2")
        server = Server(simulation, end, insecure=1, tick_count=TICKS)
        recorder = Recorder(simulation)
        server.record(recorder)
        seen, now = [[], [], []], 0
        while not server.over and now < 60_000_000:
            now += 4000
            for peer, ticks in zip([server, *clients], seen):
                ticks += ticks_of(peer.update(now))
        self.assertEqual(len(seen[0]), TICKS)
        self.assertEqual(seen[0], seen[1])
        self.assertEqual(seen[0], seen[2])
        self.assertTrue(all(client.finished for client in clients))
        self.assertGreater(clients[1].stats.rollbacks, 0)
        self.assertEqual(clients[0].simulation.game.hash, seen[0][-1][1])
        with self.assertRaises(LockstoneError):
            clients[0].simulation.step(bytes(4))

        recorder.finish("over")
        log = Log(recorder.bytes())
        verdict = log.verify(self.game)
        self.assertEqual((verdict.outcome, verdict.ticks_verified), (lockstone.SAME, TICKS), verdict.line)
        self.assertEqual([(tick.number, tick.hash) for tick in log], seen[0])
        self.assertEqual(log.seek(self.game, 50).hash, seen[0][49][1])
        self.assertEqual(next(iter(log)).number, 50)
        self.assertEqual((log.info.game, log.info.complete), (b"pushers", 1))

    def test_names_and_commands_reach_everybody(self):
        heard = []

        class Talking(Pushers):
            def command(self, slot, data):
                heard.append((self.tick, slot, data))

        self.game = GameLibrary(Talking)
        network = Network(4)
        end = network.add()
        clients = [self.client(network, end, 0), self.client(network, end, 6)]
        simulation = self.game.simulation(b"\2")
        server = Server(simulation, end, insecure=1, tick_count=TICKS)
        recorder = Recorder(simulation)
        server.record(recorder)
        seen, now, long = [[], [], []], 0, bytes(range(256)) * 100
        while not server.over and now < 60_000_000:
            now += 4000
            for peer, commands in zip([server, *clients], seen):
                commands += [(event.tick, event.slot, event.data) for event in peer.update(now)
                             if event.kind == c.LKS_SESSION_COMMAND]
            if now == 1_000_000:
                self.assertEqual(clients[1].send_command(long), 0)
                server.send_command(b"hello")
        self.assertEqual({(slot, data) for _, slot, data in seen[0]}, {(clients[1].view.slot, long), (c.LKS_SERVER_SLOT, b"hello")})
        self.assertEqual(seen[0], seen[1])
        self.assertEqual(seen[0], seen[2])
        self.assertEqual(sorted(heard), sorted(3 * seen[0]))  # of the server and both clients
        self.assertEqual([peer.player_name(1) for peer in (server, *clients)], 3 * ["player"])

        recorder.finish("over")
        heard.clear()
        verdict = Log(recorder.bytes()).verify(self.game)
        self.assertEqual((verdict.outcome, verdict.ticks_verified), (lockstone.SAME, TICKS), verdict.line)
        self.assertEqual(heard, seen[0])

    def test_logs_that_differ_are_bisected(self):
        found = played(self.game, 1).bisect(played(self.game, 99), self.game)
        self.assertEqual((found.tick, found.in_inputs), (40, 1))
        self.assertIn(b"inputs of player 0", found.line)
        self.assertIsNone(played(self.game, 1).bisect(played(self.game, 1), self.game))

    def test_refusals_say_why(self):
        with self.assertRaisesRegex(LockstoneError, "refuses the configuration"):
            self.game.simulation(b"\0")
        with self.assertRaises(AttributeError):
            Server(self.game.simulation(b"\1"), Network().add(), no_such_setting=1)
        with self.assertRaisesRegex(LockstoneError, "insecure"):
            Server(self.game.simulation(b"\1"), Network().add())


if __name__ == "__main__":
    unittest.main()
