// Versions, status codes, units.
#include <algorithm>

#include <lockstone/decimal.h>
#include <lockstone/vector_math.h>
#include <lockstone/world.h>

#include "tools/bindings/c/convert.h"

namespace {

using namespace lockstone;
using namespace lockstone::c;

static_assert(LKS_NOT_FOUND == static_cast<int>(Status::not_found));
static_assert(LKS_POSITION_BITS == Position::frac_bits && LKS_VELOCITY_BITS == Velocity::frac_bits);
static_assert(LKS_ANGULAR_VELOCITY_BITS == AngularVelocity::frac_bits);
static_assert(LKS_ACCELERATION_BITS == Acceleration::frac_bits && LKS_MASS_BITS == Mass::frac_bits);
static_assert(LKS_IMPULSE_BITS == Impulse::frac_bits && LKS_FORCE_BITS == Force::frac_bits);
static_assert(LKS_IMPULSE_BITS == AngularImpulse::frac_bits && LKS_FORCE_BITS == Torque::frac_bits);
static_assert(LKS_LENGTH_BITS == Length::frac_bits && LKS_SPEED_BITS == SolverVelocity::frac_bits);
static_assert(LKS_DISPLACEMENT_BITS == Displacement::frac_bits && LKS_UNIT_BITS == Unit::frac_bits);
static_assert(LKS_NUMBER_BITS == Number::frac_bits && LKS_RATE_BITS == Rate::frac_bits);
static_assert(LKS_INERTIA_BITS == MomentOfInertia::frac_bits);
static_assert(LKS_ANGLE_BITS == Angle::frac_bits && LKS_DENSITY_BITS == Density::frac_bits);

void check_fraction_bits(std::int32_t bits, int most) {
  if (bits < 0 || bits > most) throw_invalid("bits", "must be 0 … " + std::to_string(most));
}

const char* own_name_of(lks_status status) {
  switch (status) {
    case LKS_NULL_ARGUMENT:
      return "null argument";
    case LKS_WRONG_SIZE:
      return "wrong size";
    case LKS_BUFFER_TOO_SMALL:
      return "buffer too small";
    case LKS_READ_ONLY:
      return "read only";
    case LKS_OUT_OF_MEMORY:
      return "out of memory";
    case LKS_INTERNAL:
      return "internal fault";
    case LKS_UNSUPPORTED:
      return "unsupported";
    default:
      return "unknown status";
  }
}

}  // namespace

const char* lks_status_name(lks_status status) {
  if (status < LKS_OK || status > LKS_NOT_FOUND) return own_name_of(status);
  return to_string(static_cast<Status>(status)).data();  // literals: they end with a zero
}

uint32_t lks_c_abi(void) {
  return LKS_C_ABI;
}

const char* lks_version(void) {
  return LOCKSTONE_VERSION;
}

uint32_t lks_simulation_abi(void) {
  return k_simulation_abi;
}

uint64_t lks_canary_hash(void) {
  return canary_hash();
}

lks_status lks_quat_from_axis_angle(const lks_unit3* axis, lks_angle angle, lks_quat* out) {
  return call([&] {
    const auto direction = normalized(vec<Unit>(required(axis, "axis")));
    if (direction == Vec3<Unit>{}) throw_invalid("axis", "must not be zero");
    required(out, "out") = raw_of(from_axis_angle(direction, Angle::from_raw(angle)));
  });
}

lks_status lks_from_ratio(int64_t numerator, int64_t denominator, int32_t bits, int64_t* out) {
  return call([&] {
    check_fraction_bits(bits, 62);
    if (denominator == 0) throw_invalid("denominator", "must not be 0");
    const raw::Ratio ratio = raw::divide(numerator, denominator, bits);
    if (!ratio.fits) throw_invalid("numerator", "the quotient does not fit in 64 bits");
    required(out, "out") = ratio.value;
  });
}

lks_status lks_from_decimal(const char* text, int32_t bits, int64_t* out) {
  return call([&] {
    check_fraction_bits(bits, 62);
    const ParsedDecimal parsed = parse_decimal_text(&required(text, "text"));
    if (!parsed.ok) throw_status(LKS_MALFORMED, std::string("not a decimal number: ") + text);
    const ScaledDecimal scaled = scale_decimal(parsed.value, bits);
    if (scaled.overflow) throw_invalid("text", "the number does not fit in 64 bits");
    required(out, "out") = scaled.value;
  });
}

lks_status lks_to_decimal(int64_t raw, int32_t bits, char* out, size_t capacity) {
  return call([&] {
    check_fraction_bits(bits, k_most_decimal_bits);
    required(out, "out");
    const std::string text = format_decimal(raw, bits);
    if (text.size() >= capacity) {
      throw_status(LKS_BUFFER_TOO_SMALL,
                   "the number needs " + std::to_string(text.size() + 1) + " bytes");
    }
    write_text(text, out, capacity);
  });
}
