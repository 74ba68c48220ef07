// UTF-8, for texts from outside that are to be printed and put into JSON: names and notes.
#pragma once

#include <cstddef>
#include <string_view>

#include <lockstone/bytes.h>

namespace lockstone {

/// Bytes of the character that `text` begins with, 1 … 4; 0 where it begins with none, or with a
/// control character (below U+0020, or U+007F). Source: RFC 3629, section 4.
[[nodiscard]] std::size_t character_bytes(ByteView text);

/// Whether all of it is such characters.
[[nodiscard]] bool is_text(ByteView bytes);

/// Writes all bytes of `text`, '?' for each that is part of no such character.
void put_as_text(ByteWriter& writer, std::string_view text);

}  // namespace lockstone
