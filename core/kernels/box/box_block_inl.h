// The kernels of box_block.h for the target at hand.
#if defined(LKS_WIDE_BOX_BLOCK_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef LKS_WIDE_BOX_BLOCK_INL_H
#undef LKS_WIDE_BOX_BLOCK_INL_H
#else
#define LKS_WIDE_BOX_BLOCK_INL_H
#endif

#include "core/kernels/box/box_block.h"
#ifdef LKS_SCALAR_TWIN
#include "core/math/wide/lanes_scalar_inl.h"
#else
#include "core/math/wide/lanes_inl.h"
#endif

HWY_BEFORE_NAMESPACE();
namespace lockstone::lanes {
namespace HWY_NAMESPACE {

/// Three numbers by an axis of some box.
struct BoxVector {
  Lanes at[3];
};

/// As many pairs as there are lanes. Operands but for centres.
struct BoxLanes {
  BoxVector axes_a[3], axes_b[3], half_a, half_b, offset;
  Lanes margin;
};

HWY_INLINE HWY_ATTR Lanes size_of(Lanes x) {
  return select_less(x, broadcast(0), subtract(broadcast(0), x), x);
}
HWY_INLINE HWY_ATTR Lanes signed_by(Lanes sign, Lanes x) {
  return select_less(sign, broadcast(0), subtract(broadcast(0), x), x);
}
HWY_INLINE HWY_ATTR Lanes sign_of(Lanes x) {
  return select_less(x, broadcast(0), broadcast(-1), broadcast(1));
}
/// The operand as a word.
HWY_INLINE HWY_ATTR Lanes widened(Lanes x) {
  return multiply(x, broadcast(1));
}
HWY_INLINE HWY_ATTR Lanes dot(const BoxVector& a, const BoxVector& b) {
  return multiply_add(multiply_add(multiply(a.at[0], b.at[0]), a.at[1], b.at[1]), a.at[2], b.at[2]);
}
/// `yes` where `flag` is not 0.
HWY_INLINE HWY_ATTR Lanes choose(Lanes flag, Lanes yes, Lanes no) {
  return select_equal(flag, broadcast(0), no, yes);
}
HWY_INLINE HWY_ATTR BoxVector choose(Lanes flag, const BoxVector& yes, const BoxVector& no) {
  return {{choose(flag, yes.at[0], no.at[0]), choose(flag, yes.at[1], no.at[1]),
           choose(flag, yes.at[2], no.at[2])}};
}

/// The numbers of the axes after `axis`, and of `axis` itself.
HWY_INLINE HWY_ATTR BoxVector turned_to(Lanes axis, const BoxVector& v) {
  const auto pick = [&](Lanes of_0, Lanes of_1, Lanes of_2) HWY_ATTR {
    return select_equal(axis, broadcast(0), of_0, select_equal(axis, broadcast(1), of_1, of_2));
  };
  return {{pick(v.at[1], v.at[2], v.at[0]), pick(v.at[2], v.at[0], v.at[1]),
           pick(v.at[0], v.at[1], v.at[2])}};
}

HWY_INLINE HWY_ATTR void load_source(const BoxSource* sources, BoxLanes& out) {
  constexpr std::size_t stride = sizeof(BoxSource) / sizeof(std::int32_t);
  constexpr std::uint32_t in_order[] = {0, 1, 2, 3, 4, 5, 6, 7};
  Lanes operands[28];
  for (std::size_t i = 0; i < 28; i += 4) {
    Lanes first, second;
    load_two(RecordsAt<const std::int32_t>{sources->axes_a.data() + i, in_order, stride}, first,
             second);
    operands[i] = first;
    operands[i + 1] = upper(first);
    operands[i + 2] = second;
    operands[i + 3] = upper(second);
  }
  const auto vector = [&](std::size_t i) HWY_ATTR {
    return BoxVector{{operands[i], operands[i + 1], operands[i + 2]}};
  };
  for (std::size_t i = 0; i < 3; ++i) {
    out.axes_a[i] = vector(3 * i);
    out.axes_b[i] = vector(9 + 3 * i);
  }
  out.half_a = vector(18);
  out.half_b = vector(21);
  out.offset = vector(24);
  out.margin = operands[27];
}

/// The face of one box that separates most, the first of equals.
struct BestFace {
  Lanes axis, separation, centre;
};

/// `centre` of the other box, `reach` of it along the axes.
HWY_INLINE HWY_ATTR BestFace best_face(const BoxVector& centre, const BoxVector& half,
                                       const BoxVector (&directions)[3], const BoxVector& other) {
  const Lanes one = broadcast(std::int64_t{1} << 30);
  BestFace best{};
  for (std::size_t i = 0; i < 3; ++i) {
    Lanes beside = multiply(half.at[i], one);
    for (std::size_t j = 0; j < 3; ++j)
      beside = multiply_add(beside, other.at[j], directions[j].at[i]);
    const Lanes separation = subtract(size_of(centre.at[i]), beside);
    if (i == 0) {
      best = {broadcast(0), separation, centre.at[0]};
      continue;
    }
    const Lanes axis = broadcast(static_cast<std::int64_t>(i));
    best.axis = select_less(best.separation, separation, axis, best.axis);
    best.centre = select_less(best.separation, separation, centre.at[i], best.centre);
    best.separation = max(best.separation, separation);
  }
  return best;
}

/// The words of a `FaceMeeting`, one meeting a lane.
struct MeetingLanes {
  Lanes words[34];

  HWY_INLINE HWY_ATTR void set(std::size_t i, const BoxVector& v) {
    for (std::size_t k = 0; k < 3; ++k)
      words[i + k] = v.at[k];
  }
};

/// The two faces in the frame of the first. `rows[j]`: axis j of the other box along the axes of
/// this one.
struct FacePair {
  BoxVector rows[3]{}, centre{}, half{}, half_other{};
  Lanes axis, sign;

  HWY_INLINE HWY_ATTR void fill(MeetingLanes& out, Lanes& opposed) const {
    const Lanes one = broadcast(1), length = broadcast(std::int64_t{1} << 30);
    BoxVector seen[3]{};  // the other's axes
    for (std::size_t j = 0; j < 3; ++j) {
      const BoxVector t = turned_to(axis, rows[j]);
      seen[j] = {{multiply(t.at[0], one), multiply(t.at[1], one), multiply(t.at[2], sign)}};
    }
    const BoxVector mine = turned_to(axis, half);
    const BoxVector c = turned_to(axis, centre);
    const Lanes height = multiply(mine.at[2], length);
    const Lanes above = subtract(signed_by(sign, c.at[2]), height);

    Lanes other_axis = broadcast(0), lean = seen[0].at[2];
    for (std::size_t j = 1; j < 3; ++j) {
      const Lanes most = size_of(lean), here = size_of(seen[j].at[2]);
      other_axis = select_less(most, here, broadcast(static_cast<std::int64_t>(j)), other_axis);
      lean = select_less(most, here, seen[j].at[2], lean);
    }
    const Lanes faces_up = select_less(broadcast(0), lean, broadcast(1), broadcast(0));
    opposed = add(add(other_axis, other_axis), faces_up);

    BoxVector u{}, v{}, n{};
    for (std::size_t k = 0; k < 3; ++k) {
      const BoxVector t =
          turned_to(other_axis, BoxVector{{seen[0].at[k], seen[1].at[k], seen[2].at[k]}});
      u.at[k] = t.at[0];
      v.at[k] = t.at[1];
      n.at[k] = t.at[2];
    }
    const BoxVector sizes = turned_to(other_axis, half_other);
    const Lanes at[3] = {c.at[0], c.at[1], above};
    for (std::size_t k = 0; k < 3; ++k) {
      const Lanes out_k = multiply(n.at[k], sizes.at[2]);
      out.words[k] = choose(faces_up, subtract(at[k], out_k), add(at[k], out_k));
      out.words[3 + k] = multiply(u.at[k], sizes.at[0]);
      out.words[6 + k] = multiply(v.at[k], sizes.at[1]);
    }
    out.set(9, n);
    out.set(12, u);
    out.set(15, v);
    out.words[18] = multiply(mine.at[0], length);
    out.words[19] = multiply(mine.at[1], length);
    out.words[20] = height;
    out.words[21] = widened(sizes.at[2]);
    out.words[22] = widened(sizes.at[0]);
    out.words[23] = widened(sizes.at[1]);
  }
};

/// The reference's axes in the world, and the way to the other box, two operands a word.
HWY_INLINE HWY_ATTR void fill_axes(const BoxVector (&world)[3], const BoxVector& offset,
                                   const FacePair& pair, MeetingLanes& out) {
  BoxVector x{}, y{}, z{};
  for (std::size_t k = 0; k < 3; ++k) {
    const BoxVector t =
        turned_to(pair.axis, BoxVector{{world[0].at[k], world[1].at[k], world[2].at[k]}});
    x.at[k] = t.at[0];
    y.at[k] = t.at[1];
    z.at[k] = multiply(t.at[2], pair.sign);
  }
  out.words[28] = pack(x.at[0], x.at[1]);
  out.words[29] = pack(x.at[2], y.at[0]);
  out.words[30] = pack(y.at[1], y.at[2]);
  out.words[31] = pack(z.at[0], z.at[1]);
  out.words[32] = pack(z.at[2], offset.at[0]);
  out.words[33] = pack(offset.at[1], offset.at[2]);
}

HWY_INLINE HWY_ATTR void meet_lanes(const BoxLanes& in, MeetingLanes& out) {
  const Lanes zero = broadcast(0), one = broadcast(1);
  BoxVector centre_a{}, centre_b{};
  BoxVector b_in_a[3]{}, a_in_b[3]{};  // the axes of one along those of the other
  BoxVector b_in_a_size[3]{}, a_in_b_size[3]{};
  for (std::size_t i = 0; i < 3; ++i) {
    centre_a.at[i] = dot(in.axes_a[i], in.offset);
    centre_b.at[i] = dot(in.axes_b[i], in.offset);
    for (std::size_t j = 0; j < 3; ++j) {
      const Lanes cosine = widened(round_shift_low<30>(dot(in.axes_a[i], in.axes_b[j])));
      b_in_a[j].at[i] = a_in_b[i].at[j] = cosine;
      b_in_a_size[j].at[i] = a_in_b_size[i].at[j] = size_of(cosine);
    }
  }
  const BestFace a = best_face(centre_a, in.half_a, b_in_a_size, in.half_b);
  const BestFace b = best_face(centre_b, in.half_b, a_in_b_size, in.half_a);

  // Points below the limit are kept, see `keeps`.
  const Lanes steps = max(multiply(in.margin, broadcast(16)), one);
  const Lanes limit = add(shift_left<26>(subtract(steps, one)), broadcast(std::int64_t{1} << 25));
  const Lanes most = max(a.separation, b.separation);
  out.words[24] = most;
  out.words[25] = select_less(most, limit, zero, one);
  // The second face replaces the first above first + |first|/32 + k_face_margin.
  const Lanes gain =
      subtract(subtract(b.separation, a.separation), broadcast(std::int64_t{1} << 38));
  const Lanes of_b = select_less(size_of(a.separation), shift_left<5>(gain), one, zero);

  FacePair pair{};
  for (std::size_t j = 0; j < 3; ++j)
    pair.rows[j] = choose(of_b, a_in_b[j], b_in_a[j]);
  for (std::size_t i = 0; i < 3; ++i)
    pair.centre.at[i] = choose(of_b, subtract(zero, centre_b.at[i]), centre_a.at[i]);
  pair.half = choose(of_b, in.half_b, in.half_a);
  pair.half_other = choose(of_b, in.half_a, in.half_b);
  pair.axis = choose(of_b, b.axis, a.axis);
  pair.sign = choose(of_b, subtract(zero, sign_of(b.centre)), sign_of(a.centre));
  Lanes opposed;
  pair.fill(out, opposed);

  const Lanes eighth = multiply(turned_to(a.axis, in.half_a).at[2], broadcast(1 << 27));
  out.words[26] = select_less(eighth, subtract(zero, most), zero, one);
  const Lanes inward = select_less(pair.sign, zero, one, zero);
  const Lanes face = add(add(pair.axis, pair.axis), inward);
  out.words[27] = add(add(shift_left<12>(add(of_b, broadcast(2))), shift_left<9>(face)),
                      shift_left<6>(opposed));

  BoxVector world[3]{}, way{};
  for (std::size_t i = 0; i < 3; ++i) {
    world[i] = choose(of_b, in.axes_b[i], in.axes_a[i]);
    way.at[i] = choose(of_b, subtract(zero, in.offset.at[i]), in.offset.at[i]);
  }
  fill_axes(world, way, pair, out);
}

HWY_ATTR void meet_boxes(const BoxSource* sources, FaceMeeting* meetings) {
  constexpr std::size_t stride = sizeof(FaceMeeting) / sizeof(std::int64_t);
  constexpr std::uint32_t in_order[] = {0, 1, 2, 3, 4, 5, 6, 7};
  for (std::size_t first = 0; first < k_box_pairs; first += k_lanes) {
    BoxLanes in{};
    load_source(sources + first, in);
    MeetingLanes out{};
    meet_lanes(in, out);
    std::int64_t* const words = meetings[first].middle.data();
    for (std::size_t i = 0; i < stride; i += 2)
      store_two(out.words[i], out.words[i + 1],
                RecordsAt<std::int64_t>{words + i, in_order, stride});
  }
}

/// Data that all points of a pair share.
struct BoxPlaceLanes {
  BoxVector x{}, y{}, z{}, offset{};
  Lanes twice_height, swapped;
};

HWY_INLINE HWY_ATTR void load_place(const FaceMeeting* meetings, BoxPlaceLanes& out) {
  constexpr std::size_t stride = sizeof(FaceMeeting) / sizeof(std::int64_t);
  constexpr std::uint32_t in_order[] = {0, 1, 2, 3, 4, 5, 6, 7};
  const std::int64_t* const words = meetings->middle.data();
  const auto load_words_at = [&](std::size_t i, Lanes& first, Lanes& second) HWY_ATTR {
    load_two(RecordsAt<const std::int64_t>{words + i, in_order, stride}, first, second);
  };
  Lanes w[6], height, none;
  for (std::size_t i = 0; i < 6; i += 2)
    load_words_at(28 + i, w[i], w[i + 1]);
  load_words_at(20, height, none);
  out.x = {{w[0], upper(w[0]), w[1]}};
  out.y = {{upper(w[1]), w[2], upper(w[2])}};
  out.z = {{w[3], upper(w[3]), w[4]}};
  out.offset = {{upper(w[4]), w[5], upper(w[5])}};
  out.twice_height = shift_left<1>(height);
}

/// Points of as many pairs as there are lanes, rounded as by `FacePoints`.
HWY_INLINE HWY_ATTR void place_lanes(const BoxPlaceLanes& in, const Lanes (&point)[4],
                                     Lanes (&placed)[4]) {
  const Lanes x = round_shift_low<23>(point[0]), y = round_shift_low<23>(point[1]);
  const Lanes separation = widened(round_shift_low<26>(point[2]));
  const Lanes apart = shift_left<1>(point[2]);
  const auto where_apart = [&](Lanes yes, Lanes no)
                               HWY_ATTR { return select_less(broadcast(0), separation, yes, no); };
  const Lanes lift = where_apart(broadcast(0), point[2]);
  const Lanes on_reference = round_shift_low<24>(add(in.twice_height, lift));
  const Lanes on_other = round_shift_low<24>(add(in.twice_height, where_apart(apart, point[2])));
  Lanes a[3], b[3];
  for (std::size_t k = 0; k < 3; ++k) {
    const Lanes beside = multiply_add(multiply(in.x.at[k], x), in.y.at[k], y);
    const Lanes here = round_shift_far<37>(multiply_add(beside, in.z.at[k], on_reference));
    const Lanes there =
        subtract(round_shift_far<37>(multiply_add(beside, in.z.at[k], on_other)), in.offset.at[k]);
    a[k] = choose(in.swapped, there, here);
    b[k] = choose(in.swapped, here, there);
  }
  placed[0] = pack(a[0], a[1]);
  placed[1] = pack(a[2], b[0]);
  placed[2] = pack(b[1], b[2]);
  placed[3] = pack(separation, point[3]);
}

HWY_ATTR void place_points(const FaceMeeting* meetings, const FourPoints* points,
                           const std::int64_t* swapped, FourPlaced* placed) {
  constexpr std::size_t k_from = sizeof(FourPoints) / sizeof(std::int64_t);
  constexpr std::size_t k_to = sizeof(FourPlaced) / sizeof(std::int32_t);
  constexpr std::uint32_t in_order[] = {0, 1, 2, 3, 4, 5, 6, 7};
  for (std::size_t first = 0; first < k_box_pairs; first += k_lanes) {
    BoxPlaceLanes in{};
    load_place(meetings + first, in);
    in.swapped = load(swapped + first);
    for (std::size_t i = 0; i < 4; ++i) {
      const std::int64_t* const from = &points[first][i].x;
      std::int32_t* const to = placed[first][i].words.data();
      Lanes point[4], at[4];
      load_two(RecordsAt<const std::int64_t>{from, in_order, k_from}, point[0], point[1]);
      load_two(RecordsAt<const std::int64_t>{from + 2, in_order, k_from}, point[2], point[3]);
      place_lanes(in, point, at);
      store_two(at[0], at[1], RecordsAt<std::int32_t>{to, in_order, k_to});
      store_two(at[2], at[3], RecordsAt<std::int32_t>{to + 4, in_order, k_to});
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace lockstone::lanes
HWY_AFTER_NAMESPACE();

#endif  // the guard
