#include "core/dynamics/step/effort_policy.h"

#include <algorithm>
#include <cstdlib>

#include "core/dynamics/body/lane_bodies.h"
#include "core/dynamics/problem/body_factor.h"
#include "core/dynamics/step/contact_params.h"

namespace lockstone {
namespace {

// No converged island has more contacts, whatever the world allows.
constexpr std::size_t k_most_island_contacts = 1024;

// A contact is overloaded when it carries this many halves of a body's weight.
constexpr std::int64_t k_overload_halves = 5;

// Contacts of a stack are rigid if their points are within k_rigid_range of k_resting_overlap, they
// carry more than 1/k_rigid_part of the impulse of a bearing contact, and their bodies are slower
// than 2^-k_rigid_shift of the speed that gravity gives in a substep.
constexpr Displacement k_rigid_range = Displacement::from_ratio(1, 5000);
constexpr std::int64_t k_rigid_part = 10;
constexpr int k_rigid_shift = 6;

// Whether impulses would need more bits than there are beside speeds: above 200,000 : 1.
bool is_too_uneven(BlockFloat a, BlockFloat b) {
  constexpr std::int32_t k_least_share = (1 << 30) / 200'000;
  if (a.mantissa == 0 || b.mantissa == 0) return false;
  return std::min(ratio(a, b), ratio(b, a)).raw < k_least_share;
}

std::int64_t impulse_of(const ContactRecord& record) {
  std::int64_t sum = 0;
  for (const ContactPointRecord& point : record.points)
    sum += point.normal_impulse.raw;
  return sum;
}

}  // namespace

EffortPolicy::EffortPolicy(const TimeStep& step, std::size_t converged_contacts)
    : step_(step),
      most_island_contacts_(
          static_cast<std::uint32_t>(std::min(converged_contacts, k_most_island_contacts))) {}

void EffortPolicy::begin(const Vec3<Acceleration>& gravity) {
  std::int64_t most = 0;
  for (int i = 0; i < 3; ++i)
    most = std::max(most, std::abs(std::int64_t{gravity[i].raw}));
  bearing_impulse_ =
      most == 0 ? INT64_MAX
                : raw::round_divide(5 * raw::round_shift(most, Acceleration::frac_bits - 20),
                                    step_.substep_rate());
  LKS_ASSERT(bearing_impulse_ >= 0);
}

void EffortPolicy::mark_iterated(const ContactScene& scene, const SolverBodies& bodies,
                                 const ContactList& contacts, const TickJoints& joints,
                                 IslandBuilder& islands) {
  for (std::uint32_t i = 0; i < scene.joint_links.size(); ++i)
    if (joints.solver().number_of(i) == JointSolver::k_in_net)
      islands.load(islands.of(scene, bodies, scene.joint_links[i])).iterates_only = true;
  for (std::uint32_t number = 1; number < bodies.count(); ++number) {
    const std::uint32_t island = islands.of(BodyRef::numbered(number));
    const std::uint32_t body = bodies.side(number).body();
    if (island != 0 && (scene.bodies[body].locks & k_lock_moving) != 0)
      islands.load(island).iterates_only = true;
  }
  const auto mass = [&](BodyRef body) {
    return body.is_standing()
               ? BlockFloat{}
               : scene.bodies[bodies.side(body.number()).body()].inverse_mass_value();
  };
  contacts.for_each([&](ContactId, const ContactRef& contact) {
    const bool rolls = scene.surfaces[contact.manifold].rolling_arm != Length{};
    if (rolls || is_too_uneven(mass(contact.a), mass(contact.b)))
      islands.load(contact).iterates_only = true;
  });
}

bool EffortPolicy::may_converge(const IslandLoad& island) const {
  if (island.iterates_only || island.is_pinched) return false;
  return island.contacts != 0 && island.contacts + island.joints <= most_island_contacts_ &&
         island.bodies <= BodyFactor::k_most_bodies;
}

bool EffortPolicy::rests(const lanes::RowBody& row, const SolverBody& body) {
  return is_slower(row, body, k_rigid_shift);
}

bool EffortPolicy::is_rigid(const ContactScene& scene, const SolverBodies& bodies,
                            const ContactRef& contact) const {
  const ContactRecord& record = scene.records[contact.record];
  if (std::int64_t{record.load.raw} * record.count * k_rigid_part <= bearing_impulse_) return false;
  const Manifold& manifold = scene.manifolds[contact.manifold];
  for (std::size_t i = 0; i < static_cast<std::size_t>(manifold.count); ++i) {
    const std::int64_t off =
        std::int64_t{manifold.points[i].separation.raw} + k_resting_overlap.raw;
    if (off > k_rigid_range.raw || off < -k_rigid_range.raw) return false;
  }
  const auto is_at_rest = [&](BodyRef body) {
    return body.is_standing() || bodies.constants()[body.number()].rests;
  };
  return is_at_rest(contact.a) && is_at_rest(contact.b);
}

bool EffortPolicy::is_overloaded(const ContactScene& scene, const SolverBodies& bodies,
                                 const ContactRef& contact, std::int64_t share_b) {
  LKS_ASSERT(share_b >= 0 && share_b <= std::int64_t{1} << 30);
  const bool b_is_lighter = share_b >= 1 << 29;
  const BodyRef lighter = b_is_lighter ? contact.b : contact.a;
  if (lighter.is_standing()) return false;
  const std::int64_t impulse = impulse_of(scene.records[contact.record]);
  const std::int64_t share = b_is_lighter ? share_b : (std::int64_t{1} << 30) - share_b;
  const std::int64_t jump = raw::round_shift(impulse * (share >> 2), 15);  // Q32 + 1
  const std::int64_t weight = bodies.constants()[lighter.number()].greatest_gain();
  if (weight == 0) return false;
  if (jump < k_overload_halves * weight) {
    if (impulse != 0 || contact.has_standing()) return false;
    if (!is_touching(scene.manifolds[contact.manifold])) return false;
  }
  return is_at_rest(bodies.rows()[lighter.number()]);
}

}  // namespace lockstone
