// A client's commands: its own on their way to the server, and those of ticks, which come back.
#pragma once

#include <cstddef>
#include <cstdint>

#include <lockstone/bytes.h>

#include "net/session/client/client_data.h"

namespace lockstone::net {

/// Keeps own commands until the server has them whole, also over a new connection. Messages return
/// false for a packet that breaks the format or comes out of turn.
class ClientCommands {
 public:
  explicit ClientCommands(ClientData& data) : data_(data) {}

  /// Takes the memory for own commands.
  void reserve();

  /// The client is seated; the server has had `taken` commands of this seat, and those that it has
  /// not had are sent again.
  void begin(std::uint64_t taken);

  [[nodiscard]] Result<std::uint64_t> give(ByteView bytes);
  void send_pieces();

  [[nodiscard]] bool on_result(ByteView packet);
  [[nodiscard]] bool on_tick_command(ByteView packet);

 private:
  ClientData& data_;
  CommandBuffer own_;
  std::uint64_t settled_ = 0;   ///< the number of the first command in `own_`, among the seat's
  std::uint64_t sending_ = 0;   ///< its number in `own_`
  std::size_t sent_ = 0;        ///< bytes of it
  bool front_settled_ = false;  ///< the first is refused, and still being sent
};

}  // namespace lockstone::net
