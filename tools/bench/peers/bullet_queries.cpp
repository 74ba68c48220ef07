// The query scene in Bullet: a collision world with the same shapes at the same places.
//
// Rays are cast as the manual shows, by result callbacks with default flags; the broad phase is the
// dynamic tree, built again from the top before anything is asked. Overlaps go through contactTest.

#include <set>
#include <string>
#include <vector>

#include <BulletCollision/NarrowPhaseCollision/btRaycastCallback.h>
#include <btBulletCollisionCommon.h>

#include <lockstone/testing/floating.h>

#include "tools/bench/peers/peers.h"

namespace lockstone::bench {
namespace {

template <class Quantity>
btScalar scalar(Quantity value) {
  return static_cast<btScalar>(testing::to_double(value));
}

template <class Quantity>
btVector3 vector(const Vec3<Quantity>& v) {
  return {scalar(v.x), scalar(v.y), scalar(v.z)};
}

btTransform transform(const Transform& t) {
  const Quat& q = t.orientation;
  const btQuaternion turn(scalar(q.x), scalar(q.y), scalar(q.z), scalar(q.w));
  return btTransform(turn, vector(t.position));
}

std::unique_ptr<btConvexShape> convex_hull(AssetId id, const QueryScene& scene) {
  for (const auto& hull : scene.hulls) {
    if (hull->id() != id) continue;
    auto shape = std::make_unique<btConvexHullShape>();
    for (const Vec3<Length>& vertex : hull->vertices())
      shape->addPoint(vector(vertex), false);
    shape->recalcLocalAabb();
    shape->setMargin(0);
    return shape;
  }
  return nullptr;
}

// Null for a shape that is not convex.
std::unique_ptr<btConvexShape> convex_shape(const Shape& shape, const QueryScene* scene) {
  const Vec3<Length>& size = shape.size;
  switch (shape.kind) {
    case ShapeKind::sphere:
      return std::make_unique<btSphereShape>(scalar(size.x));
    case ShapeKind::capsule:  // Bullet wants the whole length of the core segment
      return std::make_unique<btCapsuleShape>(scalar(size.x), 2 * scalar(size.y));
    case ShapeKind::box:
      return std::make_unique<btBoxShape>(vector(size));
    case ShapeKind::hull:
      return scene == nullptr ? nullptr : convex_hull(shape.asset, *scene);
    default:
      return nullptr;
  }
}

std::uint32_t index_of(const btCollisionObject& object) {
  return static_cast<std::uint32_t>(object.getUserIndex());
}

// Stops at the first body: Bullet ends a ray whose closest fraction is 0.
struct AnyRayCallback : btCollisionWorld::RayResultCallback {
  btScalar addSingleResult(btCollisionWorld::LocalRayResult& result, bool) override {
    m_collisionObject = result.m_collisionObject;
    m_closestHitFraction = 0;
    return 0;
  }
};

// Counts bodies with a point of contact that does not lie apart.
struct OverlapCallback : btCollisionWorld::ContactResultCallback {
  std::set<const btCollisionObject*> found;

  btScalar addSingleResult(btManifoldPoint& point, const btCollisionObjectWrapper* a, int, int,
                           const btCollisionObjectWrapper* b, int, int) override {
    if (point.getDistance() > 0) return 0;
    const btCollisionObject* first = a->getCollisionObject();
    found.insert(first->getUserIndex() < 0 ? b->getCollisionObject() : first);
    return 0;
  }
};

class BulletEngine final : public QueryEngine {
 public:
  BulletEngine()
      : dispatcher_(&configuration_), world_(&dispatcher_, &broad_phase_, &configuration_) {}

  ~BulletEngine() override {
    for (const auto& object : objects_)
      world_.removeCollisionObject(object.get());
  }

  // False for a shape that has no counterpart here.
  bool add(const QueryBody& body, const QueryScene& scene) {
    std::unique_ptr<btCollisionShape> shape = convex_shape(body.shape, &scene);
    if (body.shape.kind == ShapeKind::mesh) shape = terrain(scene);
    if (shape == nullptr) return false;
    auto object = std::make_unique<btCollisionObject>();
    object->setCollisionShape(shape.get());
    object->setWorldTransform(transform(body.pose));
    object->setUserIndex(static_cast<int>(objects_.size()));
    if (body.is_static) object->setCollisionFlags(btCollisionObject::CF_STATIC_OBJECT);
    world_.addCollisionObject(object.get());
    shapes_.push_back(std::move(shape));
    objects_.push_back(std::move(object));
    return true;
  }

  void finish() {
    world_.updateAabbs();
    broad_phase_.optimize();
  }

  [[nodiscard]] std::string name() const override {
    const int version = btGetVersion();
    const char* precision = sizeof(btScalar) == sizeof(double) ? "d" : "f";
    return "Bullet " + std::to_string(version / 100) + "." + std::to_string(version % 100) +
           precision;
  }

  bool answer(const QueryRow& row, std::span<QueryAnswer> out) override {
    switch (row.kind) {
      case QueryKind::closest_ray:
        return ask_rays(row, out, [this](const Ray& ray) { return closest(ray); });
      case QueryKind::blocked_ray:
        return ask_rays(row, out, [this](const Ray& ray) { return blocked(ray); });
      case QueryKind::all_rays:
        return ask_rays(row, out, [this](const Ray& ray) { return all(ray); });
      case QueryKind::overlap:
        return ask_overlaps(row, out);
      case QueryKind::closest_cast:
        return ask_casts(row, out);
      case QueryKind::point:
      case QueryKind::near_point:
        return false;  // it has none
    }
    return false;
  }

 private:
  template <class Ask>
  static bool ask_rays(const QueryRow& row, std::span<QueryAnswer> out, Ask&& ask) {
    for (std::size_t i = 0; i < row.rays.size(); ++i)
      out[i] = ask(row.rays[i]);
    return true;
  }

  bool ask_overlaps(const QueryRow& row, std::span<QueryAnswer> out) {
    const std::unique_ptr<btConvexShape> shape = convex_shape(row.shape, nullptr);
    if (shape == nullptr) return false;
    btCollisionObject probe;
    probe.setCollisionShape(shape.get());
    for (std::size_t i = 0; i < row.poses.size(); ++i) {
      probe.setWorldTransform(transform(row.poses[i]));
      OverlapCallback callback;
      world_.contactTest(&probe, callback);
      out[i] = {static_cast<std::uint32_t>(callback.found.size())};
    }
    return true;
  }

  bool ask_casts(const QueryRow& row, std::span<QueryAnswer> out) const {
    const std::unique_ptr<btConvexShape> shape = convex_shape(row.shape, nullptr);
    if (shape == nullptr) return false;
    for (std::size_t i = 0; i < row.size(); ++i) {
      const btTransform from = transform(row.poses[i]);
      btTransform to = from;
      to.setOrigin(end_of(row.rays[i]));
      btCollisionWorld::ClosestConvexResultCallback callback(from.getOrigin(), to.getOrigin());
      world_.convexSweepTest(shape.get(), from, to, callback);
      out[i] = {};
      if (callback.hasHit())
        out[i] = {1, index_of(*callback.m_hitCollisionObject),
                  static_cast<double>(callback.m_closestHitFraction)};
    }
    return true;
  }

  std::unique_ptr<btCollisionShape> terrain(const QueryScene& scene) {
    for (const TriangleIndices& t : scene.terrain)
      terrain_.addTriangle(vector(scene.terrain_vertices[t.a]), vector(scene.terrain_vertices[t.b]),
                           vector(scene.terrain_vertices[t.c]));
    auto shape = std::make_unique<btBvhTriangleMeshShape>(&terrain_, true);
    shape->setMargin(0);
    return shape;
  }

  template <class Callback>
  void cast(const btVector3& from, const btVector3& to, Callback& callback) const {
    callback.m_flags |= btTriangleRaycastCallback::kF_FilterBackfaces;  // as ours
    world_.rayTest(from, to, callback);
  }

  static btVector3 end_of(const Ray& ray) { return vector(ray.origin) + vector(ray.translation); }

  QueryAnswer closest(const Ray& ray) const {
    const btVector3 from = vector(ray.origin), to = end_of(ray);
    btCollisionWorld::ClosestRayResultCallback callback(from, to);
    cast(from, to, callback);
    if (!callback.hasHit()) return {};
    return {1, index_of(*callback.m_collisionObject),
            static_cast<double>(callback.m_closestHitFraction)};
  }

  QueryAnswer blocked(const Ray& ray) const {
    AnyRayCallback callback;
    cast(vector(ray.origin), end_of(ray), callback);
    return {callback.hasHit() ? 1U : 0U};
  }

  QueryAnswer all(const Ray& ray) const {
    const btVector3 from = vector(ray.origin), to = end_of(ray);
    btCollisionWorld::AllHitsRayResultCallback callback(from, to);
    cast(from, to, callback);
    return {static_cast<std::uint32_t>(callback.m_collisionObjects.size())};
  }

  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btDbvtBroadphase broad_phase_;
  btTriangleMesh terrain_;
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btCollisionObject>> objects_;
  btCollisionWorld world_;
};

}  // namespace

std::unique_ptr<QueryEngine> make_bullet_engine(const QueryScene& scene) {
  auto engine = std::make_unique<BulletEngine>();
  for (const QueryBody& body : scene.bodies) {
    if (!engine->add(body, scene)) return nullptr;
  }
  engine->finish();
  return engine;
}

}  // namespace lockstone::bench
