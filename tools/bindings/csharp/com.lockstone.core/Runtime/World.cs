using System;
using System.Runtime.InteropServices;
using Lockstone.Interop;

namespace Lockstone
{
    public enum Snapshot : uint
    {
        /// <summary>For rollback: this process alone.</summary>
        Native = Interop.Native.LKS_NATIVE,
        /// <summary>For files and other machines: may come from anywhere.</summary>
        Canonical = Interop.Native.LKS_CANONICAL
    }

    public enum Frame : uint
    {
        World = Native.LKS_FRAME_WORLD,
        Body = Native.LKS_FRAME_BODY
    }

    /// <summary>A handle of C that ends with Dispose, or with the object.</summary>
    public abstract class Handle : IDisposable
    {
        protected IntPtr handle;

        protected abstract void Destroy(IntPtr handle);

        /// <summary>For functions of <c>Native</c> that are not wrapped.</summary>
        public IntPtr Pointer
        {
            get
            {
                if (handle == IntPtr.Zero) throw new ObjectDisposedException(GetType().Name);
                return handle;
            }
        }

        public void Dispose()
        {
            Release();
            GC.SuppressFinalize(this);
        }

        void Release()
        {
            IntPtr ending = handle;
            handle = IntPtr.Zero;
            if (ending != IntPtr.Zero) Destroy(ending);
        }

        ~Handle()
        {
            Release();
        }
    }

    /// <summary>The assets of a world, which keeps them: this may end before it.</summary>
    public sealed unsafe class Assets : Handle
    {
        public Assets()
        {
            IntPtr made;
            Call.Check(Native.lks_assets_create(&made));
            handle = made;
        }

        protected override void Destroy(IntPtr assets)
        {
            Native.lks_assets_destroy(assets);
        }

        /// <summary>The convex hull of 4 … 65536 points; with a radius, all points within it of that hull.</summary>
        public lks_shape AddHull(lks_i32x3[] points, int maxVertices = 64, int radius = 0)
        {
            ulong name;
            fixed (lks_i32x3* first = points)
            {
                Call.Check(radius == 0
                    ? Native.lks_assets_add_hull(Pointer, first, (UIntPtr)points.Length, maxVertices, &name)
                    : Native.lks_assets_add_rounded_hull(Pointer, first, (UIntPtr)points.Length, maxVertices, radius, &name));
            }
            return Shape.Asset(Native.LKS_HULL, name);
        }

        /// <summary>A hull, mesh or height field of the set scaled along its axes. Negative factors mirror.</summary>
        public lks_shape AddScaled(lks_shape shape, lks_i32x3 factors)
        {
            ulong name;
            Call.Check(Native.lks_assets_add_scaled(Pointer, shape.asset, &factors, &name));
            return Shape.Asset(shape.kind, name);
        }

        /// <summary>The child of a compound that a part of an event or query belongs to; of a mesh also the triangle, else 0.</summary>
        public (uint child, uint triangle) FindPart(ulong compound, uint part)
        {
            uint child, triangle;
            Call.Check(Native.lks_assets_find_part(Pointer, compound, part, &child, &triangle));
            return (child, triangle);
        }
    }

    /// <summary>A world of bodies and joints, written by commands alone. A body or joint is named by a ulong.</summary>
    public sealed unsafe class World : Handle
    {
        public World(lks_world_def def, Assets assets = null)
        {
            IntPtr made;
            Call.Check(Native.lks_world_create(&def, assets == null ? IntPtr.Zero : assets.Pointer, &made));
            handle = made;
        }

        /// <summary>A built-in scene, which takes no command: its hashes are known.</summary>
        public World(string scene, ulong seed)
        {
            fixed (byte* name = Call.Bytes(scene))
            {
                IntPtr made;
                Call.Check(Native.lks_world_create_scene(name, seed, &made));
                handle = made;
            }
        }

        protected override void Destroy(IntPtr world)
        {
            Native.lks_world_destroy(world);
        }

        /// <summary>Of the definition without assets: peers compare it before they play.</summary>
        public static ulong ConfigHash(lks_world_def def)
        {
            ulong hash;
            Call.Check(Native.lks_config_hash(&def, IntPtr.Zero, &hash));
            return hash;
        }

        /// <summary>Remembers the last ticks, at most 256, so that stepping them again after Load costs as much as
        /// differs.</summary>
        public void KeepHistory(uint ticks)
        {
            Call.Check(Native.lks_world_keep_history(Pointer, ticks));
        }

        public void ForgetHistory()
        {
            Call.Check(Native.lks_world_forget_history(Pointer));
        }

        public void Step()
        {
            Call.Check(Native.lks_step(Pointer, null));
        }

        public ulong Tick
        {
            get
            {
                ulong tick;
                Call.Check(Native.lks_tick(Pointer, &tick));
                return tick;
            }
        }

        /// <summary>Over everything that can change the future.</summary>
        public ulong Hash
        {
            get
            {
                ulong hash;
                Call.Check(Native.lks_hash(Pointer, &hash));
                return hash;
            }
        }

        public lks_hashes PartHashes
        {
            get
            {
                lks_hashes hashes;
                Call.Check(Native.lks_part_hashes(Pointer, &hashes));
                return hashes;
            }
        }

        public ulong CreateBody(lks_body_def def)
        {
            ulong body;
            Call.Check(Native.lks_create_body(Pointer, &def, &body));
            return body;
        }

        public void DestroyBody(ulong body)
        {
            Call.Check(Native.lks_destroy_body(Pointer, body));
        }

        public ulong CreateJoint(lks_joint_def def)
        {
            ulong joint;
            Call.Check(Native.lks_create_joint(Pointer, &def, &joint));
            return joint;
        }

        public void DestroyJoint(ulong joint)
        {
            Call.Check(Native.lks_destroy_joint(Pointer, joint));
        }

        public void ApplyImpulse(ulong body, lks_i64x3 impulse, Frame frame = Frame.World)
        {
            Call.Check(Native.lks_apply_impulse(Pointer, body, &impulse, (uint)frame));
        }

        public void ApplyAngularImpulse(ulong body, lks_i64x3 impulse, Frame frame = Frame.World)
        {
            Call.Check(Native.lks_apply_angular_impulse(Pointer, body, &impulse, (uint)frame));
        }

        /// <summary>Works over the coming tick.</summary>
        public void ApplyForce(ulong body, lks_i64x3 force, Frame frame = Frame.World)
        {
            Call.Check(Native.lks_apply_force(Pointer, body, &force, (uint)frame));
        }

        public void ApplyTorque(ulong body, lks_i64x3 torque, Frame frame = Frame.World)
        {
            Call.Check(Native.lks_apply_torque(Pointer, body, &torque, (uint)frame));
        }

        public void SetVelocity(ulong body, lks_i64x3 velocity)
        {
            Call.Check(Native.lks_set_velocity(Pointer, body, &velocity));
        }

        public void SetAngularVelocity(ulong body, lks_i64x3 velocity)
        {
            Call.Check(Native.lks_set_angular_velocity(Pointer, body, &velocity));
        }

        public void Teleport(ulong body, lks_pose pose)
        {
            Call.Check(Native.lks_teleport(Pointer, body, &pose));
        }

        public void MoveKinematic(ulong body, lks_pose pose)
        {
            Call.Check(Native.lks_move_kinematic(Pointer, body, &pose));
        }

        public void SetGravity(lks_i64x3 gravity)
        {
            Call.Check(Native.lks_set_gravity(Pointer, &gravity));
        }

        public void WakeBody(ulong body)
        {
            Call.Check(Native.lks_wake_body(Pointer, body));
        }

        public bool Exists(ulong body)
        {
            uint exists;
            Call.Check(Native.lks_body_exists(Pointer, body, &exists));
            return exists == 1;
        }

        public lks_pose Pose(ulong body)
        {
            lks_pose pose;
            Call.Check(Native.lks_body_pose(Pointer, body, &pose));
            return pose;
        }

        public lks_i64x3 Velocity(ulong body)
        {
            lks_i64x3 velocity;
            Call.Check(Native.lks_body_velocity(Pointer, body, &velocity));
            return velocity;
        }

        public int BodyCount
        {
            get
            {
                UIntPtr count;
                int status = Native.lks_bodies(Pointer, null, null, null, UIntPtr.Zero, &count);
                if (status != Native.LKS_BUFFER_TOO_SMALL) Call.Check(status);
                return (int)count;
            }
        }

        /// <summary>Fills both with all bodies by ascending index, without allocating; returns their number, which may
        /// be more than there was room for.</summary>
        public int Bodies(Span<ulong> names, Span<lks_pose> poses)
        {
            UIntPtr count;
            int room = Math.Min(names.Length, poses.Length);
            fixed (ulong* n = &MemoryMarshal.GetReference(names))
            fixed (lks_pose* p = &MemoryMarshal.GetReference(poses))
            {
                int status = Native.lks_bodies(Pointer, n, p, null, (UIntPtr)room, &count);
                if (status != Native.LKS_BUFFER_TOO_SMALL) Call.Check(status);
            }
            return (int)count;
        }

        /// <summary>Fills the events of the last step; returns their number.</summary>
        public int Events(Span<lks_event> events)
        {
            UIntPtr count;
            fixed (lks_event* p = &MemoryMarshal.GetReference(events))
            {
                int status = Native.lks_events(Pointer, p, (UIntPtr)events.Length, &count);
                if (status != Native.LKS_BUFFER_TOO_SMALL) Call.Check(status);
            }
            return (int)count;
        }

        /// <summary>Fills the impacts of the last step that were faster than a hit speed of their bodies; returns their
        /// number.</summary>
        public int HitEvents(Span<lks_hit_event> events)
        {
            UIntPtr count;
            fixed (lks_hit_event* p = &MemoryMarshal.GetReference(events))
            {
                int status = Native.lks_hit_events(Pointer, p, (UIntPtr)events.Length, &count);
                if (status != Native.LKS_BUFFER_TOO_SMALL) Call.Check(status);
            }
            return (int)count;
        }

        /// <summary>The first body along the ray; its `body` is 0 when there is none.</summary>
        public lks_hit CastRay(lks_i64x3 origin, lks_i32x3 way, lks_query_filter filter)
        {
            lks_hit hit;
            Call.Check(Native.lks_cast_ray(Pointer, &origin, &way, &filter, &hit));
            return hit;
        }

        /// <summary>Fills the bodies whose bounds along the world's axes overlap a box, by ascending index, without a look
        /// at their shapes; returns how many were written. No coordinate of lower may be above that of upper.</summary>
        public int BodiesInBox(lks_i64x3 lower, lks_i64x3 upper, lks_query_filter filter, Span<ulong> bodies)
        {
            UIntPtr count;
            fixed (ulong* p = &MemoryMarshal.GetReference(bodies))
            {
                Call.Check(Native.lks_bodies_in_box(Pointer, &lower, &upper, &filter, p, (UIntPtr)bodies.Length, &count));
            }
            return (int)count;
        }

        public int SnapshotBytesMax(Snapshot kind)
        {
            UIntPtr bytes;
            Call.Check(Native.lks_snapshot_bytes_max(Pointer, (uint)kind, &bytes));
            return (int)bytes;
        }

        /// <summary>Writes the state; returns its bytes.</summary>
        public int Save(Snapshot kind, Span<byte> to)
        {
            UIntPtr bytes;
            fixed (byte* p = &MemoryMarshal.GetReference(to))
                Call.Check(Native.lks_save(Pointer, (uint)kind, p, (UIntPtr)to.Length, &bytes));
            return (int)bytes;
        }

        /// <summary>Native bytes must be unchanged since Save wrote them in this process.</summary>
        public void Load(Snapshot kind, ReadOnlySpan<byte> from)
        {
            int status = TryLoad(kind, from);
            Call.Check(status);
        }

        /// <summary>The same, with the status instead of an exception.</summary>
        public int TryLoad(Snapshot kind, ReadOnlySpan<byte> from)
        {
            fixed (byte* p = &MemoryMarshal.GetReference(from))
                return Native.lks_load(Pointer, (uint)kind, p, (UIntPtr)from.Length);
        }

        /// <summary>The first difference between two canonical snapshots, for people; null where there is none.</summary>
        public string DescribeDifference(ReadOnlySpan<byte> here, ReadOnlySpan<byte> there)
        {
            byte* text = stackalloc byte[512];
            uint differs;
            fixed (byte* h = &MemoryMarshal.GetReference(here))
            fixed (byte* t = &MemoryMarshal.GetReference(there))
            {
                Call.Check(Native.lks_describe_difference(Pointer, h, (UIntPtr)here.Length, t, (UIntPtr)there.Length,
                                                          &differs, text, (UIntPtr)512));
            }
            return differs == 1 ? Call.Text(text) : null;
        }
    }
}
