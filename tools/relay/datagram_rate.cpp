#include "tools/relay/datagram_rate.h"

#include <algorithm>
#include <array>
#include <ctime>

#include <lockstone/net/transport_enet.h>

#include "net/transport/enet/enet_commands.h"
#include "net/transport/enet/enet_datagram.h"
#include "tools/relay/attacks.h"
#include "tools/relay/udp_socket.h"

namespace lockstone::relay {
namespace {

using Bytes = std::vector<std::byte>;

constexpr std::size_t k_batch = 32;  // fits into any socket's buffer
constexpr std::size_t k_head_bytes = 8;

void append(Bytes& bytes, std::span<const std::byte> more) {
  for (const std::byte byte : more)
    bytes.push_back(byte);
}

void put(Bytes& bytes, std::initializer_list<unsigned> values) {
  for (const unsigned value : values)
    bytes.push_back(static_cast<std::byte>(value));
}

std::int64_t processor_us() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return std::int64_t{time.tv_sec} * 1'000'000 + time.tv_nsec / 1000;
}

// A server, and an attacker who has the link key and speaks ENet by hand.
class Range {
 public:
  [[nodiscard]] bool open() {
    if (!net::security_available()) return false;
    net::SystemRandom system;
    net::EnetOptions options;
    options.limits = net::DatagramLimits::none();
    options.link_key = net::make_link_key(net::make_key(system), 1);
    checksum_ = net::LinkChecksum(options.link_key);
    auto server = net::EnetTransport::listen(options);
    auto socket = UdpSocket::open(Endpoint::loopback(0));
    if (!server || !socket) return false;
    server_ = std::move(server).value();
    socket_ = std::move(socket).value();
    return join();
  }

  // Sends the datagrams in turn, and returns the time that the server's part took.
  [[nodiscard]] DatagramRate measure(std::string name, const std::vector<Bytes>& datagrams,
                                     std::uint64_t count) {
    const std::uint64_t before = taken(), kept_before = kept_out();
    std::int64_t spent_us = 0;
    for (std::uint64_t sent = 0; sent < count;) {
      for (std::size_t i = 0; i < k_batch; ++i)
        send(datagrams[sent++ % datagrams.size()]);
      const std::int64_t from_us = processor_us();
      serve();
      spent_us += processor_us() - from_us;
      drain();
    }
    const std::uint64_t done = taken() - before;
    return {std::move(name), done, kept_out() - kept_before,
            done * 1'000'000 / static_cast<std::uint64_t>(std::max<std::int64_t>(spent_us, 1))};
  }

  // A datagram of this connection.
  [[nodiscard]] Bytes sealed(const Bytes& commands) const {
    Bytes bytes = head_;
    bytes.insert(bytes.end(), connection_.begin(), connection_.end());
    bytes.insert(bytes.end(), commands.begin(), commands.end());
    set_checksum(bytes);
    return bytes;
  }

  void send(const Bytes& bytes) {
    static_cast<void>(socket_->send(Endpoint::loopback(server_->port()), bytes));
  }

  void serve() {
    net::TransportEvent event;
    while (server_->poll(0, event))
      connected_ = connected_ || event.kind == net::TransportEventKind::connected;
    server_->flush();
  }

 private:
  [[nodiscard]] std::uint64_t taken() const {
    return server_->counters().datagrams + server_->counters().oversized;
  }

  [[nodiscard]] std::uint64_t kept_out() const {
    const net::EnetCounters& all = server_->counters();
    return all.malformed + all.strays + all.forged + all.too_far_ahead + all.limited +
           all.oversized;
  }

  // The checksum is computed with the connection's id in its place.
  void set_checksum(Bytes& bytes) const {
    const net::Word sum = checksum_.of(bytes);
    std::copy(sum.begin(), sum.end(), bytes.begin() + 4);
  }

  void drain() {
    std::array<std::byte, 2048> buffer{};
    Endpoint from;
    while (socket_->receive(from, buffer)) {
    }
  }

  // Asks, takes the answer, confirms it.
  [[nodiscard]] bool join() {
    net::Random random(1);
    Bytes ask = connect_datagram(random, true);
    std::copy_n(ask.begin() + 48, 4, connection_.begin());
    set_checksum(ask);
    send(ask);
    std::array<std::byte, 2048> buffer{};
    Endpoint from;
    std::optional<ByteView> answer;
    for (int i = 0; i < 1'000'000 && !answer; ++i) {
      serve();
      answer = socket_->receive(from, buffer);
    }
    if (!answer || answer->size() < k_head_bytes + 8) return false;
    const ByteView verify = answer->subspan(k_head_bytes);
    // The number of the place, the session, and a time to be acknowledged.
    put(head_, {0x80U | std::to_integer<unsigned>(verify[7]) << 4 |
                    (std::to_integer<unsigned>(verify[4]) & 0x0f),
                std::to_integer<unsigned>(verify[5]), 0, 0});
    Bytes confirm;
    put(confirm, {1, 0xff, 0, 0});
    append(confirm, std::span(verify).subspan(2, 2));
    append(confirm, std::span(*answer).subspan(2, 2));
    send(sealed(confirm));
    serve();
    drain();
    return connected_;
  }

  net::LinkChecksum checksum_{std::nullopt};
  std::unique_ptr<net::EnetTransport> server_;
  std::unique_ptr<UdpSocket> socket_;
  net::Word connection_{};
  Bytes head_;
  bool connected_ = false;
};

Bytes reliable(unsigned sequence) {
  Bytes bytes;
  put(bytes, {0x86, 0, sequence >> 8, sequence & 0xff, 0, 1, 7});
  return bytes;
}

Bytes many(unsigned first, unsigned step, unsigned count = net::CommandFilter::k_max_commands) {
  Bytes bytes;
  for (unsigned i = 0; i < count; ++i) {
    const Bytes one = reliable(first + i * step);
    bytes.insert(bytes.end(), one.begin(), one.end());
  }
  return bytes;
}

Bytes last_fragments(unsigned first, unsigned count) {
  constexpr unsigned k_full = net::k_enet_fragment_bytes;
  constexpr unsigned k_total = k_full + 1;
  Bytes bytes;
  for (unsigned i = 0; i < count; ++i) {
    put(bytes, {0x88, 0, (first + 1) >> 8, (first + 1) & 0xff, first >> 8, first & 0xff, 0, 1});
    put(bytes, {0, 0, 0, 2, 0, 0, 0, 1});
    put(bytes, {0, 0, k_total >> 8, k_total & 0xff, 0, 0, k_full >> 8, k_full & 0xff, 7});
  }
  return bytes;
}

Bytes random_bytes(net::Random& random, std::size_t size) {
  Bytes bytes(size);
  for (std::byte& byte : bytes)
    byte = static_cast<std::byte>(random.below(256));
  return bytes;
}

// 3 kB of reliable commands without data.
Bytes empty_commands() {
  Bytes bytes;
  for (unsigned i = 0; i < 500; ++i)
    put(bytes, {0x86, 0, (2 + i) >> 8, (2 + i) & 0xff, 0, 0});
  return bytes;
}

std::optional<std::vector<DatagramRate>> measure_one_server(std::uint64_t datagrams) {
  Range range;
  if (!range.open()) return std::nullopt;
  net::Random random(2);
  std::vector<Bytes> forged, garbage;
  for (std::size_t i = 0; i < k_batch; ++i) {
    forged.push_back(connect_datagram(random, true));
    garbage.push_back(random_bytes(random, 1 + random.below(1400)));
  }
  std::vector<DatagramRate> rates;
  rates.push_back(range.measure("forged", forged, datagrams));
  rates.push_back(range.measure("garbage", garbage, datagrams));
  rates.push_back(range.measure("oversized", {Bytes(5000)}, datagrams));
  rates.push_back(range.measure("empty commands", {range.sealed(empty_commands())}, datagrams));
  // As many as may wait behind a gap; then the lowest of them, for which ENet walks past the rest.
  constexpr unsigned k_commands = net::CommandFilter::k_max_commands;
  for (unsigned i = 0; i < net::CommandFilter::k_max_waiting / k_commands; ++i)
    range.send(range.sealed(many(2 + i * k_commands, 1)));
  range.serve();

  rates.push_back(range.measure("lowest again", {range.sealed(many(2, 0))}, datagrams));
  return rates;
}

// The same with the shortest fragment there is, the last of a packet that is one byte too long.
std::optional<DatagramRate> measure_fragments(std::uint64_t datagrams) {
  Range range;
  if (!range.open()) return std::nullopt;
  constexpr unsigned k_others = net::CommandFilter::k_max_waiting - 1;
  range.send(range.sealed(last_fragments(2, 1)));
  range.send(range.sealed(many(4, 1, k_others)));
  range.serve();
  return range.measure("lowest fragment again",
                       {range.sealed(last_fragments(2, net::CommandFilter::k_max_commands))},
                       datagrams);
}

}  // namespace

std::optional<std::vector<DatagramRate>> measure_rates(std::uint64_t datagrams) {
  std::optional<std::vector<DatagramRate>> rates = measure_one_server(datagrams);
  const std::optional<DatagramRate> fragments = measure_fragments(datagrams);
  if (!rates || !fragments) return std::nullopt;
  rates->push_back(*fragments);
  return rates;
}

}  // namespace lockstone::relay
