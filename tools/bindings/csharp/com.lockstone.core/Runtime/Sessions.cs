using System;
using System.Runtime.InteropServices;
using Lockstone.Interop;

namespace Lockstone
{
    /// <summary>Carries the packets of one session.</summary>
    public sealed unsafe class Transport : Handle
    {
        internal uint Connection { get; set; }

        internal Transport(IntPtr transport, uint connection)
        {
            handle = transport;
            Connection = connection;
        }

        protected override void Destroy(IntPtr transport)
        {
            Native.lks_transport_destroy(transport);
        }

        /// <summary>A server's UDP socket at a numeric address; with the backend's key of 32 bytes the match is
        /// encrypted.</summary>
        public static Transport Listen(lks_enet_def def, string address, byte[] key = null)
        {
            if (key != null && key.Length != 32) throw new ArgumentException("a key has 32 bytes", nameof(key));
            IntPtr made;
            fixed (byte* a = Call.Bytes(address))
            fixed (byte* k = key)
                Call.Check(Native.lks_enet_listen(&def, a, k, &made));
            return new Transport(made, 0);
        }

        /// <summary>A client's, which calls a server at a numeric address.</summary>
        public static Transport Connect(string address, uint port)
        {
            IntPtr made;
            uint connection;
            fixed (byte* a = Call.Bytes(address)) Call.Check(Native.lks_enet_connect(a, port, &made, &connection));
            return new Transport(made, connection);
        }

        /// <summary>A client's, encrypted, by the text of a token.</summary>
        public static Transport Join(string token)
        {
            IntPtr made;
            uint connection;
            fixed (byte* t = Call.Bytes(token)) Call.Check(Native.lks_enet_join(t, &made, &connection));
            return new Transport(made, connection);
        }

        public uint Port
        {
            get
            {
                uint port;
                Call.Check(Native.lks_enet_port(Pointer, &port));
                return port;
            }
        }

        /// <summary>Sleeps until a datagram has come, at most that long.</summary>
        public void Wait(long limitUs)
        {
            Call.Check(Native.lks_enet_wait(Pointer, limitUs));
        }
    }

    /// <summary>A network within the process, in the sessions' own time.</summary>
    public sealed unsafe class Network : Handle
    {
        public Network(ulong seed)
        {
            IntPtr made;
            Call.Check(Native.lks_network_create(seed, &made));
            handle = made;
        }

        protected override void Destroy(IntPtr network)
        {
            Native.lks_network_destroy(network);
        }

        /// <summary>The server's end.</summary>
        public Transport Add()
        {
            IntPtr made;
            Call.Check(Native.lks_network_add(Pointer, &made));
            return new Transport(made, 0);
        }

        /// <summary>A client's end, which calls the server's.</summary>
        public Transport Connect(Transport server, uint lossPpm = 0, long delayUs = 0)
        {
            Transport end = Add();
            var faults = new lks_link_faults { size = (uint)sizeof(lks_link_faults), loss_ppm = lossPpm, delay_us = delayUs };
            uint connection;
            Call.Check(Native.lks_network_connect(Pointer, end.Pointer, server.Pointer, &faults, &connection));
            end.Connection = connection;
            return end;
        }
    }

    /// <summary>The server's side of a match: seats the players, closes tick after tick, compares states.</summary>
    public sealed unsafe class Server : Handle
    {
        lks_session_event[] events = new lks_session_event[64];

        /// <summary>Its simulation must stand at tick 0; from here on it is for reading.</summary>
        public Server(lks_server_def def, Simulation simulation, Transport transport)
        {
            IntPtr made;
            Call.Check(Native.lks_server_create(&def, simulation.Pointer, transport.Pointer, &made));
            handle = made;
        }

        protected override void Destroy(IntPtr server)
        {
            Native.lks_server_destroy(server);
        }

        /// <summary>Does all that is due, and returns its events; call it at least once a tick.</summary>
        public ReadOnlySpan<lks_session_event> Update(long nowUs)
        {
            Call.Check(Native.lks_server_update(Pointer, nowUs));
            for (;;)
            {
                UIntPtr count;
                int status;
                fixed (lks_session_event* p = events)
                    status = Native.lks_server_events(Pointer, p, (UIntPtr)events.Length, &count);
                if (status != Native.LKS_BUFFER_TOO_SMALL)
                {
                    Call.Check(status);
                    return new ReadOnlySpan<lks_session_event>(events, 0, (int)count);
                }
                events = new lks_session_event[(int)count];
            }
        }

        /// <summary>The text of one of the last update's events, for people.</summary>
        public string EventText(int index)
        {
            byte* text = stackalloc byte[512];
            Call.Check(Native.lks_server_event_text(Pointer, (UIntPtr)index, text, (UIntPtr)512));
            return Call.Text(text);
        }

        /// <summary>Gives a command of the server's own, 1 … 65536 bytes, from `Native.LKS_SERVER_SLOT`.</summary>
        public void SendCommand(ReadOnlySpan<byte> bytes)
        {
            fixed (byte* p = &MemoryMarshal.GetReference(bytes))
                Call.Check(Native.lks_server_send_command(Pointer, p, (UIntPtr)bytes.Length));
        }

        /// <summary>From here on each tick is written to this log.</summary>
        public void Record(Recorder recorder)
        {
            Call.Check(Native.lks_server_record(Pointer, recorder.Pointer));
        }

        public void Stop()
        {
            Call.Check(Native.lks_server_stop(Pointer));
        }

        public lks_server_view View
        {
            get
            {
                var view = new lks_server_view { size = (uint)sizeof(lks_server_view) };
                Call.Check(Native.lks_server_get(Pointer, &view));
                return view;
            }
        }

        public lks_session_stats Stats(uint slot)
        {
            var stats = new lks_session_stats { size = (uint)sizeof(lks_session_stats) };
            Call.Check(Native.lks_server_stats(Pointer, slot, &stats));
            return stats;
        }
    }

    /// <summary>Fills the input of a tick.</summary>
    public delegate void SampleInput(ulong tick, Span<byte> input);

    /// <summary>The client's side of a match: sends inputs, steps the ticks that the server closed.</summary>
    public sealed unsafe class Client : Handle
    {
        static readonly lks_sample_function sampleFunction = Sample;

        lks_session_event[] events = new lks_session_event[64];
        readonly Transport transport;
        GCHandle sampler;

        public Client(lks_client_def def, GameLibrary game, Transport transport)
        {
            IntPtr made;
            Call.Check(Native.lks_client_create(&def, game.Pointer, transport.Pointer, transport.Connection, &made));
            handle = made;
            this.transport = transport;
        }

        protected override void Destroy(IntPtr client)
        {
            Native.lks_client_destroy(client);
            if (sampler.IsAllocated) sampler.Free();
        }

        /// <summary>The input of this player from here on.</summary>
        public void SetInput(ReadOnlySpan<byte> input)
        {
            fixed (byte* p = &MemoryMarshal.GetReference(input))
                Call.Check(Native.lks_client_set_input(Pointer, p, (UIntPtr)input.Length));
        }

        /// <summary>Asks for the input of each tick, in order and once each; null: no longer.</summary>
        public void OnSample(SampleInput sample)
        {
            Call.Check(Native.lks_client_on_sample(Pointer, IntPtr.Zero, null));
            if (sampler.IsAllocated) sampler.Free();
            if (sample == null) return;
            sampler = GCHandle.Alloc(sample);
            Call.Check(Native.lks_client_on_sample(Pointer, Marshal.GetFunctionPointerForDelegate(sampleFunction),
                                                   (void*)GCHandle.ToIntPtr(sampler)));
        }

        [MonoPInvokeCallback(typeof(lks_sample_function))]
        static void Sample(void* user, ulong tick, byte* input, UIntPtr bytes)
        {
            try
            {
                ((SampleInput)GCHandle.FromIntPtr((IntPtr)user).Target)(tick, new Span<byte>(input, (int)bytes));
            }
            catch (Exception error)
            {
                Environment.FailFast("the sampled input threw an exception: " + error);
            }
        }

        /// <summary>Does all that is due, and returns its events; call it at least once a tick.</summary>
        public ReadOnlySpan<lks_session_event> Update(long nowUs)
        {
            Call.Check(Native.lks_client_update(Pointer, nowUs));
            for (;;)
            {
                UIntPtr count;
                int status;
                fixed (lks_session_event* p = events)
                    status = Native.lks_client_events(Pointer, p, (UIntPtr)events.Length, &count);
                if (status != Native.LKS_BUFFER_TOO_SMALL)
                {
                    Call.Check(status);
                    return new ReadOnlySpan<lks_session_event>(events, 0, (int)count);
                }
                events = new lks_session_event[(int)count];
            }
        }

        public lks_client_view View
        {
            get
            {
                var view = new lks_client_view { size = (uint)sizeof(lks_client_view) };
                Call.Check(Native.lks_client_get(Pointer, &view));
                return view;
            }
        }

        /// <summary>Gives a command, 1 … 65536 bytes; it comes back to everybody at a tick. Returns its number.</summary>
        public ulong SendCommand(ReadOnlySpan<byte> bytes)
        {
            ulong number;
            fixed (byte* p = &MemoryMarshal.GetReference(bytes))
                Call.Check(Native.lks_client_send_command(Pointer, p, (UIntPtr)bytes.Length, &number));
            return number;
        }

        /// <summary>The name that a slot's player gave; kept after it left.</summary>
        public string PlayerName(int slot)
        {
            byte* text = stackalloc byte[64];
            Call.Check(Native.lks_client_player_name(Pointer, (uint)slot, text, (UIntPtr)64));
            return Call.Text(text);
        }

        /// <summary>Why it was refused or failed, for people; else empty.</summary>
        public string Reason
        {
            get
            {
                byte* text = stackalloc byte[512];
                Call.Check(Native.lks_client_reason(Pointer, text, (UIntPtr)512));
                return Call.Text(text);
            }
        }

        /// <summary>The match, for reading; null before the server's offer was understood. Dispose it.</summary>
        public Simulation Simulation
        {
            get
            {
                IntPtr made;
                int status = Native.lks_client_simulation(Pointer, &made);
                if (status == Native.LKS_NOT_FOUND) return null;
                Call.Check(status);
                return new Simulation(made);
            }
        }

        public lks_session_stats Stats
        {
            get
            {
                var stats = new lks_session_stats { size = (uint)sizeof(lks_session_stats) };
                Call.Check(Native.lks_client_stats(Pointer, &stats));
                return stats;
            }
        }

        /// <summary>Calls the server again after the connection was lost.</summary>
        public void Reconnect()
        {
            uint connection;
            Call.Check(Native.lks_enet_connect_again(transport.Pointer, &connection));
            Call.Check(Native.lks_client_reconnect(Pointer, connection));
        }

        public void Leave()
        {
            Call.Check(Native.lks_client_leave(Pointer));
        }
    }
}
