#include <CLI/App.hpp>

#include "tools/lockstone/commands.h"
#include "tools/lockstone/match/web_players.h"
#include "tools/lockstone/support/console.h"

namespace lockstone::tool {

int check_web(const WebPlayers& web) {
  if (web.certificate_file.empty() != web.key_file.empty()) {
    complain("give --ws-cert FILE and --ws-key FILE together");
    return k_usage;
  }
  if (web.port || (web.origins.empty() && web.key_file.empty())) return k_ok;
  complain("--ws-cert, --ws-key and --ws-origin need --ws PORT");
  return k_usage;
}

void add_web_options(CLI::App& command, WebPlayers& web) {
  command.add_option("--ws", web.port,
                     "TCP port for WebSockets, for players in browsers; 0: the system chooses; "
                     "default: none");
  command.add_option("--ws-cert", web.certificate_file,
                     "File (PEM) with the certificate and its chain, for wss://");
  command.add_option("--ws-key", web.key_file, "File (PEM) with the certificate's key");
  command.add_option("--ws-origin", web.origins,
                     "Take only pages of this origin, like https://game.example; may be repeated");
}

}  // namespace lockstone::tool
