// Takes the server's packets of confirmed ticks.
#pragma once

#include <lockstone/bytes.h>

#include "net/session/client/client_data.h"

namespace lockstone::net {

/// Stores the ticks, notes the acknowledgements that come with them, and asks for missing ticks.
class TickReceiver {
 public:
  explicit TickReceiver(ClientData& data) : data_(data) {}

  /// False for a packet that breaks the format or comes out of turn; then it had no effect.
  [[nodiscard]] bool on_ticks(ByteView packet);

  /// Asks for the ticks that lack between others, if that is due.
  void request_missing();

 private:
  void take_acknowledgements(const Ticks& message);
  void take_records(const Ticks& message);

  ClientData& data_;
};

}  // namespace lockstone::net
