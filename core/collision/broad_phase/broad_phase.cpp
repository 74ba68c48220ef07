#include "core/collision/broad_phase/broad_phase.h"

#include <algorithm>
#include <utility>

#include <lockstone/assert.h>

namespace lockstone {
namespace {

// How far a body may go before its fat box is put again: an eighth of its length on every side, but
// no more than an eighth of a metre, and ahead as far as it goes in the next ticks at its present
// speed, but no farther than half its length: so closely packed bodies get few candidates that
// never touch.
constexpr BoundsCoordinate k_most_margin = BoundsCoordinate::from_ratio(1, 8);
constexpr int k_margin_shift = 3;
constexpr std::int64_t k_ticks_ahead = 8;

// Candidates for each pair that the world has room for.
constexpr std::size_t k_candidates_per_pair = 2;

// Rows of candidates that are worth a worker.
constexpr std::uint32_t k_row_grain = 64;

// How long nothing but full searches are made once the candidates did not fit: a tick at first,
// since a world that was just loaded has fat boxes that few bodies keep, then twice as long each
// time, up to this.
constexpr std::uint32_t k_longest_pause = 64;

BoundsCoordinate plus(BoundsCoordinate x, std::int64_t distance) {
  return BoundsCoordinate::from_raw(raw::saturate<std::int32_t>(std::int64_t{x.raw} + distance));
}

std::int64_t length(BoundsCoordinate low, BoundsCoordinate high) {
  return std::int64_t{high.raw} - low.raw;
}

BoundsCoordinate margin_of(const Bounds& bounds) {
  std::int64_t longest = 0;
  for (int i = 0; i < 3; ++i)
    longest = std::max(longest, length(bounds.lower[i], bounds.upper[i]));
  LKS_ASSERT(longest >= 0);
  const std::int64_t margin = std::min<std::int64_t>(longest >> k_margin_shift, k_most_margin.raw);
  return BoundsCoordinate::from_raw(static_cast<std::int32_t>(margin));
}

Bounds fattened(const Bounds& before, const Bounds& now) {
  Bounds fat = inflated(now, margin_of(now));
  LKS_ASSERT(contains(fat, now));
  for (int i = 0; i < 3; ++i) {
    const std::int64_t limit = length(now.lower[i], now.upper[i]) / 2;
    const std::int64_t ahead = k_ticks_ahead * length(before.lower[i], now.lower[i]);
    if (ahead > 0) fat.upper[i] = plus(fat.upper[i], std::min(ahead, limit));
    if (ahead < 0) fat.lower[i] = plus(fat.lower[i], std::max(ahead, -limit));
  }
  return fat;
}

// A body that was fast and is slow has a fat box that meets too many.
bool is_too_fat(const Bounds& fat, const Bounds& before, const Bounds& now) {
  bool too_fat = false;
  const std::int64_t margin = margin_of(now).raw;
  for (int i = 0; i < 3; ++i) {
    const std::int64_t step = length(before.lower[i], now.lower[i]);
    LKS_ASSERT(fat.lower[i] <= now.lower[i] && fat.upper[i] >= now.upper[i]);
    const std::int64_t spare =
        length(fat.lower[i], fat.upper[i]) - length(now.lower[i], now.upper[i]);
    too_fat |= spare > 4 * margin + 2 * k_ticks_ahead * (step < 0 ? -step : step);
  }
  return too_fat;
}

// Then the body stays where it is in the search.
bool same_but_sleep(ProxyTraits a, const ProxyTraits& b) {
  a.is_asleep = b.is_asleep;
  return a == b;
}

std::variant<TreeSearch, SweepAndPrune> make_search(BroadPhaseKind kind, std::uint32_t capacity) {
  if (kind == BroadPhaseKind::sweep_and_prune) return SweepAndPrune(capacity);
  return TreeSearch(capacity);
}

}  // namespace

BroadPhase::BroadPhase(BroadPhaseKind kind, std::uint32_t body_capacity,
                       std::uint32_t pair_capacity)
    : search_(make_search(kind, body_capacity)),
      bounds_(body_capacity),
      proxies_(body_capacity),
      is_touched_(body_capacity),
      candidates_(body_capacity, k_candidates_per_pair * pair_capacity),
      pairs_(pair_capacity) {
  touched_.reserve(body_capacity);
  refined_.reserve(body_capacity);
}

void BroadPhase::clear() {
  std::visit([](auto& search) { search.clear(); }, search_);
  std::fill(proxies_.begin(), proxies_.end(), Proxy{});
  release_touched();
  body_limit_ = 0;
  has_candidates_ = false;
  ticks_without_candidates_ = next_pause_ = 0;
  changed_ = true;
}

bool BroadPhase::update(std::uint32_t body, const Bounds& bounds) {
  LKS_ASSERT(has(body));
  const Bounds& fat = proxies_[body].fat;
  if (bounds_[body] == bounds) return true;
  if (!contains(fat, bounds) || is_too_fat(fat, bounds_[body], bounds)) return false;
  bounds_[body] = bounds;
  return true;
}

void BroadPhase::set(std::uint32_t body, const Bounds& bounds, const ProxyTraits& traits) {
  LKS_ASSERT(body < proxies_.size());
  Proxy& proxy = proxies_[body];
  if (proxy.present && proxy.traits == traits) {
    if (bounds_[body] == bounds) return;
    changed_ = true;
    if (update(body, bounds)) return;
    const Bounds before = bounds_[body];
    bounds_[body] = bounds;
    proxy.fat = traits.moves ? fattened(before, bounds) : bounds;
  } else if (proxy.present && same_but_sleep(proxy.traits, traits) && contains(proxy.fat, bounds)) {
    bounds_[body] = bounds;
    proxy.traits = traits;
    touch(body);
    return;
  } else {
    bounds_[body] = bounds;
    proxy = {inflated(bounds, traits.moves ? margin_of(bounds) : BoundsCoordinate{}), traits, true};
    body_limit_ = std::max(body_limit_, body + 1);
  }
  touch(body);
  std::visit([&](auto& search) { search.put(body); }, search_);
}

void BroadPhase::remove(std::uint32_t body) {
  if (!has(body)) return;
  proxies_[body] = {};
  touch(body);
  std::visit([&](auto& search) { search.remove(body); }, search_);
}

void BroadPhase::touch(std::uint32_t body) {
  changed_ = true;
  if (is_touched_[body] != 0) return;
  is_touched_[body] = 1;
  LKS_ASSERT(body < body_limit_);
  touched_.push_back(body);
}

void BroadPhase::touch_all() {
  for (std::uint32_t body = 0; body < body_limit_; ++body)
    touch(body);
}

void BroadPhase::release_touched() {
  for (const std::uint32_t body : touched_)
    is_touched_[body] = 0;
  touched_.clear();
}

std::span<const Pair> BroadPhase::find_pairs() {
  Parallel alone;
  return find_pairs(alone);
}

std::span<const Pair> BroadPhase::find_pairs(Parallel& parallel) {
  effort_ = {};
  if (!changed_) return pairs_.pairs();
  settle();
  if (auto* sweep = std::get_if<SweepAndPrune>(&search_)) {
    sweep->refresh(touched_, proxies_, is_touched_);
  }
  pairs_.clear();
  if (update_candidates()) {
    parallel.workers() > 1 ? refine_candidates(parallel) : refine_candidates();
  } else {
    search_all();
  }
  release_touched();
  changed_ = false;
  LKS_ASSERT(std::ranges::is_sorted(pairs_.pairs()));
  return pairs_.pairs();
}

// Calls `emit(pair)` for each two bodies that may collide and whose fat boxes overlap, if one of
// them is touched.
template <class Emit>
bool BroadPhase::search(Emit&& emit) {
  LKS_ASSERT(touched_.size() <= body_limit_);
  effort_.searched = static_cast<std::uint32_t>(touched_.size());
  const auto keep = [&](std::uint32_t one, std::uint32_t other) {
    const ProxyTraits& traits = proxies_[one].traits;
    const ProxyTraits& others = proxies_[other].traits;
    if (!can_meet(traits, others)) return true;
    const Pair pair{one, other};
    return emit(is_in_order(pair, leads(traits), leads(others)) ? pair : Pair{other, one});
  };
  const auto run = [&](auto& search) {
    return search.search(touched_, proxies_, is_touched_, keep);
  };
  return std::visit(run, search_);
}

void BroadPhase::settle(Moment moment) {
  auto* trees = std::get_if<TreeSearch>(&search_);
  if (trees == nullptr) return;
  LKS_ASSERT(body_limit_ <= proxies_.size());
  const auto proxies = std::span<const Proxy>(proxies_).first(body_limit_);
  moment == Moment::tick ? trees->refresh(proxies) : trees->refresh_when_many(proxies);
}

// Returns whether the candidates are complete.
bool BroadPhase::update_candidates() {
  if (ticks_without_candidates_ > 0) {
    --ticks_without_candidates_;
    return false;
  }
  if (!has_candidates_) {
    candidates_.clear();
    touch_all();
  }
  if (touched_.empty()) return true;
  has_candidates_ = search([&](const Pair& pair) { return candidates_.add(pair); }) &&
                    candidates_.merge(std::span(is_touched_).first(body_limit_));
  next_pause_ = has_candidates_ ? 0 : std::clamp(2 * next_pause_, 1U, k_longest_pause);
  ticks_without_candidates_ = next_pause_;
  return has_candidates_;
}

void BroadPhase::refine_candidates() {
  candidates_.for_each([&](std::uint32_t body, std::span<const std::uint32_t> partners) {
    LKS_ASSERT(has(body));
    const Bounds bounds = bounds_[body];
    for (const std::uint32_t partner : partners) {
      if (overlap(bounds, bounds_[partner]) && !pairs_.append({body, partner})) return;
    }
  });
}

// The same: pairs are counted by row, and then written to where those of the rows before end.
void BroadPhase::refine_candidates(Parallel& parallel) {
  const Loop rows{candidates_.row_count(), k_row_grain};
  LKS_ASSERT(rows.count <= body_limit_);
  refined_.resize(rows.count);
  const auto for_each_pair = [&](std::uint32_t row, auto&& visit) {
    const std::uint32_t body = candidates_.body(row);
    const Bounds bounds = bounds_[body];
    for (const std::uint32_t partner : candidates_.partners(row)) {
      if (overlap(bounds, bounds_[partner])) visit(Pair{body, partner});
    }
  };
  parallel.for_each(rows, [&](std::uint32_t first, std::uint32_t end, std::uint32_t) {
    for (std::uint32_t row = first; row < end; ++row) {
      refined_[row] = 0;
      for_each_pair(row, [&](const Pair&) { ++refined_[row]; });
    }
  });
  std::size_t count = 0;
  for (std::uint32_t& of_row : refined_)
    count += std::exchange(of_row, static_cast<std::uint32_t>(count));
  const std::span<Pair> all = pairs_.make_room(count);
  parallel.for_each(rows, [&](std::uint32_t first, std::uint32_t end, std::uint32_t) {
    for (std::uint32_t row = first; row < end; ++row) {
      std::size_t place = refined_[row];
      for_each_pair(row, [&](const Pair& pair) {
        if (place < all.size()) all[place] = pair;
        ++place;
      });
    }
  });
}

void BroadPhase::search_all() {
  effort_.searched_all = true;
  LKS_ASSERT(pairs_.pairs().empty());
  touch_all();
  (void)search([&](const Pair& pair) {
    if (overlap(bounds_[pair.a], bounds_[pair.b])) pairs_.offer(pair);
    return true;
  });
  pairs_.sort();
}

bool BroadPhase::is_valid() const {
  for (std::uint32_t body = 0; body < body_limit_; ++body) {
    if (has(body) && !contains(proxies_[body].fat, bounds_[body])) return false;
  }
  return std::visit([](const auto& search) { return search.is_valid(); }, search_);
}

}  // namespace lockstone
