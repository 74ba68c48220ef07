// A server and a player of the game over the network:
//
//   Play.exe serve PLAYERS TICKS LOG   prints "port N", then "tick hash" of each tick
//   Play.exe join PORT [PREDICTION]    the same of a player; PREDICTION ticks of rollback
using System;
using Lockstone;
using Lockstone.Interop;

static class Play
{
    static void PrintTicks(ReadOnlySpan<lks_session_event> events)
    {
        for (int i = 0; i < events.Length; ++i)
            if (events[i].kind == Native.LKS_SESSION_TICK) Console.WriteLine("{0} {1:x16}", events[i].tick, events[i].hash);
    }

    static int Serve(byte players, ulong ticks, string path)
    {
        using (GameLibrary game = Pushers.MakeLibrary())
        using (Simulation simulation = game.Simulate(new[] { players }))
        {
            lks_enet_def socket = Defaults.Socket();
            socket.unlimited = 1; // this match runs as fast as it can
            lks_recorder_def log = Defaults.Recorder();
            log.replace = 1;
            lks_server_def def = Defaults.Server();
            def.insecure = 1;
            def.pacing = Native.LKS_PACING_FAST;
            def.tick_count = ticks;
            using (Transport transport = Transport.Listen(socket, "127.0.0.1"))
            using (var recorder = new Recorder(log, simulation, path))
            using (var server = new Server(def, simulation, transport))
            {
                Console.WriteLine("port {0}", transport.Port);
                server.Record(recorder);
                while (server.View.state != Native.LKS_SERVER_OVER)
                {
                    PrintTicks(server.Update(Library.NowUs));
                    transport.Wait(1000);
                }
                recorder.Finish("the match is over");
                return server.View.finish_reason == Native.LKS_FINISH_COMPLETED ? 0 : 1;
            }
        }
    }

    static int Join(uint port, uint prediction)
    {
        lks_client_def def = Defaults.Client("C#");
        def.insecure = 1;
        def.prediction_ticks = prediction;
        using (GameLibrary game = Pushers.MakeLibrary())
        using (Transport transport = Transport.Connect("127.0.0.1", port))
        using (var client = new Client(def, game, transport))
        {
            client.OnSample((tick, input) =>
            {
                for (int i = 0; i < input.Length; ++i) input[i] = (byte)(tick / 8 * 43 + (ulong)i * 97);
            });
            while (client.View.state < Native.LKS_CLIENT_FINISHED)
            {
                PrintTicks(client.Update(Library.NowUs));
                transport.Wait(1000);
            }
            if (client.View.state == Native.LKS_CLIENT_FINISHED) return 0;
            Console.Error.WriteLine(client.Reason);
            return 1;
        }
    }

    static int Main(string[] words)
    {
        if (words.Length == 4 && words[0] == "serve") return Serve(byte.Parse(words[1]), ulong.Parse(words[2]), words[3]);
        if (words.Length >= 2 && words[0] == "join")
            return Join(uint.Parse(words[1]), words.Length > 2 ? uint.Parse(words[2]) : 0);
        Console.Error.WriteLine("usage: Play.exe serve PLAYERS TICKS LOG | join PORT [PREDICTION]");
        return 64;
    }
}
