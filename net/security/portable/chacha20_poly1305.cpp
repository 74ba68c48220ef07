#include "net/security/portable/chacha20_poly1305.h"

#include <algorithm>
#include <bit>
#include <cstdint>

namespace lockstone::net::portable {
namespace {

constexpr std::size_t k_chacha_block_bytes = 64;
constexpr std::size_t k_tag_bytes = 16;
constexpr std::size_t k_short_nonce_bytes = 12;
constexpr std::uint32_t k_limb_mask = 0x3ffffff;

using ChaChaWords = std::array<std::uint32_t, 16>;
using Block = std::array<std::byte, k_chacha_block_bytes>;
using Tag = std::array<std::byte, k_tag_bytes>;

std::uint32_t load32(ByteView bytes, std::size_t at) {
  std::uint32_t word = 0;
  for (std::size_t i = 4; i-- > 0;)
    word = (word << 8) | std::to_integer<std::uint32_t>(bytes[at + i]);
  return word;
}

void store32(std::span<std::byte> out, std::size_t at, std::uint32_t word) {
  for (std::size_t i = 0; i < 4; ++i, word >>= 8)
    out[at + i] = static_cast<std::byte>(word & 0xff);
}

void quarter_round(ChaChaWords& x, std::size_t a, std::size_t b, std::size_t c, std::size_t d) {
  x[a] += x[b];
  x[d] = std::rotl(x[d] ^ x[a], 16);
  x[c] += x[d];
  x[b] = std::rotl(x[b] ^ x[c], 12);
  x[a] += x[b];
  x[d] = std::rotl(x[d] ^ x[a], 8);
  x[c] += x[d];
  x[b] = std::rotl(x[b] ^ x[c], 7);
}

void mix(ChaChaWords& x) {
  for (int round = 0; round < 10; ++round) {
    for (std::size_t i = 0; i < 4; ++i)
      quarter_round(x, i, 4 + i, 8 + i, 12 + i);
    for (std::size_t i = 0; i < 4; ++i)
      quarter_round(x, i, 4 + (i + 1) % 4, 8 + (i + 2) % 4, 12 + (i + 3) % 4);
  }
}

ChaChaWords initial_words(const Key& key) {
  ChaChaWords words{0x61707865, 0x3320646e, 0x79622d32, 0x6b206574};
  for (std::size_t i = 0; i < 8; ++i)
    words[4 + i] = load32(key.bytes, 4 * i);
  return words;
}

// HChaCha20: the first and last rows, without the addition of the initial words.
Key derive_key(const Key& key, ByteView nonce) {
  ChaChaWords x = initial_words(key);
  for (std::size_t i = 0; i < 4; ++i)
    x[12 + i] = load32(nonce, 4 * i);
  mix(x);
  Key derived;
  for (std::size_t i = 0; i < 4; ++i) {
    store32(derived.bytes, 4 * i, x[i]);
    store32(derived.bytes, 16 + 4 * i, x[12 + i]);
  }
  return derived;
}

class Stream {
 public:
  Stream(const Key& key, ByteView nonce) : words_(initial_words(key)) {
    for (std::size_t i = 0; i < 3; ++i)
      words_[13 + i] = load32(nonce, 4 * i);
  }

  /// The block of this number.
  [[nodiscard]] Block block(std::uint32_t number) {
    words_[12] = number;
    ChaChaWords x = words_;
    mix(x);
    Block bytes;
    for (std::size_t i = 0; i < 16; ++i)
      store32(bytes, 4 * i, x[i] + words_[i]);
    return bytes;
  }

  /// From block 1 on: block 0 is the key of the tag.
  void apply(ByteView from, std::span<std::byte> to) {
    for (std::size_t at = 0; at < from.size(); at += k_chacha_block_bytes) {
      const Block key = block(static_cast<std::uint32_t>(at / k_chacha_block_bytes + 1));
      const std::size_t size = std::min(k_chacha_block_bytes, from.size() - at);
      for (std::size_t i = 0; i < size; ++i)
        to[at + i] = from[at + i] ^ key[i];
    }
  }

 private:
  ChaChaWords words_;
};

/// Modulo 2^130 - 5, in five limbs of 26 bits.
class Poly1305 {
 public:
  explicit Poly1305(const Block& key) : pad_{load32(key, 16), load32(key, 20), load32(key, 24), load32(key, 28)} {
    r_ = {load32(key, 0) & 0x3ffffff, (load32(key, 3) >> 2) & 0x3ffff03,
          (load32(key, 6) >> 4) & 0x3ffc0ff, (load32(key, 9) >> 6) & 0x3f03fff,
          (load32(key, 12) >> 8) & 0x00fffff};
  }

  /// The bytes, and zeros up to a multiple of 16.
  void add_padded(ByteView bytes) {
    for (std::size_t at = 0; at < bytes.size(); at += k_tag_bytes) {
      Tag block{};
      const std::size_t size = std::min(k_tag_bytes, bytes.size() - at);
      std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(at), size, block.begin());
      add_block(block);
    }
  }

  void add_sizes(std::uint64_t first, std::uint64_t second) {
    Tag block{};
    ByteWriter writer(block);
    writer.put(first);
    writer.put(second);
    add_block(block);
  }

  [[nodiscard]] Tag finish() {
    carry_fully();
    const std::array<std::uint32_t, 4> sum = reduced_words();
    Tag tag{};
    std::uint64_t carry = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      carry += std::uint64_t{sum[i]} + pad_[i];
      store32(tag, 4 * i, static_cast<std::uint32_t>(carry));
      carry >>= 32;
    }
    return tag;
  }

 private:
  void add_block(const Tag& block) {
    h_[0] += load32(block, 0) & k_limb_mask;
    h_[1] += (load32(block, 3) >> 2) & k_limb_mask;
    h_[2] += (load32(block, 6) >> 4) & k_limb_mask;
    h_[3] += (load32(block, 9) >> 6) & k_limb_mask;
    h_[4] += (load32(block, 12) >> 8) | (1U << 24);
    multiply();
  }

  // h = h · r, where a limb beyond the fifth comes back five times as large.
  void multiply() {
    std::array<std::uint64_t, 5> d{};
    for (std::size_t i = 0; i < 5; ++i) {
      for (std::size_t j = 0; j < 5; ++j) {
        const std::uint64_t product = std::uint64_t{h_[i]} * r_[j];
        d[(i + j) % 5] += i + j < 5 ? product : 5 * product;
      }
    }
    std::uint64_t carry = 0;
    for (std::size_t i = 0; i < 5; ++i) {
      d[i] += carry;
      h_[i] = static_cast<std::uint32_t>(d[i]) & k_limb_mask;
      carry = d[i] >> 26;
    }
    carry = h_[0] + 5 * carry;
    h_[0] = static_cast<std::uint32_t>(carry) & k_limb_mask;
    h_[1] += static_cast<std::uint32_t>(carry >> 26);
  }

  void carry_fully() {
    for (int twice = 0; twice < 2; ++twice) {
      std::uint32_t carry = 0;
      for (std::uint32_t& limb : h_) {
        limb += carry;
        carry = limb >> 26;
        limb &= k_limb_mask;
      }
      h_[0] += 5 * carry;
    }
  }

  // Subtracts 2^130 - 5 if that leaves nothing negative, without a branch.
  [[nodiscard]] std::array<std::uint32_t, 4> reduced_words() const {
    std::array<std::uint32_t, 5> g{};
    std::uint32_t carry = 5;
    for (std::size_t i = 0; i < 5; ++i) {
      g[i] = h_[i] + carry;
      carry = g[i] >> 26;
      g[i] &= k_limb_mask;
    }
    const std::uint32_t keep_g = 0U - carry;  // all ones if h is at least 2^130 - 5
    for (std::size_t i = 0; i < 5; ++i)
      g[i] = (g[i] & keep_g) | (h_[i] & ~keep_g);
    return {g[0] | (g[1] << 26), (g[1] >> 6) | (g[2] << 20), (g[2] >> 12) | (g[3] << 14),
            (g[3] >> 18) | (g[4] << 8)};
  }

  std::array<std::uint32_t, 5> r_{};
  std::array<std::uint32_t, 5> h_{};
  std::array<std::uint32_t, 4> pad_;
};

Tag tag_of(Stream& stream, ByteView context, ByteView sealed) {
  Poly1305 poly(stream.block(0));
  poly.add_padded(context);
  poly.add_padded(sealed);
  poly.add_sizes(context.size(), sealed.size());
  return poly.finish();
}

// Of a long nonce the first 16 bytes make a key of their own, and the rest stands behind zeros.
Stream stream_of(const Key& key, ByteView nonce) {
  if (nonce.size() == k_short_nonce_bytes) return {key, nonce};
  std::array<std::byte, k_short_nonce_bytes> rest{};
  std::copy_n(nonce.begin() + 16, 8, rest.begin() + 4);
  return {derive_key(key, nonce), rest};
}

}  // namespace

void seal(const Key& key, ByteView nonce, ByteView context, ByteView plain,
          std::span<std::byte> out) {
  Stream stream = stream_of(key, nonce);
  stream.apply(plain, out);
  const Tag tag = tag_of(stream, context, out.first(plain.size()));
  std::copy(tag.begin(), tag.end(), out.begin() + static_cast<std::ptrdiff_t>(plain.size()));
}

bool open(const Key& key, ByteView nonce, ByteView context, ByteView sealed,
          std::span<std::byte> out) {
  Stream stream = stream_of(key, nonce);
  const ByteView body = sealed.first(sealed.size() - k_tag_bytes);
  const Tag tag = tag_of(stream, context, body);
  std::byte difference{0};
  for (std::size_t i = 0; i < k_tag_bytes; ++i)
    difference |= tag[i] ^ sealed[body.size() + i];
  std::fill(out.begin(), out.end(), std::byte{0});
  if (difference != std::byte{0}) return false;
  stream.apply(body, out);
  return true;
}

}  // namespace lockstone::net::portable
