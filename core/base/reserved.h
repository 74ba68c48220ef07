// A test for asserts: that a vector does not allocate while the world steps.
#pragma once

#include <cstddef>
#include <vector>

namespace lockstone {

/// Whether a vector can hold this many elements where it is. For asserts only: no result may depend
/// on it.
template <class T>
[[nodiscard]] bool is_reserved(const std::vector<T>& vector, std::size_t count) {
  return count <= vector.capacity();
}

}  // namespace lockstone
