// Poses to draw, for the npm package.
#include <algorithm>
#include <cmath>

#include <lockstone/world.h>

#include "tools/bindings/c/convert.h"
#include "tools/bindings/c/handles.h"
#include "tools/web/native/lockstone_web.h"

namespace {

using namespace lockstone;
using namespace lockstone::c;

// a - b in metres, exact in integers before it becomes a float.
float metres(Position a, Position b) {
  return static_cast<float>(static_cast<double>((a - b).raw) * 0x1p-32);
}

float unit(Unit value) {
  return static_cast<float>(value.raw) * 0x1p-30F;
}

void write_pose(const Transform& pose, const Vec3<Position>& origin, float* position,
                float* orientation) {
  position[0] = metres(pose.position.x, origin.x);
  position[1] = metres(pose.position.y, origin.y);
  position[2] = metres(pose.position.z, origin.z);
  orientation[0] = unit(pose.orientation.x);
  orientation[1] = unit(pose.orientation.y);
  orientation[2] = unit(pose.orientation.z);
  orientation[3] = unit(pose.orientation.w);
}

float square_between(const float* a, const float* b) {
  const float x = b[0] - a[0], y = b[1] - a[1], z = b[2] - a[2];
  return x * x + y * y + z * z;
}

// The chord between both rotations, made a unit again: near the arc for the turn of one tick.
void blend_turn(const float* before, const float* now, float fraction, float* out) {
  float dot = 0;
  for (int i = 0; i < 4; ++i)
    dot += before[i] * now[i];
  const float weight = dot < 0 ? fraction - 1 : 1 - fraction;
  float square = 0;
  for (int i = 0; i < 4; ++i) {
    out[i] = weight * before[i] + fraction * now[i];
    square += out[i] * out[i];
  }
  const float scale = 1 / std::sqrt(square);
  for (int i = 0; i < 4; ++i)
    out[i] *= scale;
}

}  // namespace

lks_status lks_web_poses(const lks_world* world, const lks_position3* origin, lks_body* bodies,
                         float* positions, float* orientations, uint32_t rows, uint32_t* used) {
  return call([&] {
    const World& source = read(world);
    const Vec3<Position> from = vec<Position>(required(origin, "origin"));
    const std::uint32_t limit = source.body_limit();
    required(used, "used") = limit;
    if (limit > rows) throw_status(LKS_BUFFER_TOO_SMALL, "there are more bodies than rows");
    for (std::uint32_t row = 0; row < limit; ++row) {
      const BodyHandle body = source.body_at(row);
      bodies[row] = body.is_null() ? 0 : id_of(body);
      if (body.is_null()) continue;
      write_pose(pose_of(source, body), from, positions + std::size_t{3} * row,
                 orientations + std::size_t{4} * row);
    }
    std::fill(bodies + limit, bodies + rows, lks_body{0});
  });
}

void lks_web_blend(const lks_web_poses_at* before, const lks_web_poses_at* now, float fraction,
                   float snap, uint32_t rows, float* positions, float* orientations) {
  for (std::size_t row = 0; row < rows; ++row) {
    if (now->bodies[row] == 0) continue;
    const float *from = before->positions + 3 * row, *to = now->positions + 3 * row;
    const float* turned = now->orientations + 4 * row;
    const bool leaps =
        before->bodies[row] != now->bodies[row] || square_between(from, to) > snap * snap;
    for (std::size_t i = 0; i < 3; ++i)
      positions[3 * row + i] = leaps ? to[i] : from[i] + (to[i] - from[i]) * fraction;
    if (leaps)
      std::copy(turned, turned + 4, orientations + 4 * row);
    else
      blend_turn(before->orientations + 4 * row, turned, fraction, orientations + 4 * row);
  }
}
