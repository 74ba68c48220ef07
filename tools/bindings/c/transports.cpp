// Networks within the process, and the clock of sessions.
#include <chrono>

#include "tools/bindings/c/game_handles.h"

struct lks_network {
  std::shared_ptr<lockstone::net::SimNetwork> network;
};

namespace lockstone::c {

Carrier& claim(lks_transport* transport) {
  Carrier& carrier = *required(transport, "transport").carrier;
  if (carrier.in_session) throw_invalid("transport", "carries a session already");
  carrier.in_session = true;
  return carrier;
}

namespace {

lks_link_faults faults_of(const lks_link_faults* from) {
  lks_link_faults defaults{};
  defaults.size = sizeof defaults;
  return from == nullptr ? defaults : take(from, defaults, "faults");
}

std::uint32_t part_per_million(std::uint32_t value, std::string_view field) {
  if (value > 1'000'000) throw_invalid(field, "must be 0 … 1,000,000");
  return value;
}

std::int64_t time_us(std::int64_t value, std::string_view field) {
  if (value < 0 || value > 10'000'000) throw_invalid(field, "must be 0 … 10,000,000 µs");
  return value;
}

net::LinkFaults link_faults(const lks_link_faults* from) {
  const lks_link_faults raw = faults_of(from);
  net::LinkFaults faults;
  faults.loss_ppm = part_per_million(raw.loss_ppm, "faults.loss_ppm");
  faults.duplicate_ppm = part_per_million(raw.duplicate_ppm, "faults.duplicate_ppm");
  faults.reorder_ppm = part_per_million(raw.reorder_ppm, "faults.reorder_ppm");
  faults.delay_us = time_us(raw.delay_us, "faults.delay_us");
  faults.jitter_us = time_us(raw.jitter_us, "faults.jitter_us");
  return faults;
}

net::SimTransport& end_of(lks_transport* transport, const lks_network& network,
                          std::string_view name) {
  const Carrier& carrier = *required(transport, name).carrier;
  if (carrier.network != network.network) throw_invalid(name, "is no end of this network");
  return static_cast<net::SimTransport&>(*carrier.session);
}

}  // namespace
}  // namespace lockstone::c

using namespace lockstone;
using namespace lockstone::c;

void lks_transport_destroy(lks_transport* transport) {
  delete transport;
}

lks_status lks_network_create(uint64_t seed, lks_network** out) {
  return call([&] {
    required(out, "out");
    *out = new lks_network{std::make_shared<net::SimNetwork>(seed)};
  });
}

void lks_network_destroy(lks_network* network) {
  delete network;
}

lks_status lks_network_add(lks_network* network, lks_transport** out) {
  return call([&] {
    const auto& shared = required(network, "network").network;
    required(out, "out");
    auto carrier = std::make_shared<Carrier>();
    carrier->network = shared;
    carrier->session = &shared->add_endpoint();
    *out = new lks_transport{std::move(carrier)};
  });
}

lks_status lks_network_connect(lks_network* network, lks_transport* from, lks_transport* to,
                               const lks_link_faults* faults, lks_connection* connection) {
  return call([&] {
    const lks_network& owner = required(network, "network");
    net::SimTransport& caller = end_of(from, owner, "from");
    net::SimTransport& called = end_of(to, owner, "to");
    if (&caller == &called) throw_invalid("to", "is the same end as `from`");
    required(connection, "connection");
    *connection = owner.network->connect(caller, called, link_faults(faults));
  });
}

int64_t lks_now_us(void) {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::microseconds>(now).count();
}
