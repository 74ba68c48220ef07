// Hashes and snapshots.
#include <algorithm>
#include <vector>

#include "tools/bindings/c/convert.h"
#include "tools/bindings/c/handles.h"

namespace {

using namespace lockstone;
using namespace lockstone::c;

static_assert(LKS_NATIVE == static_cast<int>(SnapshotKind::native) &&
              LKS_CANONICAL == static_cast<int>(SnapshotKind::canonical));

SnapshotKind kind_of(std::uint32_t kind) {
  return enumerator(kind, SnapshotKind::native, SnapshotKind::canonical, "kind");
}

ByteView bytes_of(const void* bytes, std::size_t count, const char* name) {
  return {static_cast<const std::byte*>(array(bytes, count, name)), count};
}

std::size_t bytes_max(const lks_world& world, SnapshotKind kind) {
  return world.scene ? world.scene->simulation().snapshot_bytes_max(kind)
                     : world.own->snapshot_bytes_max(kind);
}

// A simulation demands room for the largest state there can be; a world only for this one.
std::size_t save_scene(const Simulation& scene, SnapshotKind kind, std::span<std::byte> out) {
  const std::size_t most = scene.snapshot_bytes_max(kind);
  if (out.size() >= most) return scene.save(kind, out.first(most));
  std::vector<std::byte> room(most);
  const std::size_t bytes = scene.save(kind, room);
  if (bytes > out.size()) return 0;
  std::ranges::copy(std::span(room).first(bytes), out.begin());
  return bytes;
}

}  // namespace

lks_status lks_hash(const lks_world* world, uint64_t* out) {
  return call([&] {
    const lks_world& source = handle(world);
    required(out, "out") =
        source.scene ? source.scene->simulation().hash() : source.world().hash().total;
  });
}

lks_status lks_part_hashes(const lks_world* world, lks_hashes* out) {
  return call([&] {
    const StateHash hash = read(world).hash();
    required(out, "out") = {hash.total, hash.header, hash.bodies, hash.contacts, hash.joints};
  });
}

lks_status lks_snapshot_bytes_max(const lks_world* world, uint32_t kind, size_t* out) {
  return call([&] {
    const lks_world& source = saved(world);
    required(out, "out") = bytes_max(source, kind_of(kind));
  });
}

lks_status lks_save(const lks_world* world, uint32_t kind, void* out, size_t capacity,
                    size_t* bytes) {
  return call([&] {
    const lks_world& source = saved(world);
    const SnapshotKind form = kind_of(kind);
    required(bytes, "bytes");
    const std::span room(static_cast<std::byte*>(array(out, capacity, "out")), capacity);
    const std::size_t written = source.scene ? save_scene(source.scene->simulation(), form, room)
                                             : source.own->save(form, room);
    *bytes = written > 0 ? written : bytes_max(source, form);
    if (written == 0) throw_status(LKS_BUFFER_TOO_SMALL, "the snapshot does not fit");
  });
}

lks_status lks_load(lks_world* world, uint32_t kind, const void* bytes, size_t count) {
  return call([&] {
    static_cast<void>(saved(&required(world, "world")));
    const SnapshotKind form = kind_of(kind);
    const ByteView state = bytes_of(bytes, count, "bytes");
    const Status status =
        world->scene ? world->scene->simulation().load(form, state) : world->own->load(form, state);
    if (status != Status::ok) throw_failure(status);
  });
}

lks_status lks_describe_difference(const lks_world* world, const void* here, size_t here_bytes,
                                   const void* there, size_t there_bytes, uint32_t* differs,
                                   char* text, size_t capacity) {
  return call([&] {
    const lks_world& source = saved(world);
    const ByteView left = bytes_of(here, here_bytes, "here");
    const ByteView right = bytes_of(there, there_bytes, "there");
    array(text, capacity, "text");
    const StateDifference found = source.scene ? source.scene->simulation().describe(left, right)
                                               : source.own->describe_difference(left, right);
    required(differs, "differs") = found.differs ? 1 : 0;
    write_text(found.to_line(), text, capacity);
  });
}
