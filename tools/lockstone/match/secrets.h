// Files with keys and tokens.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <lockstone/net/keys.h>
#include <lockstone/net/token.h>

namespace lockstone::tool {

/// Nothing, with a complaint, when the file cannot be read or holds something else.
[[nodiscard]] std::optional<net::Key> read_key(const std::string& path);
[[nodiscard]] std::optional<net::ConnectToken> read_token(const std::string& path);

/// A new file that only its owner can read. False, with a complaint, when there is one already.
[[nodiscard]] bool write_secret_file(const std::string& path, const std::string& text);

/// Seconds and microseconds since 1970, by the system's clock.
[[nodiscard]] std::uint64_t unix_seconds();
[[nodiscard]] std::int64_t unix_microseconds();

/// True, or a complaint that this build cannot encrypt.
[[nodiscard]] bool require_security();

/// A folder of this process alone, gone with all that is in it at the end.
class PrivateFolder {
 public:
  PrivateFolder();
  ~PrivateFolder();
  PrivateFolder(const PrivateFolder&) = delete;
  PrivateFolder& operator=(const PrivateFolder&) = delete;

  /// Empty when the system refused.
  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace lockstone::tool
