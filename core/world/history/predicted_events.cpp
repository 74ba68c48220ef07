#include <algorithm>

#include <lockstone/assert.h>
#include <lockstone/predicted_events.h>

namespace lockstone {
namespace {

// Behind those of EventKind.
constexpr std::uint32_t k_hit_kind = 0x80, k_joint_kind = 0x81;

template <class Handle>
std::uint64_t number_of(const Handle& handle) {
  return std::uint64_t{handle.generation} << 32 | handle.index;
}

std::uint64_t distance(std::uint64_t a, std::uint64_t b) {
  return a < b ? b - a : a - b;
}

}  // namespace

EventName name_of(const ContactEvent& event) {
  return {static_cast<std::uint32_t>(event.kind), number_of(event.a), number_of(event.b)};
}

EventName name_of(const HitEvent& event) {
  return {k_hit_kind, number_of(event.a), number_of(event.b)};
}

EventName name_of(const JointEvent& event) {
  return {k_joint_kind, number_of(event.joint), 0};
}

bool is_lasting(const EventName& name) {
  return name.kind == static_cast<std::uint32_t>(EventKind::contact_persist) ||
         name.kind == static_cast<std::uint32_t>(EventKind::trigger_stay);
}

PredictedEvents::PredictedEvents(const Settings& settings) : settings_(settings) {
  LKS_ASSERT(settings.capacity >= 1);
  entries_.reserve(settings.capacity);
  revoked_.reserve(settings.capacity);
}

void PredictedEvents::begin_tick(std::uint64_t tick) {
  if (has_tick_ && tick <= tick_) {
    for (Entry& entry : entries_) {
      if (entry.event.tick >= tick) {
        entry.is_pending = true;
      } else if (!entry.is_pending) {
        entry.last_tick = std::min(entry.last_tick, tick - 1);
      }
    }
  }
  has_tick_ = true;
  tick_ = tick;
}

// The nearest one, the first of equals.
PredictedEvents::Entry* PredictedEvents::find_pending(const EventName& name) {
  Entry* nearest = nullptr;
  std::uint64_t reach = std::uint64_t{settings_.window_ticks} + 1;
  for (Entry& entry : entries_) {
    if (!entry.is_pending || entry.event.name != name) continue;
    const std::uint64_t ticks = distance(entry.event.tick, tick_);
    if (ticks >= reach) continue;
    nearest = &entry;
    reach = ticks;
  }
  return nearest;
}

// One that lasted until the tick before, or was told in this one.
PredictedEvents::Entry* PredictedEvents::find_lasting(const EventName& name) {
  if (!is_lasting(name)) return nullptr;
  const auto lasts = [&](const Entry& entry) {
    return !entry.is_pending && entry.event.name == name && entry.last_tick + 1 >= tick_;
  };
  const auto found = std::ranges::find_if(entries_, lasts);
  return found == entries_.end() ? nullptr : &*found;
}

PredictedEvents::Told PredictedEvents::add(const EventName& name) {
  LKS_ASSERT(has_tick_);
  if (Entry* known = find_lasting(name)) {
    known->last_tick = tick_;
    return {known->event.id, false};
  }
  if (Entry* known = find_pending(name)) {
    known->is_pending = false;
    known->event.tick = known->last_tick = tick_;
    return {known->event.id, false};
  }
  if (entries_.size() == settings_.capacity) {
    ++dropped_;
    return {0, true};
  }
  entries_.push_back({{++last_id_, name, tick_}, tick_, false});
  return {last_id_, true};
}

template <class IsRevoked>
std::span<const PredictedEvents::Event> PredictedEvents::revoke(IsRevoked&& is_revoked) {
  revoked_.clear();
  for (const Entry& entry : entries_)
    if (is_revoked(entry)) revoked_.push_back(entry.event);
  std::erase_if(entries_, is_revoked);
  return revoked_;
}

std::span<const PredictedEvents::Event> PredictedEvents::end_tick() {
  return revoke([&](const Entry& entry) {
    return entry.is_pending && entry.event.tick + settings_.window_ticks <= tick_;
  });
}

// One that lasts may go on in the tick after.
void PredictedEvents::confirm(std::uint64_t tick) {
  std::erase_if(entries_, [&](const Entry& entry) {
    const std::uint64_t end = entry.last_tick + (is_lasting(entry.event.name) ? 1 : 0);
    return !entry.is_pending && end <= tick;
  });
}

std::span<const PredictedEvents::Event> PredictedEvents::reset() {
  has_tick_ = false;
  tick_ = 0;
  return revoke([](const Entry&) { return true; });
}

}  // namespace lockstone
