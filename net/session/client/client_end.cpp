#include "net/session/client/client_end.h"

#include <lockstone/assert.h>

namespace lockstone::net {

void ClientEnd::fail(ClientFailure why) {
  data_.status.failure = why;
  hang_up(ClientState::failed, LeaveReason::left);
}

void ClientEnd::leave() {
  hang_up(ClientState::finished, LeaveReason::left);
}

void ClientEnd::leave_malformed_server() {
  data_.status.failure = ClientFailure::server_malformed;
  hang_up(ClientState::failed, LeaveReason::malformed);
}

void ClientEnd::hang_up(ClientState final_state, LeaveReason reason) {
  LKS_ASSERT(final_state >= ClientState::finished);
  data_.stats = current_stats(data_);
  data_.status.state = final_state;
  data_.server.send(Bye{reason});
  data_.server.disconnect();
}

void ClientEnd::connection_ended(RefuseReason reason) {
  const bool refused = reason != RefuseReason::none && !data_.place.seated;
  if (!refused) return fail(ClientFailure::connection_lost);
  data_.status.refusal = {reason, RefuseField::none, 0, 0};
  hang_up(ClientState::refused, LeaveReason::left);
}

bool ClientEnd::on_refuse(ByteView packet) {
  Refuse refuse;
  if (decode(packet, refuse) != Status::ok) return false;
  if (data_.status.state != ClientState::handshaking) return false;
  data_.status.refusal = {refuse.reason, refuse.field, refuse.here, refuse.there};
  hang_up(ClientState::refused, LeaveReason::left);
  return true;
}

bool ClientEnd::on_finish(ByteView packet) {
  Finish finish;
  if (decode(packet, finish) != Status::ok || !data_.place.seated) return false;
  const bool played =
      finish.reason == FinishReason::completed || finish.reason == FinishReason::stopped;
  data_.status.over = true;
  if (played && data_.status.state == ClientState::running) playback_.step_rest();
  data_.status.finish_reason = finish.reason;
  hang_up(ClientState::finished, LeaveReason::match_over);
  data_.observer->match_finished(finish.reason, finish.ticks);
  return true;
}

bool ClientEnd::on_bye(ByteView packet) {
  Bye bye;
  if (decode(packet, bye) != Status::ok) return false;
  data_.status.leave_reason = bye.reason;
  fail(ClientFailure::dropped);
  return true;
}

bool may_reconnect(const ClientStatus& status) {
  if (status.state == ClientState::refused) {
    return status.refusal.reason == RefuseReason::handshake_timeout;
  }
  if (status.state != ClientState::failed) return false;
  if (status.failure == ClientFailure::dropped) {
    return status.leave_reason == LeaveReason::disconnected ||
           status.leave_reason == LeaveReason::timed_out ||
           status.leave_reason == LeaveReason::too_far_behind;
  }
  return status.failure == ClientFailure::connection_lost ||
         status.failure == ClientFailure::server_silent ||
         status.failure == ClientFailure::handshake_timed_out;
}

}  // namespace lockstone::net
