#include <array>
#include <vector>

#include <lockstone/hash.h>
#include <lockstone/testing/floating.h>

#include "tools/bench/queries/query_engine.h"

namespace lockstone::bench {
namespace {

constexpr std::size_t k_most_found = 1024;  // more than any row of the scenes finds

std::uint32_t counted(std::size_t found) {
  LKS_CHECK(found < k_most_found);
  return static_cast<std::uint32_t>(found);
}

// `ask(question, answer)` for each question of a row.
template <class Question, class Ask>
void ask_each(const std::vector<Question>& questions, std::span<QueryAnswer> out, Ask&& ask) {
  for (std::size_t i = 0; i < questions.size(); ++i)
    out[i] = ask(questions[i]);
}

class LockstoneEngine final : public QueryEngine {
 public:
  explicit LockstoneEngine(const World& world) : world_(world) {}

  [[nodiscard]] std::string name() const override { return "lockstone"; }

  bool answer(const QueryRow& row, std::span<QueryAnswer> out) override {
    switch (row.kind) {
      case QueryKind::closest_ray:
        ask_each(row.rays, out, [&](const Ray& ray) { return closest(ray); });
        return true;
      case QueryKind::blocked_ray:
        ask_each(row.rays, out, [&](const Ray& ray) { return blocked(ray); });
        return true;
      case QueryKind::all_rays:
        ask_each(row.rays, out, [&](const Ray& ray) { return all(ray); });
        return true;
      case QueryKind::overlap:
        ask_each(row.poses, out, [&](const Transform& pose) { return overlap(row.shape, pose); });
        return true;
      case QueryKind::point:
        ask_each(row.rays, out, [&](const Ray& ray) { return point(ray); });
        return true;
      case QueryKind::near_point:
        ask_each(row.rays, out, [&](const Ray& ray) { return near(ray, row.reach); });
        return true;
      case QueryKind::closest_cast:
        for (std::size_t i = 0; i < row.size(); ++i)
          out[i] = closest(row.cast(i));
        return true;
    }
    return false;
  }

 private:
  QueryAnswer closest(const Ray& ray) const {
    const RayHit hit = world_.cast_ray(ray.origin, ray.translation);
    if (hit.body.is_null()) return {};
    return {1, hit.body.index, testing::to_double(hit.fraction)};
  }

  QueryAnswer closest(const ShapeCast& cast) const {
    const ShapeHit hit = world_.cast_shape(cast);
    if (hit.body.is_null()) return {};
    return {1, hit.body.index, testing::to_double(hit.fraction)};
  }

  QueryAnswer blocked(const Ray& ray) const {
    return {world_.is_ray_blocked(ray.origin, ray.translation) ? 1U : 0U};
  }

  QueryAnswer all(const Ray& ray) {
    return {counted(world_.cast_ray_all(ray.origin, ray.translation, hits_))};
  }

  QueryAnswer overlap(const Shape& shape, const Transform& pose) {
    if (shape.kind == ShapeKind::sphere)
      return {counted(world_.overlap_sphere(pose.position, shape.size.x, bodies_))};
    return {counted(world_.overlap_shape(shape, pose, bodies_))};
  }

  QueryAnswer point(const Ray& ray) { return {counted(world_.bodies_at(ray.origin, bodies_))}; }

  QueryAnswer near(const Ray& ray, Length reach) const {
    const ClosestHit hit = world_.closest_point(ray.origin, reach);
    if (hit.body.is_null()) return {};
    return {1, hit.body.index, testing::to_double(hit.distance)};
  }

  const World& world_;
  std::array<RayHit, k_most_found> hits_{};
  std::array<BodyHandle, k_most_found> bodies_{};
};

// Numbers in a row, hashed as little-endian bytes.
class Digest {
 public:
  void add(std::int64_t value) {
    std::array<std::byte, 16> bytes{};
    ByteWriter writer(bytes);
    writer.put(hash_);
    writer.put(value);
    hash_ = hash64(writer.written());
  }

  template <class Hit>  // RayHit, ShapeHit
  void add_hit(const Hit& hit) {
    add(hit.body.index);
    add(hit.body.generation);
    add(hit.fraction.raw);
    for (int i = 0; i < 3; ++i)
      add(hit.normal[i].raw), add(hit.point[i].raw);
  }

  void add(const ClosestHit& hit) {
    add(hit.body.index);
    add(hit.body.generation);
    add(hit.distance.raw);
    for (int i = 0; i < 3; ++i)
      add(hit.point[i].raw);
  }

  void add(std::span<const BodyHandle> bodies) {
    for (const BodyHandle body : bodies)
      add(body.index);
    add(static_cast<std::int64_t>(bodies.size()));
  }

  [[nodiscard]] std::uint64_t value() const { return hash_; }

 private:
  std::uint64_t hash_ = 0;
};

void add_answers_of_ray(const World& world, const QueryRow& row, const Ray& ray, Digest& digest) {
  const QueryKind kind = row.kind;
  std::vector<RayHit> hits(k_most_found);
  std::vector<BodyHandle> bodies(k_most_found);
  if (kind == QueryKind::closest_ray)
    return digest.add_hit(world.cast_ray(ray.origin, ray.translation));
  if (kind == QueryKind::blocked_ray)
    return digest.add(world.is_ray_blocked(ray.origin, ray.translation) ? 1 : 0);
  if (kind == QueryKind::near_point) return digest.add(world.closest_point(ray.origin, row.reach));
  if (kind == QueryKind::point)
    return digest.add(std::span(bodies).first(world.bodies_at(ray.origin, bodies)));
  const std::size_t count = world.cast_ray_all(ray.origin, ray.translation, hits);
  for (const RayHit& hit : std::span(hits).first(count))
    digest.add_hit(hit);
  digest.add(static_cast<std::int64_t>(count));
}

}  // namespace

std::unique_ptr<QueryEngine> make_lockstone_engine(const World& world) {
  return std::make_unique<LockstoneEngine>(world);
}

std::uint64_t hash_of_answers(const World& world, const QueryRow& row) {
  Digest digest;
  std::vector<BodyHandle> bodies(k_most_found);
  for (std::size_t i = 0; i < row.size(); ++i) {
    if (row.kind == QueryKind::closest_cast)
      digest.add_hit(world.cast_shape(row.cast(i)));
    else if (row.kind == QueryKind::overlap)
      digest.add(std::span(bodies).first(world.overlap_shape(row.shape, row.poses[i], bodies)));
    else
      add_answers_of_ray(world, row, row.rays[i], digest);
  }
  return digest.value();
}

}  // namespace lockstone::bench
