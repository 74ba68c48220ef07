#include "tools/numerics/bench.h"

#if defined(LOCKSTONE_HAVE_MPFR)

#include <cstring>

#include <mpfr.h>

namespace lockstone::numerics {
namespace {

using Unary = int (*)(mpfr_ptr, mpfr_srcptr, mpfr_rnd_t);
using Binary = int (*)(mpfr_ptr, mpfr_srcptr, mpfr_srcptr, mpfr_rnd_t);

constexpr mpfr_prec_t k_precision = 160;

int reciprocal(mpfr_ptr result, mpfr_srcptr x, mpfr_rnd_t rounding) {
  return mpfr_ui_div(result, 1, x, rounding);
}

struct Entry {
  const char* name;
  Unary unary;
  Binary binary;
};

constexpr Entry k_entries[] = {
    {"mul", nullptr, mpfr_mul},          {"div", nullptr, mpfr_div},
    {"reciprocal", reciprocal, nullptr}, {"sqrt", mpfr_sqrt, nullptr},
    {"rsqrt", mpfr_rec_sqrt, nullptr},   {"hypot", nullptr, mpfr_hypot},
    {"exp2", mpfr_exp2, nullptr},        {"log2", mpfr_log2, nullptr},
    {"sin", mpfr_sin, nullptr},          {"cos", mpfr_cos, nullptr},
    {"tan", mpfr_tan, nullptr},          {"asin", mpfr_asin, nullptr},
    {"acos", mpfr_acos, nullptr},        {"atan", mpfr_atan, nullptr},
    {"atan2", nullptr, mpfr_atan2},
};

}  // namespace

const char* exact_source() {
  return "MPFR, 160 bits";
}

bool exact_value(const std::string& function, long double x, long double y, long double& value) {
  for (const Entry& entry : k_entries) {
    if (function != entry.name) continue;
    mpfr_t a, b;
    mpfr_init2(a, k_precision);
    mpfr_init2(b, k_precision);
    mpfr_set_ld(a, x, MPFR_RNDN);
    mpfr_set_ld(b, y, MPFR_RNDN);
    entry.unary != nullptr ? entry.unary(a, a, MPFR_RNDN) : entry.binary(a, a, b, MPFR_RNDN);
    value = mpfr_get_ld(a, MPFR_RNDN);
    mpfr_clears(a, b, nullptr);
    return true;
  }
  return false;
}

}  // namespace lockstone::numerics

#else

namespace lockstone::numerics {

const char* exact_source() {
  return "libm, long double";
}

bool exact_value(const std::string&, long double, long double, long double&) {
  return false;
}

}  // namespace lockstone::numerics

#endif
