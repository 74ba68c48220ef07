#include "net/session/client/input_sender.h"

#include <algorithm>
#include <span>

#include "net/session/peer_watch.h"
#include "net/wire/record_coder.h"

namespace lockstone::net {
namespace {

constexpr std::int64_t k_fast_retry_us = 20'000;
constexpr std::uint64_t k_max_hash_packets = 4;

}  // namespace

void InputSender::sample() {
  if (!data_.place.plays()) return;
  if (data_.inputs.sample(sample_end(), *data_.parts.inputs)) data_.progress.news = true;
}

// One past the last tick to have an input for. In real time the local clock drives it.
std::uint64_t InputSender::sample_end() {
  const Welcome& welcome = data_.place.welcome;
  const std::uint64_t received = data_.ticks.received();
  std::uint64_t reached = received;
  if (welcome.pacing == Pacing::real_time) {
    clock_.advance(data_.status.now_us, data_.lead.trim_ppm());
    const std::uint64_t local = clock_.tick(data_.game.info.tick_rate);
    if (local > received + data_.config.max_lead_ticks) {
      clock_.set_tick(received);  // the match stalls: keep the sampled inputs
    } else {
      reached = std::max(reached, local);
    }
  }
  const std::uint64_t end = reached + welcome.input_delay_ticks + data_.lead.lead_ticks() + 1;
  return welcome.tick_count == 0 ? end : std::min(end, welcome.tick_count);
}

bool InputSender::is_due() const {
  const bool fast = data_.place.welcome.pacing == Pacing::fast;
  const std::int64_t tick_us = data_.game.tick_us;
  const std::int64_t since_us = data_.status.now_us - last_sent_us_;
  const std::int64_t soonest_us = fast ? 0 : tick_us / 2;
  const std::int64_t retry_us = fast ? k_fast_retry_us : tick_us;
  const bool running = data_.status.state == ClientState::running;
  const std::int64_t latest_us = running ? retry_us : k_keepalive_us;
  return since_us >= soonest_us && (data_.progress.news || since_us >= latest_us);
}

void InputSender::send_due() {
  if (!is_due()) return;
  last_sent_us_ = data_.status.now_us;
  data_.progress.news = false;
  // Of a match that it is not in yet, it knows nothing for certain.
  const bool running = data_.status.state == ClientState::running;
  if (!running) return data_.server.send(Inputs{}, Channel::unreliable);
  const std::uint64_t stepped = data_.progress.stepped;
  if (data_.place.spectates()) return send_inputs(stepped);
  std::uint64_t first_hash_tick = data_.progress.hashes_acknowledged;
  for (std::uint64_t i = 0; i < k_max_hash_packets; ++i) {
    send_inputs(first_hash_tick);
    first_hash_tick += k_max_hashes_per_message;
    if (first_hash_tick >= stepped) return;
  }
}

void InputSender::send_inputs(std::uint64_t first_hash_tick) {
  const OwnInputs& inputs = data_.inputs;
  Inputs message;
  message.ticks_received = data_.ticks.received();
  message.first_hash_tick = first_hash_tick;
  const std::uint64_t hash_end =
      std::min(data_.progress.stepped, first_hash_tick + k_max_hashes_per_message);
  for (std::uint64_t tick = first_hash_tick; tick < hash_end; ++tick) {
    message.hashes[message.hash_count++] = data_.progress.hashes.at(tick);
  }
  const std::size_t space_bytes =
      coded_.size() - k_inputs_header_bytes - std::size_t{message.hash_count} * 8;
  RecordWriter writer(std::span<std::byte>(coded_).first(space_bytes), data_.game.info.input_bytes);
  message.first_tick = inputs.acknowledged();
  const std::uint64_t end = data_.place.plays() ? inputs.sampled() : message.first_tick;
  for (std::uint64_t tick = message.first_tick; tick < end; ++tick) {
    const bool full = message.count == k_max_ticks_per_message;
    if (full || !inputs.has(tick) || !writer.add(inputs.find(tick))) break;
    ++message.count;
  }
  message.coded = writer.written();
  data_.server.send(message, Channel::unreliable);
}

}  // namespace lockstone::net
