// Serves files from memory to the browser on this machine, and to nobody else.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>

namespace lockstone::tool {

/// A file as it is sent.
struct ServedFile {
  std::string type;  ///< of its content: "text/html; charset=utf-8"
  std::string bytes;
  bool compressed = false;  ///< by gzip
};

/// By path below the token: "index.html".
using ServedFiles = std::map<std::string, ServedFile, std::less<>>;

/// Listens on 127.0.0.1 alone. Files stand below a random token, so that no other page and no other
/// user of the machine can guess an address; a browser may neither keep them, nor load anything
/// that is not among them (content security policy).
class PageServer {
 public:
  /// Port 0: the system chooses. The page may also connect to `origin`, like "ws://host:9000";
  /// empty: to nobody else. Null, with a complaint, when the system refuses.
  [[nodiscard]] static std::unique_ptr<PageServer> open(std::uint16_t port, ServedFiles files,
                                                        std::string_view origin);
  ~PageServer();
  PageServer(const PageServer&) = delete;
  PageServer& operator=(const PageServer&) = delete;

  /// The address of index.html.
  [[nodiscard]] const std::string& address() const;

  /// Serves requests until Ctrl-C or SIGTERM.
  void run();

  struct Parts;

 private:
  explicit PageServer(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace lockstone::tool
