// Messages that wait for a WebSocket to take them.
#pragma once

#include <algorithm>
#include <cstddef>
#include <deque>
#include <vector>

#include <lockstone/bytes.h>
#include <lockstone/net/transport.h>

#include "net/transport/websocket/packet_message.h"

namespace lockstone::net {

/// In order of sending. Unreliable packets carry all that their receiver lacks, so that the newest
/// are worth most: of more than a few that wait, the oldest is dropped.
class OutgoingMessages {
 public:
  static constexpr std::size_t k_max_unreliable = 16;

  /// `margin` bytes are free in front of each message.
  explicit OutgoingMessages(std::size_t margin = 0) : margin_(margin) {}

  struct Message {
    Channel channel = Channel::reliable;
    std::vector<std::byte> bytes;  ///< the margin, then the message
  };

  /// Returns how many unreliable ones were dropped for it: 0 or 1.
  std::size_t add(Channel channel, ByteView payload) {
    Message message{channel, {}};
    message.bytes.reserve(margin_ + k_message_head_bytes + payload.size());
    message.bytes.resize(margin_);
    message.bytes.push_back(static_cast<std::byte>(channel));
    message.bytes.insert(message.bytes.end(), payload.begin(), payload.end());
    waiting_bytes_ += message.bytes.size();
    messages_.push_back(std::move(message));
    if (channel == Channel::reliable || ++unreliable_ <= k_max_unreliable) return 0;
    drop_oldest_unreliable();
    return 1;
  }

  [[nodiscard]] bool empty() const { return messages_.empty(); }
  [[nodiscard]] std::size_t count() const { return messages_.size(); }
  /// Of all that wait, margins included.
  [[nodiscard]] std::size_t waiting_bytes() const { return waiting_bytes_; }

  /// The first one; not where it is empty.
  [[nodiscard]] Message take() {
    Message message = std::move(messages_.front());
    messages_.pop_front();
    forget(message);
    return message;
  }

  void clear() { *this = OutgoingMessages(margin_); }

 private:
  void forget(const Message& message) {
    waiting_bytes_ -= message.bytes.size();
    if (message.channel == Channel::unreliable) --unreliable_;
  }

  void drop_oldest_unreliable() {
    const auto oldest = std::find_if(messages_.begin(), messages_.end(), [](const Message& one) {
      return one.channel == Channel::unreliable;
    });
    forget(*oldest);
    messages_.erase(oldest);
  }

  std::size_t margin_;
  std::size_t waiting_bytes_ = 0;
  std::size_t unreliable_ = 0;
  std::deque<Message> messages_;
};

}  // namespace lockstone::net
