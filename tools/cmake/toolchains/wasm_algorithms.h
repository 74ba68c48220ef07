// The algorithms on ranges that the standard library of older Emscriptens lacks (libc++ before 15),
// as far as the project uses them. Included before each file by the toolchain; plain loops over the
// iterator forms.
#pragma once

#if defined(__cplusplus) && __cplusplus > 201703L
#include <version>
#if defined(_LIBCPP_VERSION) && _LIBCPP_VERSION < 15000

#include <algorithm>
#include <functional>
#include <iterator>
#include <utility>

// NOLINTBEGIN(cert-dcl58-cpp): this is the library's part.
namespace std::ranges {

template <class Range, class Test, class Projection = identity>
constexpr auto find_if(Range&& range, Test test, Projection project = {}) {
  return std::find_if(std::begin(range), std::end(range), [&](auto&& x) {
    return static_cast<bool>(std::invoke(test, std::invoke(project, x)));
  });
}

template <class Range, class Value, class Projection = identity>
constexpr auto find(Range&& range, const Value& value, Projection project = {}) {
  return ranges::find_if(
      range, [&](const auto& x) { return x == value; }, project);
}

template <class Range, class Test, class Projection = identity>
constexpr bool any_of(Range&& range, Test test, Projection project = {}) {
  return ranges::find_if(range, test, project) != std::end(range);
}

template <class Range, class Test, class Projection = identity>
constexpr bool none_of(Range&& range, Test test, Projection project = {}) {
  return !ranges::any_of(range, test, project);
}

template <class Range, class Test, class Projection = identity>
constexpr bool all_of(Range&& range, Test test, Projection project = {}) {
  const auto fails = [&](auto&& x) { return !std::invoke(test, x); };
  return !ranges::any_of(range, fails, project);
}

template <class Range, class Test, class Projection = identity>
constexpr auto count_if(Range&& range, Test test, Projection project = {}) {
  return std::count_if(std::begin(range), std::end(range), [&](auto&& x) {
    return static_cast<bool>(std::invoke(test, std::invoke(project, x)));
  });
}

template <class Range, class Value>
constexpr auto count(Range&& range, const Value& value) {
  return std::count(std::begin(range), std::end(range), value);
}

namespace shim {

// An order of elements from an order of their projections.
template <class Less, class Projection>
constexpr auto order_of(Less& less, Projection& project) {
  return [&](auto&& a, auto&& b) {
    return static_cast<bool>(std::invoke(less, std::invoke(project, a), std::invoke(project, b)));
  };
}

}  // namespace shim

template <class Range, class Less = less, class Projection = identity>
constexpr auto sort(Range&& range, Less less = {}, Projection project = {}) {
  std::sort(std::begin(range), std::end(range), shim::order_of(less, project));
  return std::end(range);
}

template <class Range, class Less = less, class Projection = identity>
constexpr bool is_sorted(Range&& range, Less less = {}, Projection project = {}) {
  return std::is_sorted(std::begin(range), std::end(range), shim::order_of(less, project));
}

template <class Range, class Less = less, class Projection = identity>
constexpr auto min_element(Range&& range, Less less = {}, Projection project = {}) {
  return std::min_element(std::begin(range), std::end(range), shim::order_of(less, project));
}

template <class Range, class Less = less, class Projection = identity>
constexpr auto max_element(Range&& range, Less less = {}, Projection project = {}) {
  return std::max_element(std::begin(range), std::end(range), shim::order_of(less, project));
}

template <class Iterator>
struct min_max_result {
  Iterator min, max;
};

// The first of the least, the last of the greatest.
template <class Range, class Less = less, class Projection = identity>
constexpr auto minmax_element(Range&& range, Less less = {}, Projection project = {}) {
  const auto found =
      std::minmax_element(std::begin(range), std::end(range), shim::order_of(less, project));
  return min_max_result<std::decay_t<decltype(found.first)>>{found.first, found.second};
}

template <class Range, class Value, class Less = less, class Projection = identity>
constexpr auto lower_bound(Range&& range, const Value& value, Less less = {},
                           Projection project = {}) {
  return std::lower_bound(std::begin(range), std::end(range), value, [&](auto&& x, const Value& v) {
    return static_cast<bool>(std::invoke(less, std::invoke(project, x), v));
  });
}

template <class Range, class Value, class Less = less, class Projection = identity>
constexpr bool binary_search(Range&& range, const Value& value, Less less = {},
                             Projection project = {}) {
  const auto found = ranges::lower_bound(range, value, less, project);
  return found != std::end(range) &&
         !static_cast<bool>(std::invoke(less, value, std::invoke(project, *found)));
}

template <class Iterator, class Out>
struct copy_result {
  Iterator in;
  Out out;
};

template <class Range, class Out>
constexpr auto copy(Range&& range, Out out) {
  const auto end = std::end(range);
  return copy_result<std::decay_t<decltype(end)>, Out>{end, std::copy(std::begin(range), end, out)};
}

template <class Range, class Value>
constexpr void fill(Range&& range, const Value& value) {
  std::fill(std::begin(range), std::end(range), value);
}

template <class A, class B>
constexpr bool equal(const A& a, const B& b) {
  return std::equal(std::begin(a), std::end(a), std::begin(b), std::end(b));
}

template <class A, class B>
constexpr bool lexicographical_compare(const A& a, const B& b) {
  return std::lexicographical_compare(std::begin(a), std::end(a), std::begin(b), std::end(b));
}

template <class Range, class Out, class Function>
constexpr auto transform(Range&& range, Out out, Function function) {
  return std::transform(std::begin(range), std::end(range), out, function);
}

}  // namespace std::ranges
// NOLINTEND(cert-dcl58-cpp)

#endif
#endif
