// Finds the pairs of bodies whose bounds overlap and that may meet.
//
// The pair set is a function of the tight bounds and the traits of the bodies alone. All else is
// derived: each body has a fat box around its bounds; the pairs whose fat boxes overlap are kept as
// candidates, and only a body that left its fat box is searched for again (the move buffer of
// E. Catto, Box2D and Box3D). When no body does, a tick costs one test for each candidate, and
// nothing at all when no bounds changed.
#pragma once

#include <cstdint>
#include <span>
#include <variant>
#include <vector>

#include <lockstone/assert.h>
#include <lockstone/collision.h>

#include "core/base/parallel.h"
#include "core/collision/broad_phase/bounds.h"
#include "core/collision/broad_phase/candidate_pairs.h"
#include "core/collision/broad_phase/pair_list.h"
#include "core/collision/broad_phase/proxy.h"
#include "core/collision/broad_phase/sweep_and_prune.h"
#include "core/collision/broad_phase/tree_search.h"

namespace lockstone {

/// The mask that no category is outside of: groups override categories.
inline constexpr std::uint32_t k_every_category = 0xffffffff;

class BroadPhase {
 public:
  BroadPhase(BroadPhaseKind kind, std::uint32_t body_capacity, std::uint32_t pair_capacity);

  /// Forgets all bodies.
  void clear();

  /// Sets a body's tight bounds and traits, adding the body if it is new.
  void set(std::uint32_t body, const Bounds& bounds, const ProxyTraits& traits);
  void remove(std::uint32_t body);

  /// Sets the bounds of a body that is present, as `set` with the same traits does, if nothing else
  /// has to change for that; otherwise does nothing and returns false. Calls for different bodies
  /// may go on at the same time; `note_change` must follow if any of the bounds were new.
  [[nodiscard]] bool update(std::uint32_t body, const Bounds& bounds);
  void note_change() { changed_ = true; }

  [[nodiscard]] bool has(std::uint32_t body) const { return proxies_[body].present; }
  [[nodiscard]] const Bounds& bounds(std::uint32_t body) const { return bounds_[body]; }

  enum class Moment : std::uint8_t { tick, command };

  /// Prepares for queries, at a command only after many changes; without it they are right, but
  /// slower. Does nothing that `find_pairs` would not do.
  void settle(Moment moment = Moment::tick);

  /// All pairs whose bounds overlap and for which `can_meet` holds, sorted. When they exceed the
  /// capacity, the first ones in that order, and `overflowed` is true. Valid until the next call.
  std::span<const Pair> find_pairs(Parallel& parallel);
  std::span<const Pair> find_pairs();

  [[nodiscard]] bool overflowed() const { return pairs_.overflowed(); }

  /// Calls `visit(body)` for every body whose category is in `mask` and whose bounds pass
  /// `test(bounds)`, in no promised order. A test that fails for a box must fail for every box
  /// inside it.
  template <class Test, class Visit>
  void traverse(std::uint32_t mask, Test&& test, Visit&& visit) const {
    traverse_some(mask, true, test, visit);
  }

  /// The same of every category, but only for bodies that nothing pushes.
  template <class Test, class Visit>
  void traverse_immovable(Test&& test, Visit&& visit) const {
    traverse_some(k_every_category, false, test, visit);
  }
  /// Counts of the last `find_pairs`, for tests and measurements: bodies searched for again, and
  /// whether the candidates had no room, so that everything was searched.
  struct Effort {
    std::uint32_t searched = 0;
    bool searched_all = false;
  };
  [[nodiscard]] const Effort& effort() const { return effort_; }

  [[nodiscard]] bool is_valid() const;

 private:
  template <class Test, class Visit>
  void traverse_some(std::uint32_t mask, bool with_dynamic, Test&& test, Visit&& visit) const {
    LKS_ASSERT(body_limit_ <= proxies_.size() && body_limit_ <= bounds_.size());
    const auto look = [&](std::uint32_t body) {
      const Proxy& proxy = proxies_[body];
      const bool asked = proxy.present && (with_dynamic || !proxy.traits.is_dynamic) &&
                         (proxy.traits.filter.category & mask) != 0;
      if (asked && test(bounds_[body])) visit(body);
    };
    if (const auto* trees = std::get_if<TreeSearch>(&search_)) {
      trees->traverse(mask, with_dynamic, test, look);
      return;
    }
    // The sorted list is in order only after a search for pairs, and along one axis a query would
    // still pass half of it: looking at all costs little more and leaves nothing to keep up.
    for (std::uint32_t body = 0; body < body_limit_; ++body)
      look(body);
  }

  void touch(std::uint32_t body);
  void touch_all();
  void release_touched();
  bool update_candidates();
  void refine_candidates();
  void refine_candidates(Parallel& parallel);
  void search_all();
  template <class Emit>
  bool search(Emit&& emit);

  std::variant<TreeSearch, SweepAndPrune> search_;
  std::vector<Bounds> bounds_;  // tight, by body index
  std::vector<Proxy> proxies_;  // by body index
  std::uint32_t body_limit_ = 0;

  std::vector<std::uint32_t> touched_;    // since the last find_pairs: new, gone, changed, or out
  std::vector<std::uint8_t> is_touched_;  // by body
  bool changed_ = false;                  // anything at all since then

  CandidatePairs candidates_;
  std::uint32_t ticks_without_candidates_ = 0;  // to come
  std::uint32_t next_pause_ = 0;                // ticks; 0: the candidates fit last
  bool has_candidates_ = false;
  std::vector<std::uint32_t> refined_;  // by row of candidates: pairs; then where they begin
  PairList pairs_;
  Effort effort_;
};

}  // namespace lockstone
