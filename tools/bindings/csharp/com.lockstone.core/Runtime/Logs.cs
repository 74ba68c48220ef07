using System;
using System.Runtime.InteropServices;
using Lockstone.Interop;

namespace Lockstone
{
    /// <summary>Writes the log of a match.</summary>
    public sealed unsafe class Recorder : Handle
    {
        /// <summary>In memory where `path` is null.</summary>
        public Recorder(lks_recorder_def def, Simulation simulation, string path = null)
        {
            IntPtr made;
            if (path == null)
            {
                Call.Check(Native.lks_recorder_create_in_memory(&def, simulation.Pointer, &made));
            }
            else
            {
                fixed (byte* p = Call.Bytes(path))
                    Call.Check(Native.lks_recorder_create(&def, simulation.Pointer, p, &made));
            }
            handle = made;
        }

        protected override void Destroy(IntPtr recorder)
        {
            Native.lks_recorder_destroy(recorder);
        }

        /// <summary>Records the tick that the simulation was just stepped by.</summary>
        public void Step(ReadOnlySpan<byte> inputs)
        {
            fixed (byte* p = &MemoryMarshal.GetReference(inputs))
                Call.Check(Native.lks_recorder_step(Pointer, p, (UIntPtr)inputs.Length, null));
        }

        public void Finish(string reason)
        {
            fixed (byte* text = Call.Bytes(reason)) Call.Check(Native.lks_recorder_finish(Pointer, text));
        }

        /// <summary>The log so far of a recorder in memory.</summary>
        public byte[] ToArray()
        {
            UIntPtr count;
            int status = Native.lks_recorder_bytes(Pointer, null, UIntPtr.Zero, &count);
            if (status != Native.LKS_BUFFER_TOO_SMALL) Call.Check(status);
            var bytes = new byte[(int)count];
            fixed (byte* p = bytes) Call.Check(Native.lks_recorder_bytes(Pointer, p, count, &count));
            return bytes;
        }
    }

    /// <summary>A recorded match.</summary>
    public sealed unsafe class Log : Handle
    {
        public Log(string path)
        {
            IntPtr made;
            fixed (byte* p = Call.Bytes(path)) Call.Check(Native.lks_log_open(p, &made));
            handle = made;
        }

        public Log(ReadOnlySpan<byte> bytes)
        {
            IntPtr made;
            fixed (byte* p = &MemoryMarshal.GetReference(bytes))
                Call.Check(Native.lks_log_open_bytes(p, (UIntPtr)bytes.Length, &made));
            handle = made;
        }

        protected override void Destroy(IntPtr log)
        {
            Native.lks_log_close(log);
        }

        public lks_log_info Info
        {
            get
            {
                var info = new lks_log_info { size = (uint)sizeof(lks_log_info) };
                Call.Check(Native.lks_log_get_info(Pointer, &info));
                return info;
            }
        }

        /// <summary>Reads the next tick into `inputs`, which has room for all players'; false after the last.</summary>
        public bool Next(out ulong tick, Span<byte> inputs, out ulong hash)
        {
            ulong number = 0, after = 0;
            int status;
            fixed (byte* p = &MemoryMarshal.GetReference(inputs))
                status = Native.lks_log_next(Pointer, &number, p, (UIntPtr)inputs.Length, null, &after);
            tick = number;
            hash = after;
            if (status == Native.LKS_NOT_FOUND) return false;
            Call.Check(status);
            return true;
        }

        /// <summary>The match at a tick; Next goes on from there.</summary>
        public Simulation Seek(GameLibrary game, ulong tick)
        {
            IntPtr made;
            Call.Check(Native.lks_log_seek(Pointer, game.Pointer, tick, &made));
            return new Simulation(made);
        }

        /// <summary>Computes every tick again and compares the hashes: `outcome` is <c>Native.LKS_LOG_…</c>.</summary>
        public lks_log_report Verify(GameLibrary game)
        {
            var report = new lks_log_report { size = (uint)sizeof(lks_log_report) };
            Call.Check(Native.lks_log_verify(Pointer, game.Pointer, &report));
            return report;
        }

        /// <summary>The first tick, body and field in which two logs differ.</summary>
        public lks_bisect_report Bisect(Log other, GameLibrary game)
        {
            var report = new lks_bisect_report { size = (uint)sizeof(lks_bisect_report) };
            Call.Check(Native.lks_log_bisect(Pointer, other.Pointer, game.Pointer, &report));
            return report;
        }
    }
}
