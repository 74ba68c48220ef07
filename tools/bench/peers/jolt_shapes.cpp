#include <algorithm>

// clang-format off: it includes the one that must come before their others
#include "tools/bench/peers/jolt_parts.h"
// clang-format on

#include <Jolt/Physics/Collision/Shape/BoxShape.h>
#include <Jolt/Physics/Collision/Shape/CapsuleShape.h>
#include <Jolt/Physics/Collision/Shape/ConvexHullShape.h>
#include <Jolt/Physics/Collision/Shape/MeshShape.h>
#include <Jolt/Physics/Collision/Shape/SphereShape.h>
#include <Jolt/Physics/Collision/Shape/StaticCompoundShape.h>

namespace lockstone::bench::jolt {
namespace {

JPH::ShapeRefC made(const JPH::ShapeSettings& settings) {
  const JPH::ShapeSettings::ShapeResult result = settings.Create();
  return result.IsValid() ? result.Get() : JPH::ShapeRefC();
}

JPH::ShapeRefC hull_of(const GeneralShape& shape) {
  JPH::Array<JPH::Vec3> points;
  for (const Triple& point : shape.points)
    points.push_back(vec(point));
  return made(JPH::ConvexHullShapeSettings(points));
}

JPH::ShapeRefC mesh_of(const GeneralShape& shape) {
  JPH::VertexList vertices;
  for (const Triple& point : shape.points) {
    JPH::Float3 vertex;
    vec(point).StoreFloat3(&vertex);
    vertices.push_back(vertex);
  }
  JPH::IndexedTriangleList triangles;
  const auto index = [](int i) { return static_cast<JPH::uint32>(i); };
  for (const auto& [a, b, c] : shape.triangles)
    triangles.emplace_back(index(a), index(b), index(c));
  return made(JPH::MeshShapeSettings(vertices, triangles));
}

JPH::ShapeRefC convex_of(const GeneralShape& shape, double density) {
  const JPH::Vec3 size = vec(shape.size);
  JPH::ShapeRefC result;
  if (shape.form == Form::sphere) result = new JPH::SphereShape(size.GetX());
  if (shape.form == Form::capsule) result = new JPH::CapsuleShape(size.GetY(), size.GetX());
  if (shape.form == Form::box)
    result = new JPH::BoxShape(size, std::min(0.05F, 0.1F * size.ReduceMin()));
  if (shape.form == Form::hull) result = hull_of(shape);
  if (result != nullptr) {
    auto* convex = static_cast<JPH::ConvexShape*>(const_cast<JPH::Shape*>(result.GetPtr()));
    convex->SetDensity(static_cast<float>(density));
  }
  return result;
}

}  // namespace

JPH::ShapeRefC Shapes::of(const GeneralShape& shape, double density) {
  JPH::ShapeRefC& known = known_[{shape, density}];
  if (known == nullptr)
    known = shape.form == Form::mesh ? mesh_of(shape) : convex_of(shape, density);
  return known;
}

JPH::ShapeRefC Shapes::of_body(const GeneralBody& body) {
  if (body.form != Form::compound) return of(body, body.density);
  JPH::StaticCompoundShapeSettings compound;
  for (const GeneralPart& part : body.parts)
    compound.AddShape(vec(part.position), quat(part.orientation), of(part, body.density));
  return made(compound);
}

}  // namespace lockstone::bench::jolt
