// Events of a client that predicts, told once: a rollback steps ticks again, and most of their
// events are those that the game has heard of already.
//
// Give each tick that was stepped its events, first of all those of a tick that is stepped again.
// Each event is then new (play its sound), or one that was told before (leave it alone); and where
// a rollback takes an event away that was told, it is revoked (stop its sound). Two events are the
// same if their kinds and bodies are, and if a rollback moved the event by no more than a few
// ticks. Events that come in every tick while something lasts (contact_persist, trigger_stay) are
// one event: new in its first tick, and told before in those that follow. For the game's own use:
// neither state nor a part of the simulation. docs/how-to/events.md shows the use.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <lockstone/event.h>
#include <lockstone/joint.h>

namespace lockstone {

/// The kind of an event and the two things it is about. A game may name events of its own by kinds
/// from k_own_event_kinds on.
struct EventName {
  std::uint32_t kind = 0;
  std::uint64_t a = 0;
  std::uint64_t b = 0;

  friend constexpr auto operator<=>(const EventName&, const EventName&) = default;
};
inline constexpr std::uint32_t k_own_event_kinds = 0x100;

/// Whether a name is that of contact_persist or trigger_stay, whose events last.
[[nodiscard]] bool is_lasting(const EventName& name);

/// Of a contact event: its EventKind and its bodies. A HitEvent and a JointEvent have kinds of
/// their own.
[[nodiscard]] EventName name_of(const ContactEvent& event);
[[nodiscard]] EventName name_of(const HitEvent& event);
[[nodiscard]] EventName name_of(const JointEvent& event);

class PredictedEvents {
 public:
  struct Settings {
    std::uint32_t capacity = 1024;   ///< events that are not final yet, ≥ 1
    std::uint32_t window_ticks = 2;  ///< a rollback moves an event by at most this
  };
  /// No function but this allocates.
  explicit PredictedEvents(const Settings& settings);
  PredictedEvents() : PredictedEvents(Settings{}) {}

  /// An event that was told: its number is the same whenever it is told again.
  struct Event {
    std::uint64_t id = 0;  ///< from 1 on, never given out twice
    EventName name{};
    std::uint64_t tick = 0;  ///< in which it happens, or begins to last, as of now
  };
  struct Told {
    std::uint64_t id = 0;  ///< of the event; 0: no room for it, and it will not be revoked
    bool is_new = false;   ///< else it was told before
  };

  /// The events of a tick follow. A tick that is not after the last one is stepped again: so are
  /// all after it, and their events are told again or were none.
  void begin_tick(std::uint64_t tick);
  Told add(const EventName& name);
  /// Returns the events that never happened, in the order in which they were told first; valid
  /// until the next call. An event is revoked once its tick and the window after it were stepped
  /// again without it; one that lasts, if it does not even begin. One that ends sooner than was
  /// guessed is not told any more.
  std::span<const Event> end_tick();

  /// Ticks up to this one are final: no rollback goes back to them. Makes room.
  void confirm(std::uint64_t tick);

  /// Forgets all, after a jump in time: a snapshot was loaded. Returns the events that were not
  /// final; valid until the next call.
  std::span<const Event> reset();

  /// Events that found no room so far.
  [[nodiscard]] std::uint64_t dropped() const { return dropped_; }

 private:
  struct Entry {
    Event event;
    std::uint64_t last_tick = 0;  // event.tick, unless it lasts
    bool is_pending = false;      // of a tick that is being stepped again, and not told again yet
  };

  [[nodiscard]] Entry* find_pending(const EventName& name);
  [[nodiscard]] Entry* find_lasting(const EventName& name);
  template <class IsRevoked>
  std::span<const Event> revoke(IsRevoked&& is_revoked);

  Settings settings_;
  std::vector<Entry> entries_;  // in the order in which they were told first
  std::vector<Event> revoked_;
  std::uint64_t tick_ = 0;
  std::uint64_t last_id_ = 0;
  std::uint64_t dropped_ = 0;
  bool has_tick_ = false;
};

}  // namespace lockstone
