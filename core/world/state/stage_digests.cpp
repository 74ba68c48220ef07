// A hash of the data after each stage of a step: pairs, manifolds, the solver's bodies, then
// the state itself.

#include <array>

#include <lockstone/hash.h>

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

std::uint64_t World::Impl::digest_of(StepStage stage) const {
  Digest digest;
  const auto add_all = [&](auto store) {
    for_each_record<decltype(store)>(
        *this, [&](std::uint32_t, const auto& record) { digest.add_record(record); });
  };
  const auto add_contacts = [&] {
    for (const ContactRecord& contact : new_contacts)
      digest.add_record(contact);
  };
  switch (stage) {
    case StepStage::find_pairs:
      for (const Pair& pair : pairs)
        digest.add(pair.a, pair.b);
      break;
    case StepStage::collide:
    case StepStage::prepare:
      for (const std::uint32_t slot : slots)
        add_manifold(manifolds[slot], digest);
      add_contacts();
      break;
    case StepStage::solve:
      for (std::uint32_t body = 0; body < header.body_limit; ++body) {
        const SolverBody* solved = awake.has(body) ? solver.find(body) : nullptr;
        if (solved == nullptr) continue;
        for (const Vec3<Velocity>& speed : solver.speeds(*solved))
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
      for (const ContactEvent& event : events)
        digest.add(static_cast<std::uint8_t>(event.kind), event.a.index, event.b.index,
                   event.approach_speed.raw);
      break;
  }
  return digest.value();
}

// Without anything to do after stages there is no hook.
void World::Impl::set_stage_hook() {
  const auto hook = [](void* context, StepStage stage) {
    auto& world = *static_cast<Impl*>(context);
    if (world.traces_stages)
      world.stage_digests.after[static_cast<std::size_t>(stage)] = world.digest_of(stage);
    if (world.validates) StateValidator(world).check_after(stage);
  };
  profiler.set_hook(traces_stages || validates ? +hook : nullptr, this);
}

void World::trace_stages(bool on) {
  impl_->traces_stages = on;
  impl_->stage_digests = {};
  impl_->set_stage_hook();
}

const StageDigests& World::stage_digests() const {
  return impl_->stage_digests;
}

}  // namespace lockstone
