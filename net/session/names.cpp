// Names of the interface's enumerators, for logs; those of reasons stand in net/wire/reasons.cpp.

#include <array>
#include <cstddef>

#include <lockstone/net/client.h>
#include <lockstone/net/server.h>
#include <lockstone/net/transport.h>
#include <lockstone/net/transport_sim.h>
#include <lockstone/net/wire.h>

namespace lockstone::net {
namespace {

template <class Enum, std::size_t N>
std::string_view name_of(const std::array<std::string_view, N>& names, Enum value) {
  const auto index = static_cast<std::size_t>(value);
  return index < N ? names[index] : "unknown";
}

}  // namespace

std::string_view to_string(Channel channel) {
  constexpr std::array<std::string_view, 2> k_names{"reliable", "unreliable"};
  return name_of(k_names, channel);
}
std::string_view to_string(TransportEventKind kind) {
  constexpr std::array<std::string_view, 3> k_names{"connected", "disconnected", "received"};
  return name_of(k_names, kind);
}
std::string_view to_string(MessageType type) {
  constexpr std::array<std::string_view, 25> k_names{
      "unknown", "hello",    "offer",          "answer",        "welcome",      "refuse", "start",
      "inputs",  "ticks",    "resend",         "desync",        "dump request", "dump",   "finish",
      "bye",     "snapshot", "snapshot taken", "activate",      "ask",          "paused", "parts",
      "named",   "command",  "tick command",   "command result"};
  return name_of(k_names, type);
}
std::string_view to_string(Entry entry) {
  constexpr std::array<std::string_view, 3> k_names{"lobby", "ticks", "snapshot"};
  return name_of(k_names, entry);
}
std::string_view to_string(ClientState state) {
  constexpr std::array<std::string_view, 8> k_names{
      "connecting", "handshaking", "lobby", "joining", "running", "finished", "refused", "failed"};
  return name_of(k_names, state);
}
std::string_view to_string(ClientFailure failure) {
  constexpr std::array<std::string_view, 8> k_names{
      "none",          "connection lost",  "handshake timed out",
      "server silent", "server malformed", "configuration not understood",
      "dropped",       "not deterministic"};
  return name_of(k_names, failure);
}
std::string_view to_string(Cut cut) {
  constexpr std::array<std::string_view, 3> k_names{"both", "sending", "receiving"};
  return name_of(k_names, cut);
}
std::string_view to_string(Substitute substitute) {
  constexpr std::array<std::string_view, 2> k_names{"repeat", "neutral"};
  return name_of(k_names, substitute);
}
std::string_view to_string(DesyncPolicy policy) {
  constexpr std::array<std::string_view, 3> k_names{"end match", "kick", "resync"};
  return name_of(k_names, policy);
}
std::string_view to_string(ServerState state) {
  constexpr std::array<std::string_view, 5> k_names{"lobby", "running", "finishing", "closing",
                                                    "over"};
  return name_of(k_names, state);
}

}  // namespace lockstone::net
