// How a client's match ends: it is over, refused, lost, or given up.
#pragma once

#include <lockstone/bytes.h>

#include "net/session/client/client_data.h"
#include "net/session/client/playback.h"

namespace lockstone::net {

/// Sets the final state with its reason, and closes the connection. Messages return false for a
/// packet that breaks the format or comes out of turn.
class ClientEnd {
 public:
  ClientEnd(ClientData& data, Playback& playback) : data_(data), playback_(playback) {}

  void fail(ClientFailure why);
  /// The game's owner leaves.
  void leave();
  /// Too many packets of the server break the format.
  void leave_malformed_server();

  /// The transport has ended the connection.
  void connection_ended(RefuseReason reason);

  [[nodiscard]] bool on_refuse(ByteView packet);
  [[nodiscard]] bool on_finish(ByteView packet);
  [[nodiscard]] bool on_bye(ByteView packet);

 private:
  void hang_up(ClientState final_state, LeaveReason reason);

  ClientData& data_;
  Playback& playback_;
};

/// Whether a client that has ended may go on over a new connection.
[[nodiscard]] bool may_reconnect(const ClientStatus& status);

}  // namespace lockstone::net
