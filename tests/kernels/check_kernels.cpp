#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

#include "core/kernels/contact/contact_rows.h"
#include "core/kernels/points/points.h"
#include "core/kernels/rotations/rotations.h"
#include "core/kernels/target.h"
#include "core/math/wide/scalar_lanes.h"
#include "tests/kernels/check.h"
#include "tests/kernels/values.h"

namespace lockstone::lanes::test {
namespace {

using lockstone::test::Random;

struct Rows {
  std::vector<BodyVelocity> bodies;
  std::vector<ContactBlock> blocks;

  friend bool operator==(const Rows&, const Rows&) = default;
};

// Wild: any bits at all. Else such as a solver would make.
struct RowMaker {
  Random& random;
  bool wild;

  std::int64_t velocity() { return wild ? word(random) : random.between(-(1LL << 53), 1LL << 53); }
  std::int64_t unit() { return wild ? operand(random) : random.between(-(1 << 30), 1 << 30); }
  std::int64_t share() { return wild ? operand(random) : random.between(0, 1 << 30); }
  std::int64_t impulse() { return wild ? operand(random) : random.between(0, 1 << 22); }

  void fill(BodyVelocity& body) {
    for (std::int64_t& x : body.velocity)
      x = velocity();
    for (std::int64_t& x : body.spin)
      x = velocity();
    for (std::int64_t& x : body.unused)
      x = word(random);
  }

  void fill(RowPoint& point, std::size_t lane) {
    for (int i = 0; i < 3; ++i) {
      point.a[i][lane] = scalar::pack(unit(), unit());
      point.b[i][lane] = scalar::pack(unit(), unit());
    }
    point.mass_keep[lane] = scalar::pack(share(), share());
    point.impulse_bias[lane] = scalar::pack(impulse(), impulse());
  }

  void fill(ContactBlock& block, std::size_t lane, std::uint32_t a, std::uint32_t b) {
    block.body_a[lane] = body_velocity_offset(a);
    block.body_b[lane] = body_velocity_offset(b);
    block.shift[lane] = random.between(1, 30);
    block.half[lane] = std::int64_t{1} << (block.shift[lane] - 1);
    for (int i = 0; i < 3; ++i) {
      block.normal[i][lane] = unit();
      block.gain_a[i][lane] = unit();
      block.gain_b[i][lane] = unit();
    }
    for (RowPoint& point : block.points)
      fill(point, lane);
  }
};

// The last block's later lanes hold no contact, as at the end of a colour.
Rows make_rows(std::size_t blocks, std::size_t lanes_of_last, bool wild, Random& random) {
  RowMaker maker{random, wild};
  Rows rows;
  rows.bodies.resize(1 + 2 * k_block_lanes * blocks);
  for (std::size_t i = 1; i < rows.bodies.size(); ++i)
    maker.fill(rows.bodies[i]);
  rows.blocks.resize(blocks);
  std::uint32_t next = 1;
  for (std::size_t i = 0; i < blocks; ++i) {
    const std::size_t used = i + 1 == blocks ? lanes_of_last : k_block_lanes;
    rows.blocks[i].shift.fill(30);
    rows.blocks[i].half.fill(1 << 29);
    for (std::size_t lane = 0; lane < used; ++lane, next += 2) {
      maker.fill(rows.blocks[i], lane, next + 1, next);
    }
  }
  return rows;
}

std::string compare_rows(const Rows& start) {
  Rows expected = start;
  solve_contact_rows_scalar(expected.bodies.data(), expected.blocks.data(), expected.blocks.size());
  return on_each_target([&] {
    Rows rows = start;
    solve_contact_rows(rows.bodies, rows.blocks);
    if (rows == expected) return std::string();
    return "contact rows in " + std::to_string(start.blocks.size()) + " blocks\n";
  });
}

struct Posed {
  std::int64_t before;
  Quat orientation;
  std::int32_t after;  // keeps the next record off a multiple of sixteen bytes
};

// Of norm 1 or near it; at times with a component of exactly ±1 or a step beside it.
Quat random_quat(Random& random) {
  constexpr std::int64_t k_one = 1 << 30;
  if (random.next() % 4 != 0) {
    const auto x = [&] {
      return Unit::from_raw(static_cast<std::int32_t>(random.between(-k_one, k_one)));
    };
    return normalized({x(), x(), x(), x()});
  }
  Unit parts[4];
  const std::int64_t sign = random.next() % 2 == 0 ? 1 : -1;
  for (Unit& part : parts)
    part = Unit::from_raw(static_cast<std::int32_t>(random.between(-2, 2)));
  parts[random.next() % 4] =
      Unit::from_raw(static_cast<std::int32_t>(sign * (k_one + random.between(-2, 2))));
  return {parts[0], parts[1], parts[2], parts[3]};
}

std::string compare_rotations(std::size_t count, Random& random) {
  std::vector<Posed> records(3 * count + 1);
  for (Posed& record : records)
    record.orientation = random_quat(random);
  std::vector<std::uint32_t> indices;
  for (std::size_t i = 0; i < count; ++i) {
    indices.push_back(static_cast<std::uint32_t>(3 * i) +
                      static_cast<std::uint32_t>(random.next() % 3));
  }
  std::vector<Mat3> expected(records.size());
  for (const std::uint32_t i : indices)
    expected[i] = to_matrix(records[i].orientation);
  return on_each_target([&] {
    std::vector<Mat3> matrices(records.size());
    compute_rotations({&records.front().orientation, sizeof(Posed)}, indices, matrices.data());
    if (matrices == expected) return std::string();
    return std::to_string(count) + " rotations\n";
  });
}

struct Cloud {
  std::vector<std::int32_t> coordinates;
  std::vector<std::int64_t> offsets;
  Direction32 direction{};

  [[nodiscard]] std::size_t count() const { return offsets.size(); }
  [[nodiscard]] PointColumns points() const {
    return {coordinates.data(), coordinates.data() + count(), coordinates.data() + 2 * count(),
            count()};
  }
};

// Few different coordinates make many equals.
Cloud random_cloud(std::size_t count, Random& random) {
  const bool coarse = random.next() % 2 == 0;
  const auto coordinate = [&] {
    return coarse ? static_cast<std::int32_t>(random.between(-2, 2)) : operand(random);
  };
  Cloud cloud;
  for (std::size_t i = 0; i < 3 * count; ++i)
    cloud.coordinates.push_back(coordinate());
  for (std::size_t i = 0; i < count; ++i)
    cloud.offsets.push_back(word(random));
  for (std::int32_t& x : cloud.direction)
    x = coordinate();
  return cloud;
}

std::string compare_points(const Cloud& cloud) {
  const Farthest farthest = farthest_point_scalar(cloud.points(), cloud.direction);
  const Extent extent = extent_along_scalar(cloud.points(), cloud.direction);
  std::vector<std::int64_t> expected(cloud.count());
  const Farthest highest =
      heights_above_scalar(cloud.points(), cloud.offsets.data(), cloud.direction, expected.data());
  const std::int64_t bound = expected[cloud.count() / 2];
  std::vector<std::uint64_t> expected_marks((cloud.count() + 63) / 64);
  mark_at_least_scalar(expected.data(), cloud.count(), bound, expected_marks.data());
  return on_each_target([&] {
    std::vector<std::int64_t> heights(cloud.count());
    std::vector<std::uint64_t> marks(expected_marks.size());
    const Farthest found =
        heights_above(cloud.points(), cloud.offsets.data(), cloud.direction, heights.data());
    mark_at_least(heights.data(), cloud.count(), bound, marks.data());
    const bool same = farthest_point(cloud.points(), cloud.direction) == farthest &&
                      extent_along(cloud.points(), cloud.direction) == extent && found == highest &&
                      marks == expected_marks;
    if (same && heights == expected) return std::string();
    return std::to_string(cloud.count()) + " points\n";
  });
}

}  // namespace

std::string on_each_target(const std::function<std::string()>& check) {
  std::string report;
  for (const std::string_view target : supported_targets()) {
    if (set_target(target) != Status::ok) return "a supported target is refused\n";
    const std::string found = check();
    if (!found.empty()) report += std::string(target) + " " + found;
  }
  return report;
}

std::string check_contact_rows(std::uint64_t seed) {
  Random random(seed);
  std::string report;
  for (int round = 0; round < 2000 && report.empty(); ++round) {
    const auto blocks = static_cast<std::size_t>(random.between(0, 5));
    const auto lanes_of_last = static_cast<std::size_t>(random.between(0, k_block_lanes));
    report += compare_rows(make_rows(blocks, lanes_of_last, round % 2 == 0, random));
  }
  return report;
}

std::string check_points(std::uint64_t seed) {
  Random random(seed);
  std::string report;
  for (int round = 0; round < 100 && report.empty(); ++round) {
    for (std::size_t count = k_point_step; count <= 16 * k_point_step; count += k_point_step)
      report += compare_points(random_cloud(count, random));
  }
  return report;
}

std::string check_rotations(std::uint64_t seed) {
  Random random(seed);
  std::string report;
  for (int round = 0; round < 60 && report.empty(); ++round) {
    for (std::size_t count = 0; count <= 20; ++count)
      report += compare_rotations(count, random);
  }
  return report;
}

}  // namespace lockstone::lanes::test
