/* Quantities: raw fixed-point integers, and exact conversions from and to whole numbers. */
#ifndef LOCKSTONE_C_UNITS_H
#define LOCKSTONE_C_UNITS_H

#include "base.h"

#ifdef __cplusplus
#ifdef __GNUC__
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wold-style-cast"
#endif
extern "C" {
#endif

/* Bits behind the binary point: 1 m is `1 << LKS_POSITION_BITS` as an lks_position. */
enum {
  LKS_POSITION_BITS = 32,
  LKS_VELOCITY_BITS = 32,
  LKS_ANGULAR_VELOCITY_BITS = 32,
  LKS_ACCELERATION_BITS = 32,
  LKS_MASS_BITS = 32,
  LKS_IMPULSE_BITS = 24,
  LKS_FORCE_BITS = 20,
  LKS_LENGTH_BITS = 20,
  LKS_SPEED_BITS = 20,
  LKS_DISPLACEMENT_BITS = 24,
  LKS_UNIT_BITS = 30,
  LKS_NUMBER_BITS = 20,
  LKS_RATE_BITS = 20,
  LKS_ANGLE_BITS = 27,
  LKS_DENSITY_BITS = 8,
  LKS_INERTIA_BITS = 28
};

typedef int64_t lks_position;         /* m */
typedef int64_t lks_velocity;         /* m/s */
typedef int64_t lks_angular_velocity; /* rad/s */
typedef int64_t lks_acceleration;     /* m/s² */
typedef int64_t lks_mass;             /* kg */
typedef int64_t lks_inertia;          /* kg·m² */
typedef int64_t lks_impulse;          /* N·s; of angular ones N·m·s */
typedef int64_t lks_force;            /* N; of torques N·m */
typedef int32_t lks_length;           /* m, ±2048: sizes, anchors, rays */
typedef int32_t lks_speed;            /* m/s, ±2048: motors, belts */
typedef int32_t lks_displacement;     /* m, ±128: separations */
typedef int32_t lks_unit;             /* ±2: unit vectors, rotations, friction, fractions */
typedef int32_t lks_number;           /* ±2048: ratios, hertz, scales */
typedef int32_t lks_rate;             /* 1/s or rad/s, ±2048 */
typedef int32_t lks_angle;            /* rad, ±16 */
typedef int32_t lks_density;          /* kg/m³ */

typedef struct lks_i64x3 {
  int64_t x, y, z;
} lks_i64x3;
typedef struct lks_i32x3 {
  int32_t x, y, z;
} lks_i32x3;

typedef lks_i64x3 lks_position3;
typedef lks_i64x3 lks_velocity3;
typedef lks_i64x3 lks_angular_velocity3;
typedef lks_i64x3 lks_acceleration3;
typedef lks_i64x3 lks_inertia3;
typedef lks_i64x3 lks_impulse3;
typedef lks_i64x3 lks_force3;
typedef lks_i32x3 lks_length3;
typedef lks_i32x3 lks_speed3;
typedef lks_i32x3 lks_unit3;
typedef lks_i32x3 lks_number3;
typedef lks_i32x3 lks_rate3;
typedef lks_i32x3 lks_angle3;

/* A rotation; functions that take one normalise it. All zero is refused. */
typedef struct lks_quat {
  lks_unit x, y, z, w;
} lks_quat;

typedef struct lks_pose {
  lks_position3 position;
  lks_quat orientation;
} lks_pose;

/* The rotation by `angle` about an axis, which is normalised. LKS_INVALID_ARGUMENT for no axis. */
LKS_API lks_status lks_quat_from_axis_angle(const lks_unit3* axis, lks_angle angle, lks_quat* out);

/* numerator / denominator · 2^bits to nearest, ties away from zero; bits 0 … 62.
 * LKS_INVALID_ARGUMENT where the denominator is 0 or the result does not fit. */
LKS_API lks_status lks_from_ratio(int64_t numerator, int64_t denominator, int32_t bits,
                                  int64_t* out);

/* Decimal text ("-9.81") · 2^bits, rounded in the same way. LKS_MALFORMED for other text. */
LKS_API lks_status lks_from_decimal(const char* text, int32_t bits, int64_t* out);

/* The shortest decimal that gives the same raw value: bits 0 … 44. Writes a terminated string. */
LKS_API lks_status lks_to_decimal(int64_t raw, int32_t bits, char* out, size_t capacity);

/* value / per_unit · 2^bits to nearest, ties away from zero, clamped to int64: per_unit 1 … 10^9,
 * bits 0 … 32. A position of 1500 mm: lks_raw64(1500, 1000, LKS_POSITION_BITS). */
static inline int64_t lks_raw64(int64_t value, int64_t per_unit, int bits) {
  const uint64_t per = (uint64_t)per_unit;
  const uint64_t size = value < 0 ? 0 - (uint64_t)value : (uint64_t)value;
  const uint64_t limit = (uint64_t)INT64_MAX + (value < 0 ? 1u : 0u);
  const uint64_t whole = size / per;
  uint64_t raw = limit;
  if (whole <= limit >> bits) {
    raw = (whole << bits) + (((size % per) << bits) + per / 2) / per;
    raw = raw < limit ? raw : limit;
  }
  if (value >= 0) return (int64_t)raw;
  return raw == 0 ? 0 : -(int64_t)(raw - 1) - 1;
}

/* The same, clamped to int32. */
static inline int32_t lks_raw32(int64_t value, int64_t per_unit, int bits) {
  const int64_t raw = lks_raw64(value, per_unit, bits);
  return (int32_t)(raw > INT32_MAX ? INT32_MAX : raw < INT32_MIN ? INT32_MIN : raw);
}

/* raw · per_unit · 2^-bits, rounded and clamped in the same way. */
static inline int64_t lks_whole(int64_t raw, int64_t per_unit, int bits) {
  const uint64_t per = (uint64_t)per_unit;
  const uint64_t size = raw < 0 ? 0 - (uint64_t)raw : (uint64_t)raw;
  const uint64_t limit = (uint64_t)INT64_MAX + (raw < 0 ? 1u : 0u);
  const uint64_t rest = size & (((uint64_t)1 << bits) - 1);
  const uint64_t half = bits > 0 ? (uint64_t)1 << (bits - 1) : 0;
  uint64_t value = limit;
  if (size >> bits <= limit / per) {
    value = (size >> bits) * per + ((rest * per + half) >> bits);
    value = value < limit ? value : limit;
  }
  if (raw >= 0) return (int64_t)value;
  return value == 0 ? 0 : -(int64_t)(value - 1) - 1;
}

static inline lks_position lks_position_mm(int64_t mm) {
  return lks_raw64(mm, 1000, LKS_POSITION_BITS);
}
static inline lks_position lks_position_um(int64_t um) {
  return lks_raw64(um, 1000000, LKS_POSITION_BITS);
}
static inline int64_t lks_position_to_mm(lks_position raw) {
  return lks_whole(raw, 1000, LKS_POSITION_BITS);
}
static inline int64_t lks_position_to_um(lks_position raw) {
  return lks_whole(raw, 1000000, LKS_POSITION_BITS);
}
static inline lks_length lks_length_mm(int64_t mm) {
  return lks_raw32(mm, 1000, LKS_LENGTH_BITS);
}
static inline lks_length lks_length_um(int64_t um) {
  return lks_raw32(um, 1000000, LKS_LENGTH_BITS);
}
static inline int64_t lks_length_to_um(lks_length raw) {
  return lks_whole(raw, 1000000, LKS_LENGTH_BITS);
}
static inline lks_velocity lks_velocity_mm_s(int64_t mm_s) {
  return lks_raw64(mm_s, 1000, LKS_VELOCITY_BITS);
}
static inline int64_t lks_velocity_to_mm_s(lks_velocity raw) {
  return lks_whole(raw, 1000, LKS_VELOCITY_BITS);
}
static inline lks_angular_velocity lks_angular_velocity_mrad_s(int64_t mrad_s) {
  return lks_raw64(mrad_s, 1000, LKS_ANGULAR_VELOCITY_BITS);
}
static inline lks_acceleration lks_acceleration_mm_s2(int64_t mm_s2) {
  return lks_raw64(mm_s2, 1000, LKS_ACCELERATION_BITS);
}
static inline lks_impulse lks_impulse_mns(int64_t mns) { /* mN·s, mN·m·s */
  return lks_raw64(mns, 1000, LKS_IMPULSE_BITS);
}
static inline lks_force lks_force_mn(int64_t mn) { /* mN, mN·m */
  return lks_raw64(mn, 1000, LKS_FORCE_BITS);
}
static inline lks_speed lks_speed_mm_s(int64_t mm_s) {
  return lks_raw32(mm_s, 1000, LKS_SPEED_BITS);
}
static inline lks_unit lks_unit_milli(int64_t thousandths) {
  return lks_raw32(thousandths, 1000, LKS_UNIT_BITS);
}
static inline lks_number lks_number_milli(int64_t thousandths) {
  return lks_raw32(thousandths, 1000, LKS_NUMBER_BITS);
}
static inline lks_rate lks_rate_milli(int64_t thousandths) {
  return lks_raw32(thousandths, 1000, LKS_RATE_BITS);
}
static inline lks_density lks_density_kg_m3(int64_t kg_m3) {
  return lks_raw32(kg_m3, 1, LKS_DENSITY_BITS);
}
/* 5030569068109 is π / 180000 · 2^58. Clamped to ±16 rad. */
static inline lks_angle lks_angle_mdeg(int32_t thousandths) {
  const uint64_t most = 916732;
  const uint64_t wanted =
      thousandths < 0 ? 0 - (uint64_t)(int64_t)thousandths : (uint64_t)thousandths;
  const uint64_t size = wanted < most ? wanted : most;
  const int64_t raw = (int64_t)((size * 5030569068109u + ((uint64_t)1 << 30)) >> 31);
  return (lks_angle)(thousandths < 0 ? -raw : raw);
}

static inline lks_quat lks_quat_identity(void) {
  const lks_quat identity = {0, 0, 0, (lks_unit)1 << LKS_UNIT_BITS};
  return identity;
}

/* Floating point is for drawing: nothing computed from it belongs into a world. */
#ifndef LKS_NO_FLOATING_POINT
static inline double lks_to_double(int64_t raw, int bits) {
  return (double)raw / (double)((int64_t)1 << bits);
}
#endif

#ifdef __cplusplus
}
#ifdef __GNUC__
#pragma GCC diagnostic pop
#endif
#endif
#endif
