// The inside of a world: canonical state first, then derived data, then scratch.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <lockstone/world.h>

#include "core/base/parallel.h"
#include "core/collision/broad_phase/broad_phase.h"
#include "core/collision/continuous/first_impact.h"
#include "core/collision/narrow_phase/collide_bodies.h"
#include "core/collision/narrow_phase/placed_shape.h"
#include "core/dynamics/body/rest.h"
#include "core/dynamics/body/tick_gain.h"
#include "core/dynamics/contact/recycling_pose.h"
#include "core/dynamics/impact/impact_island.h"
#include "core/dynamics/islands/islands.h"
#include "core/dynamics/joint/pivot_integrator.h"
#include "core/dynamics/state/body_record.h"
#include "core/dynamics/state/contact_record.h"
#include "core/dynamics/state/joint_record.h"
#include "core/dynamics/state/time_step.h"
#include "core/dynamics/step/contact_solver.h"
#include "core/geometry/distance/manifold.h"
#include "core/world/debug/profiler.h"
#include "core/world/derived/body_cache.h"
#include "core/world/derived/body_names.h"
#include "core/world/derived/index_set.h"
#include "core/world/derived/joint_graph.h"
#include "core/world/phases/bounces.h"
#include "core/world/phases/continuous.h"
#include "core/world/phases/narrow_slots.h"
#include "core/world/phases/passes.h"
#include "core/world/phases/pendulums.h"
#include "core/world/phases/separating_axes.h"
#include "core/world/phases/step_records.h"
#include "core/world/sleep/sleeping_contacts.h"
#include "core/world/state/record_checks.h"
#include "core/world/state/record_hashes.h"
#include "core/world/state/stores.h"
#include "core/world/state/world_header.h"

namespace lockstone {

// A ball in a corner meets three walls; a body with this many impacts in a tick stays where it is.
inline constexpr int k_max_impacts = 4;

// Pairs closer than this get contact points ahead of time. Half of it widens each body's bounds.
inline constexpr Length k_contact_margin = Length::from_ratio(1, 50);

struct World::Impl {
  [[gnu::cold]] Impl(const WorldDef& definition, std::shared_ptr<const AssetSet> known_assets);

  // The tick, one function a stage (step.cpp).
  StepReport step();

  // Commands (commands.cpp). Each checks its arguments in full before it writes.
  Result<BodyHandle> create_body(const BodyDef& body_def);
#define LKS_DECLARE_EXECUTE(Name) Status execute(const Name& command);
  LKS_COMMANDS(LKS_DECLARE_EXECUTE)
#undef LKS_DECLARE_EXECUTE

  Result<JointHandle> create_joint(const JointDef& joint_def);
  [[nodiscard]] Status gain_of(BodyHandle body, const Push& push, TickGain& gain) const;
  Status push_now(BodyHandle body, const Push& push);
  Status push_in_tick(BodyHandle body, const Push& push);

  [[nodiscard]] const BodyRecord* find(BodyHandle body) const;
  /// The record to be written, or null: the only way for a command to change a body that exists.
  [[nodiscard]] BodyRecord* edit(BodyHandle body);

  [[nodiscard]] std::uint32_t body_count() const;

  /// The body's shape where it is.
  [[nodiscard]] PlacedShape placed(std::uint32_t body) const;

  /// A convex shape to ask with. One that is not, or that names an unknown asset, is a programmer's
  /// error.
  [[nodiscard]] PlacedShape placed_query(const Shape& shape, const Transform& pose) const;

  /// Brings the data derived from one body up to date: after every write to it.
  void refresh(std::uint32_t body);
  void rebuild_derived();
  void drop_derived();

  /// Makes room for as many workers as `parallel` has.
  void make_scratch();

  /// Of pairs with an awake body, by key.
  [[nodiscard]] std::span<const ContactRecord> contacts() const {
    return {contact_store.data(), active_contacts};
  }

  /// Calls `visit(record)` for every contact there is, by key.
  template <class Visit>
  void for_each_contact(Visit&& visit) const {
    std::span<const ContactRecord> active = contacts();
    frozen.for_each(header.body_limit, [&](const ContactRecord& record) {
      for (; !active.empty() && active.front().key() < record.key(); active = active.subspan(1))
        visit(active.front());
      visit(record);
    });
    for (const ContactRecord& record : active)
      visit(record);
  }
  void drop_contacts_of(std::uint32_t body);

  // Joints (joints.cpp).
  [[nodiscard]] const JointRecord* find(JointHandle joint) const;
  [[nodiscard]] JointRecord* edit(JointHandle joint);
  [[nodiscard]] JointView view(const JointRecord& joint) const;
  [[nodiscard]] BodyHandle handle_of(std::uint32_t body) const {
    return {body, bodies[body].generation};
  }
  /// Whether the joints of a body sit where they may if it becomes `changed`.
  [[nodiscard]] bool fits_joints(std::uint32_t body, const BodyRecord& changed) const;
  void destroy_joint(std::uint32_t joint);
  void break_joints();
  void destroy_joints_of(std::uint32_t body);
  void link_joint(std::uint32_t index);
  void unlink_joint(std::uint32_t index);
  void rebuild_joint_links();
  [[nodiscard]] Pair pair_of(std::uint32_t a, std::uint32_t b) const;
  /// The pair that the joint exempts from collision, if it does.
  [[nodiscard]] std::optional<Pair> exempt_pair(const JointRecord& joint) const;
  /// By a joint whose bodies do not collide.
  [[nodiscard]] bool are_joined(std::uint32_t a, std::uint32_t b) const;
  /// Whether a body's path may end at another, as far as filters and joints decide.
  [[nodiscard]] bool is_obstacle(std::uint32_t body, std::uint32_t other) const;
  [[nodiscard]] bool set_total_length(JointRecord& joint) const;

  // Sleep (sleep.cpp).
  void wake(std::uint32_t body);
  void wake_ends(const JointRecord& joint);
  void wake_joined();
  [[nodiscard]] bool may_island_sleep(std::uint32_t body);
  void find_active_joints();
  void mark_joints();
  void wake_all();
  void disturb(std::uint32_t body);
  void disturb_around(std::uint32_t body);
  void adopt_contacts(std::span<const ContactRecord> all);

  /// The records of a store in the order of the state, as `f(span)`, once or more often.
  template <class F>
  void visit(BodyStore, F&& f) const {
    f(std::span(bodies).first(std::min(header.body_limit, def.body_capacity)));
  }
  template <class F>
  void visit(ContactStore, F&& f) const {
    if (frozen.count() == 0) return f(contacts());
    for_each_contact([&](const ContactRecord& contact) { f(std::span(&contact, 1)); });
  }
  template <class F>
  void visit(JointStore, F&& f) const {
    f(std::span(joints).first(std::min(header.joint_limit, def.joint_capacity)));
  }

  // Snapshots (save.cpp, load.cpp).
  [[nodiscard]] std::size_t save_canonical(std::span<std::byte> out) const;
  Status load_native(ByteView bytes);
  Status load_canonical(ByteView bytes);
  template <class State>
  void take(const WorldHeader& loaded, State&& state);
  template <class State>
  bool take_bodies(std::uint32_t limit, State& state);
  bool take_body(std::uint32_t body, const BodyRecord& record);
  template <class State>
  bool take_joints(std::uint32_t limit, State& state);
  void take_contacts();
  [[nodiscard]] bool is_awake_pair(const ContactRecord& contact) const;
  [[nodiscard]] bool are_frozen(std::span<const ContactRecord> all) const;
  bool flip_in_header(std::string_view field, unsigned bit);
  bool flip_in_contact(std::uint64_t object, std::string_view field, unsigned bit);
  void forget_events() {
    events.clear();
    joint_events.clear();
  }

  const WorldDef def;
  const std::shared_ptr<const AssetSet> assets;
  const TimeStep time_step;
  const RestRules rest_rules;

  // Canonical state: and all contacts, of which header.contact_count says how many.
  WorldHeader header;
  std::vector<BodyRecord> bodies;            // by index; size: body capacity
  std::vector<ContactRecord> contact_store;  // of awake pairs, the first active_contacts
  FrozenContacts frozen;                     // the others
  std::vector<JointRecord> joints;           // by index; size: joint capacity

  BodyNames names;                // for people: neither state nor derived from it
  bool is_derived_stale = false;  // bits of the state were flipped: the data below may not fit it

  // Derived from flags of bodies.
  std::uint32_t active_contacts = 0, asleep_count = 0;
  IndexSet awake;     // bodies that move
  IndexSet triggers;  // triggers that exist

  JointGraph joint_graph;        // derived of the joints
  std::uint32_t joint_hint = 0;  // no slot below this is free

  BodyCache cache;  // derived of each body
  BroadPhase broad_phase;
  RecordHashes<BodyRecord, k_body_domain> body_hashes;
  RecordHashes<JointRecord, k_joint_domain> joint_hashes;
  std::uint32_t free_hint = 0;  // no slot below this is free

  // Of the last step only.
  std::vector<ContactEvent> events;
  std::vector<JointEvent> joint_events;
  IndexSet changed_sleep;  // derived: bodies with that flag

  Profiler profiler;
  bool traces_stages = false;
  bool validates = false;
  StageDigests stage_digests{};
  Parallel parallel;  // changes no result

  /// The hash of the data after a stage (stage_digests.cpp).
  [[nodiscard]] std::uint64_t digest_of(StepStage stage) const;
  void set_stage_hook();

  void find_pairs(StepReport& report);
  void collide_pairs(StepReport& report);
  bool collide_side_by_side();
  void collide_one_by_one();
  void collide_piece(std::uint32_t first, std::uint32_t end, PairScratch& scratch);
  void collide_pair(std::uint32_t index, std::span<const ContactRecord> before,
                    const Vec3<Unit>& last_axis, PairScratch& scratch);
  [[nodiscard]] std::uint32_t remembered_slot(std::span<const ContactRecord> before) const;
  void read_poses(const Pair& pair, Length margin, ManifoldInput& input) const;
  [[nodiscard]] bool are_primitives(const Pair& pair) const;
  [[nodiscard]] bool is_found_at_contact_poses(const Pair& pair) const;
  void drift(const Pair& pair, Manifold& manifold) const;
  [[nodiscard]] const std::vector<Mat3>& rotations_of(const Pair& pair) const {
    return is_found_at_contact_poses(pair) ? cache.contact_rotations() : cache.rotations();
  }
  [[nodiscard]] bool has_one_piece(std::uint32_t body) const;
  [[nodiscard]] bool is_bounded_primitive(std::uint32_t body) const;
  void collide_primitives(std::uint32_t index, std::span<const ContactRecord> before,
                          const Vec3<Unit>& last_axis, PairScratch& scratch, PairTimer& timer);
  int collide_alone(std::uint32_t index, const ManifoldInput& input,
                    std::span<const ContactRecord> before, PairScratch& scratch);
  void collide_waiting(PairScratch& scratch);
  void add_known(std::uint32_t index, std::uint32_t known, const ManifoldInput& input,
                 std::span<const ContactRecord> before, PairScratch& scratch);
  void fill_single(std::uint32_t index, std::uint32_t slot, const ManifoldInput& input,
                   std::span<const ContactRecord> before);
  void fill_slot(std::uint32_t slot, const ContactKey& key, const Surface* surface_a,
                 const Surface* surface_b, const ManifoldInput& input,
                 std::span<const ContactRecord> before);
  void add_contacts(std::uint32_t index, std::span<const PartContact> parts,
                    const ManifoldInput& input, std::span<const ContactRecord> before,
                    PairScratch& scratch);
  void add_trigger(std::uint32_t index, std::span<const ContactRecord> before,
                   PairScratch& scratch);
  [[nodiscard]] std::uint32_t index_of(const ContactRecord& record) const;
  struct SeamSearch;  // for ghosts between static bodies (seams.cpp)
  bool look_for_seam(std::uint32_t pair, bool beside_static);
  void remove_seams();
  void number_contacts(StepReport& report);
  void number_contacts_of(std::uint32_t pair);

  // Surfaces of contacts (contact_surfaces.cpp).
  void find_surface(const Pair& pair, const Surface* surface_a, const Surface* surface_b,
                    const Manifold& manifold, ContactSurface& both) const;
  [[nodiscard]] Length rolling_radius(const Pair& pair) const;
  void add_drive(std::uint32_t body, const Vec3<Length>& arm, std::int32_t sign,
                 const Vec3<Unit>& normal, ContactSurface& surface) const;

  void solve_contacts(StepReport& report);
  void prepare_contacts();
  void run_substeps();
  void store_impulses();
  void move_bodies(StepReport& report);
  void move_body(std::uint32_t body, MoveCounts& counts);
  [[nodiscard]] InverseInertia inertia_of(std::uint32_t body, const SolverBody* solved) const;
  [[nodiscard]] Loop each_moved() const;
  void follow_with_contacts();
  void refresh_moved();

  void hold_before_fronts();  // thin bodies (fronts.cpp)
  void hold_before_fronts(std::uint32_t body);

  void refresh_bounds(std::uint32_t body);
  [[nodiscard]] Bounds bounds_of(std::uint32_t body) const;
  void find_events();

  // Sleep (sleep.cpp).
  void note_changed_sleep(std::uint32_t body);
  void set_awake(std::uint32_t body);
  void set_asleep(std::uint32_t body);
  void list_to_wake(std::uint32_t body);
  void wake_listed();
  void take_back(std::span<const ContactRecord> thawed);
  [[nodiscard]] bool wake_met();
  [[nodiscard]] Length margin_of(const Pair& pair) const;
  [[nodiscard]] bool meet(const Pair& pair);
  void rest_bodies(StepReport& report);
  [[nodiscard]] bool watch_bodies();
  void join_islands();
  void hold_overlapping();
  void freeze_contacts();
  void add_sleep_events();

  PairState take_pair(std::span<const ContactRecord>& records,
                      std::span<const SolverVelocity> approaches) const;
  std::optional<ContactEvent> event_of(const PairState& before, const PairState& now) const;
  template <class Emit>
  void merge_events(std::span<const ContactRecord> before, std::span<const ContactRecord> now,
                    Emit&& emit) const;
  void merge_pieces(std::uint32_t first, std::uint32_t end, bool writes);

  // Scratch of sleep.
  Islands islands;
  std::vector<std::uint32_t> to_wake;  // empty between the stages, but for bodies hit by swept ones
  std::vector<std::uint32_t> to_sleep;

  // Scratch of one step.
  std::span<const Pair> pairs;
  std::vector<std::uint32_t> moved;          // bodies, ascending
  std::vector<std::uint8_t> leaves_fat_box;  // by place in `moved`
  std::vector<Transform> starts;             // by body: where it was before it moved
  ContinuousCollision continuous;
  TriggerPasses passes;
  Bounces bounces;
  Pendulums pendulums;
  NarrowSlots narrow;

  std::vector<FoundContacts> found_contacts;        // by pair
  std::vector<ContactOrigin> origins;               // by slot
  std::vector<Manifold> manifolds;                  // by slot
  std::vector<ManifoldInput> inputs;                // by slot
  std::vector<ContactSurface> surfaces;             // by slot
  std::vector<FoundSeparations> found_separations;  // by slot
  std::vector<std::uint32_t> slots;                 // by new contact
  std::vector<ContactRecord> new_contacts;

  // The manifolds of the tick before, and their slots by stored contact, as long as
  // `remembers_manifolds`.
  std::vector<std::uint32_t> old_slots;
  std::vector<Manifold> old_manifolds;
  std::vector<ManifoldInput> old_inputs;
  std::vector<FoundSeparations> old_separations;
  bool remembers_manifolds = false;
  SeparatingAxes separating_axes;
  ContactSolver solver;
  std::vector<SolverVelocity> approach_speeds;        // by new contact
  static constexpr std::uint32_t k_event_piece = 64;  // contacts of a piece of the lists
  std::vector<std::uint32_t> event_ends;              // by piece
};

/// Kilograms, 0 of a body that nothing pushes.
[[nodiscard]] Mass mass_of(const BodyRecord& record);

/// An impulse λ·(1/mA + 1/mB) a substep, as λ a second: N, and N·m with the length 2^exponent.
[[nodiscard]] std::int64_t effort_of(std::int64_t impulse, std::int32_t rate,
                                     BlockFloat inverse_mass, int exponent);

/// |x| + |y| + |z|, at least the length, raw.
template <class T>
[[nodiscard]] constexpr std::int64_t sum_of_magnitudes(const Vec3<T>& v) {
  return abs(v.x).raw + abs(v.y).raw + abs(v.z).raw;
}

/// Properties that follow from a body's shape alone.
struct ShapeProperties {
  Vec3<Unit> inertia{};  // principal moments / (mass · s²), at least k_min_inertia
  int scale_exponent = 0;
  Length radius{};
};
[[nodiscard]] ShapeProperties properties_of(const Shape& shape, const Asset* asset);

}  // namespace lockstone
