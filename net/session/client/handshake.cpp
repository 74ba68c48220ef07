#include "net/session/client/handshake.h"

#include <memory>
#include <utility>

#include <lockstone/hash.h>

#include "net/session/setup.h"

namespace lockstone::net {

void Handshake::say_hello() {
  if (data_.status.state != ClientState::connecting) return;
  data_.status.state = ClientState::handshaking;
  const ClientPlace& place = data_.place;
  const bool seated_before =
      place.rejoin_key != 0 && place.welcome.slot < data_.game.info.player_count;
  Hello hello;
  hello.insecure = data_.config.insecure;
  hello.wanted_slot = seated_before ? place.welcome.slot : data_.config.wanted_slot;
  hello.name = PlayerName(data_.config.name);
  hello.build = BuildText(data_.config.build);
  hello.rejoin_key = place.rejoin_key;
  hello.ticks_stepped = data_.progress.stepped;
  hello.state_hash = data_.progress.state_hash;
  data_.server.send(hello);
}

bool Handshake::on_offer(ByteView packet) {
  Offer offer;
  if (decode(packet, offer) != Status::ok) return false;
  const bool expected = data_.status.state == ClientState::handshaking && !offered_;
  if (!expected || offer.insecure != data_.config.insecure) return false;
  offered_ = true;
  if (!knows_state(offer.config) && !make_simulation(offer.config)) {
    uses_.end.fail(ClientFailure::config_not_understood);
    return true;
  }
  data_.server.send(Answer{data_.game.info});
  return true;
}

// The state here is one of the match that is offered.
bool Handshake::knows_state(ByteView offered_config) const {
  return data_.game.simulation != nullptr && data_.place.rejoin_key != 0 &&
         config_hash_ == hash64(offered_config);
}

bool Handshake::make_simulation(ByteView offered_config) {
  if (data_.progress.stepped > 0) return false;  // Hello's state is one of another match
  Result<std::unique_ptr<Simulation>> made = data_.parts.factory(offered_config);
  if (!made || check_info(made.value()->info()) != SetupError::none) return false;
  ClientGame& game = data_.game;
  game.simulation = std::move(made).value();
  game.info = game.simulation->info();
  game.shape = {game.info.player_count, game.info.input_bytes};
  game.tick_us = 1'000'000 / game.info.tick_rate;
  config_hash_ = hash64(offered_config);
  reserve_memory();
  return true;
}

void Handshake::reserve_memory() {
  const ClientConfig& config = data_.config;
  const ClientGame& game = data_.game;
  const std::size_t snapshot_bytes = game.simulation->snapshot_bytes_max(SnapshotKind::canonical);
  const bool keeps = snapshot_bytes <= config.max_snapshot_bytes;
  const bool predicts = data_.predicts();
  data_.ticks = TickBuffer(config.history_ticks, game.shape.record_bytes());
  data_.inputs = OwnInputs(game.info.input_bytes);
  uses_.commands.reserve();
  data_.progress.hashes = HashRing(config.history_ticks);
  data_.progress.snapshots =
      TickRing(keeps && !predicts ? config.snapshot_ticks : 0, snapshot_bytes);
  uses_.dump.reserve(keeps ? snapshot_bytes : 0);
  uses_.entry.reserve(keeps ? snapshot_bytes : 0);
  if (predicts) uses_.prediction.reserve(keeps);
}

bool Handshake::on_welcome(ByteView packet) {
  Welcome welcome;
  if (decode(packet, welcome) != Status::ok) return false;
  ClientStatus& status = data_.status;
  if (status.state != ClientState::handshaking || data_.game.simulation == nullptr) return false;
  if (welcome.player_count != data_.game.info.player_count) return false;
  const std::uint64_t stepped = data_.progress.stepped;
  if (welcome.entry == Entry::lobby && stepped > 0) return false;
  data_.place.welcome = welcome;
  data_.place.seated = true;
  data_.place.rejoin_key = welcome.rejoin_key;
  data_.lead = LeadControl(data_.config.max_lead_ticks);
  data_.inputs.begin(welcome.input_delay_ticks);
  uses_.commands.begin(welcome.commands_taken);
  status.state = welcome.entry == Entry::lobby ? ClientState::lobby : ClientState::joining;
  data_.observer->joined(welcome.slot);
  if (welcome.entry == Entry::ticks) uses_.entry.begin(stepped);
  return true;
}

}  // namespace lockstone::net
