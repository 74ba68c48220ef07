// From a connection to a seat, or to a refusal that says why.
#include <algorithm>
#include <array>

#include "net/security/packet_seal.h"
#include "net/session/server_impl.h"

namespace lockstone::net {

void Server::Impl::accept(ConnectionId connection) {
  const auto place = std::find_if(links.begin(), links.end(),
                                  [](const Link& link) { return link.stage == Stage::unused; });
  if (place == links.end()) {
    parts.transport->disconnect(connection);
    return;
  }
  *place = {};
  place->connection = connection;
  place->stage = Stage::connected;
  place->since_us = now_us;
  place->watch.heard(now_us);
  place->identity = parts.transport->identity(connection);
}

bool Server::Impl::on_hello(Link& link, ByteView packet) {
  Hello hello;
  if (decode(packet, hello) != Status::ok) return false;
  const Refusal refusal = judge_hello(link, hello);
  if (refusal.reason != RefuseReason::none) {
    refuse(link, refusal);
    return true;
  }
  link.name = hello.name;
  link.wanted_slot = link.identity.authenticated ? link.identity.slot : hello.wanted_slot;
  link.stage = Stage::offered;
  send(link, Offer{config.insecure, config.match_config});
  return true;
}

// A client with a token speaks before the session does.
bool Server::Impl::refuse_secure_hello(Link& link, ByteView packet) {
  const bool secure = !packet.empty() && packet[0] == static_cast<std::byte>(SecureKind::hello);
  if (!secure || link.stage != Stage::connected) return false;
  refuse(link, {RefuseReason::insecure_not_allowed, RefuseField::insecure, 1, 0});
  return true;
}

Refusal Server::Impl::judge_hello(const Link& link, const Hello& hello) const {
  if (hello.protocol != k_protocol_version) {
    return {RefuseReason::protocol_mismatch, RefuseField::protocol, k_protocol_version,
            hello.protocol};
  }
  if (hello.insecure != config.insecure) {
    return {RefuseReason::insecure_not_allowed, RefuseField::insecure, config.insecure ? 1U : 0U,
            hello.insecure ? 1U : 0U};
  }
  if (!link.identity.authenticated) return judge_seats(hello.wanted_slot);
  const std::uint8_t slot = link.identity.slot;
  if (slot >= seats.size() || (hello.wanted_slot != k_any_slot && hello.wanted_slot != slot)) {
    return {RefuseReason::wrong_slot, RefuseField::slot, slot, hello.wanted_slot};
  }
  return judge_seats(slot);
}

Refusal Server::Impl::judge_seats(std::uint8_t wanted_slot) const {
  if (state != ServerState::lobby) return {RefuseReason::match_running, RefuseField::none, 0, 0};
  const std::size_t count = seats.size();
  const auto taken = std::count_if(seats.begin(), seats.end(),
                                   [](const Seat& place) { return place.link != nullptr; });
  if (static_cast<std::size_t>(taken) == count) {
    return {RefuseReason::match_full, RefuseField::player_count, count, count + 1};
  }
  if (wanted_slot == k_any_slot) return {};
  if (wanted_slot >= count) {
    return {RefuseReason::slot_taken, RefuseField::slot, count, wanted_slot};
  }
  if (seats[wanted_slot].link != nullptr) {
    return {RefuseReason::slot_taken, RefuseField::slot, wanted_slot, wanted_slot};
  }
  return {};
}

bool Server::Impl::on_answer(Link& link, ByteView packet) {
  Answer answer;
  if (decode(packet, answer) != Status::ok) return false;
  Refusal refusal = judge_info(answer.info);
  // Somebody else may have sat down since the offer.
  if (refusal.reason == RefuseReason::none) refusal = judge_seats(link.wanted_slot);
  if (refusal.reason == RefuseReason::none) {
    seat(link);
  } else {
    refuse(link, refusal);
  }
  return true;
}

Refusal Server::Impl::judge_info(const SimulationInfo& theirs) const {
  struct Field {
    RefuseField field;
    std::uint64_t here;
    std::uint64_t there;
  };
  const std::array<Field, 7> fields{{
      {RefuseField::abi, info.abi, theirs.abi},
      {RefuseField::config_hash, info.config_hash, theirs.config_hash},
      {RefuseField::scene_hash, info.scene_hash, theirs.scene_hash},
      {RefuseField::canary, info.canary, theirs.canary},
      {RefuseField::tick_rate, info.tick_rate, theirs.tick_rate},
      {RefuseField::player_count, info.player_count, theirs.player_count},
      {RefuseField::input_bytes, info.input_bytes, theirs.input_bytes},
  }};
  for (const Field& field : fields) {
    if (field.here == field.there) continue;
    return {RefuseReason::simulation_mismatch, field.field, field.here, field.there};
  }
  return {};
}

void Server::Impl::refuse(Link& link, const Refusal& refusal) {
  send(link, Refuse{refusal.reason, refusal.field, refusal.here, refusal.there});
  const ConnectionId connection = link.connection;
  release(link);
  parts.transport->disconnect(connection);
  observer->player_refused(refusal);
}

void Server::Impl::seat(Link& link) {
  std::uint8_t slot = link.wanted_slot;
  if (slot == k_any_slot) {
    for (slot = 0; seats[slot].link != nullptr;)
      ++slot;
  }
  link.slot = slot;
  link.stage = Stage::seated;
  Seat& place = seats[slot];
  place.link = &link;
  place.stats = {};
  place.inputs_next = config.input_delay_ticks;
  place.last_sent_us = now_us;
  judge.set_present(slot, true);
  parts.transport->trust(link.connection);
  send(link, Welcome{slot, info.player_count, config.input_delay_ticks, config.late_policy,
                     config.pacing, config.tick_count});
  observer->player_joined(slot, link.name.view());
}

void Server::Impl::try_start() {
  const bool all_seated = std::all_of(seats.begin(), seats.end(),
                                      [](const Seat& place) { return place.link != nullptr; });
  if (!all_seated) return;
  state = ServerState::running;
  state_since_us = now_us;
  rebase_schedule(now_us + tick_us);
  for (const Seat& place : seats)
    send(*place.link, Start{present_mask()});
  observer->match_started();
}

}  // namespace lockstone::net
