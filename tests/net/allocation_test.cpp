// Server and client must not allocate once a match runs. This program counts its allocations.
#include <array>
#include <atomic>
#include <cstdlib>
#include <memory>
#include <new>

#include <gtest/gtest.h>

#include <lockstone/net/client.h>
#include <lockstone/net/match_router.h>
#include <lockstone/net/server.h>

#include "tests/net/security/secure_fixture.h"
#include "tools/toy/toy_simulation.h"

namespace {
std::atomic<std::size_t> g_allocations{0};
}

[[gnu::noinline]] void* operator new(std::size_t size) {
  ++g_allocations;
  if (void* memory = std::malloc(size == 0 ? 1 : size)) return memory;
  std::abort();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

namespace lockstone::net {
namespace {

// Packets in one direction, without faults and without memory of its own beyond this.
class Pipe {
 public:
  bool push(Channel channel, ByteView bytes) {
    if (end_ - begin_ == slots_.size() || bytes.size() > k_slot_bytes) return false;
    Slot& slot = slots_[end_++ % slots_.size()];
    std::copy(bytes.begin(), bytes.end(), slot.bytes.begin());
    slot.size = bytes.size();
    slot.channel = channel;
    return true;
  }

  bool pop(TransportEvent& event) {
    if (begin_ == end_) return false;
    const Slot& slot = slots_[begin_++ % slots_.size()];
    event.kind = TransportEventKind::received;
    event.channel = slot.channel;
    event.bytes = ByteView(slot.bytes).first(slot.size);
    return true;
  }

 private:
  static constexpr std::size_t k_slot_bytes = k_max_datagram_bytes + k_carrier_reserve_bytes;
  struct Slot {
    std::array<std::byte, k_slot_bytes> bytes;
    std::size_t size;
    Channel channel;
  };
  std::array<Slot, 64> slots_;
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
};

// One end of a pair of pipes; the connection is number 1.
class PipeTransport final : public Transport {
 public:
  PipeTransport(Pipe& in, Pipe& out) : in_(in), out_(out) {}
  bool poll(std::int64_t, TransportEvent& event) override {
    event = {TransportEventKind::connected, 1, Channel::reliable, {}};
    if (connected_) return in_.pop(event);
    connected_ = true;
    return true;
  }
  Status send(ConnectionId, Channel channel, ByteView bytes) override {
    return out_.push(channel, bytes) ? Status::ok : Status::capacity_exhausted;
  }
  void flush() override {}
  void disconnect(ConnectionId) override {}
  [[nodiscard]] TransportStats stats(ConnectionId) const override { return {}; }

 private:
  Pipe& in_;
  Pipe& out_;
  bool connected_ = false;
};

class Presses final : public InputSource {
 public:
  void sample(std::uint64_t tick, std::span<std::byte> out) override {
    lockstone::toy::toy_input(1, 0, tick, out);
  }
};

enum class Line { bare, secure, routed };

void expect_no_allocation(Line line) {
  const bool secure = line != Line::bare;

  lockstone::toy::ToyConfig toy;
  toy.player_count = 1;
  lockstone::toy::ToySimulation simulation(toy);
  const auto up = std::make_unique<Pipe>();
  const auto down = std::make_unique<Pipe>();
  PipeTransport server_end(*up, *down);
  PipeTransport client_end(*down, *up);
  test::TestRandom random(1);
  std::unique_ptr<SecureTransport> server_secure, client_secure;
  if (secure) {
    server_secure = test::serve_securely(server_end, random);
    client_secure = test::join_securely(client_end, 0, random);
  }
  OpenMatches matches(test::backend_key(), 1);
  std::unique_ptr<MatchRouter> router;
  if (line == Line::routed) {
    router = std::move(MatchRouter::create(*server_secure, matches, {.max_matches = 1})).value();
  }
  Presses presses;
  ServerConfig server_config;
  server_config.insecure = !secure;
  server_config.match_config = toy.encode();
  ServerParts server_parts;
  server_parts.transport = &server_end;
  if (secure) server_parts.transport = server_secure.get();
  if (router != nullptr) server_parts.transport = router->open(test::k_match).value();
  server_parts.simulation = &simulation;
  const auto server = Server::create(server_config, server_parts).server;
  ClientConfig client_config;
  client_config.insecure = !secure;
  ClientParts client_parts;
  client_parts.transport = &client_end;
  if (secure) client_parts.transport = client_secure.get();
  client_parts.connection = 1;
  client_parts.factory = lockstone::toy::toy_factory();
  client_parts.inputs = &presses;
  const auto client = Client::create(client_config, client_parts).client;

  std::int64_t now_us = 0;
  const auto run_until = [&](std::int64_t end_us) {
    for (; now_us < end_us; now_us += 4000) {
      if (router != nullptr) router->pump(now_us);
      server->update(now_us);
      if (router != nullptr) router->pump(now_us);
      client->update(now_us);
    }
  };
  run_until(1'000'000);
  ASSERT_EQ(client->state(), ClientState::running);
  const std::size_t before = g_allocations;
  EXPECT_GT(before, 0U);  // the counter counts
  run_until(60'000'000);
  EXPECT_EQ(g_allocations, before);
  EXPECT_GT(client->ticks_stepped(), 3500U);
}

TEST(Allocation, NothingIsAllocatedWhileAMatchRuns) {
  expect_no_allocation(Line::bare);
}

TEST(Allocation, NothingIsAllocatedWhileAnEncryptedMatchRuns) {
  if (!security_available()) GTEST_SKIP() << "no libsodium";
  expect_no_allocation(Line::secure);
}

TEST(Allocation, NothingIsAllocatedWhileARoutedMatchRuns) {
  if (!security_available()) GTEST_SKIP() << "no libsodium";
  expect_no_allocation(Line::routed);
}

}  // namespace
}  // namespace lockstone::net
