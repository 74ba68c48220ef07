using System;
using Lockstone.Interop;

namespace Lockstone
{
    /// <summary>Exact conversions to and from raw fixed-point integers.</summary>
    public static unsafe class Units
    {
        /// <summary>value / perUnit · 2^bits to nearest, ties away from zero, clamped; perUnit 1 … 10^9, bits 0 … 32.</summary>
        public static long Raw64(long value, long perUnit, int bits)
        {
            ulong per = (ulong)perUnit, size = Size(value), limit = Limit(value), whole = size / per, raw = limit;
            if (whole <= limit >> bits)
                raw = Math.Min((whole << bits) + (((size % per) << bits) + per / 2) / per, limit);
            return Signed(raw, value < 0);
        }

        public static int Raw32(long value, long perUnit, int bits)
        {
            return (int)Math.Max(int.MinValue, Math.Min(int.MaxValue, Raw64(value, perUnit, bits)));
        }

        /// <summary>raw · perUnit · 2^-bits, rounded and clamped in the same way.</summary>
        public static long Whole(long raw, long perUnit, int bits)
        {
            ulong per = (ulong)perUnit, size = Size(raw), limit = Limit(raw), value = limit;
            ulong rest = size & ((1UL << bits) - 1), half = bits > 0 ? 1UL << (bits - 1) : 0;
            if (size >> bits <= limit / per)
                value = Math.Min((size >> bits) * per + ((rest * per + half) >> bits), limit);
            return Signed(value, raw < 0);
        }

        static ulong Size(long value) => value < 0 ? 0UL - (ulong)value : (ulong)value;
        static ulong Limit(long value) => (ulong)long.MaxValue + (value < 0 ? 1UL : 0UL);
        static long Signed(ulong size, bool negative) => negative ? (long)(0UL - size) : (long)size;

        public static long PositionMm(long mm) => Raw64(mm, 1000, Native.LKS_POSITION_BITS);
        public static long PositionToMm(long raw) => Whole(raw, 1000, Native.LKS_POSITION_BITS);
        public static int LengthMm(long mm) => Raw32(mm, 1000, Native.LKS_LENGTH_BITS);
        public static long VelocityMmS(long mmS) => Raw64(mmS, 1000, Native.LKS_VELOCITY_BITS);
        public static long VelocityToMmS(long raw) => Whole(raw, 1000, Native.LKS_VELOCITY_BITS);
        public static long AccelerationMmS2(long mmS2) => Raw64(mmS2, 1000, Native.LKS_ACCELERATION_BITS);
        public static long ImpulseMns(long mns) => Raw64(mns, 1000, Native.LKS_IMPULSE_BITS);
        public static long ForceMn(long mn) => Raw64(mn, 1000, Native.LKS_FORCE_BITS);
        public static int UnitMilli(long thousandths) => Raw32(thousandths, 1000, Native.LKS_UNIT_BITS);
        public static int NumberMilli(long thousandths) => Raw32(thousandths, 1000, Native.LKS_NUMBER_BITS);
        public static int RateMilli(long thousandths) => Raw32(thousandths, 1000, Native.LKS_RATE_BITS);
        public static int DensityKgM3(long kgM3) => Raw32(kgM3, 1, Native.LKS_DENSITY_BITS);

        public static lks_i64x3 Vec64(long x, long y, long z) => new lks_i64x3 { x = x, y = y, z = z };
        public static lks_i32x3 Vec32(int x, int y, int z) => new lks_i32x3 { x = x, y = y, z = z };

        /// <summary>Decimal text ("-9.81") · 2^bits, rounded to nearest.</summary>
        public static long Decimal(string text, int bits)
        {
            long raw;
            fixed (byte* bytes = Call.Bytes(text)) Call.Check(Native.lks_from_decimal(bytes, bits, &raw));
            return raw;
        }

        /// <summary>For drawing alone: nothing computed from it belongs into a world.</summary>
        public static double ToDouble(long raw, int bits) => raw / (double)(1L << bits);
    }

    /// <summary>Shapes, by their sizes.</summary>
    public static class Shape
    {
        static lks_shape Of(uint kind, int x, int y, int z, ulong asset = 0)
        {
            return new lks_shape { kind = kind, size = Units.Vec32(x, y, z), asset = asset };
        }

        public static lks_shape Sphere(int radius) => Of(Native.LKS_SPHERE, radius, 0, 0);
        public static lks_shape Capsule(int halfHeight, int radius) => Of(Native.LKS_CAPSULE, radius, halfHeight, 0);
        public static lks_shape Box(int halfX, int halfY, int halfZ) => Of(Native.LKS_BOX, halfX, halfY, halfZ);
        public static lks_shape Cylinder(int halfHeight, int radius) => Of(Native.LKS_CYLINDER, radius, halfHeight, 0);
        public static lks_shape Cone(int height, int radius) => Of(Native.LKS_CONE, radius, height, 0);
        /// <summary>The hull of two balls along y, whose centres are the height apart.</summary>
        public static lks_shape TaperedCapsule(int height, int bottomRadius, int topRadius) =>
            Of(Native.LKS_TAPERED_CAPSULE, bottomRadius, height, topRadius);
        /// <summary>A box of these half extents, and all within the radius of it.</summary>
        public static lks_shape RoundedBox(int halfX, int halfY, int halfZ, int radius) =>
            Of(Native.LKS_ROUNDED_BOX, halfX, halfY, halfZ, (uint)radius);
        public static lks_shape HalfSpace() => Of(Native.LKS_HALF_SPACE, 0, 0, 0);
        /// <summary>Of an asset: <c>Native.LKS_HULL</c>, <c>LKS_MESH</c>, <c>LKS_HEIGHT_FIELD</c>, <c>LKS_COMPOUND</c>.</summary>
        public static lks_shape Asset(uint kind, ulong name) => Of(kind, 0, 0, 0, name);
    }

    /// <summary>Structures that begin with the library's defaults.</summary>
    public static unsafe class Defaults
    {
        static UIntPtr SizeOf<T>() where T : struct => (UIntPtr)System.Runtime.InteropServices.Marshal.SizeOf<T>();

        public static lks_world_def World()
        {
            lks_world_def def;
            Call.Check(Native.lks_world_def_init(&def, SizeOf<lks_world_def>()));
            return def;
        }

        public static lks_body_def Body()
        {
            lks_body_def def;
            Call.Check(Native.lks_body_def_init(&def, SizeOf<lks_body_def>()));
            return def;
        }

        /// <summary>kind: <c>Native.LKS_JOINT_…</c>, which locks and frees the axes.</summary>
        public static lks_joint_def Joint(uint kind, ulong a, ulong b)
        {
            lks_joint_def def;
            Call.Check(Native.lks_joint_def_init(&def, SizeOf<lks_joint_def>(), kind, a, b));
            return def;
        }

        public static lks_query_filter Filter()
        {
            lks_query_filter filter;
            Call.Check(Native.lks_query_filter_init(&filter, SizeOf<lks_query_filter>()));
            return filter;
        }

        public static lks_enet_def Socket()
        {
            lks_enet_def def;
            Call.Check(Native.lks_enet_def_init(&def, SizeOf<lks_enet_def>()));
            return def;
        }

        public static lks_server_def Server()
        {
            lks_server_def def;
            Call.Check(Native.lks_server_def_init(&def, SizeOf<lks_server_def>()));
            return def;
        }

        public static lks_client_def Client(string name = "")
        {
            lks_client_def def;
            Call.Check(Native.lks_client_def_init(&def, SizeOf<lks_client_def>()));
            Call.Put(name, def.name, 33);
            return def;
        }

        public static lks_recorder_def Recorder()
        {
            lks_recorder_def def;
            Call.Check(Native.lks_recorder_def_init(&def, SizeOf<lks_recorder_def>()));
            return def;
        }
    }
}
