#include "tests/net/security/secure_fixture.h"

namespace lockstone::net::test {

Key backend_key() {
  TestRandom random(99);
  return make_key(random);
}

TokenGrant grant_for(std::size_t slot) {
  TokenGrant grant;
  grant.match = k_match;
  grant.player = 100 + slot;
  grant.slot = static_cast<std::uint8_t>(slot);
  grant.expires_unix_s = static_cast<std::uint64_t>(k_unix_s) + 3600;
  return grant;
}

ConnectToken token_for(std::size_t slot, RandomSource& random) {
  return issue_token(backend_key(), grant_for(slot), random).value();
}

SecureServerOptions server_options() {
  SecureServerOptions options;
  options.backend_key = backend_key();
  options.match = k_match;
  options.unix_us_at_zero = k_unix_s * 1'000'000;
  return options;
}

std::unique_ptr<SecureTransport> serve_securely(Transport& carrier, RandomSource& random) {
  return std::move(SecureTransport::serve(carrier, server_options(), random)).value();
}

std::unique_ptr<SecureTransport> join_securely(Transport& carrier, std::size_t slot,
                                               RandomSource& random) {
  return std::move(SecureTransport::join(carrier, token_for(slot, random), random)).value();
}

}  // namespace lockstone::net::test
