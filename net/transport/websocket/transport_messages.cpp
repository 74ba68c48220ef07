#include <lockstone/net/transport_messages.h>

#include "net/transport/websocket/incoming_events.h"
#include "net/transport/websocket/outgoing_messages.h"
#include "net/transport/websocket/packet_message.h"

namespace lockstone::net {
struct MessageTransport::State {
  enum class Stage : std::uint8_t {
    none,     // before the first connection, and after the end of each
    calling,  // the WebSocket is not open yet
    open,
    leaving,  // the session has ended it; reliable packets may still be taken
  };

  [[nodiscard]] bool carries(ConnectionId id) const { return stage == Stage::open && id == number; }

  void end(RefuseReason reason) {
    events.add(TransportEventKind::disconnected, number, reason);
    stage = Stage::none;
    outgoing.clear();
  }

  ConnectionId number = k_no_connection;
  Stage stage = Stage::none;
  IncomingEvents events;
  std::size_t incoming_bytes = 0;  ///< since the session has seen all
  OutgoingMessages outgoing;
  std::vector<std::byte> next;  ///< taken from `outgoing`, and not sent yet
  TransportStats stats;
};

MessageTransport::MessageTransport() : state_(std::make_unique<State>()) {}
MessageTransport::~MessageTransport() = default;

ConnectionId MessageTransport::open() {
  State& state = *state_;
  state.events.forget(state.number);
  state.outgoing.clear();
  state.next.clear();
  state.stats = {};
  state.number = (state.number + 1) & ((ConnectionId{1} << k_connection_bits) - 1);
  if (state.number == k_no_connection) state.number = 1;
  state.stage = State::Stage::calling;
  return state.number;
}

void MessageTransport::opened() {
  if (state_->stage != State::Stage::calling) return;
  state_->stage = State::Stage::open;
  state_->events.add(TransportEventKind::connected, state_->number);
}

bool MessageTransport::receive(ByteView message) {
  State& state = *state_;
  if (state.stage != State::Stage::open) return state.stage == State::Stage::leaving;
  const auto read = read_message(message);
  state.incoming_bytes += message.size();
  if (!read || state.incoming_bytes > k_max_waiting_bytes) {
    state.end(RefuseReason::none);
    return false;
  }
  TransportEvent event;
  event.connection = state.number;
  event.channel = read->channel;
  event.bytes = read->payload;
  state.events.add(event);
  ++state.stats.packets_received;
  state.stats.bytes_received += read->payload.size();
  return true;
}

ByteView MessageTransport::next_message() {
  State& state = *state_;
  if (state.next.empty() && !state.outgoing.empty()) state.next = state.outgoing.take().bytes;
  return state.next;
}

void MessageTransport::take_message() {
  state_->next.clear();
  if (state_->stage == State::Stage::leaving && state_->outgoing.empty())
    state_->stage = State::Stage::none;
}

void MessageTransport::closed(unsigned code) {
  const bool known = state_->stage == State::Stage::open || state_->stage == State::Stage::calling;
  if (known) state_->end(reason_of_close(code));
  state_->stage = State::Stage::none;
}

bool MessageTransport::is_open() const {
  return state_->stage != State::Stage::none;
}

bool MessageTransport::poll(std::int64_t /*now_us*/, TransportEvent& event) {
  if (state_->events.take(event)) return true;
  state_->incoming_bytes = 0;
  return false;
}

Status MessageTransport::send(ConnectionId connection, Channel channel, ByteView bytes) {
  State& state = *state_;
  if (!state.carries(connection)) return Status::stale_handle;
  if (bytes.empty() || bytes.size() > max_payload_bytes(channel)) return Status::invalid_argument;
  if (state.outgoing.waiting_bytes() + bytes.size() > k_max_waiting_bytes) {
    state.end(RefuseReason::none);
    return Status::capacity_exhausted;
  }
  state.outgoing.add(channel, bytes);
  ++state.stats.packets_sent;
  state.stats.bytes_sent += bytes.size();
  return Status::ok;
}

void MessageTransport::disconnect(ConnectionId connection) {
  state_->events.forget(connection);
  if (!state_->carries(connection)) return;
  const bool rest = !state_->outgoing.empty() || !state_->next.empty();
  state_->stage = rest ? State::Stage::leaving : State::Stage::none;
}

TransportStats MessageTransport::stats(ConnectionId connection) const {
  return connection == state_->number ? state_->stats : TransportStats{};
}

}  // namespace lockstone::net
