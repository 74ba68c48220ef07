// Random contacts for the benchmark of the contact-row kernels, in units and in floating point,
// from which each competitor makes its own form.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace lockstone::bench {

using Triple = std::array<double, 3>;

struct SceneBody {
  Triple velocity{};
  Triple spin{};
};

struct ScenePoint {
  Triple read_a{}, read_b{};  // M·(r̄ × n)
  Triple gain_a{}, gain_b{};  // α·(r̄ × n)
  double mass = 0;
  double keep = 1;
  double bias = 0;
  double impulse = 0;
};

struct SceneContact {
  std::uint32_t body_a = 0;
  std::uint32_t body_b = 0;
  Triple normal{};
  double share_a = 0, share_b = 0;
  std::array<ScenePoint, 4> points;
};

/// Body 0 is the immovable one. The contacts of a colour stand together and share no body.
struct RowScene {
  std::vector<SceneBody> bodies;
  std::vector<SceneContact> contacts;
  std::size_t colour_contacts = 0;  // in each colour; a multiple of eight
};

/// `bodies` moving bodies, matched at random in each of `colours`.
[[nodiscard]] RowScene make_row_scene(std::uint32_t bodies, std::uint32_t colours,
                                      std::uint64_t seed);

}  // namespace lockstone::bench
