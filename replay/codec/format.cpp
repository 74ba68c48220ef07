#include <lockstone/replay/format.h>

namespace lockstone::replay {

std::string_view to_string(ChunkType type) {
  switch (type) {
    case ChunkType::none:
      return "file header";
    case ChunkType::scene:
      return "SCENE";
    case ChunkType::input:
      return "INPUT";
    case ChunkType::hash:
      return "HASH";
    case ChunkType::keyframe:
      return "KEYFRAME";
    case ChunkType::event:
      return "EVENT";
    case ChunkType::diag:
      return "DIAG";
    case ChunkType::index:
      return "INDEX";
    case ChunkType::end:
      return "END";
    case ChunkType::signature:
      return "SIGNATURE";
    case ChunkType::command:
      return "COMMAND";
  }
  return "chunk";
}

std::string_view to_string(Codec codec) {
  if (codec == Codec::raw) return "raw";
  return codec == Codec::zstd ? "zstd" : "unknown";
}

std::string_view to_string(EventKind kind) {
  switch (kind) {
    case EventKind::join:
      return "join";
    case EventKind::leave:
      return "leave";
    case EventKind::substitution:
      return "substitution";
    case EventKind::note:
      return "note";
    case EventKind::name:
      return "name";
  }
  return "event";
}

std::string_view to_string(EndKind kind) {
  switch (kind) {
    case EndKind::finished:
      return "finished";
    case EndKind::cut:
      return "cut";
    case EndKind::repaired:
      return "repaired";
  }
  return "end";
}

}  // namespace lockstone::replay
