#include "tools/bench/rows/row_scene.h"

#include <cmath>
#include <numeric>
#include <utility>

namespace lockstone::bench {
namespace {

// M of a solid sphere, normalised by its radius: 1 / (2/5).
constexpr double k_inverse_inertia = 2.5;

// SplitMix64: G. Steele, D. Lea, C. Flood, "Fast splittable pseudorandom number generators", 2014.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : state_(seed) {}

  std::uint64_t next() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15U;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
    return z ^ (z >> 31);
  }

  double between(double low, double high) {
    return low + (high - low) * static_cast<double>(next() >> 11) * 0x1p-53;
  }

  Triple vector(double bound) {
    return {between(-bound, bound), between(-bound, bound), between(-bound, bound)};
  }

 private:
  std::uint64_t state_;
};

double dot(const Triple& a, const Triple& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Triple scaled(const Triple& a, double s) {
  return {a[0] * s, a[1] * s, a[2] * s};
}

Triple cross(const Triple& a, const Triple& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

ScenePoint make_point(const SceneContact& contact, Dice& dice) {
  const Triple lever_a = cross(dice.vector(0.5), contact.normal);
  const Triple lever_b = cross(dice.vector(0.5), contact.normal);
  ScenePoint point;
  point.read_a = scaled(lever_a, k_inverse_inertia);
  point.read_b = scaled(lever_b, k_inverse_inertia);
  point.gain_a = scaled(lever_a, contact.share_a);
  point.gain_b = scaled(lever_b, contact.share_b);
  point.mass = 1 / (1 + dot(point.read_a, point.gain_a) + dot(point.read_b, point.gain_b));
  point.keep = dice.between(0.9, 1);
  point.bias = dice.between(-0.1, 0.1);
  point.impulse = dice.between(0, 0.2);
  return point;
}

SceneContact make_contact(std::uint32_t a, std::uint32_t b, Dice& dice) {
  SceneContact contact;
  contact.body_a = a;
  contact.body_b = b;
  const Triple v = dice.vector(1);
  contact.normal = scaled(v, 1 / std::sqrt(dot(v, v) + 1e-9));
  contact.share_a = a == 0 ? 0 : b == 0 ? 1 : dice.between(0.2, 0.8);
  contact.share_b = 1 - contact.share_a;
  for (ScenePoint& point : contact.points)
    point = make_point(contact, dice);
  return contact;
}

}  // namespace

RowScene make_row_scene(std::uint32_t bodies, std::uint32_t colours, std::uint64_t seed) {
  Dice dice(seed);
  RowScene scene;
  scene.bodies.resize(bodies + 1);
  scene.colour_contacts = bodies / 16 * 8;
  for (std::uint32_t i = 1; i <= bodies; ++i)
    scene.bodies[i] = {dice.vector(3), dice.vector(3)};
  std::vector<std::uint32_t> order(bodies);
  std::iota(order.begin(), order.end(), 1U);
  for (std::uint32_t colour = 0; colour < colours; ++colour) {
    for (std::size_t i = order.size(); i > 1; --i)
      std::swap(order[i - 1], order[dice.next() % i]);
    for (std::size_t i = 0; i + 16 <= order.size(); i += 16) {
      for (std::size_t k = i; k < i + 16; k += 2) {
        scene.contacts.push_back(make_contact(order[k], order[k + 1], dice));
      }
    }
  }
  return scene;
}

}  // namespace lockstone::bench
