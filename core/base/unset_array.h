// Room for values that begins unset, whatever initialisers their type has: of a long array that is
// used in part, the rest costs nothing.
#pragma once

#include <cstddef>
#include <type_traits>

#include <lockstone/assert.h>

namespace lockstone {

/// A place is written before it is read.
template <class T, std::size_t N>
class UnsetArray {
  static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

 public:
  // NOLINTNEXTLINE(modernize-use-equals-default): it leaves the union's member unset.
  UnsetArray() {}

  [[nodiscard]] T& operator[](std::size_t i) {
    LKS_ASSERT(i < N);
    return values_[i];
  }
  [[nodiscard]] const T& operator[](std::size_t i) const {
    LKS_ASSERT(i < N);
    return values_[i];
  }

  [[nodiscard]] T* data() { return values_; }
  [[nodiscard]] const T* data() const { return values_; }

 private:
  union {
    T values_[N];
  };
};

}  // namespace lockstone
