#include "net/session/server/entry/entry_states.h"

#include <algorithm>
#include <utility>

#include <lockstone/assert.h>

namespace lockstone::net {
namespace {

constexpr std::int64_t k_donor_patience_us = 1'000'000;
constexpr std::int64_t k_piece_burst_us = 100'000;

std::size_t entry_bytes(const ServerData& data) {
  return data.simulates() ? data.parts.simulation->snapshot_bytes_max(SnapshotKind::canonical) : 0;
}

bool keeps_keyframes(const ServerConfig& config) {
  return config.max_spectators > 0 && config.spectator_delay_ticks > 0;
}

}  // namespace

EntryStates::EntryStates(ServerData& data, DumpRequests& dumps, const DesyncCases& cases)
    : data_(data),
      dumps_(dumps),
      cases_(cases),
      keyframes_(keyframe_ticks_of(data.config), data.config.spectator_delay_ticks,
                 keeps_keyframes(data.config) ? entry_bytes(data) : 0) {
  entry_.bytes.resize(entry_bytes(data));
}

bool EntryStates::is_in_use() const {
  const auto uses = [](const Follower& follower) {
    return follower.peer != nullptr && follower.offered && !follower.keyframed;
  };
  const auto& seats = data_.roster.seats();
  const auto& watchers = data_.roster.watchers();
  return std::any_of(seats.begin(), seats.end(), uses) ||
         std::any_of(watchers.begin(), watchers.end(), uses);
}

void EntryStates::offer(Follower& follower, std::uint8_t slot) {
  const bool young = entry_.ready && entry_.ticks >= follower.oldest_entry &&
                     data_.match.confirmed - entry_.ticks < data_.config.history_ticks / 4;
  if (!young && is_in_use()) return;
  const bool agreed = data_.judge.judged_ticks() >= follower.oldest_entry;
  if (!young && !data_.simulates() && !agreed) return;
  if (!young) capture();
  if (!entry_.ready || entry_.ticks < follower.oldest_entry) return;
  follower.begin_snapshot(entry_.ticks, false);
  follower.cursor = 0;
  if (data_.roster.is_slot(slot)) data_.judge.restart(slot, entry_.ticks);
}

void EntryStates::offer_keyframe(Watcher& watcher) {
  const std::uint64_t ticks = keyframes_.at_or_before(data_.visible_ticks());
  if (keyframes_.has(ticks)) watcher.begin_snapshot(ticks, true);
}

void EntryStates::capture() {
  if (!data_.simulates()) return ask_donor();
  const Simulation& simulation = *data_.parts.simulation;
  entry_.ticks = data_.match.confirmed;
  entry_.hash = simulation.hash();
  entry_.size = simulation.save(SnapshotKind::canonical, entry_.bytes);
  entry_.ready = true;
}

bool EntryStates::is_silent(const Seat& seat) const {
  return seat.peer == nullptr ||
         seat.peer->watch.silent_us(data_.match.now_us) > data_.config.timeouts.silence_warning_us;
}

// Asks one player after another for the newest state that all agreed on.
void EntryStates::ask_donor() {
  entry_.ready = false;
  const std::uint64_t agreed = data_.judge.judged_ticks();
  if (donation_.under_way || agreed == 0) return;
  const std::size_t count = data_.roster.seats().size();
  for (std::size_t i = 0; i < count; ++i) {
    const auto donor = static_cast<std::uint8_t>(donation_.next_donor++ % count);
    const Seat& seat = data_.roster.seat(donor);
    if (!seat.plays(data_.match.confirmed) || cases_.concern(donor) || is_silent(seat)) continue;
    donation_.under_way = true;
    donation_.since_us = data_.match.now_us;
    entry_.ticks = agreed;
    entry_.hash = data_.judge.right().at(agreed - 1);
    dumps_.request(donation_.transfer, donor, agreed - 1);
    return;
  }
}

void EntryStates::advance() {
  if (!donation_.under_way) return;
  DumpTransfer& transfer = donation_.transfer;
  const bool late =
      data_.match.now_us - donation_.since_us > k_donor_patience_us + data_.config.timeouts.dump_us;
  if (!transfer.done && !late && !is_silent(data_.roster.seat(transfer.slot))) return;
  donation_.under_way = false;
  entry_.ready = transfer.done && !transfer.bytes.empty();
  if (!entry_.ready) return;
  entry_.bytes = std::move(transfer.bytes);
  entry_.size = entry_.bytes.size();
  transfer = {};
}

void EntryStates::release_donor(std::uint8_t slot) {
  if (donation_.transfer.slot == slot) donation_.under_way = false;
}

DumpTransfer* EntryStates::transfer_of(std::uint8_t slot, std::uint64_t tick) {
  DumpTransfer& transfer = donation_.transfer;
  const bool meant = donation_.under_way && transfer.slot == slot && tick + 1 == entry_.ticks;
  return meant && !transfer.done ? &transfer : nullptr;
}

// The server's own snapshot is good, whatever one player says.
std::uint64_t EntryStates::reject() {
  if (!data_.simulates()) entry_.ready = false;
  return entry_.ticks + 1;
}

ByteView EntryStates::bytes_of(const Follower& follower) const {
  if (follower.keyframed) return keyframes_.find(follower.ticks_received);
  const bool same = entry_.ready && entry_.ticks == follower.ticks_received;
  return same ? ByteView(entry_.bytes).first(entry_.size) : ByteView{};
}

bool EntryStates::is_sent(const Follower& follower) const {
  return follower.snapshot_sent >= bytes_of(follower).size();
}

void EntryStates::send_pieces(Follower& follower) {
  LKS_ASSERT(follower.loading && follower.offered);
  const ByteView bytes = bytes_of(follower);
  if (bytes.empty()) return follower.await_state(0);
  const std::int64_t now_us = data_.match.now_us;
  pieces_until_us_ = std::max(pieces_until_us_, now_us - k_piece_burst_us);
  while (pieces_until_us_ <= now_us && follower.snapshot_sent < bytes.size()) {
    Snapshot message;
    message.ticks = follower.ticks_received;
    message.hash = follower.keyframed ? keyframes_.hash_of(message.ticks) : entry_.hash;
    message.total_bytes = static_cast<std::uint32_t>(bytes.size());
    message.offset_bytes = static_cast<std::uint32_t>(follower.snapshot_sent);
    message.chunk = bytes.subspan(
        follower.snapshot_sent, std::min(k_max_chunk_bytes, bytes.size() - follower.snapshot_sent));
    if (data_.peers.send(*follower.peer, message) != Status::ok) return;  // its queue is full
    follower.snapshot_sent += message.chunk.size();
    pieces_until_us_ += static_cast<std::int64_t>(message.chunk.size() * std::uint64_t{1'000'000} /
                                                  data_.config.entry_bytes_per_s);
  }
}

}  // namespace lockstone::net
