// A player of the arena, as a bot, whose messages go through its standard input and output: each is a
// length (u32, little-endian) and so many bytes. It needs no network library, so that a program beside
// it can bring it into a match from under an emulator. At the end it prints its last tick and hash.
//
// usage: lockstone_stdio_client TOKEN SEED
#include <array>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include <fcntl.h>
#include <poll.h>
#include <time.h>
#include <unistd.h>

#include <lockstone/net/client.h>
#include <lockstone/net/token.h>
#include <lockstone/net/transport_messages.h>
#include <lockstone/net/transport_secure.h>

#include "tools/arena/arena_simulation.h"
#include "tools/arena/bots.h"

namespace lockstone {
namespace {

constexpr std::size_t k_head_bytes = 4;
constexpr int k_input = 0;
constexpr int k_output = 1;

std::int64_t now_us() {
  timespec time{};
  ::clock_gettime(CLOCK_MONOTONIC, &time);
  return std::int64_t{time.tv_sec} * 1'000'000 + time.tv_nsec / 1000;
}

/// Plays by the state of the client's own simulation, and remembers the last hash.
class Bot final : public net::InputSource, public net::ClientObserver {
 public:
  explicit Bot(std::uint64_t seed) : seed_(seed) {}

  void watch(net::Client& client) { client_ = &client; }

  void sample(std::uint64_t /*tick*/, std::span<std::byte> out) override {
    const auto* match = dynamic_cast<const arena::ArenaSimulation*>(client_->simulation());
    if (match != nullptr && client_->slot() < match->arena().config.players)
      arena::bot_input(match->arena(), seed_, client_->slot()).encode(out);
  }
  void tick_stepped(std::uint64_t, std::span<const PlayerInput>, std::uint64_t hash) override {
    final_hash = hash;
  }

  std::uint64_t final_hash = 0;

 private:
  std::uint64_t seed_;
  const net::Client* client_ = nullptr;
};

/// The messages of the transport, through the pipes. False once the input has ended.
class Pipes {
 public:
  explicit Pipes(net::MessageTransport& transport) : transport_(transport) {
    ::fcntl(k_input, F_SETFL, O_NONBLOCK);
  }

  [[nodiscard]] bool carry() {
    if (!take()) return false;
    for (ByteView out = transport_.next_message(); !out.empty(); out = transport_.next_message()) {
      write_message(out);
      transport_.take_message();
    }
    return true;
  }

 private:
  [[nodiscard]] bool take() {
    std::array<std::byte, 65536> buffer;
    for (;;) {
      const ssize_t size = ::read(k_input, buffer.data(), buffer.size());
      if (size == 0) return false;
      if (size < 0) return true;
      waiting_.insert(waiting_.end(), buffer.begin(), buffer.begin() + size);
      while (take_message()) {
      }
    }
  }

  bool take_message() {
    ByteReader reader(waiting_);
    const std::size_t size = reader.get<std::uint32_t>();
    if (!reader.ok() || waiting_.size() - k_head_bytes < size) return false;
    static_cast<void>(transport_.receive(ByteView(waiting_).subspan(k_head_bytes, size)));
    const auto end = static_cast<std::ptrdiff_t>(k_head_bytes + size);
    waiting_.erase(waiting_.begin(), waiting_.begin() + end);
    return true;
  }

  static void write_message(ByteView message) {
    std::vector<std::byte> bytes(k_head_bytes + message.size());
    ByteWriter writer(bytes);
    writer.put(static_cast<std::uint32_t>(message.size()));
    writer.put_bytes(message);
    for (std::size_t done = 0; done < bytes.size();) {
      const ssize_t size = ::write(k_output, bytes.data() + done, bytes.size() - done);
      if (size <= 0) std::exit(1);
      done += static_cast<std::size_t>(size);
    }
  }

  net::MessageTransport& transport_;
  std::vector<std::byte> waiting_;
};

int play(const net::ConnectToken& token, std::uint64_t seed) {
  net::MessageTransport transport;
  net::SystemRandom random;
  auto secure = net::SecureTransport::join(transport, token, random);
  if (!secure) return 1;
  Bot bot(seed);
  net::ClientConfig config;
  config.name = "stdio";
  const net::ConnectionId connection = transport.open();
  transport.opened();
  const net::Client::Created made = net::Client::create(
      config, {secure.value().get(), connection, arena::make_arena, &bot, &bot});
  if (made.client == nullptr) return 1;
  bot.watch(*made.client);
  Pipes pipes(transport);
  while (made.client->state() < net::ClientState::finished) {
    made.client->update(now_us());
    if (!pipes.carry()) break;
    pollfd input{k_input, POLLIN, 0};
    ::poll(&input, 1, 1);
  }
  std::fprintf(stderr, "{\"ticks\": %llu, \"final_hash\": \"%016llx\"}\n",
               static_cast<unsigned long long>(made.client->ticks_stepped()),
               static_cast<unsigned long long>(bot.final_hash));
  return made.client->state() == net::ClientState::finished ? 0 : 1;
}

}  // namespace
}  // namespace lockstone

int main(int argc, char** argv) {
  if (argc != 3) return 64;
  const auto token = lockstone::net::ConnectToken::from_text(argv[1]);
  if (!token) return 2;
  return lockstone::play(token.value(), std::strtoull(argv[2], nullptr, 10));
}
