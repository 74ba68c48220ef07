// A world that a game shows: viewers get its states, and only those who know the token.
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <lockstone/hull.h>
#include <lockstone/watch/world_server.h>

#include "tests/net/transport/websocket_support.h"
#include "tools/watch/world_description.h"

namespace lockstone::watch::test {

using namespace net;
using net::test::bytes_of_text;

namespace {

std::shared_ptr<const AssetSet> tetrahedron() {
  constexpr Length k_none, k_one = Length::from_integer(1);
  const std::vector<Vec3<Length>> corners = {{k_none, k_none, k_none},
                                             {k_one, k_none, k_none},
                                             {k_none, k_one, k_none},
                                             {k_none, k_none, k_one}};
  return std::make_shared<const AssetSet>(std::vector<AssetPtr>{Hull::build(corners).hull});
}

World shown_world(std::uint32_t bodies = 12) {
  WorldDef def;
  def.body_capacity = 4096;
  def.tick_rate = 50;
  World world = World::create(def, tetrahedron()).value();
  BodyDef body;
  for (std::uint32_t i = 0; i < bodies; ++i) {
    body.shape = i == 0 ? world.assets()->all().front()->shape()
                        : Shape::sphere(Length::from_ratio(1, 2));
    body.position.x = Position::from_integer(3 * static_cast<int>(i));  // apart
    EXPECT_TRUE(world.create_body(body).ok());
  }
  return world;
}

/// A viewer, and the messages that it was sent.
class Viewer {
 public:
  explicit Viewer(std::unique_ptr<WebSocketTransport> transport)
      : transport_(std::move(transport)) {}

  static Viewer of(const std::string& address, std::string token = {}) {
    const std::size_t slash = address.rfind('/') + 1;
    Viewer viewer(std::move(WebSocketTransport::open({})).value());
    viewer.token_ = token.empty() ? address.substr(slash) : std::move(token);
    viewer.connection_ = viewer.transport_->connect(address.substr(0, slash)).value();
    return viewer;
  }

  void look() {
    TransportEvent event;
    while (transport_->poll(0, event)) {
      if (event.kind == TransportEventKind::connected) say(token_);
      if (event.kind == TransportEventKind::disconnected) gone = true;
      if (event.kind == TransportEventKind::received) take(event.bytes);
    }
    transport_->flush();
  }

  void say(const std::string& text) {
    EXPECT_EQ(transport_->send(connection_, Channel::reliable, bytes_of_text(text)), Status::ok);
  }

  std::vector<std::vector<std::byte>> messages;
  bool gone = false;

 private:
  void take(ByteView packet) {
    if (!open_) messages.emplace_back();
    messages.back().insert(messages.back().end(), packet.begin() + 1, packet.end());
    open_ = packet.front() == static_cast<std::byte>(ViewPart::more);
  }

  std::unique_ptr<WebSocketTransport> transport_;
  ConnectionId connection_ = k_no_connection;
  std::string token_;
  bool open_ = false;
};

/// Plays a world until something holds.
template <class Condition>
void play(World& world, WorldServer& server, Viewer& viewer, Condition until) {
  lockstone::test::await([&] {
    world.step();
    server.update(world, static_cast<std::int64_t>(world.tick()) * 20'000);
    viewer.look();
    return until();
  });
}

bool is_state(const std::vector<std::byte>& message) {
  return message.front() == static_cast<std::byte>(ViewMessage::state);
}

TEST(WorldServer, AViewerHasTheGamesStates) {
  World world = shown_world();
  const auto server = std::move(WorldServer::open()).value();
  Viewer viewer = Viewer::of(server->address());
  play(world, *server, viewer, [&] { return viewer.messages.size() >= 4; });
  EXPECT_EQ(server->viewers(), 1U);
  Result<World> seen = described_world(viewer.messages.front());
  ASSERT_TRUE(seen.ok());
  EXPECT_EQ(seen.value().def(), world.def());
  EXPECT_EQ(seen.value().assets()->hash(), world.assets()->hash());
  World again = shown_world();
  std::uint64_t tick = 0;
  for (std::size_t i = 1; i < viewer.messages.size(); ++i) {
    ASSERT_TRUE(is_state(viewer.messages[i]));
    const ByteView state = ByteView(viewer.messages[i]).subspan(1);
    ASSERT_EQ(seen.value().load(SnapshotKind::canonical, state), Status::ok);
    EXPECT_GT(seen.value().tick(), std::exchange(tick, seen.value().tick()));
    while (again.tick() < tick)
      again.step();
    EXPECT_EQ(seen.value().hash().total, again.hash().total);
  }
}

TEST(WorldServer, AStateOfManyPacketsArrivesWhole) {
  World world = shown_world(1000);
  ASSERT_GT(world.snapshot_bytes_max(SnapshotKind::canonical), 4 * k_max_reliable_bytes);
  const auto server = std::move(WorldServer::open()).value();
  Viewer viewer = Viewer::of(server->address());
  play(world, *server, viewer, [&] { return viewer.messages.size() >= 4; });
  Result<World> seen = described_world(viewer.messages.front());
  ASSERT_TRUE(seen.ok());
  EXPECT_EQ(seen.value().load(SnapshotKind::canonical, ByteView(viewer.messages[2]).subspan(1)),
            Status::ok);
}

TEST(WorldServer, AWrongTokenSeesNothing) {
  World world = shown_world();
  const auto server = std::move(WorldServer::open()).value();
  Viewer viewer = Viewer::of(server->address(), std::string(32, '0'));
  play(world, *server, viewer, [&] { return viewer.gone; });
  EXPECT_TRUE(viewer.messages.empty());
  EXPECT_EQ(server->viewers(), 0U);
}

TEST(WorldServer, AViewerChangesNothing) {
  World world = shown_world(), alone = shown_world();
  const auto server = std::move(WorldServer::open()).value();
  Viewer viewer = Viewer::of(server->address());
  play(world, *server, viewer, [&] { return server->viewers() == 1; });
  viewer.say("anything");
  play(world, *server, viewer, [&] { return viewer.messages.size() >= 5; });
  while (alone.tick() < world.tick())
    alone.step();
  EXPECT_EQ(world.hash().total, alone.hash().total);
}

TEST(WorldServer, ADescriptionThatIsCutOrForeignIsRefused) {
  const World world = shown_world();
  const std::vector<std::byte> whole = describe_world(world);
  EXPECT_TRUE(described_world(whole).ok());
  // A description without assets is whole at the end of its definition.
  const std::size_t definition =
      whole.size() - 4 - world.assets()->all().front()->canonical_bytes().size();
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_EQ(described_world(ByteView(whole).first(size)).ok(), size == definition) << size;
  std::vector<std::byte> foreign = whole;
  foreign[1] ^= std::byte{1};
  EXPECT_EQ(described_world(foreign).status(), Status::incompatible);
}

}  // namespace
}  // namespace lockstone::watch::test
