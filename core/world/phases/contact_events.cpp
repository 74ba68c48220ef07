#include "core/world/phases/contact_events.h"

#include <algorithm>

#include <lockstone/assert.h>

namespace lockstone {
namespace {

constexpr std::uint32_t k_copy_grain = 512;
constexpr std::uint32_t k_piece_grain = 8;

using Records = std::span<const ContactRecord>;

// The contacts of some pairs of bodies, by key.
struct ListsOfPairs {
  Records before, now;
};

Pair bodies_of(const ContactRecord& record) {
  return {record.body_a, record.body_b};
}

// Of a pair that touched, or overlapped, a tick ago and does now; at least one of the two.
EventKind kind_of(bool trigger, bool was, bool is) {
  LKS_ASSERT(was || is);
  if (!is) return trigger ? EventKind::trigger_exit : EventKind::contact_end;
  if (!was) return trigger ? EventKind::trigger_enter : EventKind::contact_begin;
  return trigger ? EventKind::trigger_stay : EventKind::contact_persist;
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
ListsOfPairs lists_between(Records old, Records now, std::size_t first, std::size_t end) {
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

ContactEvents::ContactEvents(WorldData& world, TickContacts& found)
    : world_(world), found_(found), hits_(world, found) {
  events_.reserve(std::size_t{2} * world.def.contact_capacity +
                  std::size_t{4} * world.def.body_capacity);
  piece_ends_.reserve(world.def.contact_capacity / k_piece + 1);
}

// Whether a pair whose contact goes on may have events of it.
bool ContactEvents::asks(const Pair& pair) const {
  const IndexSet& bodies = world_.cache.persist_bodies();
  return bodies.count() != 0 && (bodies.has(pair.a) || bodies.has(pair.b));
}

// Begin, stay, persist or end, from a pair's states before and now.
std::optional<ContactEvent> ContactEvents::event_of(const PairState& before,
                                                    const PairState& now) const {
  const bool was = before.touching, is = now.touching;
  const bool trigger = before.trigger || now.trigger;
  const Pair pair = now.exists ? now.bodies : before.bodies;
  if (!trigger && was == is && !(is && asks(pair))) return {};
  const bool is_told =
      has_contact_events(world_.bodies[pair.a]) && has_contact_events(world_.bodies[pair.b]);
  if (!trigger && !is_told) return {};
  const EventKind kind = kind_of(trigger, was, is);
  const Velocity approach =
      kind == EventKind::contact_begin ? rounded<Velocity>(now.approach) : Velocity{};
  const bool ended = !now.exists;
  return ContactEvent{kind,
                      {pair.a, world_.bodies[pair.a].generation},
                      {pair.b, world_.bodies[pair.b].generation},
                      approach,
                      ended ? world_.bodies[pair.a].tag : now.tag_a,
                      ended ? world_.bodies[pair.b].tag : now.tag_b};
}

// The combined state of the first pair's records, which are removed from the list. The
// approach speed is the greatest of its contacts.
PairState ContactEvents::take_pair(std::span<const ContactRecord>& records, bool is_new) const {
  LKS_ASSERT(!records.empty());
  PairState state;
  state.exists = true;
  state.bodies = {records.front().body_a, records.front().body_b};
  while (!records.empty() && Pair{records.front().body_a, records.front().body_b} == state.bodies) {
    const ContactRecord& record = records.front();
    state.trigger = state.trigger || record.is_trigger();
    state.touching = state.touching || record.is_touching() || record.is_trigger();
    if (is_new) {
      const auto index = static_cast<std::size_t>(&record - found_.records.data());
      const bool first = state.contacts++ == 0;
      if (first || found_.approach_speeds[index] > state.approach) {
        state.approach = found_.approach_speeds[index];
        const ContactSurface& surface = found_.surface_of(index);
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
void ContactEvents::merge(std::span<const ContactRecord> before, std::span<const ContactRecord> now,
                          Emit&& emit) const {
  while (!before.empty() || !now.empty()) {
    if ((now.empty() || !asks(bodies_of(now.front()))) && skip_unchanged(before, now)) continue;
    const bool take_old =
        now.empty() || (!before.empty() && bodies_of(before.front()) <= bodies_of(now.front()));
    const bool take_new =
        before.empty() || (!now.empty() && bodies_of(now.front()) <= bodies_of(before.front()));
    const PairState was = take_old ? take_pair(before, false) : PairState{};
    const PairState is = take_new ? take_pair(now, true) : PairState{};
    if (const std::optional<ContactEvent> event = event_of(was, is)) emit(*event);
  }
}

// A part of the lists, in pieces: the first pass counts the events, the second writes them where
// those of the pieces before end.
void ContactEvents::merge_pieces(std::uint32_t first, std::uint32_t end, bool writes) {
  const auto begin_of = [&](std::uint32_t piece) {
    return std::min<std::size_t>(std::size_t{piece} * k_piece, found_.records.size());
  };
  for (std::uint32_t piece = first; piece < end; ++piece) {
    if (writes && piece_ends_[piece] == (piece == 0 ? 0 : piece_ends_[piece - 1])) continue;
    const bool is_last = piece + 1 == piece_ends_.size();
    const ListsOfPairs lists =
        lists_between(world_.contacts.active(), found_.records, begin_of(piece),
                      is_last ? found_.records.size() : begin_of(piece + 1));
    std::uint32_t place = !writes || piece == 0 ? 0 : piece_ends_[piece - 1];
    merge(lists.before, lists.now, [&](const ContactEvent& event) {
      if (writes) events_[place] = event;
      ++place;
    });
    if (!writes) piece_ends_[piece] = place;
  }
}

// Turns the number of events of each piece into the place where they end.
void ContactEvents::add_up(bool shared) {
  std::uint32_t sum = 0;
  for (std::uint32_t& to : piece_ends_)
    to = sum += to;
  if (shared) events_.resize(sum);
}

void ContactEvents::find() {
  events_.clear();
  const auto count = static_cast<std::uint32_t>(found_.records.size());
  const bool shared = world_.parallel.workers() > 1 && count > k_copy_grain;
  const std::uint32_t pieces = shared ? count / k_piece + 1 : 0;
  piece_ends_.assign(pieces, 0);
  if (!shared) {
    merge(world_.contacts.active(), found_.records,
          [&](const ContactEvent& e) { events_.push_back(e); });
  }
  const Loop loops[] = {
      {pieces, k_piece_grain}, {1, 1, true}, {pieces, k_piece_grain}, {count, k_copy_grain}};
  world_.parallel.run_all(
      loops, [&](std::size_t loop, std::uint32_t first, std::uint32_t end, std::uint32_t) {
        if (loop == 0 || loop == 2) return merge_pieces(first, end, loop == 2);
        if (loop == 1) return add_up(shared);
        world_.contacts.write(first, std::span(found_.records).subspan(first, end - first));
      });
  world_.contacts.replace(found_.manifold_ids);
  world_.header.contact_count = world_.contacts.count();
}

}  // namespace lockstone
