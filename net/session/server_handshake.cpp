// From a connection to a seat, or to a refusal that says why.
#include <algorithm>
#include <array>

#include <lockstone/hash.h>

#include "net/security/packet_seal.h"
#include "net/session/server_impl.h"

namespace lockstone::net {

void Server::Impl::accept(ConnectionId connection) {
  const auto place = std::find_if(links.begin(), links.end(),
                                  [](const Link& link) { return link.stage == Stage::unused; });
  if (place == links.end()) {
    ++counters.turned_away;
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
  link.wanted_slot = hello.wanted_slot;
  link.rejoin_key = hello.rejoin_key;
  link.ticks_stepped = hello.ticks_stepped;
  link.state_hash = hello.state_hash;
  link.build = hello.build;
  const Refusal refusal = judge_hello(link, hello);
  if (refusal.reason != RefuseReason::none) {
    refuse(link, refusal);
    return true;
  }
  link.name = hello.name;
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
  if (!link.identity.authenticated) return judge_seats(link);
  const std::uint8_t slot = link.identity.slot;
  const bool exists = slot < seats.size() || slot == k_spectator_slot;
  if (!exists || (hello.wanted_slot != k_any_slot && hello.wanted_slot != slot)) {
    return {RefuseReason::wrong_slot, RefuseField::slot, slot, hello.wanted_slot};
  }
  return judge_seats(link);
}

// By its token, or, without one, by the seat that it asks for.
bool Server::Impl::is_barred(const Link& link) const {
  return offenders.is_barred(link.identity, wanted_slot(link));
}

Refusal Server::Impl::judge_seats(const Link& link) const {
  if (is_barred(link)) return {RefuseReason::expelled, RefuseField::none, 0, 0};
  const std::uint8_t wanted = wanted_slot(link);
  if (wanted == k_spectator_slot) return judge_spectator();
  const bool runs = state == ServerState::running && config.late_join;
  if (state != ServerState::lobby && !runs) {
    return {RefuseReason::match_running, RefuseField::none, 0, 0};
  }
  if (free_slot(link) != k_no_slot) return {};
  const std::size_t count = seats.size();
  if (wanted == k_any_slot) {
    return {RefuseReason::match_full, RefuseField::player_count, count, count + 1};
  }
  const std::size_t limit = std::min<std::size_t>(wanted, count);
  return {RefuseReason::slot_taken, RefuseField::slot, limit, wanted};
}

// A token takes precedence over a request.
std::uint8_t Server::Impl::wanted_slot(const Link& link) const {
  return link.identity.authenticated ? link.identity.slot : link.wanted_slot;
}

// A client that lost a seat gets it back, even before the server has noticed that it was lost.
std::uint8_t Server::Impl::free_slot(const Link& link) const {
  for (std::uint8_t slot = 0; slot < seats.size(); ++slot) {
    const Seat& place = seats[slot];
    if (place.rejoin_key != 0 && is_player_of(link, place)) return slot;
  }
  const std::uint8_t wanted = wanted_slot(link);
  for (std::uint8_t slot = 0; slot < seats.size(); ++slot) {
    const Seat& place = seats[slot];
    const bool open = place.link == nullptr && now_us >= place.reserved_until_us &&
                      !offenders.is_barred(link.identity, slot);
    if (open && (wanted == k_any_slot || wanted == slot)) return slot;
  }
  return k_no_slot;
}

bool Server::Impl::is_player_of(const Link& link, const Seat& place) const {
  if (!link.identity.authenticated) return place.rejoin_key == link.rejoin_key;
  return link.identity.slot == static_cast<std::size_t>(&place - seats.data()) &&
         link.identity.player == place.identity.player;
}

bool Server::Impl::on_answer(Link& link, ByteView packet) {
  Answer answer;
  if (decode(packet, answer) != Status::ok) return false;
  Refusal refusal = judge_info(answer.info);
  // Somebody else may have sat down since the offer.
  if (refusal.reason == RefuseReason::none) refusal = judge_seats(link);
  if (refusal.reason != RefuseReason::none) {
    refuse(link, refusal);
  } else if (wanted_slot(link) == k_spectator_slot) {
    welcome_spectator(link);
  } else {
    seat(link, free_slot(link));
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
  ++counters.refused[static_cast<std::size_t>(refusal.reason)];
  observer->player_refused(refusal);
}

void Server::Impl::seat(Link& link, std::uint8_t slot) {
  Seat& place = seats[slot];
  if (place.link != nullptr) drop(*place.link, LeaveReason::disconnected);  // its player is back
  link.slot = slot;
  link.stage = Stage::seated;
  static_cast<Follower&>(place) = {};
  place.link = &link;
  place.last_sent_us = now_us;
  place.condemned = false;
  place.expelled = false;
  place.dump_room_bytes = 0;
  place.hashes_since_us = now_us;
  parts.transport->trust(link.connection);
  if (place.rejoin_key == 0 || !is_player_of(link, place)) {
    place.stats = {};
    place.confirmed = false;
    place.identity = link.identity;
    place.rejoin_key = hash64({}, hash64({}, config.rejoin_seed) + ++keys_given) | 1;
  }
  if (state == ServerState::lobby) {
    place.inputs_next = config.input_delay_ticks;
    place.active_tick = 0;
    judge.set_present(slot, true);
    send(link, welcome(slot, Entry::lobby));
  } else {
    enter(slot, link);
  }
  observer->player_joined(slot, link.name.view());
}

Welcome Server::Impl::welcome(std::uint8_t slot, Entry way) const {
  const std::uint64_t key = slot < seats.size() ? seats[slot].rejoin_key : 0;
  return {slot,
          info.player_count,
          config.input_delay_ticks,
          config.late_policy,
          config.pacing,
          config.tick_count,
          way,
          key};
}

void Server::Impl::try_start() {
  const auto seated = std::count_if(seats.begin(), seats.end(),
                                    [](const Seat& place) { return place.link != nullptr; });
  const std::size_t wanted = config.start_players == 0
                                 ? seats.size()
                                 : std::min<std::size_t>(config.start_players, seats.size());
  if (static_cast<std::size_t>(seated) < wanted) return;
  state = ServerState::running;
  state_since_us = now_us;
  rebase_schedule(now_us + tick_us);
  for (const Link& link : links) {
    if (link.stage >= Stage::seated) send(link, Start{present_mask()});
  }
  observer->match_started();
}

}  // namespace lockstone::net
