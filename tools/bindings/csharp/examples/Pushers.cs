// The game of tools/examples/pushers in C#: every player pushes a ball over a plane.
using System;
using Lockstone;
using Lockstone.Interop;

public sealed class Pushers : Game
{
    const int MaxPlayers = 16;

    readonly World world;
    readonly ulong[] balls; // follow from the construction: not state
    readonly lockstone_game_info info;

    // The configuration is one byte: the number of players.
    public Pushers(byte[] config)
    {
        if (config.Length != 1) throw new LockstoneException(Native.LKS_MALFORMED, "one byte is expected");
        int players = config[0];
        if (players < 1 || players > MaxPlayers) throw new LockstoneException(Native.LKS_INVALID_ARGUMENT, "1 … 16 players");
        lks_world_def def = Defaults.World();
        def.body_capacity = MaxPlayers + 1;
        world = new World(def);
        lks_body_def ground = Defaults.Body();
        ground.motion = Native.LKS_STATIC;
        ground.shape = Shape.HalfSpace();
        world.CreateBody(ground);
        balls = new ulong[players];
        for (int slot = 0; slot < players; ++slot)
        {
            lks_body_def ball = Defaults.Body();
            ball.shape = Shape.Sphere(Units.LengthMm(500));
            ball.position = Units.Vec64(Units.PositionMm(1500 * slot), Units.PositionMm(500), 0);
            balls[slot] = world.CreateBody(ball);
        }
        info = new lockstone_game_info
        {
            abi = Library.SimulationAbi,
            canary = Library.CanaryHash,
            config_hash = World.ConfigHash(def) + (ulong)players,
            scene_hash = world.Hash,
            tick_rate = 60,
            player_count = (byte)players,
            input_bytes = 2
        };
    }

    public static GameLibrary MakeLibrary()
    {
        return new GameLibrary("pushers", "0.1", config => new Pushers(config), "bodies", "contacts");
    }

    public World World => world;
    public override lockstone_game_info Info => info;
    public override ulong Tick => world.Tick;
    public override void KeepHistory(uint ticks) => world.KeepHistory(ticks);
    public override void ForgetHistory() => world.ForgetHistory();
    public override ulong Hash => world.Hash;

    // Two signed numbers: a push along x and one along z, in N·s times 8.
    public override void Step(Inputs inputs)
    {
        for (int slot = 0; slot < inputs.Count && slot < balls.Length; ++slot)
            world.ApplyImpulse(balls[slot], Units.Vec64(Push(inputs[slot][0]), 0, Push(inputs[slot][1])));
        world.Step();
    }

    static long Push(byte input) => (long)(sbyte)input << (Native.LKS_IMPULSE_BITS - 3);

    public override int SnapshotBytesMax(Snapshot kind) => world.SnapshotBytesMax(kind);
    public override int Save(Snapshot kind, Span<byte> to) => world.Save(kind, to);
    public override int Load(Snapshot kind, ReadOnlySpan<byte> from) => world.TryLoad(kind, from);

    public override int PartHashes(Span<ulong> hashes)
    {
        lks_hashes parts = world.PartHashes;
        hashes[0] = parts.bodies;
        hashes[1] = parts.contacts;
        return 2;
    }

    public override string Describe(ReadOnlySpan<byte> here, ReadOnlySpan<byte> there)
    {
        return world.DescribeDifference(here, there);
    }

    public override void Dispose()
    {
        world.Dispose();
    }
}
