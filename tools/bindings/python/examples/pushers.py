"""The game of tools/examples/pushers in Python: every player pushes a ball over a plane.

    pushers.py serve PLAYERS TICKS LOG   prints "port N", then "tick hash" of each tick
    pushers.py join PORT [PREDICTION]    the same of a player; PREDICTION ticks of rollback
"""

import sys
from fractions import Fraction

import lockstone
from lockstone import Client, Game, GameLibrary, Info, Recorder, Server, Transport, World, now_us, ticks_of

MAX_PLAYERS = 16


class Pushers(Game):
    name, version = "pushers", "0.1"

    def __init__(self, config):
        """The configuration is one byte: the number of players."""
        if len(config) != 1 or not 1 <= config[0] <= MAX_PLAYERS:
            raise ValueError("one byte is expected, 1 … 16 players")
        players = config[0]
        rules = {"body_capacity": MAX_PLAYERS + 1}
        self.world = World(**rules)
        self.world.create_body(lockstone.half_space(), motion=lockstone.STATIC)
        self.balls = [self.world.create_body(lockstone.sphere("0.5"), position=(Fraction(3 * slot, 2), "0.5", 0))
                      for slot in range(players)]
        config_hash = (World.config_hash(**rules) + players) % 2**64
        self._info = Info(lockstone.simulation_abi, lockstone.canary_hash, config_hash, self.world.hash, players, 2)

    @property
    def info(self):
        return self._info

    @property
    def tick(self):
        return self.world.tick

    def step(self, inputs):
        """Two signed numbers: a push along x and one along z, in N·s times 8."""
        for ball, (data, _) in zip(self.balls, inputs):
            x, z = (Fraction((byte + 128) % 256 - 128, 8) for byte in data)
            ball.apply_impulse((x, 0, z))
        self.world.step()

    def snapshot_bytes_max(self, kind):
        return self.world.snapshot_bytes_max(kind)

    def save(self, kind):
        return self.world.save(kind)

    def load(self, kind, data):
        self.world.load(data, kind)

    def keep_history(self, ticks):
        self.world.keep_history(ticks)

    def forget_history(self):
        self.world.forget_history()

    @property
    def hash(self):
        return self.world.hash

    def part_hashes(self):
        parts = self.world.part_hashes()
        return [("bodies", parts["bodies"]), ("contacts", parts["contacts"])]

    def describe(self, here, there):
        return self.world.describe_difference(here, there)


def serve(players, ticks, path):
    simulation = GameLibrary(Pushers).simulation(bytes([players]))
    transport = Transport.listen(unlimited=1)  # this match runs as fast as it can
    print("port", transport.port, flush=True)
    server = Server(simulation, transport, insecure=1, pacing=1, tick_count=ticks)
    recorder = Recorder(simulation, path, replace=1)
    server.record(recorder)
    while not server.over:
        for tick, value in ticks_of(server.update(now_us())):
            print(f"{tick} {value:016x}")
        transport.wait(1000)
    recorder.finish("the match is over")
    return server.view.finish_reason


def join(port, prediction):
    def sample(tick, size):
        return bytes((tick // 8 * 47 + i * 61) % 256 for i in range(size))

    client = Client(GameLibrary(Pushers), Transport.connect("127.0.0.1", port), sample, insecure=1,
                    prediction_ticks=prediction, name="Python")
    while not client.over:
        for tick, value in ticks_of(client.update(now_us())):
            print(f"{tick} {value:016x}")
        client.transport.wait(1000)
    if not client.finished:
        print(client.reason, file=sys.stderr)
    return 0 if client.finished else 1


if __name__ == "__main__":
    command, *words = sys.argv[1:] or ["help"]
    if command == "serve" and len(words) == 3:
        sys.exit(serve(int(words[0]), int(words[1]), words[2]))
    if command == "join" and len(words) in (1, 2):
        sys.exit(join(int(words[0]), int(words[1]) if len(words) == 2 else 0))
    print(__doc__, file=sys.stderr)
    sys.exit(64)
