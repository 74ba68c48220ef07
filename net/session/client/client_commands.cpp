#include "net/session/client/client_commands.h"

#include <algorithm>

namespace lockstone::net {
namespace {

constexpr int k_command_pieces_per_update = 2;

}  // namespace

void ClientCommands::reserve() {
  own_ = CommandBuffer(k_waiting_command_bytes, k_max_waiting_commands);
}

// A server that was started again has forgotten how many it had.
void ClientCommands::begin(std::uint64_t taken) {
  if (front_settled_) own_.pop();
  front_settled_ = false;
  while (!own_.empty() && settled_ < taken) {
    own_.pop();
    ++settled_;
  }
  settled_ = taken;
  sending_ = own_.begin();
  sent_ = 0;
}

Result<std::uint64_t> ClientCommands::give(ByteView bytes) {
  if (!data_.place.seated || !data_.status.active()) return Status::not_found;
  const bool fits = !bytes.empty() && bytes.size() <= k_max_command_bytes;
  if (!fits || data_.place.spectates()) return Status::invalid_argument;
  if (!own_.push(0, {data_.place.welcome.slot, bytes})) return Status::capacity_exhausted;
  return settled_ + (own_.end() - 1 - own_.begin()) - (front_settled_ ? 1 : 0);
}

void ClientCommands::send_pieces() {
  for (int i = 0; i < k_command_pieces_per_update && sending_ < own_.end(); ++i) {
    const ByteView bytes = own_.bytes(sending_);
    const std::size_t size = std::min(k_max_chunk_bytes, bytes.size() - sent_);
    const CommandPiece piece{static_cast<std::uint32_t>(bytes.size()),
                             static_cast<std::uint32_t>(sent_), bytes.subspan(sent_, size)};
    if (data_.server.try_send(piece) != Status::ok) return;  // the queue is full
    sent_ += size;
    if (sent_ < bytes.size()) continue;
    ++sending_;
    sent_ = 0;
    if (front_settled_) own_.pop();
    front_settled_ = false;
  }
}

// A command may be refused at its first piece; the others are sent all the same.
bool ClientCommands::on_result(ByteView packet) {
  CommandResult result;
  if (decode(packet, result) != Status::ok || !data_.place.seated) return false;
  const bool whole = sending_ > own_.begin();
  const bool expected = whole || (sent_ > 0 && !front_settled_ && !result.taken);
  if (!expected || result.number != settled_) return false;
  ++settled_;
  if (whole) own_.pop();
  front_settled_ = !whole;
  if (!result.taken) data_.observer->command_refused(result.number);
  return true;
}

bool ClientCommands::on_tick_command(ByteView packet) {
  TickCommand piece;
  if (decode(packet, piece) != Status::ok || !data_.place.seated) return false;
  if (data_.status.state != ClientState::running) return true;  // a state comes instead
  CommandBuffer& ring = data_.commands.ring();
  const bool open = !ring.empty() && !ring.last().complete();
  const bool begins = piece.offset_bytes == 0 && !open;
  const bool in_order = ring.empty() || ring.last().tick <= piece.tick;
  if (begins && (!in_order || piece.tick < data_.progress.stepped)) return false;
  if (begins && !ring.open(piece.tick, piece.slot, piece.total_bytes)) return false;
  const CommandBuffer::Entry& entry = ring.last();
  const bool next = entry.tick == piece.tick && entry.slot == piece.slot &&
                    entry.size == piece.total_bytes && entry.filled == piece.offset_bytes;
  if (!next) return false;
  ring.append(piece.chunk);
  return true;
}

}  // namespace lockstone::net
