// Which contacts each body has.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <lockstone/assert.h>

namespace lockstone {

/// By body the numbers of its links, ascending. A link has two ends `a` and `b`; end 0 is nobody.
class BodyLinks {
 public:
  /// No function but this allocates.
  BodyLinks(std::size_t body_capacity, std::size_t link_capacity) {
    first_.reserve(body_capacity + 2);
    links_.reserve(2 * link_capacity);
  }

  template <class Link>
  void assign(std::span<const Link> links, std::size_t body_count) {
    first_.assign(body_count + 1, 0);
    for (const Link& link : links)
      for (const std::uint32_t body : {link.a, link.b})
        first_[body] += body == 0 ? 0 : 1;
    std::uint32_t total = 0;
    for (std::uint32_t& first : first_) {
      const std::uint32_t count = first;
      first = total;
      total += count;
    }
    links_.assign(total, 0);
    for (std::uint32_t i = 0; i < links.size(); ++i)
      for (const std::uint32_t body : {links[i].a, links[i].b})
        if (body != 0) links_[first_[body]++] = i;
    for (std::size_t body = body_count; body > 0; --body)
      first_[body] = first_[body - 1];
    first_[0] = 0;
    LKS_ASSERT(first_[body_count] == total);
  }

  [[nodiscard]] std::span<const std::uint32_t> at(std::uint32_t body) const {
    return std::span(links_).subspan(first_[body], first_[body + 1] - first_[body]);
  }

 private:
  std::vector<std::uint32_t> first_;  // by body: in links_
  std::vector<std::uint32_t> links_;
};

}  // namespace lockstone
