#include <array>

#include <lockstone/net/player_name.h>
#include <lockstone/net/session.h>

namespace lockstone::net {

std::string_view to_string(SetupError error) {
  switch (error) {
    case SetupError::none:
      return "none";
    case SetupError::insecure_not_requested:
      return "insecure not requested";
    case SetupError::insecure_on_secure_transport:
      return "insecure on a secure transport";
    case SetupError::match_config_too_long:
      return "match config too long";
    case SetupError::player_count_out_of_range:
      return "player count out of range";
    case SetupError::input_bytes_out_of_range:
      return "input bytes out of range";
    case SetupError::tick_rate_out_of_range:
      return "tick rate out of range";
    case SetupError::input_delay_out_of_range:
      return "input delay out of range";
    case SetupError::history_out_of_range:
      return "history out of range";
    case SetupError::timeouts_out_of_range:
      return "time-outs out of range";
    case SetupError::simulation_already_stepped:
      return "simulation already stepped";
    case SetupError::prediction_out_of_range:
      return "prediction out of range";
    case SetupError::spectators_out_of_range:
      return "spectators out of range";
  }
  return "unknown";
}

std::string Refusal::to_line() const {
  std::string line = "refused: " + std::string(to_string(reason));
  if (field == RefuseField::none) return line;
  line += ", " + std::string(to_string(field)) + ": ";
  return line + lockstone::hexadecimal(here) + " here, " + lockstone::hexadecimal(there) + " there";
}

std::string DesyncReport::to_line() const {
  // "player 2, player 0, score" would not say which of them has the other state.
  const bool about_players = difference.differs && difference.store == "player";
  const std::string at = "tick " + std::to_string(tick) + ", ";
  const bool about_itself = about_players && difference.object == slot;
  if (about_itself && name.empty()) return at + difference.to_line();
  const std::string line = at + (about_players ? "state of " : "") + player_text(slot, name) + ", ";
  if (difference.differs) return line + difference.to_line();
  return line + (part.empty() ? "hash" : part) + ": " + lockstone::hexadecimal(hash_here) +
         " here, " + lockstone::hexadecimal(hash_there) + " there";
}

}  // namespace lockstone::net
