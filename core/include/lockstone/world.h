// The world: all bodies and contacts, stepped one tick at a time.
//
// A result depends only on state, commands and tick. Everything that can change the future is saved
// and hashed; all else (trees, bounds, scratch) may be dropped at any time. Of a world's functions
// `create`, `set_task_runner`, `explain` and `describe_difference` alone allocate.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <type_traits>

#include <lockstone/asset.h>
#include <lockstone/body.h>
#include <lockstone/bytes.h>
#include <lockstone/collision.h>
#include <lockstone/command.h>
#include <lockstone/contacts.h>
#include <lockstone/debug_draw.h>
#include <lockstone/event.h>
#include <lockstone/hash.h>
#include <lockstone/joint.h>
#include <lockstone/profile.h>
#include <lockstone/query.h>
#include <lockstone/refusal.h>
#include <lockstone/simulation.h>
#include <lockstone/status.h>
#include <lockstone/tasks.h>
#include <lockstone/terrain.h>
#include <lockstone/vector_math.h>
#include <lockstone/vehicle.h>

namespace lockstone {

/// Changes whenever the same commands may give another state. Refused when unequal in a handshake
/// or a log. History: docs/explanation/determinism.md.
inline constexpr std::uint32_t k_simulation_abi = 82;

/// Capacities and rules of a world, fixed for its life.
struct WorldDef {
  std::uint32_t body_capacity = 1024;     ///< 1 … 2^20
  std::uint32_t pair_capacity = 16384;    ///< pairs with overlapping bounds, 1 … 2^24
  std::uint32_t contact_capacity = 8192;  ///< touching pairs, 1 … 2^24
  std::uint32_t joint_capacity = 1024;    ///< 0 … 2^20
  /// Contacts that islands solved to convergence may have in all, 0 … 2^16; 0: every island is
  /// iterated. Islands take their places in the order of their bodies' ids; those that find no room
  /// are iterated: docs/explanation/solver.md. Each takes about 7 kB.
  std::uint32_t converged_contacts = 2048;
  std::uint16_t tick_rate = 60;  ///< ticks per second, 10 … 480
  std::uint8_t substeps = 4;     ///< solver steps a tick, 1 … 16
  std::uint16_t sleep_ms = 500;  ///< rest before a body sleeps, to 60,000; 0: none ever does
  Length sleep_distance = Length::from_ratio(1, 200);  ///< a body at rest moves less, 1 mm … 1 m
  BroadPhaseKind broad_phase{};  ///< changes no result, so peers may differ in it
  Vec3<Acceleration> gravity = {{}, Acceleration::from_ratio(-981, 100), {}};  ///< m/s²
  Velocity speed_limit = k_speed_limit;  ///< of every body, 1 … 500 m/s
  std::uint32_t vehicle_capacity = 0;    ///< 0 … k_max_vehicles
  /// Tiles of 4 × 4 changed samples, or of 16 groups of a mesh: 0 … k_max_terrain_tiles.
  std::uint32_t terrain_tile_capacity = 0;

  friend bool operator==(const WorldDef&, const WorldDef&) = default;
};

/// A hash over everything in `def` that can change a result, and the set of assets
/// (`AssetSet::hash`, 0 for none): peers compare it before they play.
[[nodiscard]] std::uint64_t config_hash(const WorldDef& def, std::uint64_t assets = 0);

/// Counters of one step. They cost nothing and are the same on every peer; where a RollbackHistory
/// recalls islands, `status` and `asleep_bodies` still are.
struct StepReport {
  Status status = Status::ok;       ///< capacity_exhausted: pairs were left out, alike everywhere
  std::uint32_t moving_bodies = 0;  ///< awake, dynamic or kinematic; without still ones
  std::uint32_t asleep_bodies = 0;  ///< at the end of the step; kinematic ones that stand included
  std::uint32_t islands = 0;      ///< that were looked at, because a body of one was ready to sleep
  std::uint32_t free_bodies = 0;  ///< took the exact ballistic path, no solver
  std::uint32_t axis_turns = 0;   ///< about a principal axis: none of spheres, one of tops
  std::uint32_t pairs = 0;        ///< pairs with overlapping bounds, of which one is awake
  std::uint32_t contacts = 0;     ///< pairs with contact points, triggers excluded
  std::uint32_t contact_points = 0;     ///< of these contacts
  std::uint32_t colors = 0;             ///< of the constraint graph
  std::uint32_t overflow_contacts = 0;  ///< found no colour, were solved one by one
  std::uint32_t continuous_bodies = 0;  ///< moved far enough to be followed along their way
  std::uint32_t impacts = 0;            ///< stops on the way
  std::uint32_t saturations = 0;        ///< values clamped to their range
  std::uint32_t energy_limits = 0;      ///< times that an island gave back energy that its joints
                                        ///< had added, by substep
  std::uint32_t computed_islands = 0;   ///< by a RollbackHistory alone: groups of bodies that could
                                        ///< reach each other and were stepped
  std::uint32_t recalled_islands = 0;   ///< and those whose results came from memory
  std::uint32_t still_bodies = 0;       ///< awake, of islands that stand still and are not solved
  std::uint32_t still_contacts = 0;     ///< and the contacts of these islands

  friend bool operator==(const StepReport&, const StepReport&) = default;
};

/// Hashes of one state; `total` covers the others.
struct StateHash {
  std::uint64_t total = 0;     ///< of the whole state
  std::uint64_t header = 0;    ///< of tick, gravity, counts and fluids
  std::uint64_t bodies = 0;    ///< of all body records
  std::uint64_t contacts = 0;  ///< of all contact records
  std::uint64_t joints = 0;    ///< of all joint records
  std::uint32_t hashed = 0;    ///< records that were hashed in this call: no part of the state
};

/// The same with 128 bits: of all records at once, on demand.
struct StateHash128 {
  Hash128 total;     ///< of the whole state
  Hash128 header;    ///< of tick, gravity, counts and fluids
  Hash128 bodies;    ///< of all body records
  Hash128 contacts;  ///< of all contact records
  Hash128 joints;    ///< of all joint records

  friend bool operator==(const StateHash128&, const StateHash128&) = default;
};

/// An inconsistency in a world; false when nothing was found.
struct WorldFault {
  const char* what = nullptr;  ///< in English, for a log
  std::uint32_t index = 0;     ///< of the record, where one is named

  explicit operator bool() const { return what != nullptr; }
};

/// The stores of a state, in the order of snapshots.
enum class StateStore : std::uint8_t { bodies, contacts, joints };
[[nodiscard]] std::string_view to_string(StateStore store);

class CommandExplainer;
class WorldContacts;
class WorldFluids;

class World {
 public:
  /// invalid_argument when a value of `def` is outside its range: `explain` says which. Takes all
  /// memory that steps need, by the capacities. Bodies may use the assets of the set; worlds may
  /// share one.
  static Result<World> create(const WorldDef& def,
                              std::shared_ptr<const AssetSet> assets = nullptr);

  World(World&&) noexcept;
  World& operator=(World&&) noexcept;
  ~World();

  [[nodiscard]] const WorldDef& def() const;
  [[nodiscard]] const std::shared_ptr<const AssetSet>& assets() const;  ///< never null
  [[nodiscard]] std::uint64_t tick() const;                             ///< ticks stepped

  // Commands --------------------------------------------------------------------------------------

  /// Makes a body: capacity_exhausted, invalid_argument or, for an unknown asset, not_found when it
  /// cannot be. Slots are reused, lowest first; each holds 2^32 − 2 bodies in its life.
  Result<BodyHandle> create_body(const BodyDef& def);

  /// Makes a joint: capacity_exhausted, stale_handle for a body, or invalid_argument when it cannot
  /// be. Slots are reused as those of bodies. Destroying a body destroys its joints.
  Result<JointHandle> create_joint(const JointDef& def);

  /// Applies one command now. On any status but ok nothing has changed.
  Status apply(const Command& command);

  /// Why `create`, `create_body`, `create_joint` or `apply` would refuse this now: the field, its
  /// value and its valid range. Empty where they would not. Allocates text: for logs and editors.
  /// Not from two threads at once.
  static Refusal explain(const WorldDef& def);
  Refusal explain(const BodyDef& def) const;
  Refusal explain(const JointDef& def) const;
  Refusal explain(const Command& command) const;

  // The tick --------------------------------------------------------------------------------------

  /// Advances by 1 / tick_rate seconds.
  StepReport step();

  /// Events of the last step; empty after `load`. Read them before the next step: they are not
  /// state.
  [[nodiscard]] std::span<const ContactEvent> events() const;

  /// The joints that broke in the last step, by index.
  [[nodiscard]] std::span<const JointEvent> joint_events() const;

  /// Clears the profile and takes times by `now` from here on; null, as at first, takes none. No
  /// result depends on it.
  void set_clock(ProfileClock now, ProfileDetail detail = ProfileDetail::stages);
  [[nodiscard]] const StepProfile& profile() const;

  /// Whether steps hash the data after each stage, which takes about as long as the step. No
  /// result depends on it. Without it, as at first, the digests are zero.
  void trace_stages(bool on);
  [[nodiscard]] const StageDigests& stage_digests() const;  ///< of the last step

  /// Checks at level 2: records within their ranges, order of contacts, lists, bounds and hashes as
  /// they follow from the state; the first fault found. Takes about as long as a step. Not from two
  /// threads at once.
  [[nodiscard]] WorldFault find_fault() const;

  /// Does so after each stage of a step from here on, and stops the program at a fault as LKS_CHECK
  /// does. No result depends on it.
  void set_validation(bool each_stage);

  /// Steps on the runner's workers from here on; null, as at first, on the calling thread alone.
  /// Not state: no result depends on it. The runner must outlive its use. Allocates the workers'
  /// scratch memory, so that `step` does not.
  void set_task_runner(TaskRunner* runner, TaskPieces pieces = TaskPieces::worthwhile);

  // Bodies ----------------------------------------------------------------------------------------

  [[nodiscard]] bool exists(BodyHandle body) const;
  [[nodiscard]] std::uint32_t body_count() const;

  /// Every body has an index below this; `body_at` gives its handle, null for an empty slot.
  [[nodiscard]] std::uint32_t body_limit() const;
  [[nodiscard]] BodyHandle body_at(std::uint32_t index) const;

  /// The body must exist.
  [[nodiscard]] BodyView body(BodyHandle body) const;
  [[nodiscard]] Vec3<Position> position(BodyHandle body) const;  ///< of the shape's frame
  [[nodiscard]] Vec3<Velocity> velocity(BodyHandle body) const;

  /// Names a body for people, as `describe_difference` prints it. A name is not state: it is
  /// neither hashed nor saved, changes no result, and a world that loads a snapshot knows the names
  /// that were set in it alone: for a name that a snapshot holds, make it of `user_data`
  /// (docs/how-to/debugging.md). It stays with its handle, over `load` too. A name longer
  /// than k_max_body_name bytes is cut; a control character or a quotation mark becomes '?'.
  /// stale_handle when there is no such body. Does not allocate.
  Status set_name(BodyHandle body, std::string_view name);

  /// Empty without a name or a body. Valid until the slot's next body is made or named.
  [[nodiscard]] std::string_view name(BodyHandle body) const;

  /// Mass in kilograms, error ≤ 2^-30 relative; 0 for static and kinematic bodies.
  [[nodiscard]] Mass mass(BodyHandle body) const;

  /// Two bodies have a contact point with separation ≤ 0 or an impulse, as of the last step.
  [[nodiscard]] bool touching(BodyHandle a, BodyHandle b) const;

  // Joints ----------------------------------------------------------------------------------------

  [[nodiscard]] bool exists(JointHandle joint) const;
  [[nodiscard]] std::uint32_t joint_count() const;

  /// Every joint has an index below this; `joint_at` gives its handle, null for an empty slot.
  [[nodiscard]] std::uint32_t joint_limit() const;
  [[nodiscard]] JointHandle joint_at(std::uint32_t index) const;

  /// The joint must exist.
  [[nodiscard]] JointView joint(JointHandle joint) const;

  // Queries: read-only, safe from several threads, results in canonical order (query.h) ----------

  /// The first body along the ray; ties go to the lower index.
  [[nodiscard]] RayHit cast_ray(const Vec3<Position>& origin, const Vec3<Length>& translation,
                                const QueryFilter& filter = {}) const;

  /// Whether anything is in the way: stops at the first body found.
  [[nodiscard]] bool is_ray_blocked(const Vec3<Position>& origin, const Vec3<Length>& translation,
                                    const QueryFilter& filter = {}) const;

  /// Every body along the ray, each where the ray enters it, nearest first and the lower index of
  /// equals, as many as `out` holds; returns how many were written.
  std::size_t cast_ray_all(const Vec3<Position>& origin, const Vec3<Length>& translation,
                           std::span<RayHit> out, const QueryFilter& filter = {}) const;

  /// `cast_ray` for each; `out` is as long as `rays`.
  void cast_rays(std::span<const Ray> rays, std::span<RayHit> out,
                 const QueryFilter& filter = {}) const;

  /// Bodies that overlap a sphere, by index, as many as `out` holds; returns how many were written.
  std::size_t overlap_sphere(const Vec3<Position>& center, Length radius, std::span<BodyHandle> out,
                             const QueryFilter& filter = {}) const;

  /// The same for a convex shape.
  std::size_t overlap_shape(const Shape& shape, const Transform& pose, std::span<BodyHandle> out,
                            const QueryFilter& filter = {}) const;

  /// The first body that a convex shape meets on its way; ties go to the lower index. A cast that
  /// starts in an overlap hits at fraction 0.
  [[nodiscard]] ShapeHit cast_shape(const ShapeCast& cast, const QueryFilter& filter = {}) const;

  /// Every body on the way, nearest first, as `cast_ray_all`.
  std::size_t cast_shape_all(const ShapeCast& cast, std::span<ShapeHit> out,
                             const QueryFilter& filter = {}) const;

  /// `cast_shape` for each; `out` is as long as `casts`.
  void cast_shapes(std::span<const ShapeCast> casts, std::span<ShapeHit> out,
                   const QueryFilter& filter = {}) const;

  /// The nearest point of any body within `reach` (at most k_max_cast); ties go to the lower index,
  /// then the lower part.
  [[nodiscard]] ClosestHit closest_point(const Vec3<Position>& point, Length reach,
                                         const QueryFilter& filter = {}) const;

  /// How a convex shape meets bodies: the manifolds of all points nearer than `margin` (at most 64
  /// m) or overlapping, by body and part, as many as `out` holds.
  std::size_t contacts_of_shape(const Shape& shape, const Transform& pose, Length margin,
                                std::span<ShapeContact> out, const QueryFilter& filter = {}) const;

  /// Bodies that hold a point, surface included.
  std::size_t bodies_at(const Vec3<Position>& point, std::span<BodyHandle> out,
                        const QueryFilter& filter = {}) const;

  /// Draws the bodies by index, then the contacts by key, then the joints by index. Not from two
  /// threads at once.
  void draw(DebugDraw& out, const DebugDrawOptions& options = {}) const;

  // State -----------------------------------------------------------------------------------------

  /// Hashes only the records that changed since the last call, so that a world at rest costs
  /// nothing. Not from two threads at once.
  [[nodiscard]] StateHash hash() const;

  /// Hashes everything again.
  [[nodiscard]] StateHash128 hash128() const;

  /// The hashes of a store's records in the order of the state, as many as `out` holds; returns how
  /// many there are. A store's hash is their sum: with both sides' lists one knows which records
  /// differ.
  std::size_t record_hashes(StateStore store, std::span<std::uint64_t> out) const;

  /// Upper bound on `save`, constant over the world's life.
  [[nodiscard]] std::size_t snapshot_bytes_max(SnapshotKind kind) const;

  /// Writes the state; returns the number of bytes, 0 when `out` is too small.
  [[nodiscard]] std::size_t save(SnapshotKind kind, std::span<std::byte> out) const;

  /// Replaces the state. Canonical bytes may come from anywhere: they are checked in full before
  /// anything changes. Native bytes must come from `save` in this process.
  Status load(SnapshotKind kind, ByteView bytes);

  /// As native snapshots, but only the differences from one, `base`, which `load_delta` must be
  /// given again: of a world at rest a few bytes for each hundred bodies. 0 when `out` is too small
  /// or `base` is none of this world.
  [[nodiscard]] std::size_t delta_bytes_max() const;
  [[nodiscard]] std::size_t save_delta(ByteView base, std::span<std::byte> out) const;
  Status load_delta(ByteView base, ByteView delta);

  /// The first difference between two canonical snapshots of worlds with this definition. Bodies,
  /// and those of contacts and joints, are called by the names that they have in this world.
  [[nodiscard]] StateDifference describe_difference(ByteView here, ByteView there) const;

  /// Flips a bit of a field in memory, as a hardware fault would, to test the checks that must find
  /// it. Stores, objects and fields are those of a StateDifference; false when there is no such
  /// bit. The world may then be hashed, saved and compared, and must be loaded before anything
  /// else.
  bool flip_bit(std::string_view store, std::uint64_t object, std::string_view field, unsigned bit);

  /// Forgets everything that is not state, but for names. Tests call it every tick: the future must
  /// not change.
  void drop_derived();

  struct Impl;  // of the library's own files

 private:
  friend class CommandExplainer;
  friend class WorldContacts;
  friend class WorldFluids;
  friend class WorldRules;
  friend class WorldVehicles;
  friend class WorldTerrain;
  friend class RollbackHistory;
  friend Transform pose_of(const World& world, BodyHandle body);
  friend std::size_t bodies_in_box(const World& world, const Vec3<Position>& lower,
                                   const Vec3<Position>& upper, std::span<BodyHandle> out,
                                   const QueryFilter& filter);
  explicit World(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// The pose of a body's shape, as `World::body` gives it, for loops over all bodies: it computes
/// nothing else. The body must exist.
[[nodiscard]] Transform pose_of(const World& world, BodyHandle body);

/// Bodies whose bounds overlap a closed box, by index, as many as `out` holds; returns how many
/// were written. The bounds lie along the world's axes, rounded outward by at most 8 µm; those of
/// an asset hold its own box, turned as the body is. Nothing finer is looked at. `lower` may not be
/// above `upper`; both lie within ±k_world_limit.
std::size_t bodies_in_box(const World& world, const Vec3<Position>& lower,
                          const Vec3<Position>& upper, std::span<BodyHandle> out,
                          const QueryFilter& filter = {});

/// This build's hash of a short built-in scene. Two builds that differ here would diverge in a
/// match.
[[nodiscard]] std::uint64_t canary_hash();

}  // namespace lockstone
