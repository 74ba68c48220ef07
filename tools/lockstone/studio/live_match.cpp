#include "tools/lockstone/studio/live_match.h"

#include <algorithm>

namespace lockstone::tool {
namespace {

bool is_of_host(char letter) {
  return (letter >= '0' && letter <= '9') || (letter >= 'a' && letter <= 'z') ||
         (letter >= 'A' && letter <= 'Z') ||
         std::string_view(".-:[]").find(letter) != std::string_view::npos;
}

}  // namespace

std::optional<std::string> origin_of(std::string_view address) {
  std::string origin = "ws://";
  for (const std::string_view scheme : {"ws://", "wss://"}) {
    if (!address.starts_with(scheme)) continue;
    origin = scheme;
    address.remove_prefix(scheme.size());
    break;
  }
  if (address.ends_with('/')) address.remove_suffix(1);
  if (address.empty() || !std::ranges::all_of(address, is_of_host)) return std::nullopt;
  return origin.append(address);
}

std::optional<WatchedWorld> watched_world_of(std::string_view address) {
  const std::size_t slash = address.rfind('/');
  if (slash == std::string_view::npos || address.ends_with("//")) return std::nullopt;
  const std::string_view token = address.substr(slash + 1);
  const auto is_digit = [](char letter) {
    return std::string_view("0123456789abcdef").find(letter) != std::string_view::npos;
  };
  const std::optional<std::string> origin = origin_of(address.substr(0, slash));
  if (!origin || token.empty() || !std::ranges::all_of(token, is_digit)) return std::nullopt;
  return WatchedWorld{*origin, std::string(token)};
}

}  // namespace lockstone::tool
