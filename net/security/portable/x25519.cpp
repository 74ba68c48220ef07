#include "net/security/portable/x25519.h"

#include <array>
#include <cstdint>

namespace lockstone::net::portable {
namespace {

constexpr std::size_t k_limbs = 16;

/// Modulo 2^255 - 19, in 16 limbs of 16 bits, which may be negative and a little longer.
using Element = std::array<std::int64_t, k_limbs>;

// The carry out of the last limb counts 2^256 = 38.
void carry(Element& a) {
  for (std::size_t i = 0; i < k_limbs; ++i) {
    const std::int64_t over = a[i] >> 16;
    a[i] -= over * 65536;
    if (i + 1 < k_limbs) {
      a[i + 1] += over;
    } else {
      a[0] += 38 * over;
    }
  }
}

Element add(const Element& a, const Element& b) {
  Element sum;
  for (std::size_t i = 0; i < k_limbs; ++i)
    sum[i] = a[i] + b[i];
  return sum;
}

Element subtract(const Element& a, const Element& b) {
  Element difference;
  for (std::size_t i = 0; i < k_limbs; ++i)
    difference[i] = a[i] - b[i];
  return difference;
}

// Limbs are below 2^26 in size, so that sums of 16 · 39 products fit into 63 bits.
Element multiply(const Element& a, const Element& b) {
  std::array<std::int64_t, 2 * k_limbs> wide{};
  for (std::size_t i = 0; i < k_limbs; ++i) {
    for (std::size_t j = 0; j < k_limbs; ++j)
      wide[i + j] += a[i] * b[j];
  }
  Element product;
  for (std::size_t i = 0; i < k_limbs; ++i)
    product[i] = wide[i] + 38 * wide[i + k_limbs];
  carry(product);
  carry(product);
  return product;
}

// a^(2^255 - 21): all bits of the exponent are ones but those of 2 and 4.
Element invert(const Element& a) {
  Element power = a;
  for (int bit = 253; bit >= 0; --bit) {
    power = multiply(power, power);
    if (bit != 2 && bit != 4) power = multiply(power, a);
  }
  return power;
}

// Exchanges both if `bit` is 1, without a branch.
void swap_if(Element& a, Element& b, std::int64_t bit) {
  const std::int64_t mask = -bit;
  for (std::size_t i = 0; i < k_limbs; ++i) {
    const std::int64_t difference = mask & (a[i] ^ b[i]);
    a[i] ^= difference;
    b[i] ^= difference;
  }
}

Element read(const Key& key) {
  Element a;
  for (std::size_t i = 0; i < k_limbs; ++i) {
    const auto low = std::to_integer<std::int64_t>(key.bytes[2 * i]);
    const auto high = std::to_integer<std::int64_t>(key.bytes[2 * i + 1]);
    a[i] = low + 256 * high;
  }
  a[k_limbs - 1] &= 0x7fff;
  return a;
}

// Subtracts the modulus up to twice, as often as that leaves nothing negative.
Key write(Element a) {
  for (int i = 0; i < 3; ++i)
    carry(a);
  for (int twice = 0; twice < 2; ++twice) {
    Element reduced;
    reduced[0] = a[0] - 0xffed;
    for (std::size_t i = 1; i < k_limbs; ++i) {
      reduced[i] = a[i] - (i + 1 < k_limbs ? 0xffff : 0x7fff) - ((reduced[i - 1] >> 16) & 1);
      reduced[i - 1] &= 0xffff;
    }
    const std::int64_t negative = (reduced[k_limbs - 1] >> 16) & 1;
    reduced[k_limbs - 1] &= 0xffff;
    swap_if(a, reduced, 1 - negative);
  }
  Key key;
  for (std::size_t i = 0; i < k_limbs; ++i) {
    key.bytes[2 * i] = static_cast<std::byte>(a[i] & 0xff);
    key.bytes[2 * i + 1] = static_cast<std::byte>((a[i] >> 8) & 0xff);
  }
  return key;
}

std::int64_t bit_of(const Key& scalar, unsigned bit) {
  return std::to_integer<std::int64_t>(scalar.bytes[bit / 8] >> (bit % 8)) & 1;
}

Key clamped(Key secret) {
  secret.bytes[0] &= std::byte{248};
  secret.bytes[31] = (secret.bytes[31] & std::byte{127}) | std::byte{64};
  return secret;
}

}  // namespace

// The ladder of RFC 7748, section 5, with its names.
Key x25519(const Key& secret, const Key& other) {
  const Key k = clamped(secret);
  const Element x1 = read(other);
  Element x2{1}, z2{}, x3 = x1, z3{1};
  const Element a24{0xdb41, 1};  // 121665
  for (unsigned t = 255; t-- > 0;) {
    const std::int64_t bit = bit_of(k, t);
    swap_if(x2, x3, bit);
    swap_if(z2, z3, bit);
    const Element a = add(x2, z2), b = subtract(x2, z2);
    const Element aa = multiply(a, a), bb = multiply(b, b);
    const Element e = subtract(aa, bb);
    const Element da = multiply(subtract(x3, z3), a), cb = multiply(add(x3, z3), b);
    const Element sum = add(da, cb), difference = subtract(da, cb);
    x3 = multiply(sum, sum);
    z3 = multiply(x1, multiply(difference, difference));
    x2 = multiply(aa, bb);
    z2 = multiply(e, add(aa, multiply(a24, e)));
    swap_if(x2, x3, bit);
    swap_if(z2, z3, bit);
  }
  return write(multiply(x2, invert(z2)));
}

Key x25519_base() {
  Key base;
  base.bytes[0] = std::byte{9};
  return base;
}

}  // namespace lockstone::net::portable
