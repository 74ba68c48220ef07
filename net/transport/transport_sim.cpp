#include <algorithm>
#include <utility>

#include <lockstone/assert.h>
#include <lockstone/net/transport_sim.h>

#include "net/transport/random.h"

namespace lockstone::net {
namespace {

constexpr std::size_t k_max_arriving = 1 << 16;  // per endpoint; a model of finite queues
constexpr int k_max_retransmits = 12;
constexpr std::int64_t k_retransmit_floor_us = 50'000;

}  // namespace

struct SimNetwork::State {
  std::uint64_t seed = 0;
  std::uint64_t next_sequence = 0;  // breaks ties of arrival time in the order of sending
  std::uint64_t next_link = 0;
  std::int64_t now_us = -1;  // below 0: each endpoint's own clock holds
  SimTraffic traffic;
  std::vector<std::unique_ptr<SimTransport>> endpoints;
};

struct SimTransport::Packet {
  std::int64_t due_us = 0;
  std::uint64_t sequence = 0;
  ConnectionId connection = k_no_connection;  // the receiver's
  TransportEventKind kind = TransportEventKind::received;
  Channel channel = Channel::reliable;
  std::vector<std::byte> bytes;

  // For std::push_heap: the earliest packet shall be on top.
  bool operator<(const Packet& other) const {
    return std::pair(due_us, sequence) > std::pair(other.due_us, other.sequence);
  }
};

// One direction of a connection.
struct SimTransport::Link {
  Link(std::uint64_t seed, std::uint64_t number) : Link(Random(seed ^ (number << 20))) {}
  explicit Link(Random seeds)
      : loss(seeds.next()),
        burst(seeds.next()),
        duplicate(seeds.next()),
        reorder(seeds.next()),
        delay(seeds.next()),
        damage(seeds.next()),
        retransmit(seeds.next()) {}

  std::int64_t draw_delay_us() {
    const auto jitter_us = static_cast<std::uint64_t>(faults.jitter_us) + 1;
    const auto held_us = static_cast<std::uint64_t>(faults.reorder_us) + 1;
    std::int64_t delay_us = faults.delay_us + static_cast<std::int64_t>(delay.below(jitter_us));
    const bool held_back = reorder.chance(faults.reorder_ppm);
    const auto extra_us = static_cast<std::int64_t>(reorder.below(held_us));
    return held_back ? delay_us + extra_us : delay_us;
  }

  bool draw_loss() {
    const bool lost = loss.chance(faults.loss_ppm);
    const bool begins = burst.chance(faults.burst_start_ppm);
    const bool ends = burst.chance(faults.burst_end_ppm);
    const bool lost_in_burst = in_burst || begins;
    in_burst = lost_in_burst && !ends;
    return lost || lost_in_burst;
  }

  Random loss, burst, duplicate, reorder, delay, damage, retransmit;
  LinkFaults faults;
  SimTransport* peer = nullptr;
  ConnectionId peer_connection = k_no_connection;
  std::int64_t last_reliable_due_us = 0;
  bool in_burst = false;
  bool open = true;
  TransportStats stats;
};

SimNetwork::SimNetwork(std::uint64_t seed) : state_(std::make_unique<State>()) {
  state_->seed = seed;
}

SimNetwork::~SimNetwork() = default;

SimTransport& SimNetwork::add_endpoint() {
  const std::size_t index = state_->endpoints.size();
  state_->endpoints.push_back(std::unique_ptr<SimTransport>(new SimTransport(*this, index)));
  return *state_->endpoints.back();
}

ConnectionId SimNetwork::connect(SimTransport& from, SimTransport& to, const LinkFaults& faults) {
  for (SimTransport* side : {&from, &to}) {
    side->links_.push_back(std::make_unique<SimTransport::Link>(state_->seed, state_->next_link++));
    side->links_.back()->faults = faults;
  }
  SimTransport::Link& forth = *from.links_.back();
  SimTransport::Link& back = *to.links_.back();
  forth.peer = &to;
  forth.peer_connection = static_cast<ConnectionId>(to.links_.size());
  back.peer = &from;
  back.peer_connection = static_cast<ConnectionId>(from.links_.size());
  SimTransport::Packet hello;
  hello.kind = TransportEventKind::connected;
  from.send_reliable(forth, hello);
  to.send_reliable(back, hello);
  return back.peer_connection;
}

void SimNetwork::set_faults(const SimTransport& endpoint, const LinkFaults& faults, Cut way) {
  for (const auto& link : endpoint.links_) {
    if (way != Cut::receiving) link->faults = faults;
    if (way != Cut::sending) link->peer->find(link->peer_connection)->faults = faults;
  }
}

void SimNetwork::set_time(std::int64_t now_us) {
  LKS_ASSERT(now_us >= state_->now_us);
  state_->now_us = now_us;
}

void SimNetwork::kill(SimTransport& endpoint) {
  endpoint.dead_ = true;
  for (const SimTransport::Packet& packet : endpoint.arriving_) {
    --state_->traffic.packets;
    state_->traffic.bytes -= packet.bytes.size();
  }
  endpoint.arriving_.clear();
  for (const auto& link : endpoint.links_)
    link->open = false;
}

void SimNetwork::forge(SimTransport& receiver, ConnectionId connection, ByteView bytes) {
  SimTransport::Packet packet;
  packet.due_us = receiver.network_time();
  packet.connection = connection;
  packet.channel = Channel::unreliable;
  packet.bytes.assign(bytes.begin(), bytes.end());
  receiver.deliver(std::move(packet));
}

SimTraffic SimNetwork::traffic() const {
  return state_->traffic;
}

void SimNetwork::partition(const SimTransport& endpoint, std::int64_t from_us,
                           std::int64_t until_us, Cut cut) {
  state_->endpoints[endpoint.index_]->partitions_.push_back({from_us, until_us, cut});
}

SimTransport::SimTransport(SimNetwork& network, std::size_t index)
    : network_(network), index_(index) {}

SimTransport::~SimTransport() = default;

SimTransport::Link* SimTransport::find(ConnectionId connection) const {
  if (connection == k_no_connection || connection > links_.size()) return nullptr;
  return links_[connection - 1].get();
}

bool SimTransport::poll(std::int64_t now_us, TransportEvent& event) {
  LKS_ASSERT(now_us >= now_us_);
  now_us_ = std::max(now_us, now_us_);
  SimTraffic& traffic = network_.state_->traffic;
  while (!arriving_.empty() && arriving_.front().due_us <= network_time()) {
    std::pop_heap(arriving_.begin(), arriving_.end());
    current_ = std::make_unique<Packet>(std::move(arriving_.back()));
    arriving_.pop_back();
    --traffic.packets;
    traffic.bytes -= current_->bytes.size();
    Link* link = find(current_->connection);
    if (link == nullptr || !link->open) continue;
    if (current_->kind == TransportEventKind::disconnected) link->open = false;
    if (current_->kind == TransportEventKind::received) {
      ++link->stats.packets_received;
      link->stats.bytes_received += current_->bytes.size();
    }
    event = {current_->kind, current_->connection, current_->channel, current_->bytes};
    return true;
  }
  return false;
}

Status SimTransport::send(ConnectionId connection, Channel channel, ByteView bytes) {
  Link* link = find(connection);
  if (link == nullptr || !link->open) return Status::stale_handle;
  const bool reliable = channel == Channel::reliable;
  const std::size_t limit = reliable ? k_max_reliable_bytes : k_max_datagram_bytes;
  if (bytes.empty() || bytes.size() > limit + k_carrier_reserve_bytes)
    return Status::invalid_argument;
  if (link->peer->arriving_.size() >= k_max_arriving) return Status::capacity_exhausted;
  ++link->stats.packets_sent;
  link->stats.bytes_sent += bytes.size();
  Packet packet;
  packet.channel = channel;
  packet.bytes.assign(bytes.begin(), bytes.end());
  if (reliable) {
    send_reliable(*link, std::move(packet));
  } else {
    send_unreliable(*link, packet);
  }
  return Status::ok;
}

void SimTransport::disconnect(ConnectionId connection) {
  Link* link = find(connection);
  if (link == nullptr || !link->open) return;
  Packet packet;
  packet.kind = TransportEventKind::disconnected;
  send_reliable(*link, std::move(packet));
  link->open = false;
}

TransportStats SimTransport::stats(ConnectionId connection) const {
  const Link* link = find(connection);
  if (link == nullptr) return {};
  TransportStats stats = link->stats;
  stats.round_trip_us = 2 * link->faults.delay_us + link->faults.jitter_us;
  return stats;
}

// The window that keeps packets of this time from going this way, or null.
const SimTransport::Window* SimTransport::cut_off(std::int64_t at_us, Cut way) const {
  const auto found =
      std::find_if(partitions_.begin(), partitions_.end(), [at_us, way](const Window& window) {
        const bool concerned = window.cut == Cut::both || window.cut == way;
        return concerned && at_us >= window.from_us && at_us < window.until_us;
      });
  return found == partitions_.end() ? nullptr : &*found;
}

// The first moment from `sent_us` on at which the way is open.
std::int64_t SimTransport::after_partitions(const Link& link, std::int64_t sent_us) const {
  for (;;) {
    const Window* window = cut_off(sent_us, Cut::sending);
    if (window == nullptr) window = link.peer->cut_off(sent_us, Cut::receiving);
    if (window == nullptr) return sent_us;
    sent_us = window->until_us;
  }
}

// A reliable packet always arrives; every loss that it would suffer costs one retransmission.
void SimTransport::send_reliable(Link& link, Packet packet) {
  const std::int64_t retry_us = 2 * link.faults.delay_us + k_retransmit_floor_us;
  std::int64_t due_us = after_partitions(link, network_time()) + link.draw_delay_us();
  for (int i = 0; i < k_max_retransmits; ++i) {
    if (!link.retransmit.chance(link.faults.loss_ppm)) break;
    due_us += retry_us;
  }
  due_us = std::max(due_us, link.last_reliable_due_us);
  link.last_reliable_due_us = due_us;
  packet.due_us = due_us;
  packet.connection = link.peer_connection;
  link.peer->deliver(std::move(packet));
}

void SimTransport::send_unreliable(Link& link, const Packet& packet) {
  const bool lost = link.draw_loss();
  const int copies = link.duplicate.chance(link.faults.duplicate_ppm) ? 2 : 1;
  for (int i = 0; i < copies; ++i) {
    Packet copy = packet;
    copy.due_us = network_time() + link.draw_delay_us();
    copy.connection = link.peer_connection;
    damage(link, copy);
    if (lost || after_partitions(link, network_time()) != network_time()) continue;
    link.peer->deliver(std::move(copy));
  }
}

void SimTransport::damage(Link& link, Packet& packet) const {
  const bool corrupt = link.damage.chance(link.faults.corrupt_ppm);
  const bool truncate = link.damage.chance(link.faults.truncate_ppm);
  const std::size_t at = static_cast<std::size_t>(link.damage.below(packet.bytes.size()));
  const auto bits = static_cast<std::byte>(1 + link.damage.below(255));
  if (corrupt) packet.bytes[at] ^= bits;
  if (truncate) packet.bytes.resize(std::max<std::size_t>(at, 1));
}

std::int64_t SimTransport::network_time() const {
  return network_.state_->now_us < 0 ? now_us_ : network_.state_->now_us;
}

void SimTransport::deliver(Packet packet) {
  if (dead_) return;
  SimTraffic& traffic = network_.state_->traffic;
  ++traffic.packets;
  traffic.bytes += packet.bytes.size();
  traffic.peak_bytes = std::max(traffic.peak_bytes, traffic.bytes);
  packet.sequence = network_.state_->next_sequence++;
  arriving_.push_back(std::move(packet));
  std::push_heap(arriving_.begin(), arriving_.end());
}

}  // namespace lockstone::net
