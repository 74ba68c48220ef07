#include "net/session/server/entry/admission.h"

#include <algorithm>
#include <array>
#include <bit>

#include <lockstone/assert.h>
#include <lockstone/hash.h>

#include "net/security/packet_seal.h"

namespace lockstone::net {
namespace {

// A token takes precedence over a request.
std::uint8_t wanted_slot(const Peer& peer) {
  return peer.identity.authenticated ? peer.identity.slot : peer.wanted_slot;
}

}  // namespace

void Admission::accept(ConnectionId connection) {
  if (data_.peers.open(connection, data_.match.now_us) != nullptr) return;
  ++data_.counters.turned_away;
  data_.parts.transport->disconnect(connection);
}

bool Admission::on_hello(Peer& peer, ByteView packet) {
  Hello hello;
  if (decode(packet, hello) != Status::ok) return false;
  peer.wanted_slot = hello.wanted_slot;
  peer.rejoin_key = hello.rejoin_key;
  peer.ticks_stepped = hello.ticks_stepped;
  peer.state_hash = hello.state_hash;
  peer.build = hello.build;
  const Refusal refusal = judge_hello(peer, hello);
  if (refusal.reason != RefuseReason::none) {
    departures_.refuse(peer, refusal);
    return true;
  }
  peer.name = hello.name;
  peer.stage = Stage::offered;
  data_.peers.tell(peer, Offer{data_.config.insecure, data_.config.match_config});
  return true;
}

bool Admission::refuse_secure_hello(Peer& peer, ByteView packet) {
  const bool secure = !packet.empty() && packet[0] == static_cast<std::byte>(SecureKind::hello);
  if (!secure || peer.stage != Stage::connected) return false;
  departures_.refuse(peer, {RefuseReason::insecure_not_allowed, RefuseField::insecure, 1, 0});
  return true;
}

Refusal Admission::judge_hello(const Peer& peer, const Hello& hello) const {
  if (hello.protocol != k_protocol_version) {
    return {RefuseReason::protocol_mismatch, RefuseField::protocol, k_protocol_version,
            hello.protocol};
  }
  const bool insecure = data_.config.insecure;
  if (hello.insecure != insecure) {
    return {RefuseReason::insecure_not_allowed, RefuseField::insecure, insecure ? 1U : 0U,
            hello.insecure ? 1U : 0U};
  }
  if (!peer.identity.authenticated) return judge_seats(peer);
  const std::uint8_t slot = peer.identity.slot;
  const bool exists = data_.roster.is_slot(slot) || slot == k_spectator_slot;
  if (!exists || (hello.wanted_slot != k_any_slot && hello.wanted_slot != slot)) {
    return {RefuseReason::wrong_slot, RefuseField::slot, slot, hello.wanted_slot};
  }
  return judge_seats(peer);
}

Refusal Admission::judge_seats(const Peer& peer) const {
  const std::uint8_t wanted = wanted_slot(peer);
  // By its token, or, without one, by the seat that it asks for.
  if (data_.offenders.is_banned(peer.identity, wanted)) {
    return {RefuseReason::expelled, RefuseField::none, 0, 0};
  }
  if (wanted == k_spectator_slot) return spectators_.judge();
  const ServerState state = data_.match.state;
  const bool runs = state == ServerState::running && data_.config.late_join;
  if (state != ServerState::lobby && !runs) {
    return {RefuseReason::match_running, RefuseField::none, 0, 0};
  }
  if (slot_for(peer) != k_no_slot) return {};
  const std::size_t count = data_.roster.seats().size();
  if (wanted == k_any_slot) {
    return {RefuseReason::match_full, RefuseField::player_count, count, count + 1};
  }
  const std::size_t limit = std::min<std::size_t>(wanted, count);
  return {RefuseReason::slot_taken, RefuseField::slot, limit, wanted};
}

// A client that lost a seat gets it back, even before the server has noticed that it was lost.
std::uint8_t Admission::slot_for(const Peer& peer) const {
  const std::size_t count = data_.roster.seats().size();
  for (std::uint8_t slot = 0; slot < count; ++slot) {
    if (data_.roster.seat(slot).rejoin_key != 0 && is_player_of(peer, slot)) return slot;
  }
  const std::uint8_t wanted = wanted_slot(peer);
  for (std::uint8_t slot = 0; slot < count; ++slot) {
    const Seat& seat = data_.roster.seat(slot);
    const bool open = seat.peer == nullptr && data_.match.now_us >= seat.reserved_until_us &&
                      !data_.offenders.is_banned(peer.identity, slot);
    if (open && (wanted == k_any_slot || wanted == slot)) return slot;
  }
  return k_no_slot;
}

bool Admission::is_player_of(const Peer& peer, std::uint8_t slot) const {
  const Seat& seat = data_.roster.seat(slot);
  if (!peer.identity.authenticated) return seat.rejoin_key == peer.rejoin_key;
  return peer.identity.slot == slot && peer.identity.player == seat.identity.player;
}

bool Admission::on_answer(Peer& peer, ByteView packet) {
  Answer answer;
  if (decode(packet, answer) != Status::ok) return false;
  Refusal refusal = judge_info(answer.info);
  // Somebody else may have sat down since the offer.
  if (refusal.reason == RefuseReason::none) refusal = judge_seats(peer);
  if (refusal.reason != RefuseReason::none) {
    departures_.refuse(peer, refusal);
  } else if (wanted_slot(peer) == k_spectator_slot) {
    spectators_.admit(peer);
  } else {
    seat(peer, slot_for(peer));
  }
  return true;
}

Refusal Admission::judge_info(const SimulationInfo& theirs) const {
  struct Field {
    RefuseField field;
    std::uint64_t here;
    std::uint64_t there;
  };
  const SimulationInfo& info = data_.info;
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

void Admission::seat(Peer& peer, std::uint8_t slot) {
  Seat& seat = data_.roster.seat(slot);
  if (seat.peer != nullptr) {  // its player is back
    departures_.drop(*seat.peer, LeaveReason::disconnected);
  }
  peer.slot = slot;
  peer.stage = Stage::seated;
  seat.occupy(peer, data_.match.now_us);
  data_.parts.transport->trust(peer.connection);
  if (seat.rejoin_key == 0 || !is_player_of(peer, slot)) {
    seat.stats = {};
    seat.confirmed = false;
    seat.identity = peer.identity;
    seat.rejoin_key = hash64({}, hash64({}, data_.config.rejoin_seed) + ++keys_given_) | 1;
  }
  if (data_.match.state == ServerState::lobby) {
    seat.inputs_next = data_.config.input_delay_ticks;
    seat.active_tick = 0;
    data_.judge.set_present(slot, true);
    data_.peers.tell(peer, welcome_of(data_, slot, Entry::lobby));
  } else {
    entry_.begin(slot, peer);
  }
  tell_names(data_, peer);
  seat.name = peer.name;
  data_.peers.send_to_admitted(Named{slot, seat.name});
  data_.observer->player_joined(slot, peer.name.view());
}

void Admission::try_start() {
  const std::size_t count = data_.roster.seats().size();
  const auto seated = static_cast<std::size_t>(std::popcount(data_.roster.present_mask()));
  const std::size_t start_players = data_.config.start_players;
  const std::size_t wanted = start_players == 0 ? count : std::min(start_players, count);
  if (seated < wanted) return;
  MatchStatus& match = data_.match;
  LKS_ASSERT(match.state == ServerState::lobby && match.confirmed == 0);
  match.enter(ServerState::running);
  data_.schedule.rebase(match.confirmed, match.now_us + data_.tick_us);
  data_.peers.send_to_admitted(Start{data_.roster.present_mask()});
  data_.observer->match_started();
}

}  // namespace lockstone::net
