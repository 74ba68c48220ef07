// token key, token issue, token show: the work of a game's backend, for tests and small games.
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "net/security/token_seal.h"
#include "tools/lockstone/commands.h"
#include "tools/lockstone/match/secrets.h"
#include "tools/lockstone/match/servers.h"
#include "tools/lockstone/support/console.h"
#include "tools/tool/tool_command.h"

namespace lockstone::tool {
namespace {

struct IssueOptions {
  std::string key;
  std::uint64_t match = 0;
  std::uint64_t player = 0;
  std::string slot = "0";
  std::uint64_t minutes = 10;
  std::vector<std::string> servers;
  std::string out;
};

struct ShowOptions {
  std::string token;
  std::string key;
};

int make_backend_key(const std::string& path) {
  if (!require_security()) return k_unavailable;
  net::SystemRandom random;
  const bool written = write_secret_file(path, net::make_key(random).to_text() + "\n");
  return written ? k_ok : k_unavailable;
}

std::string slot_text(std::uint8_t slot) {
  return slot == net::k_spectator_slot ? "spectator" : std::to_string(slot);
}

int issue(const IssueOptions& options) {
  if (!require_security()) return k_unavailable;
  const std::optional<net::Key> key = read_key(options.key);
  if (!key) return k_corrupt;
  net::TokenGrant grant;
  grant.match = options.match;
  grant.player = options.player;
  grant.slot = options.slot == "spectator" ? net::k_spectator_slot
                                           : static_cast<std::uint8_t>(std::stoul(options.slot));
  grant.expires_unix_s = unix_seconds() + 60 * options.minutes;
  if (!add_servers(options.servers, grant.servers)) return k_usage;
  net::SystemRandom random;
  const Result<net::ConnectToken> token = net::issue_token(*key, grant, random);
  if (!token) {
    complain(fmt::format("no token: {}", to_string(token.status())));
    return k_usage;
  }
  const std::string text = token.value().to_text() + "\n";
  if (options.out.empty()) {
    fmt::print("{}", text);
    return k_ok;
  }
  return write_secret_file(options.out, text) ? k_ok : k_unavailable;
}

// Whether a server with this key would open it.
bool opens_under(const net::ConnectToken& token, const net::Key& key) {
  net::SealedGrant opened;
  const net::ShownToken shown{token.grant.match, token.grant.expires_unix_s, token.nonce,
                              token.sealed};
  return open_sealed(key, shown, opened) == Status::ok && opened.grant == token.grant &&
         opened.client_key == token.client_key && opened.server_key == token.server_key &&
         token.link_key == net::make_link_key(key, token.grant.match);
}

int show(const ShowOptions& options) {
  const std::optional<net::ConnectToken> token = read_token(options.token);
  if (!token) return k_corrupt;
  const net::TokenGrant& grant = token->grant;
  const std::uint64_t now = unix_seconds();
  fmt::print("match    {}\nplayer   {}\nslot     {}\n", grant.match, grant.player,
             slot_text(grant.slot));
  fmt::print("expires  {}, {}\n", grant.expires_unix_s,
             grant.expires_unix_s > now ? fmt::format("in {} s", grant.expires_unix_s - now)
                                        : fmt::format("{} s ago", now - grant.expires_unix_s));
  for (std::size_t i = 0; i < grant.servers.count; ++i)
    fmt::print("server   {}\n", grant.servers.entries[i].to_text());
  if (options.key.empty()) return k_ok;
  if (!require_security()) return k_unavailable;
  const std::optional<net::Key> key = read_key(options.key);
  if (!key) return k_corrupt;
  const bool opens = opens_under(*token, *key);
  fmt::print("seal     {}\n", opens ? "good" : "not of this key, or altered");
  return opens ? k_ok : k_different;
}

void add_issue_command(CLI::App& parent, Tool& tool) {
  auto options = std::make_shared<IssueOptions>();
  CLI::App* command = parent.add_subcommand("issue", "Make a token for one seat of one match");
  command->add_option("--key", options->key, "File with the backend's key")->required();
  command->add_option("--match", options->match, "Number of the match")->required();
  command->add_option("--player", options->player, "The backend's number for the player")
      ->capture_default_str();
  command->add_option("--slot", options->slot, "0 to 63, or spectator")
      ->check(CLI::Range(std::size_t{0}, k_max_players - 1) | CLI::IsMember({"spectator"}))
      ->capture_default_str();
  command->add_option("--minutes", options->minutes, "Until it expires")
      ->check(CLI::Range(0, 1'000'000))
      ->capture_default_str();
  command->add_option("--server", options->servers,
                      "Like 1.2.3.4:7777, [2001:db8::1]:7777 or game.example:7777, a name with all "
                      "addresses that it has now; up to 8 addresses. None: any server");
  command->add_option("--out", options->out, "Write it to this file, not to the terminal");
  command->callback([options, &tool] { tool.exit_code = issue(*options); });
}

}  // namespace

void add_token_command(CLI::App& app, Tool& tool) {
  CLI::App* command = app.add_subcommand("token", "Keys and connect tokens of encrypted matches");
  command->require_subcommand(1);
  auto path = std::make_shared<std::string>();
  CLI::App* key = command->add_subcommand("key", "Make a backend's key");
  key->add_option("file", *path, "Gets the key; servers need it too")->required();
  key->callback([path, &tool] { tool.exit_code = make_backend_key(*path); });
  add_issue_command(*command, tool);
  auto options = std::make_shared<ShowOptions>();
  CLI::App* show_command = command->add_subcommand("show", "Print the rights that a token grants");
  show_command->add_option("token", options->token, "File with a token")->required();
  show_command->add_option("--key", options->key, "Check its seal with the backend's key");
  show_command->callback([options, &tool] { tool.exit_code = show(*options); });
}

}  // namespace lockstone::tool
