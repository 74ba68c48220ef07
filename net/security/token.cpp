// Issues, codes and opens tokens. Layouts: docs/reference/wire-format.md, "Connect token".
#include <algorithm>

#include <lockstone/hash.h>
#include <lockstone/simulation.h>

#include "net/security/hexadecimal.h"
#include "net/security/token_seal.h"

namespace lockstone::net {
namespace {

constexpr std::uint32_t k_token_magic = 0x54534b4c;  // "LKST"
constexpr std::uint16_t k_token_version = 1;
constexpr std::size_t k_private_bytes = k_token_sealed_bytes - crypto::k_tag_bytes;
static_assert(crypto::k_token_nonce_bytes == k_token_nonce_bytes);

// Domains: a key derived for one purpose is of no use for another.
constexpr std::string_view k_seal_domain = "lockstone token seal 1";
constexpr std::string_view k_link_domain = "lockstone token link 1";

constexpr std::uint64_t k_tag_seed = 0x6d61746368746167;  // "gathctam"

ByteView bytes_of(std::string_view text) {
  return std::as_bytes(std::span<const char>(text.data(), text.size()));
}

bool valid(const TokenGrant& grant) {
  if (grant.slot >= k_max_players && grant.slot != k_spectator_slot) return false;
  if (grant.expires_unix_s > k_max_expiry_unix_s || grant.servers.count > k_max_token_servers) {
    return false;
  }
  for (std::size_t i = 0; i < grant.servers.entries.size(); ++i) {
    const ServerAddress& server = grant.servers.entries[i];
    const bool used = i < grant.servers.count;
    if (used ? server.port == 0 : server != ServerAddress{}) return false;
  }
  return true;
}

void put_servers(ByteWriter& writer, const ServerList& servers) {
  writer.put(servers.count);
  for (const ServerAddress& server : servers.entries) {
    writer.put_bytes(server.address);
    writer.put(server.port);
  }
}

template <std::size_t k_size>
void get_array(ByteReader& reader, std::array<std::byte, k_size>& out) {
  const ByteView bytes = reader.get_bytes(k_size);
  std::copy(bytes.begin(), bytes.end(), out.begin());
}

void get_servers(ByteReader& reader, ServerList& servers) {
  servers.count = reader.get<std::uint8_t>();
  for (ServerAddress& server : servers.entries) {
    get_array(reader, server.address);
    server.port = reader.get<std::uint16_t>();
  }
}

// The fields that are authenticated but not encrypted.
class SealContext {
 public:
  SealContext(std::uint64_t match, std::uint64_t expires_unix_s) {
    ByteWriter writer(bytes_);
    writer.put(k_token_magic);
    writer.put(k_token_version);
    writer.put(match);
    writer.put(expires_unix_s);
  }
  [[nodiscard]] ByteView view() const { return bytes_; }

 private:
  std::array<std::byte, 22> bytes_{};
};

Key seal_key(const Key& backend_key) {
  return crypto::derive(backend_key, {bytes_of(k_seal_domain)});
}

void seal(const Key& backend_key, ConnectToken& token) {
  std::array<std::byte, k_private_bytes> plain{};
  ByteWriter writer(plain);
  writer.put(token.grant.player);
  writer.put(token.grant.slot);
  put_servers(writer, token.grant.servers);
  writer.put_bytes(token.client_key.bytes);
  writer.put_bytes(token.server_key.bytes);
  LKS_CHECK(writer.ok() && writer.size() == plain.size());
  const SealContext context(token.grant.match, token.grant.expires_unix_s);
  crypto::seal_token(seal_key(backend_key), token.nonce, context.view(), plain, token.sealed);
  crypto::wipe(plain);
}

}  // namespace

Result<ConnectToken> issue_token(const Key& backend_key, const TokenGrant& grant,
                                 RandomSource& random) {
  if (!security_available()) return Status::incompatible;
  if (!valid(grant)) return Status::invalid_argument;
  ConnectToken token;
  token.grant = grant;
  token.client_key = make_key(random);
  token.server_key = make_key(random);
  token.link_key = make_link_key(backend_key, grant.match);
  random.fill(token.nonce);
  seal(backend_key, token);
  return token;
}

LinkKey make_link_key(const Key& backend_key, std::uint64_t match) {
  std::array<std::byte, 8> number{};
  ByteWriter(number).put(match);
  const Key derived = crypto::derive(backend_key, {bytes_of(k_link_domain), number});
  LinkKey key;
  std::copy_n(derived.bytes.begin(), key.bytes.size(), key.bytes.begin());
  return key;
}

std::uint32_t make_match_tag(std::uint64_t match) {
  std::array<std::byte, 8> number{};
  ByteWriter(number).put(match);
  const auto tag = static_cast<std::uint32_t>(hash64(number, k_tag_seed) & 0xffffffff);
  return tag == 0 ? 1 : tag;
}

Status open_sealed(const Key& backend_key, const ShownToken& token, SealedGrant& opened) {
  if (token.sealed.size() != k_token_sealed_bytes) return Status::truncated;
  const SealContext context(token.match, token.expires_unix_s);
  std::array<std::byte, k_private_bytes> plain{};
  if (!crypto::open_token(seal_key(backend_key), token.nonce, context.view(), token.sealed,
                          plain)) {
    return Status::checksum_mismatch;
  }
  ByteReader reader(plain);
  opened.grant.match = token.match;
  opened.grant.expires_unix_s = token.expires_unix_s;
  opened.grant.player = reader.get<std::uint64_t>();
  opened.grant.slot = reader.get<std::uint8_t>();
  get_servers(reader, opened.grant.servers);
  get_array(reader, opened.client_key.bytes);
  get_array(reader, opened.server_key.bytes);
  crypto::wipe(plain);
  return reader.ok() && valid(opened.grant) ? Status::ok : Status::malformed;
}

void encode_token(const ConnectToken& token, std::span<std::byte, k_token_bytes> out) {
  ByteWriter writer(out);
  writer.put(k_token_magic);
  writer.put(k_token_version);
  writer.put(token.grant.match);
  writer.put(token.grant.player);
  writer.put(token.grant.expires_unix_s);
  writer.put(token.grant.slot);
  put_servers(writer, token.grant.servers);
  writer.put_bytes(token.client_key.bytes);
  writer.put_bytes(token.server_key.bytes);
  writer.put_bytes(token.link_key.bytes);
  writer.put_bytes(token.nonce);
  writer.put_bytes(token.sealed);
  LKS_CHECK(writer.ok() && writer.size() == k_token_bytes);
}

Status decode_token(ByteView bytes, ConnectToken& token) {
  ByteReader reader(bytes);
  const bool ours = reader.get<std::uint32_t>() == k_token_magic;
  const auto version = reader.get<std::uint16_t>();
  if (!reader.ok()) return Status::truncated;
  if (!ours) return Status::malformed;
  if (version != k_token_version) return Status::unsupported_version;
  token.grant.match = reader.get<std::uint64_t>();
  token.grant.player = reader.get<std::uint64_t>();
  token.grant.expires_unix_s = reader.get<std::uint64_t>();
  token.grant.slot = reader.get<std::uint8_t>();
  get_servers(reader, token.grant.servers);
  get_array(reader, token.client_key.bytes);
  get_array(reader, token.server_key.bytes);
  get_array(reader, token.link_key.bytes);
  get_array(reader, token.nonce);
  get_array(reader, token.sealed);
  if (!reader.ok()) return Status::truncated;
  return reader.remaining() == 0 && valid(token.grant) ? Status::ok : Status::malformed;
}

std::string ConnectToken::to_text() const {
  std::array<std::byte, k_token_bytes> bytes{};
  encode_token(*this, bytes);
  return hexadecimal(bytes);
}

Result<ConnectToken> ConnectToken::from_text(std::string_view text) {
  std::array<std::byte, k_token_bytes> bytes{};
  Status status = from_hexadecimal(text, bytes);
  ConnectToken token;
  if (status == Status::ok) status = decode_token(bytes, token);
  if (status != Status::ok) return status;
  return token;
}

}  // namespace lockstone::net
