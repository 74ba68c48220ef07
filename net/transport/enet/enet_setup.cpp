// The making of an EnetTransport, and ENet's callbacks.
#include <cerrno>
#include <cstring>
#include <string>

#include "net/transport/enet/enet_state.h"

namespace lockstone::net {
namespace {

constexpr unsigned k_tries_for_a_port = 8;

}  // namespace

DatagramSource source_of(const ENetAddress& address) {
  std::array<std::byte, 4> bytes{};
  std::memcpy(bytes.data(), &address.host, bytes.size());  // in network order
  return {.address = map_ipv4(bytes), .port = address.port};
}

bool read_ipv4(const std::string& text, std::uint16_t port, ENetAddress& address) {
  address.port = port;
  if (enet_address_set_host_ip(&address, text.c_str()) == 0) return true;
  const auto ipv6 = ipv6_from_text(text);
  if (!ipv6 || !is_mapped_ipv4(*ipv6)) return false;
  std::memcpy(&address.host, ipv6->data() + 12, sizeof(address.host));
  return true;
}

EnetTransport::State::State(const EnetOptions& options)
    : connections(data, options),
      refusals(data, connections),
      gate(data, connections, refusals),
      outgoing(data, connections) {
  data.checksum = LinkChecksum(options.link_key);
  data.match_tag = options.match_tag;
  data.matches = options.matches;
}

EnetTransport::State::~State() {
  release_current();
  if (data.host != nullptr) enet_host_destroy(data.host);
}

// ENet's callbacks. It has no room for a user's pointer in a host, but the compressor's context,
// which is not used while there are no functions beside it.

EnetTransport::State& EnetTransport::State::of(const ENetHost* host) {
  return *static_cast<State*>(host->compressor.context);
}

int ENET_CALLBACK EnetTransport::State::intercept(ENetHost* host, ENetEvent*) {
  State& state = of(host);
  EnetData& data = state.data;
  ++state.datagrams_a_round_;
  if (data.ipv6 != nullptr && data.ipv6->is_wake(*host)) return state.admit_ipv6() ? 0 : 1;
  const auto datagram =
      std::as_writable_bytes(std::span(host->receivedData, host->receivedDataLength));
  if (!state.takes_ipv4_) {
    ++data.counters.datagrams;
    ++data.counters.strays;
    return 1;
  }
  data.source = source_of(host->receivedAddress);
  return state.gate.admit(datagram) ? 0 : 1;
}

// Outgoing bytes are in the host's own buffers, of which there are at least two, the header and a
// command; incoming bytes are in the host's memory for one datagram.
enet_uint32 ENET_CALLBACK EnetTransport::State::compute_checksum(const ENetBuffer* buffers,
                                                                 std::size_t count) {
  const bool sent = count > 1;
  const void* inside = sent ? static_cast<const void*>(buffers) : buffers->data;
  const std::size_t offset = sent ? offsetof(ENetHost, buffers) : offsetof(ENetHost, packetData);
  const void* begin = static_cast<const std::byte*>(inside) - offset;
  State& state = of(static_cast<const ENetHost*>(begin));
  if (!sent) return raw_value(state.gate.admitted());
  return state.outgoing.finish(std::span(buffers, count));
}

void EnetTransport::State::configure(const EnetOptions& options) {
  data.host->maximumPacketSize = k_max_reliable_bytes + k_carrier_reserve_bytes;
  data.host->maximumWaitingData = options.max_waiting_bytes;
  data.host->compressor.context = this;
  data.host->checksum = compute_checksum;
  data.host->intercept = intercept;
  // ENet's own seed is the time and an address, which others may guess.
  SystemRandom system;
  RandomSource* random = options.random;
  if (random == nullptr && security_available()) random = &system;
  if (random == nullptr) return;
  Word seed;
  random->fill(seed);
  data.host->randomSeed = raw_value(seed);
}

Result<std::unique_ptr<EnetTransport::State>> EnetTransport::State::create(
    const EnetOptions& options, const ENetAddress* address, std::string* problem) {
  if (options.max_connections < 1 || options.max_connections > k_max_socket_connections) {
    return Status::invalid_argument;
  }
  if ((options.link_key || options.matches != nullptr) && !security_available())
    return Status::incompatible;
  auto state = std::make_unique<State>(options);
  if (!state->data.library.ready()) return Status::io_error;
  state->data.listens = address != nullptr;
  errno = 0;
  state->data.host = enet_host_create(address, options.max_connections, k_channels, 0, 0);
  if (state->data.host == nullptr) {
    if (problem != nullptr) *problem = std::strerror(errno);
    return Status::io_error;
  }
  state->configure(options);
  return state;
}

Result<std::unique_ptr<EnetTransport::State>> EnetTransport::State::listen(
    const EnetOptions& options, std::string* problem) {
  ENetAddress address{};
  if (read_ipv4(options.bind_address, options.port, address)) {
    return create(options, &address, problem);
  }
  const auto local = read_ipv6(options.bind_address, options.port);
  if (local) return create_ipv6(options, *local, problem);
  *problem = "not a numeric address";
  return Status::invalid_argument;
}

// Listens at `::` for IPv4 as well, on the same port; at another address only there, and then
// ENet's own socket hears nobody but itself.
Result<std::unique_ptr<EnetTransport::State>> EnetTransport::State::create_ipv6(
    const EnetOptions& options, const DatagramSource& local, std::string* problem) {
  const bool both = local.address == Ipv6Bytes{};
  ENetAddress address{ENET_HOST_ANY, options.port};
  if (!both) {
    enet_address_set_host_ip(&address, "127.0.0.1");
    address.port = 0;
  }
  // A port that the system has chosen for IPv4 may be in use for IPv6.
  for (unsigned tries = both && options.port == 0 ? k_tries_for_a_port : 1;; --tries) {
    Result<std::unique_ptr<State>> state = create(options, &address, problem);
    if (!state) return state;
    state.value()->takes_ipv4_ = both;
    DatagramSource where = local;
    if (both) where.port = state.value()->port();
    errno = 0;
    if (state.value()->add_ipv6(&where)) return state;
    if (problem != nullptr) *problem = std::strerror(errno);
    if (tries <= 1) return Status::io_error;
  }
}

std::uint16_t EnetTransport::State::port() const {
  if (data.listens && data.ipv6 != nullptr) return data.ipv6->socket().port();
  ENetAddress address{};
  const bool bound = enet_socket_get_address(data.host->socket, &address) == 0;
  return bound ? address.port : std::uint16_t{0};
}

bool EnetTransport::State::add_ipv6(const DatagramSource* local) {
  if (data.ipv6 == nullptr) data.ipv6 = Ipv6Side::open(*data.host, local);
  return data.ipv6 != nullptr;
}

}  // namespace lockstone::net
