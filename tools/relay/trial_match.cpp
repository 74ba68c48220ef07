#include "tools/relay/trial_match.h"

#include <algorithm>
#include <ctime>
#include <map>

#include <lockstone/net/wire.h>

namespace lockstone::relay {
namespace {

constexpr std::uint64_t k_match = 7;
constexpr std::uint64_t k_unix_s = 1'800'000'000;

/// Presses anything: games take all bytes.
class AnyInputs final : public net::InputSource {
 public:
  explicit AnyInputs(std::uint64_t seed) : random_(seed) {}
  void sample(std::uint64_t, std::span<std::byte> out) override {
    if (random_.below(8) == 0) bits_ = random_.next();  // held for some ticks, as by hands
    for (std::size_t i = 0; i < out.size(); ++i)
      out[i] = static_cast<std::byte>(bits_ >> (8 * (i % 8)) & 0xff);
  }

 private:
  net::Random random_;
  std::uint64_t bits_ = 0;
};

struct ServerTrace final : net::ServerObserver {
  void tick_confirmed(std::uint64_t, std::span<const PlayerInput>,
                      std::optional<std::uint64_t> hash) override {
    hashes.push_back(hash.value_or(0));
    stalls.tick(now_us);
  }
  std::vector<std::uint64_t> hashes;
  std::int64_t now_us = 0;
  StallWatch stalls;
};

struct ClientTrace final : net::ClientObserver {
  void tick_stepped(std::uint64_t, std::span<const PlayerInput>, std::uint64_t hash) override {
    hashes.push_back(hash);
    stalls.tick(now_us);
  }
  std::vector<std::uint64_t> hashes;
  std::int64_t now_us = 0;
  StallWatch stalls;
};

// Passes everything on.
class Passage : public net::Transport {
 public:
  explicit Passage(net::Transport& carrier) : carrier_(carrier) {}
  bool poll(std::int64_t now_us, net::TransportEvent& event) override {
    return carrier_.poll(now_us, event);
  }
  Status send(net::ConnectionId connection, net::Channel channel, ByteView bytes) override {
    return carrier_.send(connection, channel, bytes);
  }
  void flush() override { carrier_.flush(); }
  void disconnect(net::ConnectionId connection) override { carrier_.disconnect(connection); }
  void trust(net::ConnectionId connection) override { carrier_.trust(connection); }
  [[nodiscard]] net::TransportStats stats(net::ConnectionId connection) const override {
    return carrier_.stats(connection);
  }
  [[nodiscard]] bool secure() const override { return carrier_.secure(); }
  [[nodiscard]] net::PeerIdentity identity(net::ConnectionId connection) const override {
    return carrier_.identity(connection);
  }

 protected:
  net::Transport& carrier_;
};

// Counts who comes to the server's session.
class Doorkeeper final : public Passage {
 public:
  using Passage::Passage;
  bool poll(std::int64_t now_us, net::TransportEvent& event) override {
    if (!carrier_.poll(now_us, event)) return false;
    if (event.kind == net::TransportEventKind::connected)
      ++entries[identity(event.connection).player];
    return true;
  }
  std::map<std::uint64_t, unsigned> entries;
};

// A changed client: every hash that it reports is wrong.
class Liar final : public Passage {
 public:
  Liar(net::Transport& carrier, std::size_t input_bytes)
      : Passage(carrier), input_bytes_(input_bytes) {}
  Status send(net::ConnectionId connection, net::Channel channel, ByteView bytes) override {
    net::Inputs message;
    if (decode(bytes, input_bytes_, message) != Status::ok)
      return carrier_.send(connection, channel, bytes);
    for (std::size_t i = 0; i < message.hash_count; ++i)
      message.hashes[i] ^= 1;
    const std::size_t size = encode(message, out_);
    return carrier_.send(connection, channel, ByteView(out_).first(size));
  }

 private:
  std::size_t input_bytes_;
  std::array<std::byte, net::k_max_message_bytes> out_{};
};

std::int64_t thread_us() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return std::int64_t{time.tv_sec} * 1'000'000 + time.tv_nsec / 1000;
}

struct Player {
  std::unique_ptr<net::EnetTransport> enet;
  std::unique_ptr<net::SecureTransport> secure;
  std::unique_ptr<Liar> liar;
  std::unique_ptr<AnyInputs> inputs;
  ClientTrace trace;
  net::ConnectionId connection = net::k_no_connection;
  std::unique_ptr<net::Client> client;
  bool paused = false;

  [[nodiscard]] bool over() const { return client->state() >= net::ClientState::finished; }
};

}  // namespace

struct TrialMatch::Impl {
  TrialOptions options;
  net::SystemRandom random;
  net::Key key = net::make_key(random);
  std::vector<std::byte> config;
  std::unique_ptr<Simulation> simulation;
  std::unique_ptr<net::EnetTransport> enet;
  std::unique_ptr<net::SecureTransport> secure;
  std::unique_ptr<Doorkeeper> door;
  ServerTrace trace;
  std::unique_ptr<net::Server> server;
  std::unique_ptr<LossyRelay> relay;
  std::vector<Player> players;
  unsigned stalls = 0;
  std::int64_t busy_us = 0;

  [[nodiscard]] bool set_up() {
    Result<std::vector<std::byte>> made =
        options.game->configure({.seed = options.seed,
                                 .players = static_cast<std::uint8_t>(options.players),
                                 .bodies = options.bodies});
    if (!made) return false;
    config = std::move(made).value();
    Result<std::unique_ptr<Simulation>> game = options.game->make(config);
    if (!game || game.value()->info().player_count != options.players) return false;
    simulation = std::move(game).value();
    if (!start_server()) return false;
    if (options.faults) {
      auto opened = LossyRelay::open(Endpoint::loopback(0), Endpoint::loopback(enet->port()),
                                     *options.faults, options.seed);
      if (!opened) return false;
      relay = std::move(opened).value();
    }
    players.resize(options.players);
    for (unsigned slot = 0; slot < options.players; ++slot)
      if (!start_player(slot)) return false;
    return true;
  }

  [[nodiscard]] bool start_server() {
    net::EnetOptions enet_options;
    enet_options.link_key = net::make_link_key(key, k_match);
    enet_options.match_tag = net::make_match_tag(k_match);
    enet_options.limits = options.limits;
    enet_options.max_connections = options.max_connections;
    enet_options.max_connections_per_address = 64;  // all are on this machine
    enet_options.max_strangers_per_address = options.strangers_per_address;
    auto listening = net::EnetTransport::listen(enet_options);
    if (!listening) return false;
    enet = std::move(listening).value();
    net::SecureServerOptions security;
    security.backend_key = key;
    security.match = k_match;
    security.max_connections = options.max_connections;
    security.unix_us_at_zero = static_cast<std::int64_t>(k_unix_s) * 1'000'000;
    secure = std::move(net::SecureTransport::serve(*enet, security, random)).value();
    net::ServerConfig server_config;
    server_config.match_config = config;
    server_config.tick_count = options.ticks;
    server_config.input_delay_ticks = options.input_delay;
    server_config.max_spectators = options.spectators;
    door = std::make_unique<Doorkeeper>(*secure);
    server =
        net::Server::create(server_config, {door.get(), simulation.get(), nullptr, &trace}).server;
    return server != nullptr;
  }

  [[nodiscard]] bool start_player(unsigned slot) {
    Player& player = players[slot];
    const net::ConnectToken token = token_for(slot, static_cast<std::uint8_t>(slot), k_unix_s + 60);
    net::EnetOptions enet_options;
    enet_options.link_key = token.link_key;
    enet_options.match_tag = net::make_match_tag(token.grant.match);
    auto opened = net::EnetTransport::open(enet_options);
    if (!opened) return false;
    player.enet = std::move(opened).value();
    player.secure = std::move(net::SecureTransport::join(*player.enet, token, random)).value();
    const std::uint16_t port = relay == nullptr ? enet->port() : relay->port();
    player.connection = player.enet->connect("127.0.0.1", port).value();
    player.inputs = std::make_unique<AnyInputs>(options.seed + slot);
    net::Transport* transport = player.secure.get();
    if (options.liar == slot) {
      player.liar = std::make_unique<Liar>(*player.secure, simulation->info().input_bytes);
      transport = player.liar.get();
    }
    player.client = net::Client::create({}, {transport, player.connection, options.game->make,
                                             player.inputs.get(), &player.trace})
                        .client;
    return player.client != nullptr;
  }

  [[nodiscard]] net::ConnectToken token_for(std::uint64_t player, std::uint8_t slot,
                                            std::uint64_t expires_unix_s) {
    net::TokenGrant grant;
    grant.match = k_match;
    grant.player = player;
    grant.slot = slot;
    grant.expires_unix_s = expires_unix_s;
    return net::issue_token(key, grant, random).value();
  }

  [[nodiscard]] bool update(std::int64_t now_us) {
    trace.now_us = now_us;
    const std::int64_t from_us = thread_us();
    server->update(now_us);
    const std::int64_t took_us = thread_us() - from_us;
    busy_us += took_us;
    if (took_us > k_stall_us) ++stalls;
    if (relay != nullptr) relay->pump(now_us);
    bool over = server->state() == net::ServerState::over;
    for (Player& player : players) {
      player.trace.now_us = now_us;
      if (!player.paused) player.client->update(now_us);
      over = over && (player.paused || player.over());
    }
    return !over;
  }
};

TrialMatch::TrialMatch(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
TrialMatch::~TrialMatch() = default;

std::unique_ptr<TrialMatch> TrialMatch::create(const TrialOptions& options) {
  if (!net::security_available()) return nullptr;
  auto impl = std::make_unique<Impl>();
  impl->options = options;
  if (!impl->set_up()) return nullptr;
  return std::unique_ptr<TrialMatch>(new TrialMatch(std::move(impl)));
}

bool TrialMatch::update(std::int64_t now_us) {
  return impl_->update(now_us);
}
void TrialMatch::stop() {
  impl_->server->stop();
}
void TrialMatch::pause(unsigned slot, bool paused) {
  impl_->players[slot].paused = paused;
}
const SimulationFactory& TrialMatch::factory() const {
  return impl_->options.game->make;
}

std::uint64_t TrialMatch::ticks_confirmed() const {
  return impl_->server->ticks_confirmed();
}
net::SlotMask TrialMatch::present_mask() const {
  return impl_->server->present_mask();
}
std::int64_t TrialMatch::longest_server_gap_us() const {
  return impl_->trace.stalls.longest_us();
}
unsigned TrialMatch::server_stalls() const {
  return impl_->stalls;
}
std::int64_t TrialMatch::server_busy_us() const {
  return impl_->busy_us;
}
const net::ServerCounters& TrialMatch::server_counters() const {
  return impl_->server->counters();
}
unsigned TrialMatch::entries_of(std::uint64_t player) const {
  const auto found = impl_->door->entries.find(player);
  return found == impl_->door->entries.end() ? 0 : found->second;
}
std::uint16_t TrialMatch::port() const {
  return impl_->enet->port();
}
const net::EnetCounters& TrialMatch::socket_counters() const {
  return impl_->enet->counters();
}
const net::SecurityCounters& TrialMatch::security_counters() const {
  return impl_->secure->counters();
}
const LossyRelay* TrialMatch::relay() const {
  return impl_->relay.get();
}
net::ConnectToken TrialMatch::token_for(std::uint64_t player, std::uint8_t slot,
                                        std::uint64_t expires_unix_s) const {
  return impl_->token_for(player, slot, expires_unix_s);
}
std::uint64_t TrialMatch::unix_s_at_zero() {
  return k_unix_s;
}
net::Transport& TrialMatch::transport_of(unsigned slot) {
  return *impl_->players[slot].secure;
}
net::ConnectionId TrialMatch::connection_of(unsigned slot) const {
  return impl_->players[slot].connection;
}

PlayerOutcome TrialMatch::outcome(unsigned slot) const {
  const Player& player = impl_->players[slot];
  const auto& mine = player.trace.hashes;
  const auto& truth = impl_->trace.hashes;
  PlayerOutcome outcome;
  outcome.ticks = mine.size();
  outcome.substituted = impl_->server->stats(static_cast<std::uint8_t>(slot)).substituted_inputs;
  outcome.stalled_us = player.trace.stalls.stalled_us();
  outcome.longest_us = player.trace.stalls.longest_us();
  outcome.equal =
      mine.size() <= truth.size() && std::equal(mine.begin(), mine.end(), truth.begin());
  outcome.state = player.client->state();
  outcome.failure = player.client->failure();
  outcome.leave_reason = player.client->leave_reason();
  return outcome;
}

}  // namespace lockstone::relay
