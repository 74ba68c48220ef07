// Lanes on Highway: as many 64-bit words side by side as a vector of the target holds.
// scalar_lanes.h defines each operation; tests compare the two bit for bit.
//
// Compiled once for each target, hence the guard that Highway resets between targets.
#if defined(LKS_WIDE_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef LKS_WIDE_LANES_INL_H
#undef LKS_WIDE_LANES_INL_H
#else
#define LKS_WIDE_LANES_INL_H
#endif

#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace lockstone::lanes {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Words = hn::ScalableTag<std::int64_t>;
using Bits = hn::RebindToUnsigned<Words>;
using Operands = hn::Repartition<std::int32_t, Words>;
using UnsignedOperands = hn::Repartition<std::uint32_t, Words>;
using Lanes = hn::Vec<Words>;

inline constexpr Words k_words{};
inline constexpr std::size_t k_lanes = HWY_LANES(std::int64_t);

HWY_INLINE HWY_ATTR Lanes load(const std::int64_t* from) {
  return hn::LoadU(k_words, from);
}
/// The upper operands of words in memory: read from their middle on, for loads are cheaper than
/// shuffles. Four bytes behind the last word are read, too.
HWY_INLINE HWY_ATTR Lanes load_upper(const std::int64_t* from) {
  const auto* halves = reinterpret_cast<const std::int32_t*>(from);
  return hn::BitCast(k_words, hn::LoadU(Operands(), halves + 1));
}
HWY_INLINE HWY_ATTR void store(Lanes x, std::int64_t* to) {
  hn::StoreU(x, k_words, to);
}
HWY_INLINE HWY_ATTR Lanes broadcast(std::int64_t x) {
  return hn::Set(k_words, x);
}

HWY_INLINE HWY_ATTR Lanes add(Lanes a, Lanes b) {
  return hn::Add(a, b);
}
HWY_INLINE HWY_ATTR Lanes subtract(Lanes a, Lanes b) {
  return hn::Sub(a, b);
}

/// The upper operand, copied to the lower half, by a shuffle: fewer ports execute shifts.
HWY_INLINE HWY_ATTR Lanes upper(Lanes x) {
  return hn::BitCast(k_words, hn::DupOdd(hn::BitCast(Operands(), x)));
}

/// The lower halves of two words in one.
HWY_INLINE HWY_ATTR Lanes pack(Lanes low, Lanes high) {
  const auto raised = hn::ShiftLeft<32>(high);
  return hn::BitCast(k_words,
                     hn::OddEven(hn::BitCast(Operands(), raised), hn::BitCast(Operands(), low)));
}

/// `low` with the upper half of `other`.
HWY_INLINE HWY_ATTR Lanes with_upper_of(Lanes low, Lanes other) {
  return hn::BitCast(k_words,
                     hn::OddEven(hn::BitCast(Operands(), other), hn::BitCast(Operands(), low)));
}

HWY_INLINE HWY_ATTR Lanes lower_part(Lanes x) {
  return hn::And(x, broadcast(0xffffffff));
}
HWY_INLINE HWY_ATTR Lanes upper_part(Lanes x) {
  return hn::BitCast(k_words, hn::ShiftRight<32>(hn::BitCast(Bits(), x)));
}

HWY_INLINE HWY_ATTR Lanes low_byte(Lanes x) {
  return hn::And(x, broadcast(0xff));
}

template <int shift>
HWY_INLINE HWY_ATTR Lanes shift_left(Lanes x) {
  return hn::ShiftLeft<shift>(x);
}

/// Logically.
template <int shift>
HWY_INLINE HWY_ATTR Lanes shift_right(Lanes x) {
  return hn::BitCast(k_words, hn::ShiftRight<shift>(hn::BitCast(Bits(), x)));
}

HWY_INLINE HWY_ATTR Lanes multiply(Lanes a, Lanes b) {
#if HWY_TARGET == HWY_WASM
  // Highway 1.0.3 multiplies signed operands here as if they were unsigned (MulEven,
  // wasm_128-inl.h).
  const Lanes low_a = hn::ShiftRight<32>(hn::ShiftLeft<32>(a));
  const Lanes low_b = hn::ShiftRight<32>(hn::ShiftLeft<32>(b));
  return Lanes{wasm_i64x2_mul(low_a.raw, low_b.raw)};
#else
  return hn::MulEven(hn::BitCast(Operands(), a), hn::BitCast(Operands(), b));
#endif
}
HWY_INLINE HWY_ATTR Lanes multiply_add(Lanes sum, Lanes a, Lanes b) {
  return hn::Add(sum, multiply(a, b));
}
HWY_INLINE HWY_ATTR Lanes multiply_subtract(Lanes sum, Lanes a, Lanes b) {
  return hn::Sub(sum, multiply(a, b));
}

template <int shift>
HWY_INLINE HWY_ATTR Lanes round_shift_low(Lanes x) {
  const auto u = hn::BitCast(Bits(), x);
  const auto half = hn::Set(Bits(), std::uint64_t{1} << (shift - 1));
  const auto moved = hn::Sub(hn::Add(u, half), hn::ShiftRight<63>(u));
  return hn::BitCast(k_words, hn::ShiftRight<shift>(moved));
}

/// As above by more than a word's half: the lower half alone, its sign and all.
template <int shift>
HWY_INLINE HWY_ATTR Lanes round_shift_far(Lanes x) {
  static_assert(shift > 32);
  const auto u = hn::BitCast(Bits(), x);
  const auto half = hn::Set(Bits(), std::uint64_t{1} << (shift - 1));
  const auto moved = hn::Sub(hn::Add(u, half), hn::ShiftRight<63>(u));
  const auto halves = hn::DupOdd(hn::BitCast(Operands(), moved));
  return hn::BitCast(k_words, hn::ShiftRight<shift - 32>(halves));
}

/// Every lane by a shift of its own, logically. Highway 1.0 has none for words of 64 bits on
/// WebAssembly, nor has the processor.
HWY_INLINE HWY_ATTR hn::Vec<Bits> shift_right_each(hn::Vec<Bits> x, hn::Vec<Bits> shift) {
#if HWY_TARGET == HWY_WASM
  HWY_ALIGN std::uint64_t words[k_lanes], shifts[k_lanes];
  hn::Store(x, Bits(), words);
  hn::Store(shift, Bits(), shifts);
  for (std::size_t lane = 0; lane < k_lanes; ++lane)
    words[lane] >>= shifts[lane];
  return hn::Load(Bits(), words);
#else
  return hn::Shr(x, shift);
#endif
}

HWY_INLINE HWY_ATTR Lanes shift_right_each(Lanes x, Lanes shift) {
  return hn::BitCast(k_words, shift_right_each(hn::BitCast(Bits(), x), hn::BitCast(Bits(), shift)));
}

HWY_INLINE HWY_ATTR Lanes power_of_two(Lanes exponent) {
#if HWY_TARGET == HWY_WASM
  HWY_ALIGN std::int64_t words[k_lanes];
  hn::Store(exponent, k_words, words);
  for (std::size_t lane = 0; lane < k_lanes; ++lane)
    words[lane] = static_cast<std::int64_t>(std::uint64_t{1} << words[lane]);
  return hn::Load(k_words, words);
#else
  return hn::Shl(broadcast(1), exponent);
#endif
}

/// As above with a shift of each lane's own; `half` is 2^(shift − 1).
HWY_INLINE HWY_ATTR Lanes round_shift_low(Lanes x, Lanes shift, Lanes half) {
  const auto u = hn::BitCast(Bits(), x);
  const auto moved = hn::Sub(hn::Add(u, hn::BitCast(Bits(), half)), hn::ShiftRight<63>(u));
  return hn::BitCast(k_words, shift_right_each(moved, hn::BitCast(Bits(), shift)));
}

// AVX2 and older have no arithmetic shift of words: there a word moves up by 2^63 first, is shifted
// logically, and moves down by as much of that as is left.
#if HWY_TARGET == HWY_AVX2 || HWY_TARGET == HWY_SSE4
inline constexpr bool k_shifts_logically = true;
#else
inline constexpr bool k_shifts_logically = false;
#endif
inline constexpr std::uint64_t k_word_middle = std::uint64_t{1} << 63;

template <int shift>
HWY_INLINE HWY_ATTR Lanes round_shift(Lanes x) {
  const auto u = hn::BitCast(Bits(), x);
  constexpr std::uint64_t k_half = std::uint64_t{1} << (shift - 1);
  if constexpr (k_shifts_logically) {
    const auto raised = hn::Add(u, hn::Set(Bits(), k_half + k_word_middle));
    const auto size = hn::ShiftRight<shift>(hn::Sub(raised, hn::ShiftRight<63>(u)));
    return hn::BitCast(k_words, hn::Sub(size, hn::Set(Bits(), k_word_middle >> shift)));
  } else {
    const auto moved = hn::Sub(hn::Add(u, hn::Set(Bits(), k_half)), hn::ShiftRight<63>(u));
    return hn::ShiftRight<shift>(hn::BitCast(k_words, moved));
  }
}

/// Every lane by a shift of its own; `half` is 2^(shift − 1).
HWY_INLINE HWY_ATTR Lanes round_shift(Lanes x, Lanes shift, Lanes half) {
  const auto u = hn::BitCast(Bits(), x), shifts = hn::BitCast(Bits(), shift);
  const auto moved = hn::Sub(hn::Add(u, hn::BitCast(Bits(), half)), hn::ShiftRight<63>(u));
  const auto middle = hn::Set(Bits(), k_word_middle);
  const auto size = shift_right_each(hn::Xor(moved, middle), shifts);
  return hn::BitCast(k_words, hn::Sub(size, shift_right_each(middle, shifts)));
}

HWY_INLINE HWY_ATTR Lanes bit_and(Lanes a, Lanes b) {
  return hn::And(a, b);
}
HWY_INLINE HWY_ATTR Lanes bit_or(Lanes a, Lanes b) {
  return hn::Or(a, b);
}
HWY_INLINE HWY_ATTR Lanes bit_and_not(Lanes a, Lanes b) {
  return hn::AndNot(a, b);
}
HWY_INLINE HWY_ATTR Lanes without_sign(Lanes x) {
  return hn::Xor(x, hn::BroadcastSignBit(x));
}

HWY_INLINE HWY_ATTR Lanes zero_if_negative(Lanes x) {
#if HWY_TARGET == HWY_AVX3
  return hn::Max(x, hn::Zero(k_words));
#else
  return hn::AndNot(hn::BroadcastSignBit(x), x);
#endif
}

HWY_INLINE HWY_ATTR Lanes at_most(Lanes x, std::int32_t bound) {
  // The bound's upper half is zero, so the result is clean.
  const auto most = hn::BitCast(UnsignedOperands(), broadcast(bound));
  return hn::BitCast(k_words, hn::Min(hn::BitCast(UnsignedOperands(), x), most));
}

template <int shift>
HWY_INLINE HWY_ATTR Lanes round_shift_unsigned(Lanes x) {
  const auto half = hn::Set(Bits(), std::uint64_t{1} << (shift - 1));
  return hn::BitCast(k_words, hn::ShiftRight<shift>(hn::Add(hn::BitCast(Bits(), x), half)));
}

template <int shift>
HWY_INLINE HWY_ATTR Lanes round_shift_positive(Lanes x, std::int32_t bound) {
  return at_most(round_shift_unsigned<shift>(zero_if_negative(x)), bound);
}

template <int bits_dropped>
HWY_INLINE HWY_ATTR Lanes round_to_multiple(Lanes x) {
  const auto u = hn::BitCast(Bits(), x);
  const auto half = hn::Set(Bits(), std::uint64_t{1} << (bits_dropped - 1));
  const auto moved = hn::Sub(hn::Add(u, half), hn::ShiftRight<63>(u));
  const auto dropped = hn::Set(Bits(), (std::uint64_t{1} << bits_dropped) - 1);
  return hn::BitCast(k_words, hn::AndNot(dropped, moved));
}

HWY_INLINE HWY_ATTR Lanes min(Lanes a, Lanes b) {
  return hn::Min(a, b);
}
HWY_INLINE HWY_ATTR Lanes max(Lanes a, Lanes b) {
  return hn::Max(a, b);
}
HWY_INLINE HWY_ATTR Lanes clamp(Lanes x, Lanes lowest, Lanes highest) {
  return hn::Min(hn::Max(x, lowest), highest);
}
HWY_INLINE HWY_ATTR Lanes saturate(Lanes x) {
  return clamp(x, broadcast(INT32_MIN), broadcast(INT32_MAX));
}
HWY_INLINE HWY_ATTR Lanes select_less(Lanes a, Lanes b, Lanes yes, Lanes no) {
  return hn::IfThenElse(hn::Lt(a, b), yes, no);
}
HWY_INLINE HWY_ATTR bool any_less(Lanes a, Lanes b) {
  return !hn::AllFalse(k_words, hn::Lt(a, b));
}
/// Bit i: a < b in lane i.
HWY_INLINE HWY_ATTR std::uint32_t bits_of_less(Lanes a, Lanes b) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(k_words, hn::Lt(a, b), bytes);
  return bytes[0];
}
HWY_INLINE HWY_ATTR Lanes select_equal(Lanes a, Lanes b, Lanes yes, Lanes no) {
  return hn::IfThenElse(hn::Eq(a, b), yes, no);
}

/// Lane i: base[index[i]], for indices below 2^31.
HWY_INLINE HWY_ATTR Lanes gather_64(const std::int64_t* base, const std::int64_t* index) {
  return hn::GatherIndex(k_words, base, load(index));
}
HWY_INLINE HWY_ATTR void scatter_64(Lanes x, std::int64_t* base, const std::int64_t* index) {
  hn::ScatterIndex(x, k_words, base, load(index));
}

/// Lane i: base[index[i]], its sign extended into the upper half.
HWY_INLINE HWY_ATTR Lanes gather_32(const std::int32_t* base, const std::int32_t* index) {
  const hn::Rebind<std::int32_t, Words> half_words;
  return hn::PromoteTo(k_words, hn::GatherIndex(half_words, base, hn::LoadU(half_words, index)));
}
/// The lower halves.
HWY_INLINE HWY_ATTR void scatter_32(Lanes x, std::int32_t* base, const std::int32_t* index) {
  const hn::Rebind<std::int32_t, Words> half_words;
  const auto narrow = hn::TruncateTo(hn::Rebind<std::uint32_t, Words>(), hn::BitCast(Bits(), x));
  hn::ScatterIndex(hn::BitCast(half_words, narrow), half_words, base, hn::LoadU(half_words, index));
}

// Records of words, one for each lane, are read and written 16 bytes at a time: a vector is put
// together from such pieces by inserts, which take them from memory, and a single interleaving step
// completes the transposition. That beats 4×4 shuffles of whole rows, and gather instructions.
using Pair = hn::FixedTag<std::int64_t, 2>;
using Piece = hn::Vec<Pair>;
inline constexpr Pair k_pair{};
inline constexpr hn::FixedTag<std::int32_t, 4> k_four_operands{};

HWY_INLINE HWY_ATTR Piece load_piece(const std::int64_t* from) {
  return hn::LoadU(k_pair, from);
}
HWY_INLINE HWY_ATTR Piece load_piece(const std::int32_t* from) {
  return hn::BitCast(k_pair, hn::LoadU(k_four_operands, from));
}
HWY_INLINE HWY_ATTR void store_piece(Piece x, std::int64_t* to) {
  hn::StoreU(x, k_pair, to);
}
HWY_INLINE HWY_ATTR void store_piece(Piece x, std::int32_t* to) {
  hn::StoreU(hn::BitCast(k_four_operands, x), k_four_operands, to);
}

/// The pieces of every second record from `i` on: records i, i + 2, i + 4, …
template <class At>
HWY_INLINE HWY_ATTR Lanes load_pieces(const At& at, std::size_t i) {
#if HWY_TARGET == HWY_AVX3
  const hn::FixedTag<std::int64_t, 4> quad;
  const auto low = hn::Combine(quad, load_piece(at(i + 2)), load_piece(at(i)));
  const auto high = hn::Combine(quad, load_piece(at(i + 6)), load_piece(at(i + 4)));
  return hn::Combine(k_words, high, low);
#elif HWY_TARGET == HWY_AVX2
  return hn::Combine(k_words, load_piece(at(i + 2)), load_piece(at(i)));
#else
  return load_piece(at(i));
#endif
}

template <class At>
HWY_INLINE HWY_ATTR void store_pieces(Lanes x, const At& at, std::size_t i) {
#if HWY_TARGET == HWY_AVX3
  const hn::FixedTag<std::int64_t, 4> quad;
  const auto low = hn::LowerHalf(quad, x);
  const auto high = hn::UpperHalf(quad, x);
  store_piece(hn::LowerHalf(k_pair, low), at(i));
  store_piece(hn::UpperHalf(k_pair, low), at(i + 2));
  store_piece(hn::LowerHalf(k_pair, high), at(i + 4));
  store_piece(hn::UpperHalf(k_pair, high), at(i + 6));
#elif HWY_TARGET == HWY_AVX2
  store_piece(hn::LowerHalf(k_pair, x), at(i));
  store_piece(hn::UpperHalf(k_pair, x), at(i + 2));
#else
  store_piece(x, at(i));
#endif
}

/// Words 0 and 1 at `at(i)` of each lane i.
template <class At>
HWY_INLINE HWY_ATTR void load_two(const At& at, Lanes& first, Lanes& second) {
  const Lanes even = load_pieces(at, 0);
  const Lanes odd = load_pieces(at, 1);
  first = hn::InterleaveLower(k_words, even, odd);
  second = hn::InterleaveUpper(k_words, even, odd);
}

template <class At>
HWY_INLINE HWY_ATTR void store_two(Lanes first, Lanes second, const At& at) {
  store_pieces(hn::InterleaveLower(k_words, first, second), at, 0);
  store_pieces(hn::InterleaveUpper(k_words, first, second), at, 1);
}

/// Where the lanes' records lie: that of lane i at base + index[i] · stride words.
template <class Word>
struct RecordsAt {
  Word* base;
  const std::uint32_t* index;
  std::size_t stride;

  HWY_INLINE HWY_ATTR Word* operator()(std::size_t lane) const {
    return base + index[lane] * stride;
  }
};

/// A 4×4 transposition: words 0 … 3 of each lane's record.
HWY_INLINE HWY_ATTR void load_four(const RecordsAt<const std::int64_t>& at, Lanes (&words)[4]) {
  load_two(at, words[0], words[1]);
  load_two(RecordsAt<const std::int64_t>{at.base + 2, at.index, at.stride}, words[2], words[3]);
}

HWY_INLINE HWY_ATTR void store_four(const Lanes (&words)[4], const RecordsAt<std::int64_t>& at) {
  store_two(words[0], words[1], at);
  store_two(words[2], words[3], RecordsAt<std::int64_t>{at.base + 2, at.index, at.stride});
}

}  // namespace HWY_NAMESPACE
}  // namespace lockstone::lanes
HWY_AFTER_NAMESPACE();

#endif  // the guard
