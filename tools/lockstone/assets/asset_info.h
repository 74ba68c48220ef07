// The asset commands' description of an asset.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include <lockstone/asset.h>

namespace lockstone::tool {

/// "hull", "mesh", "height-field" or "compound".
[[nodiscard]] std::string kind_name(ShapeKind kind);

/// Kind, id, counts, bounds (metres) and, for assets that a dynamic body can have, the mass
/// distribution at 1000 kg/m³.
[[nodiscard]] nlohmann::ordered_json asset_json(const std::string& file, const Asset& asset);

/// The same, a line an entry.
void print_asset(const nlohmann::ordered_json& json);

}  // namespace lockstone::tool
