// One file that holds several: the POSIX ustar format, which every `tar` unpacks.
#pragma once

#include <string>
#include <vector>

#include <lockstone/bytes.h>

namespace lockstone::tool {

struct TarEntry {
  std::string name;  ///< at most 99 characters
  std::vector<std::byte> bytes;
};

/// The archive's bytes. Nothing in it but names and contents: the same entries give the same bytes.
[[nodiscard]] std::vector<std::byte> make_tar(const std::vector<TarEntry>& entries);

/// The files of an archive from anywhere, up to its end or the first header that is none.
[[nodiscard]] std::vector<TarEntry> read_tar(ByteView archive);

}  // namespace lockstone::tool
