// JSON for machines, on the standard output stream.
#pragma once

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace lockstone::tool {

/// Bytes that are no UTF-8, which a file's name may hold, are replaced by U+FFFD.
template <class Json>
void write_json(const Json& json, int indent = 2) {
  fmt::print("{}\n", json.dump(indent, ' ', false, Json::error_handler_t::replace));
}

}  // namespace lockstone::tool
