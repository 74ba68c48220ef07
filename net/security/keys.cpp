#include <lockstone/net/keys.h>

#include "net/security/crypto.h"
#include "net/security/hexadecimal.h"

namespace lockstone::net {

std::string Key::to_text() const {
  return hexadecimal(bytes);
}

Result<Key> Key::from_text(std::string_view text) {
  Key key;
  if (const Status status = from_hexadecimal(text, key.bytes); status != Status::ok) return status;
  return key;
}

bool security_available() {
  return crypto::crypto_available();
}

Key make_key(RandomSource& random) {
  Key key;
  random.fill(key.bytes);
  return key;
}

}  // namespace lockstone::net
