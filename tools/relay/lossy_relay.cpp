#include "tools/relay/lossy_relay.h"

#include <algorithm>
#include <utility>

#include <poll.h>

namespace lockstone::relay {
namespace {

constexpr std::uint64_t k_million = 1'000'000;
constexpr std::int64_t k_held_back_us = 40'000;

}  // namespace

LossyRelay::Way::Way(std::uint64_t seed)
    : loss(seed ^ 0x1000),
      duplicate(seed ^ 0x2000),
      reorder(seed ^ 0x3000),
      delay(seed ^ 0x4000),
      damage(seed ^ 0x5000) {}

Result<std::unique_ptr<LossyRelay>> LossyRelay::open(const Endpoint& local, const Endpoint& server,
                                                     const Faults& faults, std::uint64_t seed) {
  auto front = UdpSocket::open(local);
  if (!front) return front.status();
  return std::unique_ptr<LossyRelay>(
      new LossyRelay(std::move(front).value(), server, faults, seed));
}

LossyRelay::LossyRelay(std::unique_ptr<UdpSocket> front, const Endpoint& server,
                       const Faults& faults, std::uint64_t seed)
    : front_(std::move(front)), server_(server), faults_(faults), seed_(seed) {}

LossyRelay::Client* LossyRelay::client_of(const Endpoint& endpoint) {
  const auto found = std::find_if(clients_.begin(), clients_.end(),
                                  [&](const auto& client) { return client->endpoint == endpoint; });
  if (found != clients_.end()) return found->get();
  if (clients_.size() >= k_max_clients) return nullptr;
  auto socket = UdpSocket::open({server_.address == 0x7f000001 ? server_.address : 0, 0});
  if (!socket) return nullptr;
  const std::uint64_t seed = net::Random(seed_ + clients_.size()).next();
  clients_.push_back(std::make_unique<Client>(endpoint, std::move(socket).value(), seed));
  return clients_.back().get();
}

void LossyRelay::pump(std::int64_t now_us) {
  Endpoint from;
  while (const auto bytes = front_->receive(from, buffer_)) {
    const Client* client = client_of(from);
    if (client == nullptr) {
      ++counters_.refused;
      continue;
    }
    const auto at = std::find_if(clients_.begin(), clients_.end(),
                                 [client](const auto& other) { return other.get() == client; });
    take(static_cast<std::size_t>(at - clients_.begin()), true, *bytes, now_us);
  }
  for (std::size_t i = 0; i < clients_.size(); ++i) {
    while (const auto bytes = clients_[i]->socket->receive(from, buffer_)) {
      if (from == server_) take(i, false, *bytes, now_us);
    }
  }
  while (!waiting_.empty() && waiting_.front().due_us <= now_us) {
    std::pop_heap(waiting_.begin(), waiting_.end());
    deliver(waiting_.back());
    waiting_.pop_back();
  }
}

void LossyRelay::take(std::size_t client, bool upwards, ByteView bytes, std::int64_t now_us) {
  ++counters_.received;
  Way& way = upwards ? clients_[client]->up : clients_[client]->down;
  const bool lost = draw_loss(way, now_us);
  const int copies = way.duplicate.chance(faults_.duplicate_ppm) ? 2 : 1;
  if (lost) {
    ++counters_.lost;
    return;
  }
  counters_.duplicated += static_cast<std::uint64_t>(copies - 1);
  for (int i = 0; i < copies; ++i) {
    if (waiting_.size() >= k_max_waiting) {
      ++counters_.refused;
      return;
    }
    Waiting waiting{now_us + draw_delay_us(way),
                    next_sequence_++,
                    client,
                    upwards,
                    {bytes.begin(), bytes.end()}};
    damage(way, waiting.bytes);
    waiting_.push_back(std::move(waiting));
    std::push_heap(waiting_.begin(), waiting_.end());
  }
}

// Two states, after E. N. Gilbert, "Capacity of a burst-noise channel", 1960: a run of losses
// begins with the chance that makes `loss_ppm` of all datagrams lost in runs of the mean length.
bool LossyRelay::draw_loss(Way& way, std::int64_t now_us) const {
  if (faults_.loss_ppm == 0) return false;
  const std::uint64_t draw = way.loss.below(k_million * k_million);
  if (faults_.burst_packets == 0) return draw / k_million < faults_.loss_ppm;
  const std::uint64_t change = k_million * k_million / faults_.burst_packets;
  if (way.in_burst) {
    way.in_burst = draw >= change && now_us - way.burst_began_us < k_longest_burst_us;
  } else {
    way.burst_began_us = now_us;
    way.in_burst = draw < change / (k_million - faults_.loss_ppm) * faults_.loss_ppm;
  }
  return way.in_burst;
}

std::int64_t LossyRelay::draw_delay_us(Way& way) {
  const auto span = static_cast<std::uint64_t>(2 * faults_.jitter_us + 1);
  std::int64_t delay_us =
      faults_.delay_us - faults_.jitter_us + static_cast<std::int64_t>(way.delay.below(span));
  const auto extra_us = static_cast<std::int64_t>(way.reorder.below(k_held_back_us));
  if (way.reorder.chance(faults_.reorder_ppm)) {
    delay_us += extra_us;
    ++counters_.held_back;
  }
  return std::max<std::int64_t>(delay_us, 0);
}

void LossyRelay::damage(Way& way, std::vector<std::byte>& bytes) {
  const bool flip = way.damage.chance(faults_.flip_ppm);
  const bool truncate = way.damage.chance(faults_.truncate_ppm);
  const std::uint64_t bit = way.damage.below(8 * bytes.size());
  if (bytes.empty()) return;
  if (flip) {
    bytes[bit / 8] ^= std::byte{1} << bit % 8;
    ++counters_.flipped;
  }
  if (truncate) {
    bytes.resize(bit / 8);
    ++counters_.truncated;
  }
}

void LossyRelay::deliver(const Waiting& waiting) {
  const Client& client = *clients_[waiting.client];
  if (waiting.upwards) {
    client.socket->send(server_, waiting.bytes);
  } else {
    front_->send(client.endpoint, waiting.bytes);
  }
  ++counters_.delivered;
}

void LossyRelay::wait(std::int64_t now_us, std::int64_t limit_us) const {
  if (!waiting_.empty()) limit_us = std::min(limit_us, waiting_.front().due_us - now_us);
  if (limit_us <= 0) return;
  std::vector<pollfd> sockets{{front_->descriptor(), POLLIN, 0}};
  for (const auto& client : clients_)
    sockets.push_back({client->socket->descriptor(), POLLIN, 0});
  const auto limit_ms = static_cast<int>((limit_us + 999) / 1000);
  poll(sockets.data(), static_cast<nfds_t>(sockets.size()), limit_ms);
}

}  // namespace lockstone::relay
