// The kernels, compiled for every target that Highway offers here.
#include "core/math/wide/highway_setup.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/kernels/highway_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "core/kernels/kernel_table.h"

// Highway's fallback targets have one lane and other rules for products: our scalar twins replace
// them.
#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
#include "core/kernels/ball/ball_block_inl.h"
#include "core/kernels/box/box_block_inl.h"
#include "core/kernels/contact/manifold_bounce_inl.h"
#include "core/kernels/contact/manifold_iterate_inl.h"
#include "core/kernels/contact/manifold_prepare_inl.h"
#include "core/kernels/contact/manifold_relax_inl.h"
#include "core/kernels/points/points_inl.h"
#include "core/kernels/proximal/proximal_inl.h"
#include "core/kernels/proximal/proximal_matrix_inl.h"
#include "core/kernels/rotations/rotations_inl.h"
#endif

#if HWY_ONCE
namespace lockstone::lanes {
namespace {

#define LKS_BLOCK_KERNELS(target)                                                                  \
  constexpr ManifoldKernels k_manifolds_##target{target::prepare_manifolds,                        \
                                                 target::solve_manifolds, target::relax_manifolds, \
                                                 target::bounce_manifolds};                        \
  constexpr BallKernels k_balls_##target{target::begin_balls, target::solve_ball_positions,        \
                                         target::update_balls};                                    \
  constexpr BoxKernels k_boxes_##target{target::meet_boxes, target::place_points};

#define LKS_ISLAND_KERNELS(target)                                                       \
  constexpr ProximalKernels                                                              \
      k_islands{target::magnitudes,     target::begin_phase,      target::pass,          \
                target::find_residuals, target::add_right_sides,  target::propose,       \
                target::add_changes,    target::update_residuals, target::couple,        \
                target::add_to_matrix,  target::add_rows,         target::subtract_rows, \
                target::row_products,   target::eliminate,        target::solve_down,    \
                target::solve_up};                                                       \
  constexpr const ProximalKernels* k_island_kernels = &k_islands;

#if defined(__x86_64__) && HWY_TARGETS & HWY_AVX2
LKS_ISLAND_KERNELS(N_AVX2)
#elif HWY_TARGETS & HWY_NEON
LKS_ISLAND_KERNELS(N_NEON)
#elif HWY_TARGETS & HWY_WASM
LKS_ISLAND_KERNELS(N_WASM)
#else
constexpr const ProximalKernels* k_island_kernels = &k_scalar_proximal;
#endif

#if defined(__x86_64__)
#if HWY_TARGETS & HWY_SSE4
LKS_BLOCK_KERNELS(N_SSE4)
#endif
#if HWY_TARGETS & HWY_AVX2
LKS_BLOCK_KERNELS(N_AVX2)
#endif
#if HWY_TARGETS & HWY_AVX3
LKS_BLOCK_KERNELS(N_AVX3)
#endif
#elif HWY_TARGETS & HWY_NEON
LKS_BLOCK_KERNELS(N_NEON)
#elif HWY_TARGETS & HWY_WASM
LKS_BLOCK_KERNELS(N_WASM)
#endif

constexpr Kernels k_tables[] = {
#if defined(__x86_64__)
#if HWY_TARGETS & HWY_SSE4
    {"sse4", N_SSE4::k_lanes, N_SSE4::compute_rotations, N_SSE4::farthest_point,
     N_SSE4::extent_along, N_SSE4::heights_above, N_SSE4::mark_at_least, &k_manifolds_N_SSE4,
     &k_balls_N_SSE4, &k_boxes_N_SSE4, &k_scalar_proximal},
#endif
#if HWY_TARGETS & HWY_AVX2
    {"avx2", N_AVX2::k_lanes, N_AVX2::compute_rotations, N_AVX2::farthest_point,
     N_AVX2::extent_along, N_AVX2::heights_above, N_AVX2::mark_at_least, &k_manifolds_N_AVX2,
     &k_balls_N_AVX2, &k_boxes_N_AVX2, k_island_kernels},
#endif
#if HWY_TARGETS & HWY_AVX3
    {"avx512", N_AVX3::k_lanes, N_AVX3::compute_rotations, N_AVX3::farthest_point,
     N_AVX3::extent_along, N_AVX3::heights_above, N_AVX3::mark_at_least, &k_manifolds_N_AVX3,
     &k_balls_N_AVX3, &k_boxes_N_AVX3, k_island_kernels},
#endif
#elif HWY_TARGETS & HWY_NEON
    {"neon", N_NEON::k_lanes, N_NEON::compute_rotations, N_NEON::farthest_point,
     N_NEON::extent_along, N_NEON::heights_above, N_NEON::mark_at_least, &k_manifolds_N_NEON,
     &k_balls_N_NEON, &k_boxes_N_NEON, k_island_kernels},
#elif HWY_TARGETS & HWY_WASM
    {"wasm", N_WASM::k_lanes, N_WASM::compute_rotations, N_WASM::farthest_point,
     N_WASM::extent_along, N_WASM::heights_above, N_WASM::mark_at_least, &k_manifolds_N_WASM,
     &k_balls_N_WASM, &k_boxes_N_WASM, k_island_kernels},
#endif
    {},
};

}  // namespace

const Kernels* highway_kernels(std::string_view target) {
  for (const Kernels& table : k_tables) {
    if (table.target == target) return &table;
  }
  return nullptr;
}

}  // namespace lockstone::lanes
#endif  // HWY_ONCE
