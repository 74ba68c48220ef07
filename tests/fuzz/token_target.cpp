// Connect tokens: the public bytes, and behind a good seal the private ones.

#include <algorithm>

#include <lockstone/assert.h>

#include "net/security/token_seal.h"
#include "tests/fuzz/target.h"
#include "tests/net/security/secure_fixture.h"

namespace lockstone::fuzz {
namespace {

using namespace net;

// Seals any private bytes as a backend would, and lets a server look at them.
bool run_private(ByteView bytes) {
  constexpr std::size_t k_private_bytes = k_token_sealed_bytes - crypto::k_tag_bytes;
  if (bytes.size() < k_private_bytes || !security_available()) return false;
  std::array<std::byte, 22> context{};
  ByteWriter writer(context);
  writer.put(std::uint32_t{0x54534b4c});
  writer.put(std::uint16_t{1});
  writer.put(std::uint64_t{3});
  writer.put(std::uint64_t{4});
  constexpr std::string_view k_domain = "lockstone token seal 1";
  const Key key = crypto::derive(test::backend_key(), {std::as_bytes(std::span(k_domain))});
  std::array<std::byte, k_token_sealed_bytes> sealed{};
  crypto::seal_token(key, {}, context, bytes.first(k_private_bytes), sealed);
  SealedGrant opened;
  const Status status = open_sealed(test::backend_key(), {3, 4, {}, sealed}, opened);
  LKS_CHECK(status != Status::checksum_mismatch);
  LKS_CHECK(status != Status::ok || opened.grant.servers.count <= k_max_token_servers);
  return status == Status::ok;
}

bool run(ByteView bytes) {
  ConnectToken token;
  const bool good = decode_token(bytes, token) == Status::ok;
  if (good) {
    std::array<std::byte, k_token_bytes> again{};
    encode_token(token, again);
    LKS_CHECK(std::equal(again.begin(), again.end(), bytes.begin(), bytes.end()));
    LKS_CHECK(ConnectToken::from_text(token.to_text()).value() == token);
    for (std::size_t i = 0; i < token.grant.servers.count; ++i) {
      const ServerAddress& server = token.grant.servers.entries[i];
      LKS_CHECK(ServerAddress::from_text(server.to_text()).value() == server);
    }
  }
  // The private part has the layout of the public one from its player on, without the time.
  if (bytes.size() < k_token_bytes) return good;
  Bytes inside(bytes.begin() + 14, bytes.begin() + 22);
  inside.insert(inside.end(), bytes.begin() + 30, bytes.begin() + 240);
  return run_private(inside) || good;
}

void mend(Bytes& bytes) {
  if (bytes.size() < 6) return;
  ByteWriter writer(bytes);
  writer.put(std::uint32_t{0x54534b4c});
  writer.put(std::uint16_t{1});
  bytes.resize(k_token_bytes);
}

std::vector<Bytes> seeds() {
  std::vector<Bytes> all;
  test::TestRandom random(3);
  for (const unsigned servers : {0U, 1U, 8U}) {
    ConnectToken token;
    token.grant = test::grant_for(servers);
    for (unsigned i = 0; i < servers; ++i)
      LKS_CHECK(token.grant.servers.add(ServerAddress::from_text("10.0.0.1:7777").value()));
    random.fill(token.client_key.bytes);
    random.fill(token.sealed);
    all.emplace_back(k_token_bytes);
    encode_token(token, std::span(all.back()).first<k_token_bytes>());
  }
  return all;
}

const Registration k_registration{{.name = "token", .seeds = seeds, .mend = mend, .run = run}};

}  // namespace
}  // namespace lockstone::fuzz
