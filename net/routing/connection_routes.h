// Which match a connection belongs to.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include <lockstone/net/transport.h>

namespace lockstone::net {

/// A small table, searched for every packet: ids stand close together. Allocates when made only.
class ConnectionRoutes {
 public:
  static constexpr std::size_t k_none = static_cast<std::size_t>(-1);

  explicit ConnectionRoutes(std::size_t capacity) : capacity_(capacity) {
    ids_.reserve(capacity);
    places_.reserve(capacity);
  }

  [[nodiscard]] bool full() const { return ids_.size() == capacity_; }

  /// `k_none` for an unknown connection.
  [[nodiscard]] std::size_t find(ConnectionId connection) const {
    const std::size_t index = index_of(connection);
    return index == k_none ? k_none : places_[index];
  }

  /// Some connection of the place, or k_no_connection.
  [[nodiscard]] ConnectionId first_of(std::size_t place) const {
    const auto found = std::find(places_.begin(), places_.end(), place);
    return found == places_.end() ? k_no_connection
                                  : ids_[static_cast<std::size_t>(found - places_.begin())];
  }

  /// Not for a known connection, nor where it is full.
  void add(ConnectionId connection, std::size_t place) {
    ids_.push_back(connection);
    places_.push_back(place);
  }

  void remove(ConnectionId connection) {
    const std::size_t index = index_of(connection);
    if (index == k_none) return;
    ids_[index] = ids_.back();
    places_[index] = places_.back();
    ids_.pop_back();
    places_.pop_back();
  }

 private:
  [[nodiscard]] std::size_t index_of(ConnectionId connection) const {
    const auto found = std::find(ids_.begin(), ids_.end(), connection);
    return found == ids_.end() ? k_none : static_cast<std::size_t>(found - ids_.begin());
  }

  std::size_t capacity_;
  std::vector<ConnectionId> ids_;
  std::vector<std::size_t> places_;  ///< in the order of the ids
};

}  // namespace lockstone::net
