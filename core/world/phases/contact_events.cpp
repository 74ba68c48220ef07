// Contact events of a tick: compares the contacts of each pair of bodies before and after it.

#include <algorithm>

#include "core/world/world_impl.h"

namespace lockstone {
namespace {

constexpr std::uint32_t k_copy_grain = 512;
constexpr std::uint32_t k_piece_grain = 8;

using Records = std::span<const ContactRecord>;

// The contacts of some pairs of bodies, by key.
struct ContactLists {
  Records before, now;
};

Pair bodies_of(const ContactRecord& record) {
  return {record.body_a, record.body_b};
}

// Takes a pair of bodies from both lists that has one contact, which touches as it did: no event.
bool skip_unchanged(Records& before, Records& now) {
  if (before.empty() || now.empty()) return false;
  const ContactRecord& old = before[0];
  const ContactRecord& is = now[0];
  if (bodies_of(old) != bodies_of(is) || old.flags != is.flags || old.is_trigger()) return false;
  const auto begins_several = [](Records records) {
    return records.size() > 1 && bodies_of(records[0]) == bodies_of(records[1]);
  };
  if (begins_several(before) || begins_several(now)) return false;
  before = before.subspan(1);
  now = now.subspan(1);
  return true;
}

// Both lists from the pair of bodies of new contact `first` on, before that of new contact `end`;
// open where these are the ends of the list.
ContactLists lists_between(Records old, Records now, std::size_t first, std::size_t end) {
  const auto begin_of_pair = [&](std::size_t i) {
    while (i > 0 && i < now.size() && bodies_of(now[i]) == bodies_of(now[i - 1]))
      ++i;
    return i;
  };
  const auto old_of = [&](std::size_t i) {
    const auto found = std::ranges::lower_bound(old, bodies_of(now[i]), {}, bodies_of);
    return static_cast<std::size_t>(found - old.begin());
  };
  const std::size_t from = begin_of_pair(first), to = begin_of_pair(end);
  const std::size_t old_end = to == now.size() ? old.size() : old_of(to);
  const std::size_t old_from = from == 0 ? 0 : from == now.size() ? old_end : old_of(from);
  return {old.subspan(old_from, old_end - old_from), now.subspan(from, to - from)};
}

}  // namespace

// Begin, stay or end, from a pair's states before and now.
std::optional<ContactEvent> World::Impl::event_of(const PairState& before,
                                                  const PairState& now) const {
  const bool was = before.touching, is = now.touching;
  const bool trigger = before.trigger || now.trigger;
  if (!trigger && was == is) return {};
  const Pair pair = now.exists ? now.bodies : before.bodies;
  const EventKind kind = trigger ? (!is   ? EventKind::trigger_exit
                                    : was ? EventKind::trigger_stay
                                          : EventKind::trigger_enter)
                                 : (is ? EventKind::contact_begin : EventKind::contact_end);
  const Velocity approach =
      kind == EventKind::contact_begin ? rounded<Velocity>(now.approach) : Velocity{};
  const bool ended = !now.exists;
  return ContactEvent{
      kind,     {pair.a, bodies[pair.a].generation},    {pair.b, bodies[pair.b].generation},
      approach, ended ? bodies[pair.a].tag : now.tag_a, ended ? bodies[pair.b].tag : now.tag_b};
}

// The combined state of the first pair's records, which are removed from the list. The
// approach speed is the greatest of its contacts.
PairState World::Impl::take_pair(std::span<const ContactRecord>& records,
                                 std::span<const SolverVelocity> approaches) const {
  PairState state;
  state.exists = true;
  state.bodies = {records.front().body_a, records.front().body_b};
  while (!records.empty() && Pair{records.front().body_a, records.front().body_b} == state.bodies) {
    const ContactRecord& record = records.front();
    state.trigger = state.trigger || record.is_trigger();
    state.touching = state.touching || record.is_touching() || record.is_trigger();
    if (!approaches.empty()) {
      const auto index = static_cast<std::size_t>(&record - new_contacts.data());
      const bool first = state.contacts++ == 0;
      if (first || approaches[index] > state.approach) {
        state.approach = approaches[index];
        const ContactSurface& surface = surfaces[slots[index]];
        state.tag_a = surface.tag_a;
        state.tag_b = surface.tag_b;
      }
    }
    records = records.subspan(1);
  }
  return state;
}

// Merges old and new contacts, both sorted by pair.
template <class Emit>
void World::Impl::merge_events(std::span<const ContactRecord> before,
                               std::span<const ContactRecord> now, Emit&& emit) const {
  while (!before.empty() || !now.empty()) {
    if (skip_unchanged(before, now)) continue;
    const bool take_old =
        now.empty() || (!before.empty() && bodies_of(before.front()) <= bodies_of(now.front()));
    const bool take_new =
        before.empty() || (!now.empty() && bodies_of(now.front()) <= bodies_of(before.front()));
    const PairState was = take_old ? take_pair(before, {}) : PairState{};
    const PairState is = take_new ? take_pair(now, approach_speeds) : PairState{};
    if (const std::optional<ContactEvent> event = event_of(was, is)) emit(*event);
  }
}

// A part of the lists, in pieces: the first pass counts the events, the second writes them where
// those of the pieces before end.
void World::Impl::merge_pieces(std::uint32_t first, std::uint32_t end, bool writes) {
  const auto begin_of = [&](std::uint32_t piece) {
    return std::min<std::size_t>(std::size_t{piece} * k_event_piece, new_contacts.size());
  };
  for (std::uint32_t piece = first; piece < end; ++piece) {
    if (writes && event_ends[piece] == (piece == 0 ? 0 : event_ends[piece - 1])) continue;
    const bool is_last = piece + 1 == event_ends.size();
    const ContactLists lists = lists_between(contacts(), new_contacts, begin_of(piece),
                                             is_last ? new_contacts.size() : begin_of(piece + 1));
    std::uint32_t place = !writes || piece == 0 ? 0 : event_ends[piece - 1];
    merge_events(lists.before, lists.now, [&](const ContactEvent& event) {
      if (writes) events[place] = event;
      ++place;
    });
    if (!writes) event_ends[piece] = place;
  }
}

// Finds the contacts that began or ended, and makes the new contacts the state.
void World::Impl::find_events() {
  const StageTimer timer(profiler, StepStage::events);
  events.clear();
  const auto count = static_cast<std::uint32_t>(new_contacts.size());
  const bool shared = parallel.workers() > 1 && count > k_copy_grain;
  const std::uint32_t pieces = shared ? count / k_event_piece + 1 : 0;
  event_ends.assign(pieces, 0);
  if (!shared) {
    merge_events(contacts(), new_contacts, [&](const ContactEvent& e) { events.push_back(e); });
  }
  const auto add_up = [&] {
    std::uint32_t sum = 0;
    for (std::uint32_t& to : event_ends)
      to = sum += to;
    if (shared) events.resize(sum);
  };
  const Loop loops[] = {
      {pieces, k_piece_grain}, {1, 1, true}, {pieces, k_piece_grain}, {count, k_copy_grain}};
  parallel.run_all(loops,
                   [&](std::size_t loop, std::uint32_t first, std::uint32_t end, std::uint32_t) {
                     if (loop == 0 || loop == 2) return merge_pieces(first, end, loop == 2);
                     if (loop == 1) return add_up();
                     std::copy(new_contacts.begin() + first, new_contacts.begin() + end,
                               contact_store.begin() + first);
                   });
  active_contacts = count;
  passes.add_events();
  events.insert(events.end(), continuous.impacts().begin(), continuous.impacts().end());
  header.contact_count = active_contacts + frozen.count();
}

}  // namespace lockstone
