// A listening TCP socket that answers short HTTP requests.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

namespace lockstone::tool {

struct HttpAnswer {
  const char* status = "200 OK";
  const char* type = "text/plain; charset=utf-8";
  std::string body;
};

/// Never blocks, and serves one caller at a time: a silent one gives way to the next.
class MetricsPort {
 public:
  /// Receives the head of a request, such as `GET /metrics HTTP/1.1`.
  using Answerer = std::function<HttpAnswer(std::string_view request)>;

  /// On a numeric IPv4 or IPv6 address. Null, with a complaint, when the system refuses. 0: the
  /// system chooses.
  [[nodiscard]] static std::unique_ptr<MetricsPort> open(std::uint16_t port,
                                                         const std::string& address = "127.0.0.1");
  ~MetricsPort();
  [[nodiscard]] std::uint16_t port() const;

  MetricsPort(const MetricsPort&) = delete;
  MetricsPort& operator=(const MetricsPort&) = delete;

  /// Serves the requests since the last call.
  void serve(const Answerer& answerer);

 private:
  explicit MetricsPort(int socket) : socket_(socket) {}
  void admit_next();
  void read(const Answerer& answerer);
  void write();
  void leave();

  int socket_;
  int client_ = -1;  ///< has connected, and has not yet got its whole answer
  std::string request_;
  std::string answer_;    ///< empty: the request is not yet whole
  std::size_t sent_ = 0;  ///< of the answer
};

}  // namespace lockstone::tool
