using System;
using System.Text;
using Lockstone.Interop;

namespace Lockstone
{
    /// <summary>A call did nothing: the status and a message for people.</summary>
    public sealed class LockstoneException : Exception
    {
        /// <summary>One of <c>Native.LKS_…</c>.</summary>
        public int Status { get; }

        public LockstoneException(int status, string message) : base(message)
        {
            Status = status;
        }
    }

    /// <summary>Checks of calls, and texts of C.</summary>
    static unsafe class Call
    {
        internal static void Check(int status)
        {
            if (status == Native.LKS_OK) return;
            string name = Text(Native.lks_status_name(status)), message = Text(Native.lks_last_error());
            throw new LockstoneException(status, message.Length == 0 || message == name ? name : name + ": " + message);
        }

        internal static string Text(byte* text)
        {
            int length = 0;
            while (text[length] != 0) ++length;
            return length == 0 ? "" : Encoding.UTF8.GetString(text, length);
        }

        /// <summary>With the zero at its end.</summary>
        internal static byte[] Bytes(string text)
        {
            return Encoding.UTF8.GetBytes(text + "\0");
        }

        /// <summary>Writes a text into an array of a structure, cut to its room.</summary>
        internal static void Put(string text, byte* to, int room)
        {
            byte[] bytes = Encoding.UTF8.GetBytes(text ?? "");
            int length = Math.Min(bytes.Length, room - 1);
            while (length > 0 && length < bytes.Length && (bytes[length] & 0xc0) == 0x80) --length;
            for (int i = 0; i < room; ++i) to[i] = i < length ? bytes[i] : (byte)0;
        }
    }

    /// <summary>Facts of the library.</summary>
    public static unsafe class Library
    {
        public static string Version => Call.Text(Native.lks_version());
        /// <summary>Changes whenever the same commands may give another state: peers must agree on it.</summary>
        public static uint SimulationAbi => Native.lks_simulation_abi();
        /// <summary>This build's hash of a short scene. Peers must agree on it too.</summary>
        public static ulong CanaryHash => Native.lks_canary_hash();
        /// <summary>Microseconds of a clock that never runs backwards, for sessions.</summary>
        public static long NowUs => Native.lks_now_us();
    }
}
