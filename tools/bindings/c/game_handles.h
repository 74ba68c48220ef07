// Definitions of the handles of games, simulations, transports and recorders.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <lockstone/net/keys.h>
#include <lockstone/net/transport.h>
#include <lockstone/net/transport_messages.h>
#include <lockstone/net/transport_secure.h>
#include <lockstone/net/transport_sim.h>
#include <lockstone/replay/recorder.h>
#include <lockstone/simulation.h>

#include "tools/bindings/c/call.h"

namespace lockstone::c {

/// A game, shared by all objects that were made with it.
struct Game {
  std::string name;  ///< empty: the built-in ones
  std::string version;
  SimulationFactory make;
};

/// A simulation with its origin. A session that steps it claims it.
struct Match {
  std::shared_ptr<const Game> game;
  std::vector<std::byte> config;
  std::unique_ptr<Simulation> simulation;
  bool in_session = false;
};

/// A socket, or one end of a network, and the encryption around it.
struct Carrier {
  std::shared_ptr<net::SimNetwork> network;  ///< of a network within the process
  std::unique_ptr<net::Transport> socket;    ///< an EnetTransport or MessageTransport
  std::unique_ptr<net::SystemRandom> random;
  std::unique_ptr<net::SecureTransport> secure;
  net::MessageTransport* carried = nullptr;  ///< the socket, where the program carries its messages
  net::Transport* session = nullptr;         ///< the part that a session drives
  std::vector<net::HostPort> servers{};      ///< of a client, in the order in which to call them
  std::size_t next_server = 0;
  bool in_session = false;
};

/// A log being written.
struct LogWriter {
  /// Begins it at the simulation's tick.
  static std::shared_ptr<LogWriter> begin(const lks_recorder_def* def, std::shared_ptr<Match> match,
                                          const Simulation& simulation,
                                          std::unique_ptr<replay::Sink> sink);

  std::shared_ptr<const Match> match;  ///< without a simulation: of a client
  std::unique_ptr<replay::Sink> sink;
  const replay::MemorySink* memory = nullptr;  ///< the sink of a log in memory
  std::optional<replay::Recorder> recorder;
};

}  // namespace lockstone::c

struct lks_game {
  std::shared_ptr<const lockstone::c::Game> game;
};

/// Of the caller (`match`), or that of a client.
struct lks_simulation {
  std::shared_ptr<lockstone::c::Match> match;
  std::shared_ptr<lockstone::Simulation> simulation;
};

struct lks_transport {
  std::shared_ptr<lockstone::c::Carrier> carrier;
};

struct lks_recorder {
  std::shared_ptr<lockstone::c::LogWriter> log;
};

namespace lockstone::c {

/// A handle of a simulation that a game made.
[[nodiscard]] std::unique_ptr<lks_simulation> make_handle(std::shared_ptr<const Game> game,
                                                          std::vector<std::byte> config,
                                                          std::unique_ptr<Simulation> simulation);

/// One input for each slot, from bytes that stand one after another. Throws for a wrong number of
/// bytes and unknown origins.
class FlatInputs {
 public:
  FlatInputs(const SimulationInfo& info, const void* inputs, std::size_t bytes,
             const std::uint32_t* origins);
  [[nodiscard]] std::span<const PlayerInput> list() const { return {inputs_.data(), count_}; }

 private:
  std::array<PlayerInput, k_max_players> inputs_{};
  std::size_t count_;
};

/// Throws where the transport carries a session already.
Carrier& claim(lks_transport* transport);

inline ByteView bytes_of(const void* bytes, std::size_t count, std::string_view name) {
  return {static_cast<const std::byte*>(array(bytes, count, name)), count};
}

/// Copies bytes to the caller; throws where they do not fit.
void give_bytes(ByteView bytes, void* out, std::size_t capacity, std::size_t& count,
                std::string_view name);

/// A text in an array of the caller's structure, which must end within it.
template <std::size_t N>
std::string text_in(const char (&text)[N], std::string_view field) {
  const void* end = std::memchr(text, 0, N);
  if (end == nullptr) throw_invalid(field, "does not end within the structure");
  return text;
}

/// Passes a message to lks_set_log's function.
void say(std::uint32_t level, std::string_view text) noexcept;

}  // namespace lockstone::c
