// Every kind of joint is the same through the C interface as in the core.
#include <gtest/gtest.h>

#include "tests/bindings/twin_worlds.h"

namespace lockstone {
namespace {

using namespace lockstone::literals;

// Two bodies of their own and a joint of this kind between them.
class JointsThroughC : public TwinScene {
 protected:
  static constexpr Vec3<Length> k_anchor{0.25_m, 0.5_m, 0_m};

  void SetUp() override {
    TwinScene::SetUp();
    for (std::uint32_t kind = LKS_JOINT_DISTANCE; kind <= LKS_JOINT_PATH; ++kind)
      add_joint(kind);
  }

  void add_joint(std::uint32_t kind) {
    const int place = 30 + 6 * static_cast<int>(kind);
    const BodyHandle a = add(MotionType::dynamic, Shape::sphere(1_m), place, 10);
    const BodyHandle b = add(MotionType::dynamic, Shape::box(1_m, 0.5_m, 1_m), place + 2, 10);
    JointDef def = JointDef::of(static_cast<JointKind>(kind), a, b);
    lks_joint_def raw;
    ASSERT_EQ(lks_joint_def_init(&raw, sizeof raw, kind, c::id_of(a), c::id_of(b)), LKS_OK);
    def.frame_a.position = k_anchor;
    raw.frame_a.position = c::raw_of(k_anchor);
    def.frame_b.position = k_anchor - Vec3<Length>{2_m, 0_m, 0_m};  // the same place
    raw.frame_b.position = c::raw_of(def.frame_b.position);
    def.ground_a = def.ground_b = {0_m, 20_m, 0_m};
    raw.ground_a = raw.ground_b = c::raw_of(def.ground_a);
    def.linear[0].upper = 6_m;
    raw.linear[0].upper = def.linear[0].upper.raw;
    def.angular[0].max_effort = 50_Nm;
    raw.angular[0].max_effort = def.angular[0].max_effort.raw;
    def.break_force = Force::from_integer(100'000'000);
    raw.break_force = def.break_force.raw;
    def.collide = true;
    raw.collide = 1;
    def.user_data = raw.user_data = kind;
    def.path = path_;
    raw.path = path_.value;
    const Result<JointHandle> made = world_->create_joint(def);
    lks_joint id = 0;
    expect_same(made.status(), lks_create_joint(twin_, &raw, &id), "create joint");
    ASSERT_TRUE(made.ok()) << kind;
    EXPECT_EQ(id, c::id_of(made.value()));
    joints_.push_back(made.value());
    step(3);
  }

  std::vector<JointHandle> joints_;
};

TEST_F(JointsThroughC, OfEveryKindGiveTheSameState) {
  EXPECT_EQ(joints_.size(), 13U);
}

TEST_F(JointsThroughC, ViewsShowTheJointAsTheCoreDoes) {
  for (const JointHandle joint : joints_) {
    const JointView view = world_->joint(joint);
    lks_joint_view raw{};
    raw.size = sizeof raw;
    ASSERT_EQ(lks_joint_get(twin_, c::id_of(joint), &raw), LKS_OK);
    EXPECT_EQ(c::vec<Length>(raw.offset), view.offset);
    EXPECT_EQ(c::vec<Angle>(raw.angle), view.angle);
    EXPECT_EQ(c::vec<Force>(raw.force), view.force);
    EXPECT_EQ(raw.user_data, view.user_data);
  }
}

TEST_F(JointsThroughC, AxesAreSetAlike) {
  const LinearAxis spring{.target = 1_m, .hertz = Number::from_integer(3)};
  const lks_axis raw_spring{LKS_AXIS_FREE,        0, 0, Length(1_m).raw, 0, 3 << LKS_NUMBER_BITS,
                            1 << LKS_NUMBER_BITS, 0, 0};
  const AngularAxis motor{.speed = Rate::from_integer(2), .max_effort = 80_Nm};
  const lks_axis raw_motor{
      LKS_AXIS_FREE, 0, 0, 0, 2 << LKS_RATE_BITS, 0, 1 << LKS_NUMBER_BITS, 0, Torque(80_Nm).raw};
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const auto axis = static_cast<std::uint8_t>(i % 3);
    const lks_joint id = c::id_of(joints_[i]);
    expect_same(world_->apply(SetLinearAxis{joints_[i], axis, spring}),
                lks_set_linear_axis(twin_, id, axis, &raw_spring), "linear axis");
    expect_same(world_->apply(SetAngularAxis{joints_[i], axis, motor}),
                lks_set_angular_axis(twin_, id, axis, &raw_motor), "angular axis");
  }
  step(10);
}

TEST_F(JointsThroughC, AreDestroyedAlike) {
  expect_same(world_->apply(DestroyJoint{joints_[0]}),
              lks_destroy_joint(twin_, c::id_of(joints_[0])), "destroy joint");
  step(10);
}

}  // namespace
}  // namespace lockstone
