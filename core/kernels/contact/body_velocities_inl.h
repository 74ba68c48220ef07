// The bodies of as many contacts as there are lanes, read from and written to BodyVelocity records.
#if defined(LKS_WIDE_ROW_BODIES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef LKS_WIDE_ROW_BODIES_INL_H
#undef LKS_WIDE_ROW_BODIES_INL_H
#else
#define LKS_WIDE_ROW_BODIES_INL_H
#endif

#include "core/kernels/contact/contact_rows.h"
#ifdef LKS_SCALAR_TWIN
#include "core/math/wide/lanes_scalar_inl.h"
#else
#include "core/math/wide/lanes_inl.h"
#endif

HWY_BEFORE_NAMESPACE();
namespace lockstone::lanes {
namespace HWY_NAMESPACE {

/// One body of each contact, or another record of the same form.
struct BodyLanes {
  Lanes velocity[3];
  Lanes spin[3];
};

HWY_INLINE HWY_ATTR void load_bodies(const std::int64_t* bodies, const std::uint32_t* index,
                                     BodyLanes& x) {
  using At = RecordsAt<const std::int64_t>;
  load_two(At{bodies, index, 1}, x.velocity[0], x.velocity[1]);
  load_two(At{bodies + 2, index, 1}, x.velocity[2], x.spin[0]);
  load_two(At{bodies + 4, index, 1}, x.spin[1], x.spin[2]);
}

HWY_INLINE HWY_ATTR void store_bodies(const BodyLanes& x, std::int64_t* bodies,
                                      const std::uint32_t* index) {
  using At = RecordsAt<std::int64_t>;
  store_two(x.velocity[0], x.velocity[1], At{bodies, index, 1});
  store_two(x.velocity[2], x.spin[0], At{bodies + 2, index, 1});
  store_two(x.spin[1], x.spin[2], At{bodies + 4, index, 1});
}

}  // namespace HWY_NAMESPACE
}  // namespace lockstone::lanes
HWY_AFTER_NAMESPACE();

#endif  // the guard
