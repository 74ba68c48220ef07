#include "core/collision/broad_phase/sweep_and_prune.h"

#include <algorithm>

#include <lockstone/assert.h>

namespace lockstone {
namespace {

// How often the axis is looked at again.
constexpr std::uint32_t k_axis_period = 64;

std::int64_t middle(BoundsCoordinate low, BoundsCoordinate high) {
  return (std::int64_t{low.raw} + high.raw) / 2;
}

}  // namespace

SweepAndPrune::SweepAndPrune(std::uint32_t body_capacity) : listed_(body_capacity) {
  for (std::vector<Entry>* list :
       {&lists_[0], &lists_[1], &touched_, &untouched_, &touched_standing_}) {
    list->reserve(body_capacity);
  }
}

void SweepAndPrune::clear() {
  lists_[0].clear();
  lists_[1].clear();
  std::fill(listed_.begin(), listed_.end(), Listed::nowhere);
  refreshes_ = 0;
}

void SweepAndPrune::refresh(std::span<const std::uint32_t> touched, std::span<const Proxy> proxies,
                            std::span<const std::uint8_t> is_touched) {
  LKS_ASSERT(axis_ >= 0 && axis_ < 3);
  if (touched.empty()) return;
  const bool concerned[] = {concerns(Listed::standing, touched, proxies),
                            concerns(Listed::moving, touched, proxies)};
  for (int i = 0; i < 2; ++i) {
    if (concerned[i]) update(lists_[i], k_lists[i], proxies, is_touched);
  }
  for (const std::uint32_t body : touched) {
    const Proxy& proxy = proxies[body];
    if (!proxy.present || listed_[body] != Listed::nowhere) continue;
    const int i = proxy.traits.moves ? 1 : 0;
    listed_[body] = k_lists[i];
    lists_[i].push_back(entry_of(body, proxy));
  }
  for (int i = 0; i < 2; ++i) {
    if (concerned[i]) sort(lists_[i]);
  }
  if (refreshes_++ % k_axis_period != 0) return;
  if (const int axis = widest_axis(); axis != axis_) turn(axis, proxies);
}

bool SweepAndPrune::belongs(const Proxy& proxy, Listed kind) {
  return proxy.present && proxy.traits.moves == (kind == Listed::moving);
}

bool SweepAndPrune::concerns(Listed kind, std::span<const std::uint32_t> touched,
                             std::span<const Proxy> proxies) const {
  return std::ranges::any_of(touched, [&](std::uint32_t body) {
    return listed_[body] == kind || belongs(proxies[body], kind);
  });
}

// Takes over new boxes and drops bodies that no longer belong.
void SweepAndPrune::update(std::vector<Entry>& list, Listed kind, std::span<const Proxy> proxies,
                           std::span<const std::uint8_t> is_touched) {
  std::size_t kept = 0;
  for (const Entry& entry : list) {
    const std::uint32_t body = entry.body;
    LKS_ASSERT(listed_[body] == kind);
    if (is_touched[body] == 0) {
      list[kept++] = entry;
    } else if (belongs(proxies[body], kind)) {
      list[kept++] = entry_of(body, proxies[body]);
    } else {
      listed_[body] = Listed::nowhere;
    }
  }
  list.resize(kept);
}

SweepAndPrune::Entry SweepAndPrune::entry_of(std::uint32_t body, const Proxy& proxy) const {
  const Bounds& box = proxy.fat;
  LKS_ASSERT(proxy.present && body < listed_.size());
  const int y = (axis_ + 1) % 3, z = (axis_ + 2) % 3;
  return {{{box.lower[axis_], box.lower[y], box.lower[z]},
           {box.upper[axis_], box.upper[y], box.upper[z]}},
          body};
}

// Bodies that move a little nearly keep their order, so that insertion sort takes one pass. A list
// that proves to be far from sorted is sorted as any other.
void SweepAndPrune::sort(std::vector<Entry>& list) {
  std::size_t moves_left = 8 * list.size();
  for (std::size_t i = 1; i < list.size(); ++i) {
    if (!(list[i] < list[i - 1])) continue;
    const Entry entry = list[i];
    std::size_t place = i;
    for (; place > 0 && entry < list[place - 1] && moves_left > 0; --place, --moves_left)
      list[place] = list[place - 1];
    list[place] = entry;
    if (moves_left == 0) {
      std::sort(list.begin(), list.end());
      return;
    }
  }
  LKS_ASSERT(std::is_sorted(list.begin(), list.end()));
}

// The axis along which the moving bodies are spread farthest, by the mean distance from the mean:
// along it the fewest boxes overlap. Another axis must be better by half, or two would take turns.
int SweepAndPrune::widest_axis() const {
  const std::vector<Entry>& list = lists_[1];
  const auto count = static_cast<std::int64_t>(std::max<std::size_t>(list.size(), 1));
  std::int64_t spread[3];
  for (int i = 0; i < 3; ++i) {
    std::int64_t sum = 0, distance = 0;
    for (const Entry& entry : list)
      sum += middle(entry.box.lower[i], entry.box.upper[i]);
    for (const Entry& entry : list) {
      const std::int64_t off = middle(entry.box.lower[i], entry.box.upper[i]) - sum / count;
      distance += off < 0 ? -off : off;
    }
    spread[i] = distance / count;
    LKS_ASSERT(spread[i] >= 0);
  }
  int widest = 0;  // counted from the present axis
  for (int i = 1; i < 3; ++i) {
    if (spread[i] > spread[widest] + (widest == 0 ? spread[0] / 2 : 0)) widest = i;
  }
  return (axis_ + widest) % 3;
}

void SweepAndPrune::turn(int axis, std::span<const Proxy> proxies) {
  LKS_ASSERT(axis >= 0 && axis < 3);
  axis_ = axis;
  for (std::vector<Entry>& list : lists_) {
    for (Entry& entry : list)
      entry = entry_of(entry.body, proxies[entry.body]);
    sort(list);
  }
}

void SweepAndPrune::split(std::span<const std::uint8_t> is_touched) {
  LKS_ASSERT(std::is_sorted(lists_[1].begin(), lists_[1].end()));
  touched_.clear();
  untouched_.clear();
  touched_standing_.clear();
  for (const Entry& entry : lists_[1]) {
    (is_touched[entry.body] != 0 ? touched_ : untouched_).push_back(entry);
  }
  for (const Entry& entry : lists_[0]) {
    if (is_touched[entry.body] != 0) touched_standing_.push_back(entry);
  }
}

bool SweepAndPrune::is_valid() const {
  for (int i = 0; i < 2; ++i) {
    const std::vector<Entry>& list = lists_[i];
    if (!std::is_sorted(list.begin(), list.end())) return false;
    const auto stray = [&](const Entry& entry) { return listed_[entry.body] != k_lists[i]; };
    if (std::ranges::any_of(list, stray)) return false;
  }
  const auto listed = std::ranges::count_if(listed_, [](Listed l) { return l != Listed::nowhere; });
  return static_cast<std::size_t>(listed) == lists_[0].size() + lists_[1].size();
}

}  // namespace lockstone
