#include <gtest/gtest.h>

#include <lockstone/hash.h>

#include "net/security/token_seal.h"
#include "tests/net/security/secure_fixture.h"

namespace lockstone::net::test {
namespace {

ShownToken shown(const ConnectToken& token) {
  return {token.grant.match, token.grant.expires_unix_s, token.nonce, token.sealed};
}

ConnectToken sample_token() {
  TestRandom random(5);
  TokenGrant grant = grant_for(2);
  EXPECT_TRUE(grant.servers.add(ServerAddress::from_text("10.1.2.3:7777").value()));
  return issue_token(backend_key(), grant, random).value();
}

TEST(Token, OpensToItsGrant) {
  const ConnectToken token = sample_token();
  SealedGrant opened;
  ASSERT_EQ(open_sealed(backend_key(), shown(token), opened), Status::ok);
  EXPECT_EQ(opened.grant, token.grant);
  EXPECT_EQ(opened.client_key, token.client_key);
  EXPECT_EQ(opened.server_key, token.server_key);
  EXPECT_NE(token.client_key, token.server_key);
  EXPECT_EQ(token.link_key, make_link_key(backend_key(), k_match));
  EXPECT_NE(token.link_key, make_link_key(backend_key(), k_match + 1));
}

TEST(Token, SurvivesBytesAndText) {
  const ConnectToken token = sample_token();
  const std::string text = token.to_text();
  EXPECT_EQ(text.size(), 2 * k_token_bytes);
  EXPECT_EQ(ConnectToken::from_text(text).value(), token);
  EXPECT_EQ(ConnectToken::from_text(text.substr(2)).status(), Status::malformed);
}

// The bytes of docs/reference/wire-format.md: a change of them is a new version.
TEST(Token, BytesStayTheSame) {
  std::array<std::byte, k_token_bytes> bytes{};
  encode_token(sample_token(), bytes);
  EXPECT_EQ(hash64(bytes), 0x64656b44681f1abaULL);
}

TEST(Token, NoChangedBitOpens) {
  const ConnectToken token = sample_token();
  SealedGrant opened;
  const auto expect_refused = [&opened](const ShownToken& changed) {
    EXPECT_EQ(open_sealed(backend_key(), changed, opened), Status::checksum_mismatch);
  };
  for (std::size_t bit = 0; bit < 8 * k_token_sealed_bytes; ++bit) {
    ConnectToken changed = token;
    changed.sealed[bit / 8] ^= std::byte{1} << bit % 8;
    expect_refused(shown(changed));
  }
  for (std::size_t bit = 0; bit < 8 * k_token_nonce_bytes; ++bit) {
    ConnectToken changed = token;
    changed.nonce[bit / 8] ^= std::byte{1} << bit % 8;
    expect_refused(shown(changed));
  }
  for (int bit = 0; bit < 40; ++bit) {
    ConnectToken other_match = token, other_end = token;
    other_match.grant.match ^= std::uint64_t{1} << bit;
    other_end.grant.expires_unix_s ^= std::uint64_t{1} << bit;
    expect_refused(shown(other_match));
    expect_refused(shown(other_end));
  }
}

TEST(Token, OpensUnderNoOtherKey) {
  const ConnectToken token = sample_token();
  SealedGrant opened;
  for (std::size_t bit = 0; bit < 8 * k_key_bytes; ++bit) {
    Key key = backend_key();
    key.bytes[bit / 8] ^= std::byte{1} << bit % 8;
    EXPECT_EQ(open_sealed(key, shown(token), opened), Status::checksum_mismatch);
  }
}

TEST(Token, ValuesOutOfRangeAreNotIssued) {
  TestRandom random(6);
  TokenGrant grant = grant_for(0);
  grant.slot = k_max_players;
  EXPECT_EQ(issue_token(backend_key(), grant, random).status(), Status::invalid_argument);
  grant.slot = k_spectator_slot;
  EXPECT_TRUE(issue_token(backend_key(), grant, random).ok());
  grant.expires_unix_s = k_max_expiry_unix_s + 1;
  EXPECT_EQ(issue_token(backend_key(), grant, random).status(), Status::invalid_argument);
  grant = grant_for(0);
  grant.servers.count = 1;  // port 0
  EXPECT_EQ(issue_token(backend_key(), grant, random).status(), Status::invalid_argument);
}

TEST(Token, BytesThatBreakTheFormatAreRefused) {
  std::array<std::byte, k_token_bytes + 1> bytes{};
  encode_token(sample_token(), std::span(bytes).first<k_token_bytes>());
  ConnectToken token;
  EXPECT_EQ(decode_token(bytes, token), Status::malformed);
  for (std::size_t size = 0; size < k_token_bytes; ++size) {
    EXPECT_EQ(decode_token(ByteView(bytes).first(size), token), Status::truncated);
  }
  const auto status_with = [&bytes](std::size_t at, std::byte value) {
    auto changed = bytes;
    changed[at] = value;
    ConnectToken ignored;
    return decode_token(ByteView(changed).first(k_token_bytes), ignored);
  };
  EXPECT_EQ(status_with(0, std::byte{1}), Status::malformed);
  EXPECT_EQ(status_with(4, std::byte{9}), Status::unsupported_version);
  EXPECT_EQ(status_with(30, std::byte{64}), Status::malformed);          // slot
  EXPECT_EQ(status_with(31, std::byte{9}), Status::malformed);           // servers
  EXPECT_EQ(status_with(32 + 18 + 3, std::byte{1}), Status::malformed);  // an unused server
}

TEST(ServerAddress, ReadsAndWritesIpv4) {
  for (const char* text : {"127.0.0.1:1", "255.255.255.255:65535", "10.0.20.3:7777"}) {
    EXPECT_EQ(ServerAddress::from_text(text).value().to_text(), text);
  }
  for (const char* text : {"", "1.2.3.4", "1.2.3:5", "1.2.3.4:0", "1.2.3.4:65536", "1.2.3.256:1",
                           "01.2.3.4:5", "1.2.3.4:5 ", "1.2.3.4.5:6", "-1.2.3.4:5", "a.b.c.d:1"}) {
    EXPECT_EQ(ServerAddress::from_text(text).status(), Status::malformed) << text;
  }
}

TEST(ServerAddress, ReadsAndWritesIpv6) {
  for (const char* text :
       {"[::]:9", "[::1]:27015", "[2001:db8::]:1", "[2001:db8::1]:65535", "[1:2:3:4:5:6:7:8]:9",
        "[fe80::1:0:0:1]:7", "[1:0:2::3]:7", "[1::2:0:0:3:4]:7", "[::fffe:0:1]:7", "[0:1::]:7",
        "[0:2:0:3:4:5:6:7]:7"}) {
    const Result<ServerAddress> read = ServerAddress::from_text(text);
    ASSERT_TRUE(read.ok()) << text;
    EXPECT_EQ(read.value().to_text(), text);
  }
}

TEST(ServerAddress, WritesIpv6InOneForm) {
  const auto rewritten = [](const char* text) {
    return ServerAddress::from_text(text).value().to_text();
  };
  EXPECT_EQ(rewritten("[2001:0DB8:0:0:0:0:0:1]:7"), "[2001:db8::1]:7");
  EXPECT_EQ(rewritten("[1:0:0:2:0:0:0:3]:7"), "[1:0:0:2::3]:7");      // the longest run
  EXPECT_EQ(rewritten("[1:0:0:2:0:0:3:4]:7"), "[1::2:0:0:3:4]:7");    // of two, the first
  EXPECT_EQ(rewritten("[1::3:4:5:6:7:8]:7"), "[1:0:3:4:5:6:7:8]:7");  // a single zero stays
  EXPECT_EQ(rewritten("[64:ff9b::10.0.0.1]:7"), "[64:ff9b::a00:1]:7");
  EXPECT_EQ(rewritten("[::ffff:10.0.0.1]:7"), "10.0.0.1:7");  // the same server
}

TEST(ServerAddress, RefusesTextThatIsNoIpv6Address) {
  for (const char* text : {"::1:7",
                           "[::1]",
                           "[::1]:",
                           "[::1]:0",
                           "[::1]:65536",
                           "[::1] :7",
                           "[::1:7",
                           "::1]:7",
                           "[]:7",
                           "[:]:7",
                           "[:::]:7",
                           "[1::2::3]:7",
                           "[1:2:3:4:5:6:7]:7",
                           "[1:2:3:4:5:6:7:8:9]:7",
                           "[1:2:3:4:5:6:7::8:9]:7",
                           "[::1:2:3:4:5:6:7:8]:7",
                           "[12345::]:7",
                           "[g::]:7",
                           "[:1::]:7",
                           "[1:]:7",
                           "[fe80::1%eth0]:7",
                           "[1.2.3.4::]:7",
                           "[::1.2.3]:7",
                           "[::1.2.3.4:5]:7",
                           "[1.2.3.4]:7",
                           "[::+1]:7",
                           "[::1]:+7",
                           "[::1]:07",
                           "[[::1]]:7"}) {
    EXPECT_EQ(ServerAddress::from_text(text).status(), Status::malformed) << text;
  }
}

TEST(HostPort, TakesNamesAndAddresses) {
  for (const char* text : {"localhost:7", "game.example:7777", "10.0.0.1:7", "[::1]:7"})
    EXPECT_EQ(HostPort::from_text(text).value().to_text(), text);
  EXPECT_EQ(HostPort::from_text("[::1]:7").value(), (HostPort{"::1", 7}));
  for (const char* text : {"", ":", "localhost", "localhost:", ":7", "localhost:0", "localhost:x",
                           "::1:7", "[localhost]:7", "a b:7", "localhost:7 "}) {
    EXPECT_EQ(HostPort::from_text(text).status(), Status::malformed) << text;
  }
}

}  // namespace
}  // namespace lockstone::net::test
