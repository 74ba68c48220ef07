// Events of sessions.
#include <algorithm>

#include "tools/bindings/c/session_handles.h"

namespace lockstone::c {

void SessionEvents::add(lks_session_event event, std::string text) {
  if (!text.empty()) texts_.push_back({events_.size(), std::move(text)});
  events_.push_back(event);
}

void SessionEvents::give(lks_session_event* out, std::size_t capacity, std::size_t* count) const {
  array(out, capacity, "out");
  required(count, "count");
  std::copy_n(events_.begin(), std::min(capacity, events_.size()), out);
  give_count(events_.size(), capacity, *count, "events");
}

void SessionEvents::give_text(std::size_t index, char* out, std::size_t capacity) const {
  array(out, capacity, "out");
  write_text(text_of(index), out, capacity);
}

std::string_view SessionEvents::text_of(std::size_t index) const {
  if (index >= events_.size()) throw_status(LKS_NOT_FOUND, "there is no such event");
  const auto found = std::ranges::find(texts_, index, &Text::index);
  return found == texts_.end() ? std::string_view() : found->text;
}

void SessionEvents::give_command(std::size_t index, void* out, std::size_t capacity,
                                 std::size_t* count) const {
  required(count, "count");
  const std::string_view text = text_of(index);
  if (events_[index].kind != LKS_SESSION_COMMAND)
    throw_status(LKS_NOT_FOUND, "the event is no command");
  give_bytes(std::as_bytes(std::span(text)), out, capacity, *count, "the command");
}

void SessionEvents::add_commands(std::uint64_t tick, std::span<const PlayerCommand> commands) {
  for (const PlayerCommand& command : commands) {
    lks_session_event event = event_of(LKS_SESSION_COMMAND);
    event.tick = tick;
    event.slot = command.slot;
    event.value = static_cast<std::int64_t>(command.bytes.size());
    add(event, {reinterpret_cast<const char*>(command.bytes.data()), command.bytes.size()});
  }
}

lks_session_event event_of(const net::DesyncReport& report) {
  lks_session_event event = event_of(LKS_SESSION_DESYNC);
  event.slot = report.slot;
  event.tick = report.tick;
  event.reason = static_cast<std::uint32_t>(report.verdict);
  event.hash = report.hash_here;
  event.other_hash = report.hash_there;
  return event;
}

std::int64_t timeout_of(std::int64_t value_us, std::string_view field) {
  if (value_us <= 0) throw_invalid(field, "must be above 0");
  return value_us;
}

}  // namespace lockstone::c
