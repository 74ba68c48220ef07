using System;
using System.Runtime.InteropServices;
using Lockstone.Interop;

namespace Lockstone
{
    /// <summary>Marks functions that C calls, for ahead-of-time compilers.</summary>
    [AttributeUsage(AttributeTargets.Method)]
    sealed class MonoPInvokeCallbackAttribute : Attribute
    {
        public MonoPInvokeCallbackAttribute(Type type)
        {
        }
    }

    public enum Origin : uint
    {
        Received = 0,
        /// <summary>Late: the last input was repeated.</summary>
        Repeated = 1,
        /// <summary>Late: all zero.</summary>
        Neutral = 2,
        /// <summary>Nobody sits in this slot; all zero.</summary>
        Absent = 3
    }

    /// <summary>The players' inputs for one tick. Any bytes are legal: they come from the network.</summary>
    public readonly unsafe ref struct Inputs
    {
        readonly lockstone_game_input* list;
        readonly int bytes;
        public int Count { get; }

        internal Inputs(lockstone_game_input* list, int count, int bytes)
        {
            this.list = list;
            this.bytes = bytes;
            Count = count;
        }

        public ReadOnlySpan<byte> this[int slot] => new ReadOnlySpan<byte>(list[Checked(slot)].bytes, bytes);
        public Origin OriginOf(int slot) => (Origin)list[Checked(slot)].origin;

        int Checked(int slot)
        {
            if (slot < 0 || slot >= Count) throw new IndexOutOfRangeException();
            return slot;
        }
    }

    /// <summary>A deterministic game. Only inputs, state and tick decide about a result; no float does. Step, Save, Load
    /// and Hash allocate nothing. An exception out of it ends the program.</summary>
    public abstract class Game : IDisposable
    {
        public abstract lockstone_game_info Info { get; }
        /// <summary>Ticks stepped.</summary>
        public abstract ulong Tick { get; }
        public abstract void Step(Inputs inputs);
        /// <summary>A command of the next tick, of a slot or of the server (<c>Native.LKS_SERVER_SLOT</c>): right before
        /// Step.</summary>
        public virtual void Command(uint slot, ReadOnlySpan<byte> bytes)
        {
        }
        public abstract int SnapshotBytesMax(Snapshot kind);
        /// <summary>Writes the whole state; returns its bytes.</summary>
        public abstract int Save(Snapshot kind, Span<byte> to);
        /// <summary>Replaces the whole state, or returns another status than <c>Native.LKS_OK</c> and changes
        /// nothing.</summary>
        public abstract int Load(Snapshot kind, ReadOnlySpan<byte> from);
        /// <summary>Over everything that can change the future.</summary>
        public abstract ulong Hash { get; }
        /// <summary>From here on remembers the last ticks, as World.KeepHistory does. A client that predicts asks for
        /// it.</summary>
        public virtual void KeepHistory(uint ticks)
        {
        }
        /// <summary>The next steps simulate in full.</summary>
        public virtual void ForgetHistory()
        {
        }
        /// <summary>Hashes of all parts of the state, at most 8, always the same ones: <see cref="PartNames"/>.</summary>
        public virtual int PartHashes(Span<ulong> hashes) => 0;
        /// <summary>The first difference between two canonical snapshots, for people; null where there is none.</summary>
        public virtual string Describe(ReadOnlySpan<byte> here, ReadOnlySpan<byte> there) => null;
        public virtual void Dispose()
        {
        }
    }

    /// <summary>The game of this program, as sessions and logs take it. A program has one.</summary>
    public sealed unsafe class GameLibrary : Handle
    {
        static Func<byte[], Game> create;
        static byte*[] partNames;

        sealed class Match
        {
            internal Game game;
            internal int inputBytes;
        }

        // C keeps their addresses, so they live as long as the program.
        static readonly lockstone_game_create_function createFunction = Create;
        static readonly lockstone_game_destroy_function destroyFunction = DestroyMatch;
        static readonly lockstone_game_info_function infoFunction = Info;
        static readonly lockstone_game_tick_function tickFunction = Tick;
        static readonly lockstone_game_step_function stepFunction = Step;
        static readonly lockstone_game_snapshot_bytes_max_function bytesMaxFunction = SnapshotBytesMax;
        static readonly lockstone_game_save_function saveFunction = Save;
        static readonly lockstone_game_load_function loadFunction = Load;
        static readonly lockstone_game_hash_function hashFunction = Hash;
        static readonly lockstone_game_part_hashes_function partsFunction = PartHashes;
        static readonly lockstone_game_describe_function describeFunction = Describe;
        static readonly lockstone_game_keep_history_function keepHistoryFunction = KeepHistory;
        static readonly lockstone_game_forget_history_function forgetHistoryFunction = ForgetHistory;
        static readonly lockstone_game_command_function commandFunction = Command;

        /// <summary>`create` makes the match at tick 0 from configuration bytes, which may come from a stranger; it
        /// throws a LockstoneException for those that it does not know. `parts` names the hashes of parts.</summary>
        public GameLibrary(string name, string version, Func<byte[], Game> create, params string[] parts)
        {
            GameLibrary.create = create;
            partNames = new byte*[parts.Length];
            for (int i = 0; i < parts.Length; ++i) partNames[i] = Keep(parts[i]);
            lockstone_game_table table = Table(Keep(name), Keep(version));
            IntPtr made;
            Call.Check(Native.lks_game_create(&table, &made));
            handle = made;
        }

        static lockstone_game_table Table(byte* name, byte* version)
        {
            return new lockstone_game_table
            {
                abi = Native.LOCKSTONE_GAME_ABI,
                bytes = (uint)sizeof(lockstone_game_table),
                name = name,
                version = version,
                create = Marshal.GetFunctionPointerForDelegate(createFunction),
                destroy = Marshal.GetFunctionPointerForDelegate(destroyFunction),
                info = Marshal.GetFunctionPointerForDelegate(infoFunction),
                tick = Marshal.GetFunctionPointerForDelegate(tickFunction),
                step = Marshal.GetFunctionPointerForDelegate(stepFunction),
                snapshot_bytes_max = Marshal.GetFunctionPointerForDelegate(bytesMaxFunction),
                save = Marshal.GetFunctionPointerForDelegate(saveFunction),
                load = Marshal.GetFunctionPointerForDelegate(loadFunction),
                hash = Marshal.GetFunctionPointerForDelegate(hashFunction),
                part_hashes = Marshal.GetFunctionPointerForDelegate(partsFunction),
                describe = Marshal.GetFunctionPointerForDelegate(describeFunction),
                keep_history = Marshal.GetFunctionPointerForDelegate(keepHistoryFunction),
                forget_history = Marshal.GetFunctionPointerForDelegate(forgetHistoryFunction),
                command = Marshal.GetFunctionPointerForDelegate(commandFunction)
            };
        }

        protected override void Destroy(IntPtr game)
        {
            Native.lks_game_destroy(game);
        }

        /// <summary>A match at tick 0.</summary>
        public Simulation Simulate(ReadOnlySpan<byte> config)
        {
            IntPtr made;
            fixed (byte* p = &MemoryMarshal.GetReference(config))
                Call.Check(Native.lks_simulation_create(Pointer, p, (UIntPtr)config.Length, &made));
            return new Simulation(made);
        }

        // Names live as long as the program.
        static byte* Keep(string text)
        {
            byte[] bytes = Call.Bytes(text);
            IntPtr kept = Marshal.AllocHGlobal(bytes.Length);
            Marshal.Copy(bytes, 0, kept, bytes.Length);
            return (byte*)kept;
        }

        static Match MatchOf(void* match) => (Match)GCHandle.FromIntPtr((IntPtr)match).Target;
        internal static Game GameOf(void* match) => MatchOf(match).game;

        static void Fail(Exception error)
        {
            Environment.FailFast("the game threw an exception: " + error);
        }

        [MonoPInvokeCallback(typeof(lockstone_game_create_function))]
        static int Create(byte* config, UIntPtr bytes, void** match)
        {
            try
            {
                Game game = create(new ReadOnlySpan<byte>(config, (int)bytes).ToArray());
                var made = new Match { game = game, inputBytes = game.Info.input_bytes };
                *match = (void*)GCHandle.ToIntPtr(GCHandle.Alloc(made));
                return Native.LKS_OK;
            }
            catch (LockstoneException refusal)
            {
                return refusal.Status;
            }
            catch (Exception error)
            {
                Fail(error);
                return Native.LKS_MALFORMED;
            }
        }

        [MonoPInvokeCallback(typeof(lockstone_game_destroy_function))]
        static void DestroyMatch(void* match)
        {
            GCHandle held = GCHandle.FromIntPtr((IntPtr)match);
            ((Match)held.Target).game.Dispose();
            held.Free();
        }

        [MonoPInvokeCallback(typeof(lockstone_game_info_function))]
        static void Info(void* match, lockstone_game_info* to)
        {
            *to = GameOf(match).Info;
        }

        [MonoPInvokeCallback(typeof(lockstone_game_tick_function))]
        static ulong Tick(void* match)
        {
            return GameOf(match).Tick;
        }

        [MonoPInvokeCallback(typeof(lockstone_game_step_function))]
        static void Step(void* match, lockstone_game_input* inputs, UIntPtr count)
        {
            try
            {
                Match held = MatchOf(match);
                held.game.Step(new Inputs(inputs, (int)count, held.inputBytes));
            }
            catch (Exception error)
            {
                Fail(error);
            }
        }

        [MonoPInvokeCallback(typeof(lockstone_game_snapshot_bytes_max_function))]
        static UIntPtr SnapshotBytesMax(void* match, uint kind)
        {
            return (UIntPtr)GameOf(match).SnapshotBytesMax((Snapshot)kind);
        }

        [MonoPInvokeCallback(typeof(lockstone_game_save_function))]
        static UIntPtr Save(void* match, uint kind, byte* to, UIntPtr capacity)
        {
            try
            {
                return (UIntPtr)GameOf(match).Save((Snapshot)kind, new Span<byte>(to, (int)capacity));
            }
            catch (Exception error)
            {
                Fail(error);
                return UIntPtr.Zero;
            }
        }

        [MonoPInvokeCallback(typeof(lockstone_game_load_function))]
        static int Load(void* match, uint kind, byte* bytes, UIntPtr size)
        {
            try
            {
                return GameOf(match).Load((Snapshot)kind, new ReadOnlySpan<byte>(bytes, (int)size));
            }
            catch (Exception error)
            {
                Fail(error);
                return Native.LKS_MALFORMED;
            }
        }

        [MonoPInvokeCallback(typeof(lockstone_game_hash_function))]
        static ulong Hash(void* match)
        {
            return GameOf(match).Hash;
        }

        [MonoPInvokeCallback(typeof(lockstone_game_keep_history_function))]
        static void KeepHistory(void* match, uint ticks)
        {
            GameOf(match).KeepHistory(ticks);
        }

        [MonoPInvokeCallback(typeof(lockstone_game_forget_history_function))]
        static void ForgetHistory(void* match)
        {
            GameOf(match).ForgetHistory();
        }

        [MonoPInvokeCallback(typeof(lockstone_game_command_function))]
        static void Command(void* match, uint slot, byte* bytes, UIntPtr size)
        {
            GameOf(match).Command(slot, new ReadOnlySpan<byte>(bytes, (int)size));
        }

        [MonoPInvokeCallback(typeof(lockstone_game_part_hashes_function))]
        static UIntPtr PartHashes(void* match, lockstone_game_hash* to)
        {
            ulong* hashes = stackalloc ulong[8];
            int count = GameOf(match).PartHashes(new Span<ulong>(hashes, 8));
            for (int i = 0; i < count; ++i)
                to[i] = new lockstone_game_hash { name = partNames[i], low = hashes[i] };
            return (UIntPtr)count;
        }

        [MonoPInvokeCallback(typeof(lockstone_game_describe_function))]
        static int Describe(void* match, byte* here, UIntPtr hereBytes, byte* there, UIntPtr thereBytes,
                            lockstone_game_difference* to)
        {
            *to = default(lockstone_game_difference);
            string text = GameOf(match).Describe(new ReadOnlySpan<byte>(here, (int)hereBytes),
                                                 new ReadOnlySpan<byte>(there, (int)thereBytes));
            if (text == null) return 0;
            Call.Put("state", to->store, (int)Native.LOCKSTONE_GAME_TEXT_BYTES);
            Call.Put(text, to->field, (int)Native.LOCKSTONE_GAME_TEXT_BYTES);
            return 1;
        }
    }

    /// <summary>A match of the game.</summary>
    public sealed unsafe class Simulation : Handle
    {
        internal Simulation(IntPtr simulation)
        {
            handle = simulation;
        }

        protected override void Destroy(IntPtr simulation)
        {
            Native.lks_simulation_destroy(simulation);
        }

        /// <summary>Your game, for reading, as to draw it.</summary>
        public Game Game
        {
            get
            {
                void* match;
                Call.Check(Native.lks_simulation_match(Pointer, &match));
                return GameLibrary.GameOf(match);
            }
        }

        public ulong Tick => Game.Tick;
        public ulong Hash => Game.Hash;

        /// <summary>`inputs`: the players' inputs one after another, all received.</summary>
        public void Step(ReadOnlySpan<byte> inputs)
        {
            fixed (byte* p = &MemoryMarshal.GetReference(inputs))
                Call.Check(Native.lks_simulation_step(Pointer, p, (UIntPtr)inputs.Length, null));
        }
    }
}
