// The fields of each message, in their order on the wire, with their ranges: one list from which
// `encode` and `decode` come. `Wire` is a WireWriter, whose `Message` is const, or a WireReader.
#pragma once

#include <lockstone/net/wire.h>
#include <lockstone/simulation_fields.h>

#include "net/wire/wire_io.h"

namespace lockstone::net {

template <class Wire, class Message>
void fields(Wire& wire, Message& message, const Hello&) {
  wire.constant(k_protocol_magic);
  wire.value(message.protocol);
  // Another version may have another layout: all it shares with this one is the beginning.
  if (!wire.goes_on(message.protocol == k_protocol_version)) return;
  wire.value(message.insecure);
  wire.value(message.wanted_slot);
  wire.require(message.wanted_slot < k_max_players || message.wanted_slot == k_any_slot ||
               message.wanted_slot == k_spectator_slot);
  wire.value(message.rejoin_key);
  wire.tick(message.ticks_stepped);
  wire.value(message.state_hash);
  wire.text(message.name);
  wire.text(message.build);
}

template <class Wire, class Message>
void fields(Wire& wire, Message& message, const Offer&) {
  wire.value(message.insecure);
  wire.block(message.config, k_max_config_bytes);
}

// Ranges are left to the comparison with the server's own values, which names the field.
template <class Wire, class Message>
void fields(Wire& wire, Message& message, const Answer&) {
  visit_fields(message.info, [&](auto& field) { wire.value(field); });
}

template <class Wire, class Message>
void fields(Wire& wire, Message& message, const Welcome&) {
  wire.value(message.slot);
  wire.value(message.player_count);
  wire.require(message.player_count <= k_max_players);
  wire.require(message.slot < message.player_count || message.slot == k_spectator_slot);
  wire.value(message.input_delay_ticks);
  wire.require(message.input_delay_ticks <= k_max_input_delay_ticks);
  wire.choice(message.late_policy, LatePolicy::strict);
  wire.choice(message.pacing, Pacing::fast);
  wire.tick(message.tick_count);
  wire.choice(message.entry, Entry::snapshot);
  wire.value(message.rejoin_key);
  wire.value(message.commands_taken);
}

template <class Wire, class Message>
void fields(Wire& wire, Message& message, const Refuse&) {
  wire.choice(message.reason, k_last_refuse_reason);
  wire.require(message.reason != RefuseReason::none);
  wire.choice(message.field, RefuseField::slot);
  wire.value(message.here);
  wire.value(message.there);
}

template <class Wire, class Message>
void fields(Wire& wire, Message& message, const Start&) {
  wire.value(message.present_mask);
  wire.require(message.present_mask != 0);
}

template <class Wire, class Message>
void fields(Wire& wire, Message& message, const Inputs&) {
  wire.tick(message.ticks_received);
  wire.tick(message.first_tick);
  wire.value(message.count);
  wire.tick(message.first_hash_tick);
  wire.value(message.hash_count);
  wire.items(message.hashes, message.hash_count, [&](auto& hash) { wire.value(hash); });
  wire.rest(message.coded);
}

template <class Wire, class Message>
void fields(Wire& wire, Message& message, const Ticks&) {
  wire.tick(message.first_tick);
  wire.value(message.count);
  wire.tick(message.ticks_confirmed);
  wire.tick(message.inputs_received);
  wire.tick(message.hashes_received);
  wire.value(message.waiting_mask);
  wire.value(message.margin_quarters);
  wire.require(message.first_tick + message.count <= message.ticks_confirmed);
  wire.require(message.hashes_received <= message.ticks_confirmed);
  wire.rest(message.coded);
}

template <class Wire, class Message>
void fields(Wire& wire, Message& message, const Resend&) {
  wire.tick(message.first_tick);
  wire.value(message.count);
  wire.require(message.count > 0);
}

template <class Wire, class Message>
void fields(Wire& wire, Message& message, const DesyncNotice&) {
  wire.tick(message.tick);
  wire.value(message.slot);
  wire.require(message.slot < k_max_players);
  wire.choice(message.verdict, Verdict::server_diverged);
  wire.value(message.hash_here);
  wire.value(message.hash_there);
  wire.value(message.differs);
  wire.value(message.object);
  for (auto* text :
       {&message.store, &message.name, &message.field, &message.here, &message.there}) {
    wire.text(*text);
  }
}

template <class Wire, class Message>
void fields(Wire& wire, Message& message, const DumpRequest&) {
  wire.tick(message.tick);
}

/// A piece of a sequence of bytes, with its place in the whole.
template <class Wire, class Message>
void piece_fields(Wire& wire, Message& message) {
  wire.value(message.total_bytes);
  wire.value(message.offset_bytes);
  wire.block(message.chunk, k_max_chunk_bytes);
  wire.require(message.offset_bytes <= message.total_bytes);
  wire.require(message.chunk.size() <= message.total_bytes - message.offset_bytes);
}

template <class Wire, class Message>
void fields(Wire& wire, Message& message, const Dump&) {
  wire.tick(message.tick);
  piece_fields(wire, message);
  wire.require(!message.chunk.empty() || message.total_bytes == 0);  // every piece brings progress
}

template <class Wire, class Message>
void fields(Wire& wire, Message& message, const Finish&) {
  wire.choice(message.reason, FinishReason::no_players);
  wire.tick(message.ticks);
  wire.value(message.has_hash);
  wire.value(message.hash);
}

template <class Wire, class Message>
void fields(Wire& wire, Message& message, const Bye&) {
  wire.choice(message.reason, k_last_leave_reason);
}

template <class Wire, class Message>
void fields(Wire& wire, Message& message, const Snapshot&) {
  wire.tick(message.ticks);
  wire.value(message.hash);
  piece_fields(wire, message);
  wire.require(!message.chunk.empty());
}

template <class Wire, class Message>
void fields(Wire& wire, Message& message, const SnapshotTaken&) {
  wire.tick(message.ticks);
  wire.value(message.good);
}

template <class Wire, class Message>
void fields(Wire& wire, Message& message, const Activate&) {
  wire.value(message.slot);
  wire.require(message.slot < k_max_players);
  wire.tick(message.tick);
}

template <class Wire, class Message>
void fields(Wire& wire, Message& message, const Ask&) {
  wire.choice(message.kind, AskKind::vote);
  wire.value(message.topic);
  wire.value(message.choice);
  wire.require(message.kind == AskKind::vote || (message.topic == 0 && message.choice == 0));
}

template <class Wire, class Message>
void fields(Wire& wire, Message& message, const Paused&) {
  wire.value(message.paused);
}

template <class Wire, class Message>
void fields(Wire& wire, Message& message, const Parts&) {
  wire.tick(message.ticks);
  wire.require(message.ticks > 0 && message.ticks % k_parts_interval_ticks == 0);
  wire.value(message.count);
  wire.require(message.count >= 1);
  wire.items(message.hashes, message.count, [&](auto& hash) {
    wire.value(hash.low);
    wire.value(hash.high);
  });
}

template <class Wire, class Message>
void fields(Wire& wire, Message& message, const Named&) {
  wire.value(message.slot);
  wire.require(message.slot < k_max_players);
  wire.text(message.name);
}

// A whole command has a size of its own, and every piece brings progress.
template <class Wire, class Message>
void command_piece_fields(Wire& wire, Message& message) {
  piece_fields(wire, message);
  wire.require(message.total_bytes <= k_max_command_bytes);
  wire.require(!message.chunk.empty());
}

template <class Wire, class Message>
void fields(Wire& wire, Message& message, const CommandPiece&) {
  command_piece_fields(wire, message);
}

template <class Wire, class Message>
void fields(Wire& wire, Message& message, const TickCommand&) {
  wire.tick(message.tick);
  wire.value(message.slot);
  wire.require(message.slot < k_max_players || message.slot == k_server_slot);
  command_piece_fields(wire, message);
}

template <class Wire, class Message>
void fields(Wire& wire, Message& message, const CommandResult&) {
  wire.value(message.number);
  wire.value(message.taken);
}

}  // namespace lockstone::net
