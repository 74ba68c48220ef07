// The page of the studio, embedded when this program was built.
#pragma once

#include <span>
#include <string_view>

namespace lockstone::tool {

/// A file of the page, compressed by gzip.
struct PageFile {
  std::string_view name;
  std::string_view bytes;
};

[[nodiscard]] std::span<const PageFile> page_files();

}  // namespace lockstone::tool
