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
  if (index >= events_.size()) throw Failure{LKS_NOT_FOUND, "there is no such event"};
  const auto found = std::ranges::find(texts_, index, &Text::index);
  write_text(found == texts_.end() ? std::string_view() : found->text, out, capacity);
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
  if (value_us <= 0) throw invalid(field, "must be above 0");
  return value_us;
}

}  // namespace lockstone::c
