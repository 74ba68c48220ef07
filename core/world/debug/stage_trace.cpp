// A hash of the data after each stage of a step: pairs, manifolds, the solver's bodies, then
// the state itself.

#include "core/world/debug/stage_trace.h"

#include <array>

#include <lockstone/hash.h>

#include "core/dynamics/step/contact_solver.h"
#include "core/world/state/record_hash.h"
#include "core/world/state/state_validator.h"
#include "core/world/world_impl.h"

namespace lockstone {
namespace {

// A sum of hashes, each seeded with its place, so that nothing needs a buffer.
class Digest {
 public:
  template <class Record>
  void add_record(const Record& record) {
    sum_ += hash_record(record, ++place_);
  }

  template <class... Integers>
  void add(Integers... integers) {
    std::array<std::byte, (sizeof(Integers) + ...)> bytes{};
    ByteWriter writer(bytes);
    (writer.put(integers), ...);
    sum_ += hash64(bytes, ++place_);
  }

  template <class D, class R, int N>
  void add(const Vec3<Fixed<D, R, N>>& v) {
    add(v.x.raw, v.y.raw, v.z.raw);
  }

  [[nodiscard]] std::uint64_t value() const { return sum_; }

 private:
  std::uint64_t sum_ = 0;
  std::uint64_t place_ = 0;
};

void add_manifold(const Manifold& manifold, Digest& digest) {
  digest.add(manifold.normal);
  for (int i = 0; i < manifold.count; ++i) {
    const ManifoldPoint& point = manifold.points[static_cast<std::size_t>(i)];
    digest.add(point.anchor_a);
    digest.add(point.anchor_b);
    digest.add(point.separation.raw, point.feature);
  }
}

}  // namespace

std::uint64_t StageTrace::digest_of(StepStage stage) const {
  Digest digest;
  const auto add_all = [&](auto store) {
    for_each_record<decltype(store)>(
        world_, [&](std::uint32_t, const auto& record) { digest.add_record(record); });
  };
  const auto add_contacts = [&] {
    for (const ContactRecord& contact : world_.found.records)
      digest.add_record(contact);
  };
  switch (stage) {
    case StepStage::find_pairs:
      for (const Pair& pair : world_.pairs)
        digest.add(pair.a, pair.b);
      break;
    case StepStage::collide:
    case StepStage::prepare:
      for (const std::uint32_t id : world_.found.manifold_ids)
        add_manifold(world_.found.manifolds[id], digest);
      add_contacts();
      break;
    case StepStage::solve:
      for (std::uint32_t body = 0; body < world_.header.body_limit; ++body) {
        const SolverBody* solved = world_.awake.has(body) ? world_.solver->find(body) : nullptr;
        if (solved == nullptr) continue;
        for (const Vec3<Velocity>& speed : world_.solver->speeds(*solved))
          digest.add(speed);
      }
      break;
    case StepStage::store:
      add_contacts();
      add_all(JointStore{});
      break;
    default:
      add_all(BodyStore{});
      add_all(JointStore{});
      if (stage < StepStage::events) break;
      for (const ContactEvent& event : world_.events.list())
        digest.add(static_cast<std::uint8_t>(event.kind), event.a.index, event.b.index,
                   event.approach_speed.raw);
      break;
  }
  return digest.value();
}

void StageTrace::begin_step() {
  if (takes_digests_) digests_.before = digest_of(StepStage::move);
}

void StageTrace::after(StepStage stage) {
  if (takes_digests_) digests_.after[static_cast<std::size_t>(stage)] = digest_of(stage);
  if (validates_) StateValidator(world_).check_after(stage);
}

// Without anything to do after stages there is no hook.
void StageTrace::set_hook() {
  const auto hook = [](void* context, StepStage stage) {
    static_cast<StageTrace*>(context)->after(stage);
  };
  world_.profiler.set_hook(takes_digests_ || validates_ ? +hook : nullptr, this);
}

void StageTrace::take_digests(bool on) {
  takes_digests_ = on;
  digests_ = {};
  set_hook();
}

void StageTrace::validate(bool on) {
  validates_ = on;
  set_hook();
}

void World::trace_stages(bool on) {
  impl_->trace.take_digests(on);
}

const StageDigests& World::stage_digests() const {
  return impl_->trace.digests();
}

}  // namespace lockstone
