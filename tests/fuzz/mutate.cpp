#include "tests/fuzz/mutate.h"

#include <algorithm>

namespace lockstone::fuzz {
namespace {

std::size_t below(test::Random& random, std::size_t limit) {
  return static_cast<std::size_t>(random.next() % limit);
}

struct Range {
  std::size_t begin = 0;
  std::size_t bytes = 0;
};

// Mostly short, at times all that there is.
Range any_range(std::size_t size, test::Random& random) {
  if (size == 0) return {};
  const std::size_t begin = below(random, size);
  const std::size_t most = random.next() % 4 == 0 ? size - begin : std::min<std::size_t>(16, size);
  return {begin, std::min(size - begin, 1 + below(random, most))};
}

auto at(Bytes& bytes, std::size_t index) {
  return bytes.begin() + static_cast<std::ptrdiff_t>(index);
}

void flip_bit(Bytes& bytes, test::Random& random) {
  bytes[below(random, bytes.size())] ^= static_cast<std::byte>(1U << below(random, 8));
}

// Little-endian, of 1, 2, 4 or 8 bytes: a bound, or a neighbour of one, or a small number.
void put_extreme(Bytes& bytes, test::Random& random) {
  constexpr std::uint64_t k_values[] = {0,
                                        1,
                                        ~std::uint64_t{0},
                                        std::uint64_t{1} << 63,
                                        (std::uint64_t{1} << 63) - 1,
                                        0x8000000080000000U,
                                        0x7fffffff7fffffffU,
                                        0x00ff00ff00ff00ffU};
  std::uint64_t value = k_values[below(random, std::size(k_values))];
  if (random.next() % 3 == 0) value += random.next() % 64 - 32;
  const std::size_t width = std::size_t{1} << below(random, 4);
  const std::size_t place = below(random, bytes.size()) / width * width;
  for (std::size_t i = 0; i < width && place + i < bytes.size(); ++i)
    bytes[place + i] = static_cast<std::byte>(value >> (8 * i) & 0xff);
}

void cut(Bytes& bytes, test::Random& random) {
  const Range range = any_range(bytes.size(), random);
  bytes.erase(at(bytes, range.begin), at(bytes, range.begin + range.bytes));
}

void truncate(Bytes& bytes, test::Random& random) {
  bytes.resize(below(random, bytes.size() + 1));
}

void insert(Bytes& bytes, std::span<const std::byte> part, std::size_t place) {
  if (bytes.size() + part.size() > k_max_bytes) return;
  bytes.insert(at(bytes, place), part.begin(), part.end());
}

void repeat(Bytes& bytes, test::Random& random) {
  const Range range = any_range(bytes.size(), random);
  const Bytes part(at(bytes, range.begin), at(bytes, range.begin + range.bytes));
  insert(bytes, part, below(random, bytes.size() + 1));
}

// Overwrites bytes, or inserts between them.
void take_from(std::span<const std::byte> other, Bytes& bytes, test::Random& random) {
  const Range range = any_range(other.size(), random);
  const std::span<const std::byte> part = other.subspan(range.begin, range.bytes);
  const std::size_t place = random.next() % 2 == 0 ? std::min(range.begin, bytes.size())
                                                   : below(random, bytes.size() + 1);
  if (random.next() % 2 == 0) return insert(bytes, part, place);
  const std::size_t count = std::min(part.size(), bytes.size() - place);
  std::copy_n(part.begin(), count, at(bytes, place));
}

void change(Bytes& bytes, std::span<const std::byte> other, test::Random& random) {
  switch (random.next() % 12) {
    case 0:
      return cut(bytes, random);
    case 1:
      return repeat(bytes, random);
    case 2:
      return truncate(bytes, random);
    case 3:
      return take_from(other, bytes, random);
    case 4:
    case 5:
      return put_extreme(bytes, random);
    case 6:
    case 7:
      bytes[below(random, bytes.size())] = static_cast<std::byte>(random.next() & 0xff);
      return;
    default:
      return flip_bit(bytes, random);
  }
}

}  // namespace

void mutate(Bytes& bytes, std::span<const std::byte> other, test::Random& random) {
  const std::size_t count = 1 + below(random, 8);
  for (std::size_t i = 0; i < count; ++i) {
    if (bytes.empty()) bytes.assign(1 + below(random, 64), std::byte{0});
    change(bytes, other, random);
  }
}

}  // namespace lockstone::fuzz
