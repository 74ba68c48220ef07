#include "tools/lockstone/bench/hosting/hosting_bots.h"

#include <array>
#include <utility>

#include <lockstone/hash.h>

#include "tools/lockstone/match/secrets.h"

namespace lockstone::tool {

void BotLine::push(const net::TransportEvent& event) {
  waiting_.push_back({event, {event.bytes.begin(), event.bytes.end()}});
}

bool BotLine::poll(std::int64_t, net::TransportEvent& event) {
  if (waiting_.empty()) return false;
  current_ = std::move(waiting_.front());
  waiting_.pop_front();
  event = current_.event;
  event.bytes = current_.bytes;
  return true;
}

void BotInputs::sample(std::uint64_t tick, std::span<std::byte> out) {
  constexpr std::uint64_t k_held_ticks = 10;
  const std::array<std::uint64_t, 2> drawn{seed_, tick / k_held_ticks};
  std::uint64_t bits = hash64(std::as_bytes(std::span(drawn)));
  for (std::byte& byte : out) {
    byte = static_cast<std::byte>(bits & 0xff);
    bits = bits >> 8 | bits << 56;
  }
}

std::unique_ptr<BotTeam> BotTeam::call(std::uint16_t port, const net::Key& key, std::uint64_t match,
                                       unsigned bots, const HashBoards& boards) {
  auto team = std::make_unique<BotTeam>();
  net::EnetOptions options;
  options.max_connections = bots;
  options.link_key = net::make_link_key(key, match);
  options.match_tag = net::make_match_tag(match);
  auto opened = net::EnetTransport::open(options);
  if (!opened) return nullptr;
  team->socket_ = std::move(opened).value();
  for (unsigned slot = 0; slot < bots; ++slot) {
    net::TokenGrant grant;
    grant.match = match;
    grant.player = match * 256 + slot;
    grant.slot = static_cast<std::uint8_t>(slot);
    grant.expires_unix_s = unix_seconds() + 600;
    const auto token = net::issue_token(key, grant, team->random_);
    if (!token || !team->add(port, token.value(), boards)) return nullptr;
  }
  return team;
}

bool BotTeam::add(std::uint16_t port, const net::ConnectToken& token, const HashBoards& boards) {
  const Result<net::ConnectionId> connection = socket_->connect("127.0.0.1", port);
  if (!connection) return false;
  Bot bot;
  bot.line = std::make_unique<BotLine>(*socket_, connection.value());
  auto secure = net::SecureTransport::join(*bot.line, token, random_);
  if (!secure) return false;
  bot.secure = std::move(secure).value();
  bot.inputs = std::make_unique<BotInputs>(token.grant.player);
  net::ClientConfig config;
  config.wanted_slot = token.grant.slot;
  config.snapshot_ticks = 0;
  net::ClientParts parts;
  parts.transport = bot.secure.get();
  parts.connection = connection.value();
  parts.inputs = bot.inputs.get();
  parts.factory = [&boards](ByteView bytes) -> Result<std::unique_ptr<Simulation>> {
    std::shared_ptr<HashBoard> board = boards.find(bytes);
    if (board == nullptr) return Status::not_found;
    return std::unique_ptr<Simulation>(std::make_unique<EchoSimulation>(std::move(board)));
  };
  bot.client = std::move(net::Client::create(config, std::move(parts)).client);
  bots_.push_back(std::move(bot));
  return bots_.back().client != nullptr;
}

void BotTeam::update(std::int64_t now_us) {
  net::TransportEvent event;
  while (socket_->poll(now_us, event)) {
    for (Bot& bot : bots_) {
      if (bot.line->connection() == event.connection) bot.line->push(event);
    }
  }
  for (Bot& bot : bots_)
    bot.client->update(now_us);
  socket_->flush();
}

}  // namespace lockstone::tool
