// A match in one process, over a network with losses; its log; a behaviour of Unity that shows it.
using System;
using System.Collections.Generic;
using Lockstone;
using Lockstone.Interop;
using Lockstone.Unity;
using UnityEngine;

sealed class Shown : MatchBehaviour
{
    internal Client client;
    internal int events;
    protected override Client Client => client;
    protected override World WorldOf(Game game) => ((Pushers)game).World;
    protected override void OnSessionEvent(lks_session_event happened) => ++events;
    internal void Frame() => Update();
}

static class SessionTest
{
    const int Ticks = 150;
    static int failures;

    static void Expect(bool holds, string what)
    {
        if (holds) return;
        ++failures;
        Console.Error.WriteLine("failed: " + what);
    }

    static Client Join(GameLibrary game, Transport end, uint prediction)
    {
        lks_client_def def = Defaults.Client("player");
        def.insecure = 1;
        def.prediction_ticks = prediction;
        var client = new Client(def, game, end);
        client.OnSample((tick, input) => input.Fill((byte)(tick / 4 * (31 + prediction))));
        return client;
    }

    static void Keep(ReadOnlySpan<lks_session_event> events, List<ulong> hashes)
    {
        for (int i = 0; i < events.Length; ++i)
            if (events[i].kind == Native.LKS_SESSION_TICK) hashes.Add(events[i].hash);
    }

    static bool Same(List<ulong> a, List<ulong> b)
    {
        if (a.Count != b.Count) return false;
        for (int i = 0; i < a.Count; ++i) if (a[i] != b[i]) return false;
        return true;
    }

    static unsafe void PlayMatch(GameLibrary game)
    {
        var network = new Network(3);
        Transport end = network.Add();
        var ends = new[] { network.Connect(end, 50000, 30000), network.Connect(end, 50000, 30000) };
        var clients = new[] { Join(game, ends[0], 0), Join(game, ends[1], 6) };
        Simulation simulation = game.Simulate(new byte[] { 2 });
        var recorder = new Recorder(Defaults.Recorder(), simulation);
        lks_server_def def = Defaults.Server();
        def.insecure = 1;
        def.tick_count = Ticks;
        var server = new Server(def, simulation, end);
        server.Record(recorder);
        var seen = new[] { new List<ulong>(), new List<ulong>(), new List<ulong>() };
        for (long now = 0; server.View.state != Native.LKS_SERVER_OVER && now < 60000000; now += 4000)
        {
            Keep(server.Update(now), seen[0]);
            for (int i = 0; i < 2; ++i) Keep(clients[i].Update(now), seen[i + 1]);
        }
        Expect(seen[0].Count == Ticks && Same(seen[0], seen[1]) && Same(seen[0], seen[2]), "all hashes are equal");
        Expect(clients[1].Stats.rollbacks > 0, "a client rolled back");
        using (Simulation view = clients[1].Simulation) Expect(view.Hash == seen[0][Ticks - 1], "the last state");

        recorder.Finish("over");
        byte[] bytes = recorder.ToArray();
        var log = new Log(bytes);
        lks_log_report report = log.Verify(game);
        Expect(report.outcome == Native.LKS_LOG_SAME && report.ticks_verified == Ticks, "the log verifies");
        Expect(log.Seek(game, 100).Hash == seen[0][99], "the state at tick 100");
        ulong tick, hash;
        Expect(log.Next(out tick, new byte[4], out hash) && tick == 100 && hash == seen[0][100], "the tick after it");
        Expect(log.Bisect(new Log(bytes), game).found == 0, "a log equals itself");

        ends[0].Dispose(); // in any order
        network.Dispose();
        server.Dispose();
        simulation.Dispose();
    }

    static void ShowMatch(GameLibrary game)
    {
        var network = new Network(4);
        Transport end = network.Add();
        Client client = Join(game, network.Connect(end), 0);
        lks_server_def def = Defaults.Server();
        def.insecure = 1;
        def.pacing = Native.LKS_PACING_FAST;
        def.tick_count = 100000;
        var server = new Server(def, game.Simulate(new byte[] { 1 }), end);
        var shown = new Shown { client = client };
        var ball = new Transform();
        bool following = false;
        long until = Library.NowUs + 20000000;
        while ((ball.localPosition.z == 0 || shown.events < 20) && Library.NowUs < until)
        {
            server.Update(Library.NowUs);
            shown.Frame();
            using (Simulation view = client.Simulation)
            {
                if (following || view == null) continue;
                var names = new ulong[2];
                ((Pushers)view.Game).World.Bodies(names, new lks_pose[2]);
                shown.Show(names[1], ball);
                following = true;
            }
        }
        Expect(ball.localPosition.z != 0 && ball.localPosition.y > 0.4f && ball.localPosition.y < 0.6f, "the ball is shown");
        Expect(Math.Abs(ball.localRotation.w) <= 1, "its rotation is");
    }

    static void Refuse(GameLibrary game)
    {
        try
        {
            game.Simulate(new byte[] { 0 });
            Expect(false, "a refusal");
        }
        catch (LockstoneException error)
        {
            Expect(error.Status == Native.LKS_INVALID_ARGUMENT && error.Message.Contains("configuration"), error.Message);
        }
        Expect(Units.PositionMm(-1500) == -(3L << 31) && Units.PositionToMm(Units.PositionMm(-1)) == -1, "units");
        Expect(Units.LengthMm(long.MaxValue) == int.MaxValue && Units.Decimal("0.25", 20) == 1 << 18, "units");
        var ended = new World(Defaults.World());
        ended.Dispose();
        try
        {
            ended.Step();
            Expect(false, "an ended world is refused");
        }
        catch (ObjectDisposedException)
        {
        }
    }

    static unsafe void RoundHulls()
    {
        var corners = new lks_i32x3[8];
        for (int i = 0; i < 8; ++i)
            corners[i] = Units.Vec32(Units.LengthMm(i % 2 * 1000), Units.LengthMm(i / 2 % 2 * 1000), Units.LengthMm(i / 4 * 1000));
        World world;
        lks_shape plain, round;
        using (var assets = new Assets())
        {
            plain = assets.AddHull(corners);
            round = assets.AddHull(corners, 64, Units.LengthMm(100));
            int one = Units.NumberMilli(1000);
            Expect(assets.AddScaled(round, Units.Vec32(one, one, one)).asset == round.asset, "a copy of the same size");
            Expect(assets.AddScaled(plain, Units.Vec32(one, 2 * one, -one)).asset != plain.asset, "a scaled copy");
            world = new World(Defaults.World(), assets);
        }
        Expect(plain.kind == Native.LKS_HULL && plain.asset != round.asset, "two hulls");
        lks_body_def body = Defaults.Body();
        body.shape = round;
        Expect(world.CreateBody(body) != 0, "a rounded hull is a body");
        world.Dispose();
    }

    static void FindInBox()
    {
        using (var world = new World(Defaults.World()))
        {
            lks_body_def ball = Defaults.Body();
            ball.shape = Shape.Sphere(Units.LengthMm(250));
            var names = new ulong[3];
            for (int i = 0; i < 3; ++i)
            {
                ball.position = Units.Vec64(Units.PositionMm(1000 * i), 0, 0);
                names[i] = world.CreateBody(ball);
            }
            lks_i64x3 lower = Units.Vec64(Units.PositionMm(-100), Units.PositionMm(-100), Units.PositionMm(-100));
            lks_i64x3 upper = Units.Vec64(Units.PositionMm(1100), Units.PositionMm(100), Units.PositionMm(100));
            var found = new ulong[4];
            lks_query_filter filter = Defaults.Filter();
            Expect(world.BodiesInBox(lower, upper, filter, found) == 2 && found[0] == names[0] && found[1] == names[1], "two of three balls");
            filter.ignore = names[0];
            Expect(world.BodiesInBox(lower, upper, filter, found) == 1 && found[0] == names[1], "without the first");
            Expect(world.BodiesInBox(lower, upper, Defaults.Filter(), new Span<ulong>(found, 0, 1)) == 1 && found[0] == names[0], "as many as fit");
            try
            {
                world.BodiesInBox(upper, lower, filter, found);
                Expect(false, "a box turned round is refused");
            }
            catch (LockstoneException error)
            {
                Expect(error.Message.Contains("lower"), error.Message);
            }
        }
    }

    static int Main()
    {
        FindInBox();
        GameLibrary game = Pushers.MakeLibrary();
        PlayMatch(game);
        ShowMatch(game);
        Refuse(game);
        RoundHulls();
        GC.Collect();
        GC.WaitForPendingFinalizers();
        Console.WriteLine(failures == 0 ? "passed" : "failed");
        return failures == 0 ? 0 : 1;
    }
}
