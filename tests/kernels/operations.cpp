// The operations of lanes_inl.h behind the table of operations.h, for every target.
#include "core/math/wide/highway_setup.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/kernels/operations.cpp"
#include <iterator>

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "tests/kernels/operations.h"

#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
#include "core/math/wide/lanes_inl.h"

HWY_BEFORE_NAMESPACE();
namespace lockstone::lanes {
namespace HWY_NAMESPACE {

HWY_ATTR void test_compute(test::Operation operation, const test::Operands& in, test::Values& out) {
  const Lanes a = load(in.a.data()), b = load(in.b.data()), c = load(in.c.data());
  const Lanes shift = load(in.shift.data()), half = load(in.half.data());
  const Lanes far = load(in.far.data()), far_half = load(in.far_half.data());
  switch (operation) {
#define LKS_LANE_CASE(name, wide, ...) \
  case test::Operation::name:          \
    return store(wide, out.data());
    LKS_LANE_OPERATIONS(LKS_LANE_CASE)
#undef LKS_LANE_CASE
    case test::Operation::count:
      return;
  }
}

HWY_ATTR bool test_any_less(const test::Operands& in) {
  return any_less(load(in.a.data()), load(in.b.data()));
}
HWY_ATTR std::uint32_t test_bits_of_less(const test::Operands& in) {
  return bits_of_less(load(in.a.data()), load(in.b.data()));
}
HWY_ATTR void test_gather_64(const std::int64_t* base, const std::int64_t* index,
                             test::Values& out) {
  store(gather_64(base, index), out.data());
}
HWY_ATTR void test_scatter_64(const test::Values& x, std::int64_t* base,
                              const std::int64_t* index) {
  scatter_64(load(x.data()), base, index);
}
HWY_ATTR void test_gather_32(const std::int32_t* base, const std::int32_t* index,
                             test::Values& out) {
  store(gather_32(base, index), out.data());
}
HWY_ATTR void test_scatter_32(const test::Values& x, std::int32_t* base,
                              const std::int32_t* index) {
  scatter_32(load(x.data()), base, index);
}
HWY_ATTR void test_load_four(const std::int64_t* base, const std::uint32_t* index,
                             std::size_t stride, test::Values (&out)[4]) {
  Lanes words[4];
  load_four({base, index, stride}, words);
  for (int i = 0; i < 4; ++i)
    store(words[i], out[i].data());
}
HWY_ATTR void test_store_four(const test::Values (&x)[4], std::int64_t* base,
                              const std::uint32_t* index, std::size_t stride) {
  Lanes words[4];
  for (int i = 0; i < 4; ++i)
    words[i] = load(x[i].data());
  store_four(words, {base, index, stride});
}

}  // namespace HWY_NAMESPACE
}  // namespace lockstone::lanes
HWY_AFTER_NAMESPACE();
#endif

#if HWY_ONCE
namespace lockstone::lanes::test {
namespace {

#define LKS_TARGET(name, lanes, space)                                                \
  TargetOperations {                                                                  \
    name, lanes, space::test_compute, space::test_any_less, space::test_bits_of_less, \
        space::test_gather_64, space::test_scatter_64, space::test_gather_32,         \
        space::test_scatter_32, space::test_load_four, space::test_store_four         \
  }

const TargetOperations k_compiled[] = {
#if defined(__x86_64__)
#if HWY_TARGETS & HWY_SSE4
    LKS_TARGET("sse4", 2, N_SSE4),
#endif
#if HWY_TARGETS & HWY_AVX2
    LKS_TARGET("avx2", 4, N_AVX2),
#endif
#if HWY_TARGETS & HWY_AVX3
    LKS_TARGET("avx512", 8, N_AVX3),
#endif
#elif HWY_TARGETS & HWY_NEON
    LKS_TARGET("neon", 2, N_NEON),
#elif HWY_TARGETS & HWY_WASM
    LKS_TARGET("wasm", 2, N_WASM),
#endif
    {},  // an array needs something
};

}  // namespace

std::span<const TargetOperations> compiled_operations() {
  return std::span(k_compiled).first(std::size(k_compiled) - 1);
}

std::string_view name_of(Operation operation) {
  constexpr std::string_view k_names[] = {
#define LKS_LANE_NAME(name, ...) #name,
      LKS_LANE_OPERATIONS(LKS_LANE_NAME)
#undef LKS_LANE_NAME
          "count"};
  return k_names[static_cast<std::size_t>(operation)];
}

}  // namespace lockstone::lanes::test
#endif  // HWY_ONCE
