// Connect tokens: who may take which seat of which match, sealed by the game's backend for its
// servers. The bytes are those of docs/reference/wire-format.md.
//
// The idea of a token with a private part, which only servers read, and a public one for the client
// is that of netcode (Glenn Fiedler, "netcode.io protocol").
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include <lockstone/bytes.h>
#include <lockstone/net/keys.h>
#include <lockstone/net/transport.h>
#include <lockstone/status.h>

namespace lockstone::net {

/// A host's name, or its numeric address, and a port.
struct HostPort {
  std::string host;  ///< an IPv6 address without brackets
  std::uint16_t port = 0;
  friend bool operator==(const HostPort&, const HostPort&) = default;

  /// From `game.example:7777`, `127.0.0.1:7777` or `[::1]:7777`; the name is not looked up.
  /// malformed: anything else, and port 0.
  [[nodiscard]] static Result<HostPort> from_text(std::string_view text);
  [[nodiscard]] std::string to_text() const;
};

/// Where a server listens: an IPv6 address, or an IPv4 one mapped into its form for IPv6.
struct ServerAddress {
  std::array<std::byte, 16> address{};
  std::uint16_t port = 0;
  friend bool operator==(const ServerAddress&, const ServerAddress&) = default;

  /// From `127.0.0.1:7777` or `[2001:db8::1]:7777`. malformed: anything else, such as a name or a
  /// zone.
  [[nodiscard]] static Result<ServerAddress> from_text(std::string_view text);
  /// As from_text reads it, in the one form of RFC 5952.
  [[nodiscard]] std::string to_text() const;
  [[nodiscard]] HostPort to_host_port() const;
};

inline constexpr std::size_t k_max_token_servers = 8;
inline constexpr std::uint64_t k_max_expiry_unix_s = std::uint64_t{1} << 40;

/// At most k_max_token_servers addresses, in the order in which the client shall try them.
struct ServerList {
  std::array<ServerAddress, k_max_token_servers> entries{};  ///< from `count` on: zeros
  std::uint8_t count = 0;
  friend bool operator==(const ServerList&, const ServerList&) = default;

  /// False if the list is full.
  bool add(const ServerAddress& address);
  [[nodiscard]] bool contains(const ServerAddress& address) const;
};

/// The rights that a token grants.
struct TokenGrant {
  std::uint64_t match = 0;
  std::uint64_t player = 0;          ///< the backend's number for the account
  std::uint8_t slot = 0;             ///< 0 … k_max_players - 1, or k_spectator_slot
  std::uint64_t expires_unix_s = 0;  ///< until then it opens connections; at most 2^40
  ServerList servers;                ///< none: any server that has the key
  friend bool operator==(const TokenGrant&, const TokenGrant&) = default;
};

inline constexpr std::size_t k_token_nonce_bytes = 24;
inline constexpr std::size_t k_token_sealed_bytes = 234;
inline constexpr std::size_t k_token_bytes = 514;

/// The backend gives this to one client, over a channel that nobody else reads.
struct ConnectToken {
  TokenGrant grant;
  Key client_key;  ///< of packets from the client
  Key server_key;  ///< of packets from the server
  LinkKey link_key;
  std::array<std::byte, k_token_nonce_bytes> nonce{};
  std::array<std::byte, k_token_sealed_bytes> sealed{};  ///< the same for the server alone
  friend bool operator==(const ConnectToken&, const ConnectToken&) = default;

  /// The bytes in lower-case hexadecimal digits.
  [[nodiscard]] std::string to_text() const;
  [[nodiscard]] static Result<ConnectToken> from_text(std::string_view text);
};

/// A token with fresh keys, sealed under the secret that backend and servers share.
/// invalid_argument: the grant has values out of range; incompatible: not security_available.
[[nodiscard]] Result<ConnectToken> issue_token(const Key& backend_key, const TokenGrant& grant,
                                               RandomSource& random);

/// The key of a match's datagrams, which a server needs before it has seen a token. Only where
/// security_available.
[[nodiscard]] LinkKey make_link_key(const Key& backend_key, std::uint64_t match);

/// A number for the match that is no secret, for EnetOptions::match_tag. Never 0.
[[nodiscard]] std::uint32_t make_match_tag(std::uint64_t match);

void encode_token(const ConnectToken& token, std::span<std::byte, k_token_bytes> out);
/// Checks all but the sealed part, which needs the backend's key. The token is unspecified unless
/// ok.
[[nodiscard]] Status decode_token(ByteView bytes, ConnectToken& token);

}  // namespace lockstone::net
