// The bodies that joints connect to each body: a list a body, ordered by joint. A change costs no
// more than the lists of its two bodies are long.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/dynamics/state/joint_record.h"

namespace lockstone {

class JointNeighbours {
  static constexpr std::uint32_t k_none = 0xffffffff;

  // A joint's two bodies, and the next joint of each.
  struct Entry {
    std::uint32_t body[2] = {k_none, k_none};
    std::uint32_t next[2] = {k_none, k_none};

    [[nodiscard]] std::size_t end_of(std::uint32_t of) const { return body[0] == of ? 0 : 1; }
  };

 public:
  /// No function but this allocates.
  JointNeighbours(std::uint32_t body_capacity, std::uint32_t joint_capacity)
      : lists_(body_capacity), entries_(joint_capacity) {}

  /// Leaves none; `links` are those that are there.
  void clear(std::span<const JointLink> links);

  /// A joint of two different bodies, which is not there yet.
  void add(const JointLink& link);
  /// One that is there.
  void remove(const JointLink& link);

  /// The bodies that joints connect to one body, in the order of the joints, but for those with a
  /// mark.
  class Range {
   public:
    class Iterator {
     public:
      Iterator(const Range& range, std::uint32_t joint) : range_(&range), joint_(joint) { skip(); }
      std::uint32_t operator*() const { return other(); }
      Iterator& operator++() {
        joint_ = next();
        skip();
        return *this;
      }
      bool operator==(const Iterator& that) const { return joint_ == that.joint_; }

     private:
      [[nodiscard]] const Entry& entry() const { return range_->entries_[joint_]; }
      [[nodiscard]] std::uint32_t next() const {
        return entry().next[entry().end_of(range_->body_)];
      }
      [[nodiscard]] std::uint32_t other() const {
        return entry().body[1 - entry().end_of(range_->body_)];
      }
      void skip() {
        while (joint_ != k_none && range_->marks_[other()] != 0)
          joint_ = next();
      }

      const Range* range_;
      std::uint32_t joint_;
    };

    [[nodiscard]] Iterator begin() const { return {*this, first_}; }
    [[nodiscard]] Iterator end() const { return {*this, k_none}; }
    [[nodiscard]] bool empty() const { return begin() == end(); }
    [[nodiscard]] bool has_one() const { return !empty() && ++begin() == end(); }

   private:
    friend class JointNeighbours;
    Range(std::span<const Entry> entries, std::span<const std::uint8_t> marks, std::uint32_t body,
          std::uint32_t first)
        : entries_(entries), marks_(marks), body_(body), first_(first) {}

    std::span<const Entry> entries_;
    std::span<const std::uint8_t> marks_;
    std::uint32_t body_, first_;
  };

  /// `marks`, by body: those left out; a marked body has no neighbours.
  [[nodiscard]] Range of(std::uint32_t body, std::span<const std::uint8_t> marks) const {
    return {entries_, marks, body, marks[body] != 0 ? k_none : lists_[body].first};
  }

 private:
  struct List {
    std::uint32_t first = k_none;
    std::uint32_t last = k_none;
  };

  void insert(std::uint32_t joint, std::size_t end);
  void erase(std::uint32_t joint, std::size_t end);
  /// Where the number of the joint that follows `before` in the body's list stands.
  [[nodiscard]] std::uint32_t& follower(std::uint32_t body, std::uint32_t before);
  /// The last joint of the body's list below `joint`; none is k_none.
  [[nodiscard]] std::uint32_t before(std::uint32_t body, std::uint32_t joint) const;

  std::vector<List> lists_;     // by body
  std::vector<Entry> entries_;  // by joint
};

}  // namespace lockstone
