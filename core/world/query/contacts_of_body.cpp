// The contacts and joints of a body, as the last step left them. All follows from the state: where
// bodies touch is found again from their poses.

#include <algorithm>
#include <optional>
#include <tuple>

#include "core/collision/narrow_phase/collide_bodies.h"
#include "core/world/derived/quantities.h"
#include "core/world/query/sorted_results.h"
#include "core/world/world_impl.h"

namespace lockstone {
namespace {

auto order_of(const BodyContact& contact) {
  return std::tuple(contact.other.index, contact.part, contact.other_part, contact.normal.x.raw,
                    contact.normal.y.raw, contact.normal.z.raw, contact.tag, contact.other_tag,
                    contact.normal_force.raw);
}

// One contact after the other, seen from one of the two bodies. Finds the manifolds of each pair
// once.
class ContactReader {
 public:
  explicit ContactReader(World::Impl& world) : world_(world) {}

  [[nodiscard]] BodyContact read(const ContactRecord& record, std::uint32_t body) {
    const BodyRecord &a = world_.bodies[record.body_a], &b = world_.bodies[record.body_b];
    inverse_mass_ = add(a.inverse_mass_value(), b.inverse_mass_value());
    BodyContact contact;
    std::int64_t normal_impulse = 0;
    for (const ContactPointRecord& point : record.points)
      normal_impulse += point.normal_impulse.raw;
    contact.normal_force = force_of(normal_impulse);
    for (int i = 0; i < 3; ++i)
      contact.friction[i] = force_of(record.friction_impulse[i].raw);
    contact.part = record.part_a;
    contact.other_part = record.part_b;
    contact.tag = a.tag;
    contact.other_tag = b.tag;
    contact.other = world_.handle_of(record.body_b);
    if (const PartContact* part = part_of(record)) add_points(record, *part, contact);
    return body == record.body_a ? contact : seen_from_other_side(contact, record);
  }

 private:
  [[nodiscard]] Force force_of(std::int64_t impulse) const {
    return Force::from_raw(effort_of(impulse, world_.time_step.substep_rate(), inverse_mass_, 0));
  }

  [[nodiscard]] const PartContact* part_of(const ContactRecord& record) {
    const Pair pair{record.body_a, record.body_b};
    if (pair != pair_) {
      collide_bodies(world_.placed(pair.a), world_.placed(pair.b), world_.narrow.margin_of(pair),
                     found_);
    }
    pair_ = pair;
    const auto part = std::ranges::find_if(found_, [&](const PartContact& contact) {
      return contact.part_a == record.part_a && contact.part_b == record.part_b;
    });
    return part == found_.end() ? nullptr : part;
  }

  void add_points(const ContactRecord& record, const PartContact& part, BodyContact& contact) {
    const Manifold& manifold = part.manifold;
    contact.normal = manifold.normal;
    contact.count = static_cast<std::uint32_t>(manifold.count);
    for (std::size_t i = 0; i < contact.count; ++i) {
      const ManifoldPoint& from = manifold.points[i];
      contact.points[i] = {
          place_between(from, world_.bodies[record.body_a], world_.bodies[record.body_b]),
          from.separation, force_of(record.impulse_of(from.feature).raw)};
    }
    if (part.surface_a != nullptr) contact.tag = part.surface_a->tag;
    if (part.surface_b != nullptr) contact.other_tag = part.surface_b->tag;
    contact.other_part = part_at(world_, record.body_b, contact.points[0].point, record.part_b);
  }

  [[nodiscard]] BodyContact seen_from_other_side(BodyContact contact,
                                                 const ContactRecord& record) const {
    contact.other = world_.handle_of(record.body_a);
    std::swap(contact.part, contact.other_part);
    std::swap(contact.tag, contact.other_tag);
    contact.normal = -contact.normal;
    contact.friction = -contact.friction;
    return contact;
  }

  World::Impl& world_;
  BlockFloat inverse_mass_{};
  PartContacts found_;
  std::optional<Pair> pair_;  // of `found_`
};

}  // namespace

/// The way of these functions into a world.
class WorldContacts {
 public:
  static World::Impl& of(const World& world) { return *world.impl_; }
};

std::size_t contacts_of(const World& world, BodyHandle body, std::span<BodyContact> out) {
  if (!world.exists(body)) return 0;
  World::Impl& impl = WorldContacts::of(world);
  ContactReader reader(impl);
  std::size_t count = 0;
  const auto visit = [&](const ContactRecord& record) {
    if (!record.is_touching() || record.is_inert()) return;
    if (record.body_a != body.index && record.body_b != body.index) return;
    insert_sorted(
        reader.read(record, body.index), out, count,
        [](const BodyContact& x, const BodyContact& y) { return order_of(x) < order_of(y); });
  };
  for (const ContactRecord& record : impl.contacts.active())
    visit(record);
  impl.contacts.sleeping().for_each_of(body.index, visit);
  return count;
}

std::size_t joints_of(const World& world, BodyHandle body, std::span<JointHandle> out) {
  if (!world.exists(body)) return 0;
  const World::Impl& impl = WorldContacts::of(world);
  std::size_t count = 0;
  for (const JointLink& link : impl.joint_graph.links()) {
    if (count == out.size()) break;
    if (link.body_a != body.index && link.body_b != body.index) continue;
    out[count++] = {link.joint, impl.joints[link.joint].generation};
  }
  return count;
}

std::span<const HitEvent> hit_events(const World& world) {
  return WorldContacts::of(world).events.hits().list();
}

}  // namespace lockstone
