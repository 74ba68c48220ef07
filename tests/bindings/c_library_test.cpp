// Versions, numbers, structures and logs through the C interface.
#include <array>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <lockstone.h>

#include <lockstone/fit.h>
#include <lockstone/hull.h>
#include <lockstone/literals.h>
#include <lockstone/replay/recorder.h>
#include <lockstone/replay/verifier.h>
#include <lockstone/shape_pair.h>

#include "tests/support/sample_level.h"
#include "tools/bindings/c/call.h"
#include "tools/scenes/play.h"
#include "tools/scenes/scene_simulation.h"

namespace lockstone {
namespace {

/// A structure as later versions might have it: `second` was appended.
struct Grown {
  std::uint32_t size;
  std::uint32_t first;
  std::uint64_t second;
};

}  // namespace

template <>
inline constexpr std::size_t c::k_first_size<Grown> = 8;

namespace {

using namespace lockstone::literals;

TEST(CLibrary, ItsVersionsAreThoseOfTheCore) {
  EXPECT_EQ(lks_c_abi(), static_cast<std::uint32_t>(LKS_C_ABI));
  EXPECT_EQ(lks_simulation_abi(), k_simulation_abi);
  EXPECT_EQ(lks_canary_hash(), canary_hash());
  EXPECT_STREQ(lks_version(), LOCKSTONE_VERSION);
}

template <class Enumerator>
void expect_same(int number, Enumerator enumerator) {
  EXPECT_EQ(number, static_cast<int>(enumerator)) << to_string(enumerator);
}

TEST(CLibrary, StatusesHaveTheNamesOfTheCore) {
  for (int i = LKS_OK; i <= LKS_NOT_FOUND; ++i)
    EXPECT_EQ(lks_status_name(i), std::string(to_string(static_cast<Status>(i))));
}

TEST(CLibrary, ShapesHaveTheNumbersOfTheCore) {
  expect_same(LKS_CAPSULE, ShapeKind::capsule);
  expect_same(LKS_BOX, ShapeKind::box);
  expect_same(LKS_HULL, ShapeKind::hull);
  expect_same(LKS_HALF_SPACE, ShapeKind::half_space);
  expect_same(LKS_MESH, ShapeKind::mesh);
  expect_same(LKS_HEIGHT_FIELD, ShapeKind::height_field);
  expect_same(LKS_COMPOUND, ShapeKind::compound);
  expect_same(LKS_CYLINDER, ShapeKind::cylinder);
  expect_same(LKS_CONE, ShapeKind::cone);
  expect_same(LKS_TAPERED_CAPSULE, ShapeKind::tapered_capsule);
  expect_same(LKS_ROUNDED_BOX, ShapeKind::rounded_box);
}

TEST(CLibrary, FitsTheShapesOfTheCore) {
  const std::vector<Vec3<Length>> points{{1_m, 2_m, {}}, {-1_m, 0.5_m, {}}, {{}, {}, 3_m}};
  std::vector<lks_length3> raw;
  for (const Vec3<Length>& point : points)
    raw.push_back({point.x.raw, point.y.raw, point.z.raw});
  lks_shape shape;
  lks_pose pose;
  ASSERT_EQ(lks_fit(LKS_CAPSULE, raw.data(), raw.size(), &shape, &pose), LKS_OK);
  const FittedShape fitted = fit_capsule(points).value();
  EXPECT_EQ(shape.kind, static_cast<std::uint32_t>(LKS_CAPSULE));
  EXPECT_EQ(shape.size.x, fitted.shape.size.x.raw);
  EXPECT_EQ(shape.size.y, fitted.shape.size.y.raw);
  EXPECT_EQ(pose.position.x, rounded<Position>(fitted.position.x).raw);
  EXPECT_EQ(pose.orientation.w, fitted.orientation.w.raw);
  EXPECT_EQ(lks_fit(LKS_HULL, raw.data(), raw.size(), &shape, &pose), LKS_INVALID_ARGUMENT);
  EXPECT_EQ(lks_fit(LKS_BOX, raw.data(), 0, &shape, &pose), LKS_INVALID_ARGUMENT);
}

TEST(CLibrary, FindsThePartsOfACompoundWithMeshes) {
  const auto level = test::sample_level();
  lks_assets* assets = nullptr;
  ASSERT_EQ(lks_assets_create(&assets), LKS_OK);
  std::uint64_t id = 0;
  const std::vector<std::byte> bytes = level->canonical_bytes();
  EXPECT_EQ(lks_assets_add_bytes(assets, bytes.data(), bytes.size(), &id), LKS_NOT_FOUND);
  const std::vector<std::byte> mesh = test::sample_panels()->canonical_bytes();
  ASSERT_EQ(lks_assets_add_bytes(assets, mesh.data(), mesh.size(), &id), LKS_OK);
  ASSERT_EQ(lks_assets_add_bytes(assets, bytes.data(), bytes.size(), &id), LKS_OK);
  std::uint32_t child = 0, triangle = 0;
  for (const std::uint32_t part : {1U, 3U, 256U, 259U, 260U, 263U}) {
    const CompoundPart found = level->find_part(part).value();
    EXPECT_EQ(lks_assets_find_part(assets, id, part, &child, &triangle), LKS_OK);
    EXPECT_EQ((CompoundPart{child, triangle}), found) << part;
  }
  EXPECT_EQ(lks_assets_find_part(assets, id, 264, &child, &triangle), LKS_NOT_FOUND);
  lks_assets_destroy(assets);
}

// A hull of the set 3 m above a ball.
struct TwoShapes {
  lks_assets* assets = nullptr;
  std::uint64_t hull = 0;
  lks_placed_shape a{};
  lks_placed_shape b{};

  TwoShapes() {
    constexpr std::int32_t k_metre = 1 << 20;
    const std::vector<lks_length3> points{
        {k_metre, 0, 0}, {-k_metre, 0, 0}, {0, k_metre, 0}, {0, 0, k_metre}};
    EXPECT_EQ(lks_assets_create(&assets), LKS_OK);
    EXPECT_EQ(lks_assets_add_hull(assets, points.data(), points.size(), 64, &hull), LKS_OK);
    a = {lks_sphere(k_metre / 2), {{0, 0, 0}, lks_quat_identity()}};
    b = {lks_shape_of(LKS_HULL, 0, 0, 0, hull),
         {{0, std::int64_t{3} << 32, 0}, lks_quat_identity()}};
  }
  ~TwoShapes() { lks_assets_destroy(assets); }
};

TEST(CLibrary, ComparesTwoShapesAsTheCoreDoes) {
  const TwoShapes two;
  lks_shape_gap gap;
  ASSERT_EQ(lks_shape_distance(two.assets, &two.a, &two.b, 4 << 20, &gap), LKS_OK);
  EXPECT_EQ(gap.found, 1u);
  EXPECT_EQ(gap.overlapping, 0u);
  EXPECT_EQ(gap.distance, std::int64_t{5} << 31);
  EXPECT_EQ(gap.normal.y, 1 << 30);
  EXPECT_EQ(gap.point_a.y, std::int64_t{1} << 31);
  EXPECT_EQ(gap.point_b.y, std::int64_t{3} << 32);

  const lks_length3 way{0, -(4 << 20), 0};
  lks_shape_hit hit;
  ASSERT_EQ(lks_shape_cast(two.assets, &two.a, &two.b, &way, &hit), LKS_OK);
  EXPECT_EQ(hit.hit, 1u);
  EXPECT_NEAR(hit.fraction / 1073741824.0, 0.625, 1e-6);
  lks_pose end = two.b.pose;
  end.position.y = -(std::int64_t{1} << 32);
  const lks_pose& still = two.a.pose;
  ASSERT_EQ(lks_shape_impact(two.assets, &two.a, &still, &two.b, &end, 512, &hit), LKS_OK);
  EXPECT_EQ(hit.hit, 1u);
  EXPECT_NEAR(hit.fraction / 1073741824.0, 0.625, 0.0006);
  EXPECT_EQ(hit.normal.y, 1 << 30);

  EXPECT_EQ(lks_shape_distance(nullptr, &two.a, &two.b, 0, &gap), LKS_NOT_FOUND);
  EXPECT_EQ(lks_shape_distance(two.assets, &two.a, &two.b, -1, &gap), LKS_INVALID_ARGUMENT);
  EXPECT_EQ(lks_shape_impact(two.assets, &two.a, &still, &two.b, &end, 7, &hit),
            LKS_INVALID_ARGUMENT);
}

TEST(CLibrary, SettingsOfBodiesHaveTheNumbersOfTheCore) {
  expect_same(LKS_STATIC, MotionType::static_body);
  expect_same(LKS_KINEMATIC, MotionType::kinematic);
  expect_same(LKS_DYNAMIC, MotionType::dynamic);
  expect_same(LKS_FRAME_BODY, Frame::body);
  expect_same(LKS_COMBINE_AVERAGE, CombineRule::average);
  expect_same(LKS_COMBINE_GEOMETRIC_MEAN, CombineRule::geometric_mean);
  expect_same(LKS_COMBINE_MINIMUM, CombineRule::minimum);
  expect_same(LKS_COMBINE_MULTIPLY, CombineRule::multiply);
  expect_same(LKS_COMBINE_MAXIMUM, CombineRule::maximum);
}

TEST(CLibrary, JointsHaveTheNumbersOfTheCore) {
  expect_same(LKS_JOINT_DISTANCE, JointKind::distance);
  expect_same(LKS_JOINT_BALL, JointKind::ball);
  expect_same(LKS_JOINT_HINGE, JointKind::hinge);
  expect_same(LKS_JOINT_SLIDER, JointKind::slider);
  expect_same(LKS_JOINT_WELD, JointKind::weld);
  expect_same(LKS_JOINT_WHEEL, JointKind::wheel);
  expect_same(LKS_JOINT_MOTOR, JointKind::motor);
  expect_same(LKS_JOINT_SIX_AXIS, JointKind::six_axis);
  expect_same(LKS_JOINT_PULLEY, JointKind::pulley);
  expect_same(LKS_JOINT_GEAR, JointKind::gear);
  expect_same(LKS_JOINT_RACK, JointKind::rack);
  expect_same(LKS_JOINT_RATCHET, JointKind::ratchet);
  expect_same(LKS_JOINT_PATH, JointKind::path);
  expect_same(LKS_AXIS_LOCKED, AxisMode::locked);
  expect_same(LKS_AXIS_FREE, AxisMode::free);
  expect_same(LKS_AXIS_LIMITED, AxisMode::limited);
}

TEST(CLibrary, EventsHaveTheNumbersOfTheCore) {
  expect_same(LKS_CONTACT_END, EventKind::contact_end);
  expect_same(LKS_TRIGGER_ENTER, EventKind::trigger_enter);
  expect_same(LKS_CONTACT_PERSIST, EventKind::contact_persist);
  expect_same(LKS_TRIGGER_STAY, EventKind::trigger_stay);
  expect_same(LKS_TRIGGER_EXIT, EventKind::trigger_exit);
  expect_same(LKS_IMPACT, EventKind::impact);
  expect_same(LKS_SLEEP, EventKind::sleep);
}

TEST(CLibrary, OutcomesOfVerifyingHaveTheNumbersOfTheLibrary) {
  expect_same(LKS_LOG_DIVERGED, replay::VerifyOutcome::diverged);
  expect_same(LKS_LOG_CORRUPT, replay::VerifyOutcome::corrupt);
  expect_same(LKS_LOG_INCOMPATIBLE, replay::VerifyOutcome::incompatible);
}

TEST(CLibrary, WholeNumbersConvertAsRatiosOfTheCore) {
  for (std::int64_t size = 1; size < std::int64_t{1} << 40; size = size * 7 / 5 + 1) {
    for (const std::int64_t value : {size, -size}) {
      const auto position = Position::try_from_ratio(value, 1'000'000);
      ASSERT_EQ(lks_position_um(value), position->raw) << value;
      ASSERT_EQ(lks_position_to_um(position->raw), value);
      const auto length = Length::try_from_ratio(value, 1000);
      if (!length) continue;
      ASSERT_EQ(lks_length_mm(value), length->raw) << value;
    }
  }
  constexpr std::int64_t k_pi_numerator = 245'850'922, k_pi_denominator = 78'256'779;  // to 1e-16
  for (int degrees = -900; degrees <= 900; ++degrees) {
    const Angle angle = Angle::from_ratio(degrees * k_pi_numerator, 180 * k_pi_denominator);
    ASSERT_EQ(lks_angle_mdeg(degrees * 1000), angle.raw) << degrees;
  }
  EXPECT_EQ(lks_angle_mdeg(90'000), Angle(90_deg).raw);
}

TEST(CLibrary, AStructureOfAnOlderHeaderHasDefaultsForNewFields) {
  const Grown defaults{sizeof(Grown), 1, 2};
  Grown caller{8, 7, 99};
  const Grown taken = c::take(&caller, defaults, "grown");
  EXPECT_EQ(taken.first, 7U);
  EXPECT_EQ(taken.second, 2U);
  c::give(defaults, &caller, 8, "grown");
  EXPECT_EQ(caller.size, 8U);
  EXPECT_EQ(caller.first, 1U);
  EXPECT_EQ(caller.second, 99U) << "written behind the caller's structure";
  for (const std::uint32_t size : {0U, 4U, 9U, 12U, 24U}) {
    caller.size = size;
    EXPECT_THROW((void)c::take(&caller, defaults, "grown"), c::Failure) << size;
  }
}

TEST(CLibrary, EachThreadHasAMessageOfItsOwn) {
  ASSERT_EQ(lks_step(nullptr, nullptr), LKS_NULL_ARGUMENT);
  const std::string here = lks_last_error();
  std::thread([&] {
    EXPECT_STREQ(lks_last_error(), "");
    EXPECT_EQ(lks_from_ratio(1, 0, 0, nullptr), LKS_INVALID_ARGUMENT);
    EXPECT_NE(lks_last_error(), here);
  }).join();
  EXPECT_EQ(lks_last_error(), here);
}

TEST(CLibrary, ALongMessageIsCutBetweenTwoCharacters) {
  lks_world* world = nullptr;
  for (std::size_t shift = 0; shift < 3; ++shift) {
    std::string text = std::string(shift, 'a');
    while (text.size() < 600)
      text += "…";
    ASSERT_EQ(lks_world_create_scene(text.c_str(), 1, &world), LKS_NOT_FOUND);
    const std::string message = lks_last_error();
    EXPECT_LT(message.size(), 512U);
    EXPECT_EQ(message.substr(message.size() - 3), "…");
  }
}

std::vector<std::byte> record(bool altered) {
  const auto config = scenes::encode_config("rolling", 1);
  const auto game = scenes::make_simulation(config).value();
  replay::MemorySink log;
  replay::Recorder recorder(
      log, {.keyframe_bytes_max = game->snapshot_bytes_max(SnapshotKind::canonical)});
  EXPECT_EQ(recorder.begin(game->info(), config, {.match_id = 1, .build = "test"}), Status::ok);
  const std::array<std::byte, 1> nothing{};
  const std::array inputs{PlayerInput{nothing, InputOrigin::absent}};
  while (game->tick() < 50) {
    const std::uint64_t tick = game->tick();
    game->step(inputs);
    const std::uint64_t hash = game->hash() ^ (altered && tick == 20 ? 1U : 0U);
    EXPECT_EQ(recorder.record_tick(tick, inputs, hash), Status::ok);
  }
  EXPECT_EQ(recorder.finish("done"), Status::ok);
  const auto bytes = log.bytes();
  return {bytes.begin(), bytes.end()};
}

lks_log_report verify(std::span<const std::byte> log) {
  lks_log_report report{};
  report.size = sizeof report;
  EXPECT_EQ(lks_verify_log_bytes(log.data(), log.size(), &report), LKS_OK) << lks_last_error();
  return report;
}

TEST(CLibrary, LogsAreVerified) {
  const lks_log_report same = verify(record(false));
  EXPECT_EQ(same.outcome, static_cast<std::uint32_t>(LKS_LOG_SAME));
  EXPECT_EQ(same.ticks_verified, 50U);
  EXPECT_EQ(same.complete, 1U);
  EXPECT_NE(same.final_hash, 0U);
  const lks_log_report other = verify(record(true));
  EXPECT_EQ(other.outcome, static_cast<std::uint32_t>(LKS_LOG_DIVERGED));
  EXPECT_EQ(other.diverged_tick, 20U);
  EXPECT_EQ(other.expected, other.actual ^ 1U);
  EXPECT_NE(std::string(other.line).find("tick 20"), std::string::npos) << other.line;
  std::vector<std::byte> damaged = record(false);
  damaged[damaged.size() / 2] ^= std::byte{1};
  EXPECT_EQ(verify(damaged).outcome, static_cast<std::uint32_t>(LKS_LOG_CORRUPT));
}

}  // namespace
}  // namespace lockstone
