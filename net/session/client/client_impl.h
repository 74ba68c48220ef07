// The inside of net::Client: the data that its parts share, and the parts in the order in which
// they are built on each other.
#pragma once

#include <cstdint>

#include <lockstone/net/client.h>

#include "net/session/client/client_commands.h"
#include "net/session/client/client_data.h"
#include "net/session/client/client_end.h"
#include "net/session/client/dump_sender.h"
#include "net/session/client/handshake.h"
#include "net/session/client/input_sender.h"
#include "net/session/client/match_entry.h"
#include "net/session/client/playback.h"
#include "net/session/client/prediction.h"
#include "net/session/client/tick_receiver.h"
#include "net/session/peer_watch.h"

namespace lockstone::net {

/// An update receives, calls the parts in a fixed order, and sends.
struct Client::Impl {
  Impl(const ClientConfig& config, ClientParts parts);

  void update(std::int64_t now_us);
  [[nodiscard]] bool reconnect(ConnectionId connection);
  void ask(AskKind kind, std::uint8_t topic, std::uint8_t choice);

  ClientData data;
  Prediction prediction;
  Playback playback;
  TickReceiver receiver;
  InputSender sender;
  ClientCommands commands;
  DumpSender dump;
  ClientEnd end;
  MatchEntry entry;
  Handshake handshake;

  PeerWatch watch;
  bool updated = false;       ///< before, there is no time to count from
  std::int64_t begun_us = 0;  ///< first update

 private:
  void begin(std::int64_t now_us);
  void receive();
  void receive_packet(ByteView packet);
  [[nodiscard]] bool dispatch(ByteView packet);
  void watch_server();
  void play();
  [[nodiscard]] bool on_desync(ByteView packet);
  [[nodiscard]] bool on_paused(ByteView packet);
  [[nodiscard]] bool on_named(ByteView packet);
};

}  // namespace lockstone::net
