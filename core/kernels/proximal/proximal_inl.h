// The kernels of proximal_block.h for the target at hand: phases.
#if defined(LKS_WIDE_PROXIMAL_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef LKS_WIDE_PROXIMAL_INL_H
#undef LKS_WIDE_PROXIMAL_INL_H
#else
#define LKS_WIDE_PROXIMAL_INL_H
#endif

#include "core/kernels/proximal/proximal_block.h"
#include "core/kernels/proximal/proximal_friction.h"
#include "core/math/wide/scalar_lanes.h"
#ifdef LKS_SCALAR_TWIN
#include "core/math/wide/lanes_scalar_inl.h"
#else
#include "core/math/wide/lanes_inl.h"
#endif

// An island's rows are eight at most, and each set of these kernels is 20 kB of every program: on
// x86 that of AVX2 serves wider processors too, and narrower ones have the scalar twins.
#if defined(LKS_SCALAR_TWIN) || HWY_TARGET == HWY_AVX2 || HWY_TARGET == HWY_NEON || \
    HWY_TARGET == HWY_WASM
HWY_BEFORE_NAMESPACE();
namespace lockstone::lanes {
namespace HWY_NAMESPACE {

/// A shift of all lanes; 1 ≤ shift ≤ 62.
struct Shift {
  Lanes count, half;

  HWY_INLINE HWY_ATTR explicit Shift(int shift)
      : count(broadcast(shift)), half(broadcast(std::int64_t{1} << (shift - 1))) {}
  HWY_INLINE HWY_ATTR Lanes operator()(Lanes x) const { return round_shift(x, count, half); }
};

HWY_INLINE HWY_ATTR Lanes within(Lanes x, std::int64_t most) {
  return clamp(x, broadcast(-most), broadcast(most));
}

HWY_INLINE HWY_ATTR std::uint64_t all_bits(Lanes x) {
  std::int64_t words[k_lanes];
  store(x, words);
  std::int64_t bits = 0;
  for (const std::int64_t word : words)
    bits |= word;
  return static_cast<std::uint64_t>(bits);
}

HWY_INLINE HWY_ATTR std::int64_t sum_of(Lanes x) {
  std::int64_t words[k_lanes];
  store(x, words);
  std::int64_t sum = 0;
  for (const std::int64_t word : words)
    sum = scalar::add(sum, word);
  return sum;
}

/// J·u of the rows in lanes, Q30.
HWY_INLINE HWY_ATTR Lanes row_dots(const ProximalBlock& block, std::size_t lane, const BlockWord& a,
                                   const BlockWord& b) {
  Lanes of_a = broadcast(0), of_b = broadcast(0);
  for (std::size_t i = 0; i < k_body_words; ++i) {
    const Lanes side = load(&block.sides[i][lane]);
    of_a = multiply_add(of_a, side, broadcast(a[i]));
    of_b = multiply_add(of_b, upper(side), broadcast(b[i]));
  }
  return add(of_a, of_b);
}

/// Adds Jᵀ·x, |x| ≤ 2^30, to both bodies.
HWY_INLINE HWY_ATTR void add_transposed(const ProximalBlock& block, const BlockWord& x,
                                        BlockWord& a, BlockWord& b) {
  for (std::size_t lane = 0; lane < k_block_lanes; lane += k_lanes) {
    Lanes of_a = broadcast(0), of_b = broadcast(0);
    for (std::size_t r = 0; r < block.rows; ++r) {
      const Lanes row = load(&block.by_row[r][lane]), by = broadcast(x[r]);
      of_a = multiply_add(of_a, row, by);
      of_b = multiply_add(of_b, upper(row), by);
    }
    store(add(load(&a[lane]), round_shift<30>(of_a)), &a[lane]);
    store(add(load(&b[lane]), round_shift<30>(of_b)), &b[lane]);
  }
}

/// J·u + speed + γ(λ − c), Q30; `dots` is J·u.
HWY_INLINE HWY_ATTR Lanes residual_of(const ProximalBlock& block, std::size_t lane, Lanes dots) {
  const Lanes pulled = subtract(load(&block.impulse[lane]), load(&block.centre[lane]));
  const Lanes speed = shift_left<k_residual_point>(load(&block.speed[lane]));
  return add(multiply_add(dots, load(&block.give[lane]), pulled), speed);
}

HWY_ATTR std::uint64_t magnitudes(const ProximalBlock* blocks, std::size_t count) {
  Lanes most = broadcast(0);
  for (const ProximalBlock* block = blocks; block != blocks + count; ++block) {
    for (std::size_t lane = 0; lane < k_block_lanes; lane += k_lanes) {
      const Lanes speed = add(load(&block->moving[lane]), load(&block->bias[lane]));
      most = bit_or(most, without_sign(speed));
      most = bit_or(most, without_sign(load(&block->held[lane])));
      most = bit_or(most, without_sign(load(&block->warm[lane])));
    }
  }
  return all_bits(most);
}

HWY_ATTR void begin_phase(ProximalBlock* blocks, std::size_t count, int down, int loose) {
  const Shift coarser(down), less_coarse(down - loose > 1 ? down - loose : 1);
  for (ProximalBlock* block = blocks; block != blocks + count; ++block) {
    for (std::size_t lane = 0; lane < k_block_lanes; lane += k_lanes) {
      const Lanes speed = add(load(&block->moving[lane]), load(&block->bias[lane]));
      const Lanes impulse = within(coarser(load(&block->held[lane])), k_most_unit);
      store(within(coarser(speed), k_most_unit), &block->speed[lane]);
      store(impulse, &block->impulse[lane]);
      store(impulse, &block->start[lane]);
      store(within(coarser(load(&block->held_centre[lane])), k_most_unit), &block->centre[lane]);
      store(max(less_coarse(load(&block->least_change[lane])), broadcast(1)),
            &block->tolerance[lane]);
    }
  }
}

/// The rows of a contact while a pass goes over them, one after the other: as one is pushed, the
/// residuals of all are updated by their coupling.
struct RowPass {
  ProximalBlock& block;
  BlockWord residual{};  // in units of the phase
  BlockWord change{};    // of impulses, in this pass
  PassResult result{true, true};

  HWY_INLINE HWY_ATTR void begin(const BlockWord& a, const BlockWord& b) {
    for (std::size_t lane = 0; lane < k_block_lanes; lane += k_lanes)
      store(round_shift<30>(residual_of(block, lane, row_dots(block, lane, a, b))),
            &residual[lane]);
  }
  /// Clamps to the range of units, or of `most`.
  HWY_INLINE HWY_ATTR std::int64_t fit(std::int64_t x, std::int64_t most = k_most_unit) {
    const std::int64_t result_x = x < -most ? -most : x > most ? most : x;
    result.fits = result.fits && result_x == x;
    return result_x;
  }
  /// The impulse that leaves the row without a residual.
  HWY_INLINE HWY_ATTR std::int64_t wanted(std::size_t i) {
    const std::int64_t error = fit(residual[i], INT32_MAX) * block.own_part[i];
    return fit(block.impulse[i] - raw::round_shift(error, 30));
  }
  HWY_INLINE HWY_ATTR void push(std::size_t i, std::int64_t impulse) {
    const std::int64_t by = fit(impulse - block.impulse[i]);
    if (by == 0) return;
    block.impulse[i] = impulse;
    change[i] = by;
    result.done = result.done && by < block.tolerance[i] && by > -block.tolerance[i];
    for (std::size_t lane = 0; lane < k_block_lanes; lane += k_lanes) {
      const Lanes step = multiply(load(&block.coupling[i][lane]), broadcast(by));
      store(add(load(&residual[lane]), round_shift<30>(step)), &residual[lane]);
    }
  }
  HWY_INLINE HWY_ATTR void push_all() {
    for (std::size_t i = 0; i < block.points; ++i) {
      const std::int64_t impulse = wanted(i);
      push(i, impulse > 0 ? impulse : 0);
    }
    for (std::size_t i = block.points; block.has_locks && i < block.rows; ++i)
      push(i, wanted(i));
    if (!block.has_friction()) return;
    BlockWord next = block.impulse;
    for (std::size_t i = block.points; i < block.rows; ++i)
      next[i] = wanted(i);
    block.slides = shorten_friction(block, next) != 0;
    for (std::size_t i = block.points; i < block.rows; ++i)
      push(i, next[i]);
  }
  HWY_INLINE HWY_ATTR void end(BlockWord& a, BlockWord& b) {
    add_transposed(block, change, a, b);
    for (BlockWord* body : {&a, &b}) {
      for (std::size_t lane = 0; lane < k_block_lanes; lane += k_lanes) {
        const Lanes x = load(&(*body)[lane]), kept = within(x, k_most_unit);
        result.fits = result.fits && !any_less(x, kept) && !any_less(kept, x);
        store(kept, &(*body)[lane]);
      }
    }
  }
};

HWY_ATTR PassResult pass(ProximalBlock* blocks, std::size_t count, BlockWord* bodies) {
  PassResult result{true, true};
  for (ProximalBlock* block = blocks; block != blocks + count; ++block) {
    RowPass rows{*block};
    rows.begin(bodies[block->a], bodies[block->b]);
    rows.push_all();
    rows.end(bodies[block->a], bodies[block->b]);
    result.done = result.done && rows.result.done;
    result.fits = result.fits && rows.result.fits;
  }
  return result;
}

HWY_ATTR std::uint64_t find_residuals(ProximalBlock* blocks, std::size_t count,
                                      const BlockWord* bodies) {
  Lanes most = broadcast(0);
  for (ProximalBlock* block = blocks; block != blocks + count; ++block) {
    for (std::size_t lane = 0; lane < k_block_lanes; lane += k_lanes) {
      const Lanes dots = row_dots(*block, lane, bodies[block->a], bodies[block->b]);
      const Lanes residual = residual_of(*block, lane, dots);
      const Lanes idle = bit_and_not(load(&block->active[lane]), load(&block->normal[lane]));
      most = bit_or(most, bit_and_not(idle, without_sign(residual)));
      store(residual, &block->residual[lane]);
      store(load(&block->impulse[lane]), &block->next[lane]);
    }
  }
  return all_bits(most);
}

HWY_ATTR void add_right_sides(const ProximalBlock* blocks, std::size_t count, int drop,
                              BlockWord* sums) {
  constexpr int k_finer = k_residual_point - k_weight_point;
  const Shift dropped(drop), coarser(drop > k_finer ? drop - k_finer : 1);
  const Lanes finer = broadcast(drop > k_finer ? 1 : std::int64_t{1} << (k_finer - drop));
  for (const ProximalBlock* block = blocks; block != blocks + count; ++block) {
    BlockWord x;
    for (std::size_t lane = 0; lane < k_block_lanes; lane += k_lanes) {
      const Lanes active = load(&block->active[lane]);
      const Lanes residual = dropped(load(&block->residual[lane]));
      const Lanes part = round_shift_low<30>(multiply(residual, load(&block->weight[lane])));
      const Lanes change = subtract(load(&block->next[lane]), load(&block->impulse[lane]));
      const Lanes held = drop > k_finer ? coarser(change) : multiply(change, finer);
      store(bit_or(bit_and(active, subtract(broadcast(0), part)), bit_and_not(active, held)),
            &x[lane]);
    }
    add_transposed(*block, x, sums[block->a], sums[block->b]);
  }
}

/// One solve of a direct step, read.
struct ProposedStep {
  Shift dropped, scaled, units;
  Lanes off = broadcast(0), flips = broadcast(0), most = broadcast(0);
  bool follows;
  bool stays = true;  // friction that slides, within its tolerance

  HWY_INLINE HWY_ATTR ProposedStep(int drop, bool slides_follow)
      : dropped(drop),
        scaled(30 + k_residual_point - k_weight_point - drop),
        units(drop < k_residual_point ? k_residual_point - drop : 1),
        follows(slides_follow) {}

  HWY_INLINE HWY_ATTR void propose(ProximalBlock& block, std::size_t lane, Lanes dots) {
    const Lanes zero = broadcast(0), active = load(&block.active[lane]);
    const Lanes normal = load(&block.normal[lane]), impulse = load(&block.impulse[lane]);
    const Lanes nothing = subtract(zero, load(&block.tolerance[lane]));
    const Lanes left = add(dropped(load(&block.residual[lane])), round_shift<30>(dots));
    const Lanes fitting = saturate(left), speed = units(left);
    // Active ones: λ − left / γ.
    const Lanes free = subtract(impulse, scaled(multiply(fitting, load(&block.weight[lane]))));
    const Lanes kept = within(free, k_most_unit);
    off = bit_or(off, bit_and(active, bit_or(subtract(left, fitting), subtract(free, kept))));
    const Lanes pulls = select_less(kept, nothing, bit_and(active, normal), zero);
    const Lanes closes = select_less(speed, nothing, bit_and_not(active, normal), zero);
    const Lanes pushed = select_less(bit_and(normal, kept), zero, zero, kept);
    // Friction that slides: a step of a pass.
    const Lanes friction = broadcast(block.has_friction() ? -1 : 0);
    const Lanes slides = bit_and_not(bit_or(active, normal), friction);
    const Lanes step = round_shift<30>(multiply(saturate(speed), load(&block.own_part[lane])));
    const Lanes last = load(&block.next[lane]);
    const Lanes slid = follows ? within(subtract(last, step), k_most_unit) : last;
    store(bit_or(bit_and(active, pushed), bit_and(slides, slid)), &block.next[lane]);
    store(bit_or(bit_and_not(pulls, active), closes), &block.next_active[lane]);
    flips = add(flips, bit_and(bit_or(pulls, closes), broadcast(1)));
    most = bit_or(most, bit_and(closes, without_sign(load(&block.residual[lane]))));
  }

  /// Limits a contact's friction, once its normal impulses are proposed; `before`: the impulses
  /// proposed before these. Returns whether it begins to slide, or to stick.
  HWY_INLINE HWY_ATTR bool limit_friction(ProximalBlock& block, const BlockWord& before) {
    const std::int64_t over = shorten_friction(block, block.next);
    bool pushes = false;
    for (std::size_t i = 0; i < block.points; ++i)
      pushes = pushes || block.next[i] > 0;
    const bool stuck = block.active[block.points] != 0;
    const bool sticks =
        stuck ? over <= block.tolerance[block.points] : follows && pushes && over == 0;
    for (std::size_t i = block.points; i < block.rows; ++i) {
      const std::int64_t change = follows ? block.next[i] - before[i] : before[i];
      const std::int64_t none = follows ? block.tolerance[i] : 0;
      stays = stays && (stuck || (change <= none && -change <= none));
      if (sticks && !stuck) block.next[i] = before[i];
      block.next_active[i] = sticks ? -1 : 0;
    }
    return sticks != stuck;
  }
};

HWY_ATTR Proposal propose(ProximalBlock* blocks, std::size_t count, int drop, bool follows,
                          const BlockWord* changes) {
  Proposal result;
  ProposedStep step(drop, follows);
  for (ProximalBlock* block = blocks; block != blocks + count; ++block) {
    const BlockWord before = block->next;
    for (std::size_t lane = 0; lane < k_block_lanes; lane += k_lanes)
      step.propose(*block, lane, row_dots(*block, lane, changes[block->a], changes[block->b]));
    if (block->has_friction() && step.limit_friction(*block, before)) ++result.changed;
    for (std::size_t lane = 0; lane < k_block_lanes; lane += k_lanes) {
      const Lanes change = subtract(load(&block->next[lane]), load(&block->impulse[lane]));
      const Lanes far = shift_left<k_residual_point>(without_sign(change));
      step.most = bit_or(step.most, bit_and_not(load(&block->next_active[lane]), far));
    }
  }
  result.changed += static_cast<std::uint32_t>(sum_of(step.flips));
  result.is_solved = result.changed == 0 && step.stays;
  result.fits = all_bits(step.off) == 0;
  result.bits = all_bits(step.most);
  return result;
}

HWY_ATTR bool add_changes(const ProximalBlock* blocks, std::size_t count, BlockWord* sums) {
  Lanes off = broadcast(0);
  for (const ProximalBlock* block = blocks; block != blocks + count; ++block) {
    BlockWord x;
    for (std::size_t lane = 0; lane < k_block_lanes; lane += k_lanes) {
      const Lanes change = subtract(load(&block->next[lane]), load(&block->impulse[lane]));
      const Lanes kept = within(change, k_most_unit);
      off = bit_or(off, subtract(change, kept));
      store(kept, &x[lane]);
    }
    add_transposed(*block, x, sums[block->a], sums[block->b]);
  }
  return all_bits(off) == 0;
}

HWY_ATTR void update_residuals(ProximalBlock* blocks, std::size_t count, const BlockWord* bodies,
                               int shift) {
  constexpr std::int64_t k_most_kept = std::int64_t{1} << 58;
  const Shift rounded(shift > 0 ? shift : 1);
  for (ProximalBlock* block = blocks; block != blocks + count; ++block) {
    for (std::size_t lane = 0; lane < k_block_lanes; lane += k_lanes) {
      const Lanes dots = row_dots(*block, lane, bodies[block->a], bodies[block->b]);
      Lanes change = shift > 0 ? rounded(dots) : within(dots, k_most_kept >> -shift);
      for (int i = shift; i < 0; ++i)
        change = add(change, change);
      const Lanes moving = add(load(&block->moving[lane]), within(change, k_most_kept));
      store(within(moving, k_most_kept), &block->moving[lane]);
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace lockstone::lanes
HWY_AFTER_NAMESPACE();
#endif  // the targets

#endif  // the guard
