// Writes and reads the fields that a list visits: integers and enumerations, little-endian.
#pragma once

#include <type_traits>

#include <lockstone/bytes.h>

namespace lockstone::replay {

[[nodiscard]] inline auto put_with(ByteWriter& writer) {
  return [&writer](auto field) { writer.put(field); };
}

/// An enumeration may get a value that it does not name.
[[nodiscard]] inline auto get_with(ByteReader& reader) {
  return [&reader](auto& field) {
    using Field = std::remove_reference_t<decltype(field)>;
    if constexpr (std::is_enum_v<Field>)
      field = static_cast<Field>(reader.get<std::underlying_type_t<Field>>());
    else
      field = reader.get<Field>();
  };
}

}  // namespace lockstone::replay
