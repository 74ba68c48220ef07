// The game of tools/examples/pushers written against the C++ libraries alone, as server and player:
// peers in other languages play against it, and every tick's hash must be equal.
//
//   native_peer serve PLAYERS TICKS LOG | join PORT [PREDICTION]
#include <array>
#include <charconv>
#include <chrono>
#include <cinttypes>
#include <cstdio>
#include <memory>
#include <string_view>
#include <vector>

#include <lockstone/net/client.h>
#include <lockstone/net/server.h>
#include <lockstone/net/transport_enet.h>
#include <lockstone/replay/recorder.h>
#include <lockstone/world.h>

namespace {

using namespace lockstone;

constexpr std::size_t k_most_players = 16;  // of this game, as in the other languages

class Pushers final : public Simulation {
 public:
  explicit Pushers(std::uint8_t players)
      : players_(players), world_(std::move(World::create(definition())).value()) {
    BodyDef ground;
    ground.motion = MotionType::static_body;
    ground.shape = Shape::half_space();
    (void)world_.apply(CreateBody{ground});
    for (std::uint8_t slot = 0; slot < players; ++slot) {
      BodyDef ball;
      ball.shape = Shape::sphere(Length::from_ratio(1, 2));
      ball.position.x = Position::from_ratio(3 * slot, 2);
      ball.position.y = Position::from_ratio(1, 2);
      balls_[slot] = world_.create_body(ball).value();
    }
    scene_hash_ = world_.hash().total;
  }

  [[nodiscard]] SimulationInfo info() const override {
    return {.abi = k_simulation_abi,
            .config_hash =
                config_hash(definition(), AssetSet(std::vector<AssetPtr>()).hash()) + players_,
            .scene_hash = scene_hash_,
            .canary = canary_hash(),
            .tick_rate = 60,
            .player_count = players_,
            .input_bytes = 2};
  }
  [[nodiscard]] std::uint64_t tick() const override { return world_.tick(); }
  void step(std::span<const PlayerInput> inputs) override {
    const auto push = [](std::byte input) {
      return Impulse::from_raw(std::int64_t{static_cast<std::int8_t>(input)}
                               << (Impulse::frac_bits - 3));
    };
    for (std::size_t slot = 0; slot < inputs.size() && slot < players_; ++slot) {
      const ByteView bytes = inputs[slot].bytes;
      (void)world_.apply(ApplyImpulse{balls_[slot], {push(bytes[0]), {}, push(bytes[1])}});
    }
    (void)world_.step();
  }
  [[nodiscard]] std::size_t snapshot_bytes_max(SnapshotKind kind) const override {
    return world_.snapshot_bytes_max(kind);
  }
  [[nodiscard]] std::size_t save(SnapshotKind kind, std::span<std::byte> out) const override {
    return world_.save(kind, out);
  }
  Status load(SnapshotKind kind, ByteView bytes) override { return world_.load(kind, bytes); }
  [[nodiscard]] std::uint64_t hash() const override { return world_.hash().total; }
  [[nodiscard]] std::size_t part_hashes(std::span<PartHash, k_max_state_parts> out) const override {
    const StateHash hash = world_.hash();
    out[0] = {"bodies", {.low = hash.bodies, .high = 0}};
    out[1] = {"contacts", {.low = hash.contacts, .high = 0}};
    return 2;
  }
  [[nodiscard]] StateDifference describe(ByteView here, ByteView there) const override {
    return world_.describe_difference(here, there);
  }

 private:
  static WorldDef definition() {
    WorldDef def;
    def.body_capacity = k_most_players + 1;
    return def;
  }

  std::uint8_t players_;
  World world_;
  std::array<BodyHandle, k_most_players> balls_{};
  std::uint64_t scene_hash_ = 0;
};

Result<std::unique_ptr<Simulation>> make_pushers(ByteView config) {
  if (config.size() != 1) return Status::malformed;
  const auto players = static_cast<std::uint8_t>(config[0]);
  if (players < 1 || players > k_most_players) return Status::invalid_argument;
  return std::unique_ptr<Simulation>(std::make_unique<Pushers>(players));
}

std::int64_t now_us() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::microseconds>(now).count();
}

void print_tick(std::uint64_t tick, std::uint64_t hash) {
  std::printf("%" PRIu64 " %016" PRIx64 "\n", tick, hash);
}

struct Referee final : net::ServerObserver {
  replay::Recorder* recorder = nullptr;
  void tick_confirmed(std::uint64_t tick, std::span<const PlayerInput> inputs,
                      std::optional<std::uint64_t> hash) override {
    print_tick(tick, hash.value_or(0));
    (void)recorder->record_tick(tick, inputs, hash.value_or(0));
  }
};

int serve(std::uint8_t players, std::uint64_t ticks, const char* path) {
  Pushers game(players);
  const std::array config{std::byte{players}};
  const auto sink = std::move(replay::FileSink::create(path)).value();
  replay::Recorder recorder(*sink);
  if (recorder.begin(game.info(), config, {.game = "pushers"}) != Status::ok) return 1;
  net::EnetOptions options;
  options.limits = net::DatagramLimits::none();
  const auto socket = std::move(net::EnetTransport::listen(options)).value();
  std::printf("port %u\n", unsigned{socket->port()});
  std::fflush(stdout);
  Referee referee;
  referee.recorder = &recorder;
  net::ServerConfig settings;
  settings.insecure = true;
  settings.pacing = net::Pacing::fast;
  settings.match_config.assign(config.begin(), config.end());
  settings.tick_count = ticks;
  const auto [server, error] =
      net::Server::create(settings, {socket.get(), &game, nullptr, &referee});
  while (server != nullptr && server->state() != net::ServerState::over) {
    server->update(now_us());
    socket->wait(1000);
  }
  if (recorder.finish("over") != Status::ok || server == nullptr) return 1;
  return server->finish_reason() == net::FinishReason::completed ? 0 : 1;
}

struct Bot final : net::InputSource, net::ClientObserver {
  void sample(std::uint64_t tick, std::span<std::byte> out) override {
    for (std::size_t i = 0; i < out.size(); ++i)
      out[i] = static_cast<std::byte>(tick / 8 * 53 + i * 77);
  }
  void tick_stepped(std::uint64_t tick, std::span<const PlayerInput>, std::uint64_t hash) override {
    print_tick(tick, hash);
  }
};

int join(std::uint16_t port, std::uint8_t prediction) {
  const auto socket = std::move(net::EnetTransport::open({})).value();
  const auto connection = socket->connect("127.0.0.1", port).value();
  Bot bot;
  net::ClientConfig settings;
  settings.insecure = true;
  settings.name = "C++";
  settings.prediction_ticks = prediction;
  const auto [client, error] =
      net::Client::create(settings, {socket.get(), connection, make_pushers, &bot, &bot, nullptr});
  while (client != nullptr && client->state() < net::ClientState::finished) {
    client->update(now_us());
    socket->wait(1000);
  }
  return client != nullptr && client->state() == net::ClientState::finished ? 0 : 1;
}

template <class T>
T number(std::string_view text) {
  T value{};
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string_view> words(argv + 1, argv + argc);
  if (words.size() == 4 && words[0] == "serve") {
    return serve(number<std::uint8_t>(words[1]), number<std::uint64_t>(words[2]), argv[4]);
  }
  if ((words.size() == 2 || words.size() == 3) && words[0] == "join") {
    return join(number<std::uint16_t>(words[1]),
                words.size() == 3 ? number<std::uint8_t>(words[2]) : std::uint8_t{0});
  }
  std::fprintf(stderr, "usage: native_peer serve PLAYERS TICKS LOG | join PORT [PREDICTION]\n");
  return 64;
}
