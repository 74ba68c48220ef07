#include "tools/lockstone/studio/page_server.h"

#include <algorithm>
#include <array>
#include <string_view>

#include <fmt/format.h>
#include <libwebsockets.h>

#include "tools/lockstone/support/console.h"
#include "tools/lockstone/support/interrupt.h"
#include "tools/watch/random_token.h"

namespace lockstone::tool {

namespace {

constexpr std::size_t k_piece_bytes = 64 * 1024;
constexpr int k_service_ms = 100;  // between looks for Ctrl-C

// WebAssembly is compiled in the page; all but a match comes from this server.
std::string policy_with(std::string_view origin) {
  std::string policy =
      "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; style-src 'self'; img-src 'self' "
      "blob:; worker-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'; "
      "connect-src 'self' ";
  return policy.append(origin);
}

/// The answer that is being sent to one browser's request.
struct Sending {
  const ServedFile* file;
  std::size_t sent;
};

}  // namespace

struct PageServer::Parts {
  ServedFiles files;
  std::string token = watch::random_token();
  std::string host;  // as a browser must name it
  std::string address;
  std::string policy;
  lws_context* context = nullptr;

  ~Parts() {
    if (context != nullptr) lws_context_destroy(context);
  }

  [[nodiscard]] const ServedFile* find(std::string_view path) const {
    const std::string root = '/' + token + '/';
    if (!path.starts_with(root)) return nullptr;
    path.remove_prefix(root.size());
    const auto found = files.find(path.empty() ? std::string_view("index.html") : path);
    return found == files.end() ? nullptr : &found->second;
  }
};

namespace {

std::string header_of(lws* connection, lws_token_indexes which) {
  std::array<char, 256> text{};
  const int length = lws_hdr_copy(connection, text.data(), static_cast<int>(text.size()), which);
  return length > 0 ? std::string(text.data(), static_cast<std::size_t>(length)) : std::string();
}

/// Writes the head of an answer.
class Head {
 public:
  explicit Head(lws* connection) : connection_(connection) {}

  bool begin(const ServedFile& file) {
    return lws_add_http_common_headers(connection_, HTTP_STATUS_OK, file.type.c_str(),
                                       file.bytes.size(), &at_, end()) == 0;
  }
  bool add(const char* name, std::string_view value) {
    const auto* letters = reinterpret_cast<const unsigned char*>(name);
    const auto* text = reinterpret_cast<const unsigned char*>(value.data());
    return lws_add_http_header_by_name(connection_, letters, text, static_cast<int>(value.size()),
                                       &at_, end()) == 0;
  }
  bool send() {
    return lws_finalize_write_http_header(connection_, room_.data() + LWS_PRE, &at_, end()) == 0;
  }

 private:
  [[nodiscard]] unsigned char* end() { return room_.data() + room_.size() - 1; }

  lws* connection_;
  std::array<unsigned char, LWS_PRE + 2048> room_{};
  unsigned char* at_ = room_.data() + LWS_PRE;
};

bool send_head(lws* connection, const ServedFile& file, std::string_view policy) {
  Head head(connection);
  if (!head.begin(file)) return false;
  if (file.compressed && !head.add("content-encoding:", "gzip")) return false;
  return head.add("content-security-policy:", policy) && head.add("cache-control:", "no-store") &&
         head.add("x-content-type-options:", "nosniff") &&
         head.add("referrer-policy:", "no-referrer") &&
         head.add("cross-origin-opener-policy:", "same-origin") &&
         head.add("cross-origin-embedder-policy:", "require-corp") &&
         head.add("cross-origin-resource-policy:", "same-origin") && head.send();
}

int refuse(lws* connection) {
  lws_return_http_status(connection, HTTP_STATUS_NOT_FOUND, nullptr);
  return lws_http_transaction_completed(connection);
}

// A page of another site that resolves its own name to this machine says that name as the host.
bool is_allowed(lws* connection, const PageServer::Parts& parts) {
  return lws_hdr_total_length(connection, WSI_TOKEN_GET_URI) > 0 &&
         header_of(connection, WSI_TOKEN_HOST) == parts.host;
}

int begin_answer(lws* connection, const PageServer::Parts& parts, Sending& sending) {
  if (!is_allowed(connection, parts)) return refuse(connection);
  const ServedFile* file = parts.find(header_of(connection, WSI_TOKEN_GET_URI));
  if (file == nullptr) return refuse(connection);
  sending = {file, 0};
  if (!send_head(connection, *file, parts.policy)) return -1;
  lws_callback_on_writable(connection);
  return 0;
}

int send_piece(lws* connection, Sending& sending) {
  if (sending.file == nullptr) return 0;
  const std::string& bytes = sending.file->bytes;
  const std::size_t count = std::min(bytes.size() - sending.sent, k_piece_bytes);
  const bool last = sending.sent + count == bytes.size();
  std::array<unsigned char, LWS_PRE + k_piece_bytes> room{};
  std::copy_n(bytes.data() + sending.sent, count, room.data() + LWS_PRE);
  const auto kind = last ? LWS_WRITE_HTTP_FINAL : LWS_WRITE_HTTP;
  if (lws_write(connection, room.data() + LWS_PRE, count, kind) < static_cast<int>(count))
    return -1;
  sending.sent += count;
  if (!last) return lws_callback_on_writable(connection) < 0 ? -1 : 0;
  sending.file = nullptr;
  return lws_http_transaction_completed(connection) != 0 ? -1 : 0;
}

int answer(lws* connection, lws_callback_reasons reason, void* user, void* data, std::size_t size) {
  auto* parts = static_cast<PageServer::Parts*>(lws_context_user(lws_get_context(connection)));
  auto* sending = static_cast<Sending*>(user);
  switch (reason) {
    case LWS_CALLBACK_HTTP:
      return begin_answer(connection, *parts, *sending);
    case LWS_CALLBACK_HTTP_WRITEABLE:
      return send_piece(connection, *sending);
    default:
      return lws_callback_http_dummy(connection, reason, user, data, size);
  }
}

const std::array<lws_protocols, 2> k_protocols{
    {{"http", answer, sizeof(Sending), 0, 0, nullptr, 0}, {nullptr, nullptr, 0, 0, 0, nullptr, 0}}};

lws_context* listen(std::uint16_t port, PageServer::Parts& parts) {
  lws_set_log_level(0, nullptr);
  lws_context_creation_info info{};
  info.port = port;
  info.iface = "127.0.0.1";
  info.protocols = k_protocols.data();
  info.user = &parts;
  info.gid = info.uid = -1;  // as it is
  info.server_string = "lockstone";
  info.options = LWS_SERVER_OPTION_DISABLE_IPV6 | LWS_SERVER_OPTION_SKIP_SERVER_CANONICAL_NAME |
                 LWS_SERVER_OPTION_FAIL_UPON_UNABLE_TO_BIND;
  return lws_create_context(&info);
}

}  // namespace

PageServer::PageServer(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}

PageServer::~PageServer() = default;

std::unique_ptr<PageServer> PageServer::open(std::uint16_t port, ServedFiles files,
                                             std::string_view origin) {
  auto parts = std::make_unique<Parts>();
  parts->files = std::move(files);
  parts->policy = policy_with(origin);
  parts->context = listen(port, *parts);
  lws_vhost* host =
      parts->context == nullptr ? nullptr : lws_get_vhost_by_name(parts->context, "default");
  if (host == nullptr) {
    complain(fmt::format("studio: cannot listen on 127.0.0.1 port {}", port));
    return nullptr;
  }
  parts->host = fmt::format("127.0.0.1:{}", lws_get_vhost_listen_port(host));
  parts->address = fmt::format("http://{}/{}/", parts->host, parts->token);
  return std::unique_ptr<PageServer>(new PageServer(std::move(parts)));
}

const std::string& PageServer::address() const {
  return parts_->address;
}

void PageServer::run() {
  catch_interrupts();
  while (!interrupted() && lws_service(parts_->context, k_service_ms) >= 0) {
  }
}

}  // namespace lockstone::tool
