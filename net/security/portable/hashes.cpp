#include "net/security/portable/hashes.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>

namespace lockstone::net::portable {
namespace {

constexpr std::size_t k_blake_block_bytes = 128;

constexpr std::array<std::uint64_t, 8> k_start{
    0x6a09e667f3bcc908, 0xbb67ae8584caa73b, 0x3c6ef372fe94f82b, 0xa54ff53a5f1d36f1,
    0x510e527fade682d1, 0x9b05688c2b3e6c1f, 0x1f83d9abfb41bd6b, 0x5be0cd19137e2179};

// The order of the words in each of ten rounds; the last two rounds take the first two again.
constexpr std::array<std::array<std::uint8_t, 16>, 10> k_orders{{
    {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15},
    {14, 10, 4, 8, 9, 15, 13, 6, 1, 12, 0, 2, 11, 7, 5, 3},
    {11, 8, 12, 0, 5, 2, 15, 13, 10, 14, 3, 6, 7, 1, 9, 4},
    {7, 9, 3, 1, 13, 12, 11, 14, 2, 6, 5, 10, 4, 0, 15, 8},
    {9, 0, 5, 7, 2, 4, 10, 15, 14, 1, 11, 12, 6, 8, 3, 13},
    {2, 12, 6, 10, 0, 11, 8, 3, 4, 13, 7, 5, 15, 14, 1, 9},
    {12, 5, 1, 15, 14, 13, 4, 10, 0, 7, 6, 3, 9, 2, 8, 11},
    {13, 11, 7, 14, 12, 1, 3, 9, 5, 0, 15, 4, 8, 6, 2, 10},
    {6, 15, 14, 9, 11, 3, 0, 8, 12, 2, 13, 7, 1, 4, 10, 5},
    {10, 2, 8, 4, 7, 6, 1, 5, 15, 11, 9, 14, 3, 12, 13, 0},
}};

using BlakeWords = std::array<std::uint64_t, 16>;

std::uint64_t load64(ByteView bytes) {
  return ByteReader(bytes).get<std::uint64_t>();
}

class Blake2b {
 public:
  explicit Blake2b(const Key& key) : h_(k_start) {
    h_[0] ^= 0x01010000U ^ (k_key_bytes << 8) ^ k_key_bytes;
    std::array<std::byte, k_blake_block_bytes> padded{};
    std::copy(key.bytes.begin(), key.bytes.end(), padded.begin());
    add(padded);
  }

  void add(ByteView bytes) {
    for (const std::byte byte : bytes) {
      if (used_ == k_blake_block_bytes) {
        total_ += k_blake_block_bytes;
        compress(false);
        used_ = 0;
      }
      block_[used_++] = byte;
    }
  }

  [[nodiscard]] Key finish() {
    total_ += used_;
    std::fill(block_.begin() + static_cast<std::ptrdiff_t>(used_), block_.end(), std::byte{0});
    compress(true);
    Key digest;
    ByteWriter writer(digest.bytes);
    for (std::size_t i = 0; i < 4; ++i)
      writer.put(h_[i]);
    return digest;
  }

 private:
  static void mix(BlakeWords& v, std::size_t a, std::size_t column, std::uint64_t x, std::uint64_t y) {
    const std::size_t b = 4 + (a + column) % 4;
    const std::size_t c = 8 + (a + 2 * column) % 4;
    const std::size_t d = 12 + (a + 3 * column) % 4;
    v[a] += v[b] + x;
    v[d] = std::rotr(v[d] ^ v[a], 32);
    v[c] += v[d];
    v[b] = std::rotr(v[b] ^ v[c], 24);
    v[a] += v[b] + y;
    v[d] = std::rotr(v[d] ^ v[a], 16);
    v[c] += v[d];
    v[b] = std::rotr(v[b] ^ v[c], 63);
  }

  void compress(bool last) {
    BlakeWords m{}, v{};
    for (std::size_t i = 0; i < 16; ++i)
      m[i] = load64(ByteView(block_).subspan(8 * i, 8));
    std::copy(h_.begin(), h_.end(), v.begin());
    std::copy(k_start.begin(), k_start.end(), v.begin() + 8);
    v[12] ^= total_;
    if (last) v[14] = ~v[14];
    for (std::size_t round = 0; round < 12; ++round) {
      const auto& order = k_orders[round % 10];
      for (std::size_t i = 0; i < 8; ++i)
        mix(v, i % 4, i / 4, m[order[2 * i]], m[order[2 * i + 1]]);
    }
    for (std::size_t i = 0; i < 8; ++i)
      h_[i] ^= v[i] ^ v[i + 8];
  }

  std::array<std::uint64_t, 8> h_;
  std::array<std::byte, k_blake_block_bytes> block_{};
  std::size_t used_ = 0;
  std::uint64_t total_ = 0;
};

struct SipState {
  std::uint64_t a, b, c, d;

  void round() {
    a += b;
    b = std::rotl(b, 13) ^ a;
    a = std::rotl(a, 32);
    c += d;
    d = std::rotl(d, 16) ^ c;
    a += d;
    d = std::rotl(d, 21) ^ a;
    c += b;
    b = std::rotl(b, 17) ^ c;
    c = std::rotl(c, 32);
  }

  void take(std::uint64_t word) {
    d ^= word;
    round();
    round();
    a ^= word;
  }
};

}  // namespace

// Columns first, then diagonals: `mix` shifts the rows by its second index.
Key blake2b(const Key& key, std::initializer_list<ByteView> parts) {
  Blake2b hash(key);
  for (const ByteView part : parts)
    hash.add(part);
  return hash.finish();
}

std::uint64_t siphash(const LinkKey& key, ByteView bytes) {
  const std::uint64_t first = load64(ByteView(key.bytes).first(8));
  const std::uint64_t second = load64(ByteView(key.bytes).last(8));
  SipState state{first ^ 0x736f6d6570736575, second ^ 0x646f72616e646f6d,
                 first ^ 0x6c7967656e657261, second ^ 0x7465646279746573};
  const std::size_t whole = bytes.size() / 8 * 8;
  for (std::size_t at = 0; at < whole; at += 8)
    state.take(load64(bytes.subspan(at, 8)));
  std::uint64_t last = std::uint64_t{bytes.size() & 0xff} << 56;
  for (std::size_t i = whole; i < bytes.size(); ++i)
    last |= std::to_integer<std::uint64_t>(bytes[i]) << (8 * (i - whole));
  state.take(last);
  state.c ^= 0xff;
  for (int i = 0; i < 4; ++i)
    state.round();
  return state.a ^ state.b ^ state.c ^ state.d;
}

}  // namespace lockstone::net::portable
