#include "tools/bench/rows/integer_rows.h"

#include <cmath>
#include <span>

#include <lockstone/hash.h>

namespace lockstone::bench {
namespace {

// Fraction bits of the factors of velocities: M·(r̄ × n) stays below 4.
constexpr int k_shift = 29;

std::int64_t fixed(double x, int bits) {
  return std::llround(std::ldexp(x, bits));
}

std::int64_t pack(std::int64_t low, std::int64_t high) {
  return static_cast<std::int64_t>((static_cast<std::uint64_t>(low) & 0xffffffffU) |
                                   (static_cast<std::uint64_t>(high) << 32));
}

void set_point(const ScenePoint& from, std::size_t lane, lanes::RowPoint& to) {
  for (std::size_t i = 0; i < 3; ++i) {
    to.a[i][lane] = pack(fixed(from.read_a[i], k_shift), fixed(from.gain_a[i], 30));
    to.b[i][lane] = pack(fixed(from.read_b[i], k_shift), fixed(from.gain_b[i], 30));
  }
  to.mass_keep[lane] = pack(fixed(from.mass, 30), fixed(from.keep, 30));
  to.impulse_bias[lane] = pack(fixed(from.impulse, 20), fixed(from.bias, 20));
}

void set_contact(const SceneContact& from, std::size_t lane, lanes::ContactBlock& to) {
  to.body_a[lane] = lanes::body_velocity_offset(from.body_a);
  to.body_b[lane] = lanes::body_velocity_offset(from.body_b);
  to.shift[lane] = k_shift;
  to.half[lane] = std::int64_t{1} << (k_shift - 1);
  for (std::size_t i = 0; i < 3; ++i) {
    to.normal[i][lane] = fixed(from.normal[i], k_shift);
    to.gain_a[i][lane] = fixed(from.normal[i] * from.share_a, 30);
    to.gain_b[i][lane] = fixed(from.normal[i] * from.share_b, 30);
  }
  for (std::size_t k = 0; k < 4; ++k)
    set_point(from.points[k], lane, to.points[k]);
}

}  // namespace

IntegerRows::IntegerRows(const RowScene& scene)
    : bodies(scene.bodies.size()),
      blocks(scene.contacts.size() / lanes::k_block_lanes),
      colour_blocks(scene.colour_contacts / lanes::k_block_lanes) {
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      bodies[i].velocity[k] = fixed(scene.bodies[i].velocity[k], lanes::k_velocity_bits);
      bodies[i].spin[k] = fixed(scene.bodies[i].spin[k], lanes::k_velocity_bits);
    }
  }
  for (std::size_t i = 0; i < scene.contacts.size(); ++i) {
    set_contact(scene.contacts[i], i % lanes::k_block_lanes, blocks[i / lanes::k_block_lanes]);
  }
}

void IntegerRows::sweep() {
  for (std::size_t i = 0; i < blocks.size(); i += colour_blocks) {
    lanes::solve_contact_rows(bodies, std::span(blocks).subspan(i, colour_blocks));
  }
}

std::uint64_t IntegerRows::hash() const {
  const std::uint64_t of_bodies = hash64(std::as_bytes(std::span(bodies)));
  return hash64(std::as_bytes(std::span(blocks)), of_bodies);
}

}  // namespace lockstone::bench
