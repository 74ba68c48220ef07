#include "tools/bench/rows/float_rows.h"

#if defined(__SSE2__)

#include <emmintrin.h>

namespace lockstone::bench {
namespace {

// As Highway does with the integer kernels: nothing is left to the compiler's taste.
#define LKS_INLINE inline __attribute__((always_inline))

struct BodyLanes {
  __m128 word[8];  // velocity x, y, z, spin x, y, z, and unused words
};

// Its eight words, through the address of the whole.
LKS_INLINE const float* words_of(const FloatBody& body) {
  return reinterpret_cast<const float*>(&body);
}
LKS_INLINE float* words_of(FloatBody& body) {
  return reinterpret_cast<float*>(&body);
}

LKS_INLINE void load_bodies(const FloatBody* bodies, const std::uint32_t* index, BodyLanes& x) {
  for (int half = 0; half < 2; ++half) {
    __m128* word = x.word + 4 * half;
    for (int lane = 0; lane < 4; ++lane) {
      word[lane] = _mm_load_ps(words_of(bodies[index[lane]]) + 4 * half);
    }
    _MM_TRANSPOSE4_PS(word[0], word[1], word[2], word[3]);
  }
}

LKS_INLINE void store_bodies(BodyLanes x, FloatBody* bodies, const std::uint32_t* index) {
  for (int half = 0; half < 2; ++half) {
    __m128* word = x.word + 4 * half;
    _MM_TRANSPOSE4_PS(word[0], word[1], word[2], word[3]);
    for (int lane = 0; lane < 4; ++lane) {
      _mm_store_ps(words_of(bodies[index[lane]]) + 4 * half, word[lane]);
    }
  }
}

__m128 multiply_add(__m128 sum, const float* a, __m128 b) {
  return _mm_add_ps(sum, _mm_mul_ps(_mm_load_ps(a), b));
}

__m128 multiply_subtract(__m128 sum, const float* a, __m128 b) {
  return _mm_sub_ps(sum, _mm_mul_ps(_mm_load_ps(a), b));
}

LKS_INLINE void solve_point(const FloatBlock& block, FloatPoint& point, BodyLanes& a,
                            BodyLanes& b) {
  __m128 along = _mm_setzero_ps(), of_a = _mm_setzero_ps(), of_b = _mm_setzero_ps();
  for (int i = 0; i < 3; ++i) {
    along = multiply_add(along, block.normal[i], _mm_sub_ps(b.word[i], a.word[i]));
    of_a = multiply_add(of_a, point.read_a[i], a.word[3 + i]);
    of_b = multiply_add(of_b, point.read_b[i], b.word[3 + i]);
  }
  const __m128 v = _mm_add_ps(along, _mm_sub_ps(of_b, of_a));
  const __m128 error = _mm_add_ps(v, _mm_load_ps(point.bias));
  const __m128 old = _mm_load_ps(point.impulse);
  const __m128 kept = _mm_mul_ps(_mm_load_ps(point.keep), old);
  const __m128 total = multiply_subtract(kept, point.mass, error);
  const __m128 impulse = _mm_max_ps(total, _mm_setzero_ps());
  const __m128 change = _mm_sub_ps(impulse, old);
  _mm_store_ps(point.impulse, impulse);
  for (int i = 0; i < 3; ++i) {
    a.word[i] = multiply_subtract(a.word[i], block.gain_a[i], change);
    b.word[i] = multiply_add(b.word[i], block.gain_b[i], change);
    a.word[3 + i] = multiply_subtract(a.word[3 + i], point.gain_a[i], change);
    b.word[3 + i] = multiply_add(b.word[3 + i], point.gain_b[i], change);
  }
}

float single(double x) {
  return static_cast<float>(x);
}

void set_point(const ScenePoint& from, std::size_t lane, FloatPoint& to) {
  for (std::size_t i = 0; i < 3; ++i) {
    to.read_a[i][lane] = single(from.read_a[i]);
    to.read_b[i][lane] = single(from.read_b[i]);
    to.gain_a[i][lane] = single(from.gain_a[i]);
    to.gain_b[i][lane] = single(from.gain_b[i]);
  }
  to.mass[lane] = single(from.mass);
  to.keep[lane] = single(from.keep);
  to.bias[lane] = single(from.bias);
  to.impulse[lane] = single(from.impulse);
}

void set_contact(const SceneContact& from, std::size_t lane, FloatBlock& to) {
  to.body_a[lane] = from.body_a;
  to.body_b[lane] = from.body_b;
  for (std::size_t i = 0; i < 3; ++i) {
    to.normal[i][lane] = single(from.normal[i]);
    to.gain_a[i][lane] = single(from.normal[i] * from.share_a);
    to.gain_b[i][lane] = single(from.normal[i] * from.share_b);
  }
  for (std::size_t k = 0; k < 4; ++k)
    set_point(from.points[k], lane, to.points[k]);
}

}  // namespace

FloatRows::FloatRows(const RowScene& scene)
    : bodies(scene.bodies.size()), blocks(scene.contacts.size() / 4) {
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      bodies[i].velocity[k] = single(scene.bodies[i].velocity[k]);
      bodies[i].spin[k] = single(scene.bodies[i].spin[k]);
    }
  }
  for (std::size_t i = 0; i < scene.contacts.size(); ++i) {
    set_contact(scene.contacts[i], i % 4, blocks[i / 4]);
  }
}

void FloatRows::sweep() {
  for (FloatBlock& block : blocks) {
    BodyLanes a, b;
    load_bodies(bodies.data(), block.body_a, a);
    load_bodies(bodies.data(), block.body_b, b);
    for (FloatPoint& point : block.points)
      solve_point(block, point, a, b);
    store_bodies(a, bodies.data(), block.body_a);
    store_bodies(b, bodies.data(), block.body_b);
  }
}

void FloatRows::sweep_in_twos() {
  for (std::size_t i = 0; i < blocks.size(); i += 2) {
    FloatBlock& block = blocks[i];
    FloatBlock& next = blocks[i + 1];
    BodyLanes a, b, next_a, next_b;
    load_bodies(bodies.data(), block.body_a, a);
    load_bodies(bodies.data(), block.body_b, b);
    load_bodies(bodies.data(), next.body_a, next_a);
    load_bodies(bodies.data(), next.body_b, next_b);
    for (std::size_t k = 0; k < 4; ++k) {
      solve_point(block, block.points[k], a, b);
      solve_point(next, next.points[k], next_a, next_b);
    }
    store_bodies(a, bodies.data(), block.body_a);
    store_bodies(b, bodies.data(), block.body_b);
    store_bodies(next_a, bodies.data(), next.body_a);
    store_bodies(next_b, bodies.data(), next.body_b);
  }
}

}  // namespace lockstone::bench

#endif
