#include "tools/arena/state_codec.h"

#include <string>
#include <type_traits>
#include <vector>

#include "tools/arena/rules.h"

namespace lockstone::arena {
namespace {

class Encoder {
 public:
  explicit Encoder(ByteWriter& writer) : writer_(writer) {}

  void record(std::string_view, std::size_t) {}

  template <class T>
  void field(const char*, T value) {
    writer_.put(value);
  }
  void field(const char*, BodyHandle handle) {
    writer_.put(handle.index);
    writer_.put(handle.generation);
  }
  void field(const char*, const Vec3<SolverVelocity>& velocity) {
    for (int axis = 0; axis < 3; ++axis)
      writer_.put(velocity[axis].raw);
  }

 private:
  ByteWriter& writer_;
};

class Decoder {
 public:
  explicit Decoder(ByteReader& reader) : reader_(reader) {}

  void record(std::string_view, std::size_t) {}

  template <class T>
  void field(const char*, T& value) {
    value = reader_.get<T>();
  }
  void field(const char*, BodyHandle& handle) {
    handle.index = reader_.get<std::uint32_t>();
    handle.generation = reader_.get<std::uint32_t>();
  }
  void field(const char*, Vec3<SolverVelocity>& velocity) {
    for (int axis = 0; axis < 3; ++axis)
      velocity[axis].raw = reader_.get<std::int32_t>();
  }

 private:
  ByteReader& reader_;
};

std::string hexadecimal(std::uint64_t value, std::size_t bytes) {
  std::string text(2 + 2 * bytes, '0');
  text[1] = 'x';
  for (std::size_t i = text.size(); i-- > 2; value >>= 4)
    text[i] = "0123456789abcdef"[value & 15];
  return text;
}

/// One field as people read it.
struct Entry {
  std::string_view store;
  std::size_t object;
  std::string field;
  std::string value;
};

class Lister {
 public:
  void record(std::string_view store, std::size_t object) {
    store_ = store;
    object_ = object;
  }

  template <class T>
  void field(const char* name, T value) {
    using Bits = std::make_unsigned_t<T>;
    add(name, hexadecimal(static_cast<Bits>(value), sizeof(T)));
  }
  void field(const char* name, BodyHandle handle) {
    field((std::string(name) + ".index").c_str(), handle.index);
    field((std::string(name) + ".generation").c_str(), handle.generation);
  }
  void field(const char* name, const Vec3<SolverVelocity>& velocity) {
    for (int axis = 0; axis < 3; ++axis)
      field((std::string(name) + '.' + "xyz"[axis]).c_str(), velocity[axis].raw);
  }

  std::vector<Entry> entries;

 private:
  void add(std::string name, std::string value) {
    entries.push_back({store_, object_, std::move(name), std::move(value)});
  }

  std::string_view store_;
  std::size_t object_ = 0;
};

// Values that the rules index with; all others are safe as they come.
bool in_range(const GameState& state, std::size_t players) {
  if (state.game.driver > players) return false;
  for (const PlayerRecord& player : state.players) {
    if (player.rival > players) return false;
    if (player.score > k_max_score || player.score < -k_max_score) return false;
  }
  return true;
}

}  // namespace

void encode_state(const GameState& state, std::size_t players, ByteWriter& writer) {
  Encoder encoder(writer);
  visit_state(state, players, encoder);
}

Result<GameState> decode_state(std::size_t players, ByteReader& reader) {
  GameState state;
  Decoder decoder(reader);
  visit_state(state, players, decoder);
  if (!reader.ok()) return Status::truncated;
  if (!in_range(state, players)) return Status::malformed;
  return state;
}

StateDifference first_difference(const GameState& here, const GameState& there,
                                 std::size_t players) {
  Lister left, right;
  visit_state(here, players, left);
  visit_state(there, players, right);
  for (std::size_t i = 0; i < left.entries.size(); ++i) {
    const Entry& a = left.entries[i];
    const Entry& b = right.entries[i];
    if (a.value == b.value) continue;
    return {true, std::string(a.store), a.object, {}, a.field, a.value, b.value};
  }
  return {};
}

}  // namespace lockstone::arena
