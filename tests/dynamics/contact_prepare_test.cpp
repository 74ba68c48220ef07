// How softly a contact begins.
#include "core/dynamics/contact/contact_prepare.h"

#include <gtest/gtest.h>

namespace lockstone {
namespace {

class ContactPrepare : public ::testing::Test {
 protected:
  ContactPrepare() { body_.inverse_mass.mantissa = 1 << 30; }

  // Of a contact of two points, one of them as far as can be.
  [[nodiscard]] std::int32_t kept_at(Displacement separation) const {
    Manifold manifold;
    manifold.count = 2;
    manifold.points[0].separation = Displacement::max();
    manifold.points[1].separation = separation;
    const ContactRecord record;
    const ContactSurface surface;
    lanes::PrepareInput source;
    (void)fill_source({body_, body_, manifold, record, surface, true}, softness_, source);
    return source.keep;
  }

  [[nodiscard]] static constexpr Displacement mm(int x) {
    return Displacement::from_ratio(x, 1000);
  }

  SolverBody body_;
  const ContactSoftness softness_ = ContactSoftness::of(TimeStep::of(60, 4));
};

TEST_F(ContactPrepare, KeepsItsShareUpToThreeMillimetres) {
  for (const Displacement separation : {Displacement::max(), mm(20), mm(0), -mm(1), -mm(3)})
    EXPECT_EQ(kept_at(separation), softness_.between_moving.mass_scale) << separation.raw;
}

TEST_F(ContactPrepare, OfAPinchedIslandKeepsLessTheDeeperItIsAndHalfFromSixMillimetres) {
  std::int32_t before = softness_.between_moving.mass_scale;
  for (const int tenths : {31, 40, 50, 59}) {
    const std::int32_t kept = kept_at(Displacement::from_ratio(-tenths, 10'000));
    EXPECT_LT(kept, before) << tenths;
    before = kept;
  }
  for (const Displacement separation : {-mm(6), -mm(100), Displacement::min()})
    EXPECT_NEAR(kept_at(separation), 1 << 29, 1 << 14) << separation.raw;
}

}  // namespace
}  // namespace lockstone
