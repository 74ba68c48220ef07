// The kernel of contact rows on every target. It has a file and a table of its own, so that
// programs which solve no rows do not link it: manifolds are solved by manifold_block.h.
#if defined(LOCKSTONE_WITH_HIGHWAY)
#include "core/math/wide/highway_setup.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/kernels/row_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
#else
#define HWY_ONCE 1
#endif

#include <algorithm>
#include <string_view>

#include "core/kernels/contact/contact_rows.h"
#include "core/kernels/target.h"

#if defined(LOCKSTONE_WITH_HIGHWAY) && HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
#include "core/kernels/contact/contact_rows_inl.h"
#endif

#if HWY_ONCE
namespace lockstone::lanes {
namespace {

struct RowKernel {
  std::string_view target;
  void (*solve)(BodyVelocity* bodies, ContactBlock* blocks, std::size_t count);
};

constexpr RowKernel k_row_kernels[] = {
#if defined(LOCKSTONE_WITH_HIGHWAY) && defined(__x86_64__)
#if HWY_TARGETS & HWY_SSE4
    {"sse4", N_SSE4::solve_contact_rows},
#endif
#if HWY_TARGETS & HWY_AVX2
    {"avx2", N_AVX2::solve_contact_rows},
#endif
#if HWY_TARGETS & HWY_AVX3
    {"avx512", N_AVX3::solve_contact_rows},
#endif
#elif defined(LOCKSTONE_WITH_HIGHWAY) && HWY_TARGETS & HWY_NEON
    {"neon", N_NEON::solve_contact_rows},
#elif defined(LOCKSTONE_WITH_HIGHWAY) && HWY_TARGETS & HWY_WASM
    {"wasm", N_WASM::solve_contact_rows},
#endif
    {"scalar", solve_contact_rows_scalar},
};

}  // namespace

void solve_contact_rows(std::span<BodyVelocity> bodies, std::span<ContactBlock> blocks) {
  const auto at = std::ranges::find(k_row_kernels, current_target(), &RowKernel::target);
  at->solve(bodies.data(), blocks.data(), blocks.size());
}

}  // namespace lockstone::lanes
#endif  // HWY_ONCE
