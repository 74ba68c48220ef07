#include "core/dynamics/step/input/contact_list.h"

#include <lockstone/assert.h>

#include "core/base/reserved.h"

namespace lockstone {
namespace {

// The least number of items in a piece of a loop: about a microsecond of work.
constexpr std::uint32_t k_side_grain = 256;

}  // namespace

ContactList::ContactList(std::size_t contact_capacity) {
  sides_.reserve(contact_capacity);
  refs_.reserve(contact_capacity);
}

// Collects the few fields of large records that `gather` reads, side by side.
void ContactList::find_sides(const ContactScene& scene, std::int64_t bearing_impulse,
                             std::size_t first, std::size_t end) {
  for (std::size_t i = first; i < end; ++i) {
    const ContactRecord& record = scene.records[i];
    Sides& sides = sides_[i];
    LKS_ASSERT(record.body_a < scene.bodies.size() && record.body_b < scene.bodies.size());
    LKS_ASSERT(record.is_inert() || scene.manifold_ids[i] < scene.manifolds.size());
    LKS_ASSERT(record.count <= record.points.size());
    sides = {};
    if (record.is_inert() || scene.surfaces[scene.manifold_ids[i]].is_left_out) continue;
    const auto side_of = [&](std::uint32_t body) -> BodySide {
      return {body, static_cast<MotionType>(scene.bodies[body].motion)};
    };
    sides = {side_of(record.body_a), side_of(record.body_b)};
    LKS_ASSERT(sides.a.is_dynamic() || sides.b.is_dynamic());
    if (record.count == 0 && sides.a.is_dynamic() && sides.b.is_dynamic()) sides.a.mark();
    if (std::int64_t{record.mean_impulse.raw} * record.count > bearing_impulse) sides.b.mark();
  }
}

// In the order of the records: bodies, colours and lanes follow from the state alone.
void ContactList::gather(const ContactScene& scene, std::int64_t bearing_impulse,
                         SolverBodies& bodies, Parallel& parallel) {
  LKS_ASSERT(is_reserved(sides_, scene.records.size()));
  sides_.resize(scene.records.size());
  parallel.for_each({static_cast<std::uint32_t>(sides_.size()), k_side_grain},
                    [&](std::size_t first, std::size_t end, std::uint32_t) {
                      find_sides(scene, bearing_impulse, first, end);
                    });
  refs_.resize(sides_.size());
  std::size_t count = 0;
  for (std::uint32_t i = 0; i < sides_.size(); ++i) {
    const Sides sides = sides_[i];
    if (sides.a.is_none()) continue;
    const BodyRef a = bodies.gather(sides.a), b = bodies.gather(sides.b);
    refs_[count++] = {i, scene.manifold_ids[i], a, b};
  }
  refs_.resize(count);
}

}  // namespace lockstone
