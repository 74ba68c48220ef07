#include <algorithm>
#include <array>
#include <atomic>
#include <mutex>
#include <vector>

#include <lockstone/assert.h>
#include <lockstone/net/match_router.h>

#include "net/routing/connection_routes.h"
#include "net/routing/routed_transport.h"

namespace lockstone::net {
namespace {

constexpr std::size_t k_min_queue_bytes = std::size_t{128} * 1024;
constexpr std::size_t k_orders_a_connection = 2;
static_assert(k_min_queue_bytes >= 2 * (k_max_reliable_bytes + sizeof(Parcel)));
constexpr std::size_t k_max_queue_bytes = std::size_t{64} * 1024 * 1024;
constexpr std::size_t k_max_connections_per_match = 1024;

// A flood from the network must not keep the packets of matches from leaving.
constexpr unsigned k_max_events_a_pump = 4096;

bool in_range(const MatchRouterOptions& options) {
  return options.max_matches >= 1 && options.max_matches <= k_max_open_matches &&
         options.max_connections >= 1 && options.max_connections <= k_max_socket_connections &&
         options.max_connections_per_match >= 1 &&
         options.max_connections_per_match <= k_max_connections_per_match &&
         options.queue_bytes >= k_min_queue_bytes + k_orders_a_connection * sizeof(Parcel) *
                                                        options.max_connections_per_match &&
         options.queue_bytes <= k_max_queue_bytes;
}

}  // namespace

struct MatchRouter::Impl {
  enum class Stage : std::uint8_t { free, open, closing };

  struct Place {
    explicit Place(const MatchRouterOptions& options) : transport(options) {}
    std::uint64_t match = 0;      ///< under the router's mutex
    Stage stage = Stage::free;    ///< under the router's mutex
    std::size_t connections = 0;  ///< of the thread that pumps, as is all below
    RoutedTransport transport;
  };

  Impl(Transport& carrier, OpenMatches& matches, const MatchRouterOptions& options);

  void receive(std::int64_t now_us);
  void accept(ConnectionId connection);
  void hand_over(const TransportEvent& event, std::size_t place);
  void end(ConnectionId connection, std::size_t place);
  void carry_out(std::size_t place);
  void carry_out(const Parcel& parcel, ByteView bytes, std::size_t place);
  void end_all(std::size_t place);
  void release(std::size_t place);
  [[nodiscard]] Stage stage_of(std::size_t place) const;
  [[nodiscard]] std::size_t place_of(std::uint64_t match) const;

  Transport& carrier;
  OpenMatches& matches;
  const MatchRouterOptions options;
  RouterCounters counters;
  ConnectionRoutes routes;
  mutable std::mutex mutex;
  std::vector<std::unique_ptr<Place>> places;
};

MatchRouter::Impl::Impl(Transport& below, OpenMatches& open, const MatchRouterOptions& given)
    : carrier(below), matches(open), options(given), routes(given.max_connections) {
  places.reserve(options.max_matches);
  for (std::size_t i = 0; i < options.max_matches; ++i)
    places.push_back(std::make_unique<Place>(options));
}

MatchRouter::MatchRouter(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
MatchRouter::~MatchRouter() = default;

Result<std::unique_ptr<MatchRouter>> MatchRouter::create(Transport& carrier, OpenMatches& matches,
                                                         const MatchRouterOptions& options) {
  if (!in_range(options) || !carrier.secure()) return Status::invalid_argument;
  return std::unique_ptr<MatchRouter>(
      new MatchRouter(std::make_unique<Impl>(carrier, matches, options)));
}

Result<Transport*> MatchRouter::open(std::uint64_t match) {
  Impl& impl = *impl_;
  const std::lock_guard lock(impl.mutex);
  const auto place = std::find_if(impl.places.begin(), impl.places.end(),
                                  [](const auto& one) { return one->stage == Impl::Stage::free; });
  if (place == impl.places.end()) return Status::capacity_exhausted;
  if (const Status status = impl.matches.add(match); status != Status::ok) return status;
  (*place)->match = match;
  (*place)->stage = Impl::Stage::open;
  return &(*place)->transport;
}

void MatchRouter::close(const Transport& transport) {
  Impl& impl = *impl_;
  const std::lock_guard lock(impl.mutex);
  for (const auto& place : impl.places) {
    if (&place->transport != &transport || place->stage != Impl::Stage::open) continue;
    place->stage = Impl::Stage::closing;
    impl.matches.remove(place->match);
  }
}

void MatchRouter::pump(std::int64_t now_us) {
  impl_->receive(now_us);
  for (std::size_t place = 0; place < impl_->places.size(); ++place)
    impl_->carry_out(place);
  impl_->carrier.flush();
}

const RouterCounters& MatchRouter::counters() const {
  return impl_->counters;
}

void MatchRouter::Impl::receive(std::int64_t now_us) {
  TransportEvent event;
  for (unsigned i = 0; i < k_max_events_a_pump && carrier.poll(now_us, event); ++i) {
    if (event.kind == TransportEventKind::connected) {
      accept(event.connection);
      continue;
    }
    const std::size_t place = routes.find(event.connection);
    if (place != ConnectionRoutes::k_none) hand_over(event, place);
  }
}

// Room for word of its end is kept for every connection that a match has heard of.
void MatchRouter::Impl::accept(ConnectionId connection) {
  Parcel parcel;
  parcel.kind = ParcelKind::connected;
  parcel.connection = connection;
  parcel.identity = carrier.identity(connection);
  const std::size_t index = place_of(parcel.identity.match);
  Place* place = index == ConnectionRoutes::k_none ? nullptr : places[index].get();
  const bool fits = parcel.identity.authenticated && place != nullptr &&
                    place->connections < options.max_connections_per_match && !routes.full() &&
                    place->transport.inbox.put(parcel, {}, place->connections + 1);
  if (!fits) {
    ++counters.homeless;
    carrier.disconnect(connection);
    return;
  }
  routes.add(connection, index);
  ++place->connections;
}

void MatchRouter::Impl::hand_over(const TransportEvent& event, std::size_t index) {
  Place& place = *places[index];
  Parcel parcel;
  parcel.channel = event.channel;
  parcel.connection = event.connection;
  if (event.kind == TransportEventKind::disconnected) {
    parcel.kind = ParcelKind::disconnected;
    parcel.reason = event.reason;
    routes.remove(event.connection);
    --place.connections;
    const bool fits = place.transport.inbox.put(parcel, {}, place.connections);
    LKS_ASSERT(fits);
    static_cast<void>(fits);
    return;
  }
  parcel.kind = ParcelKind::received;
  parcel.stats = carrier.stats(event.connection);
  parcel.size = event.bytes.size();
  if (place.transport.inbox.put(parcel, event.bytes, place.connections)) return;
  if (event.channel == Channel::unreliable) {
    ++counters.lost;
    return;
  }
  end(event.connection, index);
}

// The reliable stream of a connection has a gap.
void MatchRouter::Impl::end(ConnectionId connection, std::size_t index) {
  ++counters.broken;
  carrier.disconnect(connection);
  TransportEvent event;
  event.kind = TransportEventKind::disconnected;
  event.connection = connection;
  hand_over(event, index);
}

void MatchRouter::Impl::carry_out(std::size_t index) {
  const Stage stage = stage_of(index);
  if (stage == Stage::free) return;
  RoutedTransport& transport = places[index]->transport;
  Parcel parcel;
  ByteView bytes;
  while (transport.outbox.take(parcel, bytes))
    carry_out(parcel, bytes, index);
  if (transport.order_lost.exchange(false)) end_all(index);
  if (stage == Stage::closing) release(index);
}

void MatchRouter::Impl::carry_out(const Parcel& parcel, ByteView bytes, std::size_t index) {
  if (routes.find(parcel.connection) != index) return;  // it has ended meanwhile
  switch (parcel.kind) {
    case ParcelKind::send: {
      const Status status = carrier.send(parcel.connection, parcel.channel, bytes);
      if (status != Status::ok && parcel.channel == Channel::reliable) {
        end(parcel.connection, index);
      }
      return;
    }
    case ParcelKind::trust:
      carrier.trust(parcel.connection);
      return;
    case ParcelKind::disconnect:
      routes.remove(parcel.connection);
      --places[index]->connections;
      carrier.disconnect(parcel.connection);
      return;
    default:
      LKS_ASSERT(false);
  }
}

void MatchRouter::Impl::end_all(std::size_t index) {
  for (ConnectionId connection = routes.first_of(index); connection != k_no_connection;
       connection = routes.first_of(index))
    end(connection, index);
}

// The match no longer reads: its connections end without a word to it.
void MatchRouter::Impl::release(std::size_t index) {
  Place& place = *places[index];
  for (ConnectionId connection = routes.first_of(index); connection != k_no_connection;
       connection = routes.first_of(index)) {
    routes.remove(connection);
    carrier.disconnect(connection);
  }
  place.connections = 0;
  place.transport.reset();
  const std::lock_guard lock(mutex);
  place.stage = Stage::free;
}

MatchRouter::Impl::Stage MatchRouter::Impl::stage_of(std::size_t index) const {
  const std::lock_guard lock(mutex);
  return places[index]->stage;
}

std::size_t MatchRouter::Impl::place_of(std::uint64_t match) const {
  const std::lock_guard lock(mutex);
  const auto found = std::find_if(places.begin(), places.end(), [match](const auto& place) {
    return place->stage == Stage::open && place->match == match;
  });
  return found == places.end() ? ConnectionRoutes::k_none
                               : static_cast<std::size_t>(found - places.begin());
}

}  // namespace lockstone::net
