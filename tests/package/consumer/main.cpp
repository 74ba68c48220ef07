// The smallest program of a user: it hashes three bytes, and it links the libraries that net needs.
#include <array>
#include <cstddef>
#include <cstdio>

#include <lockstone/hash.h>

#if defined(LOCKSTONE_WITH_ENET)
#include <lockstone/net/transport_enet.h>

static bool opens_a_socket() {
  return lockstone::net::EnetTransport::open({}).ok();
}
#else
static bool opens_a_socket() {
  return true;
}
#endif

int main() {
  const std::array<std::byte, 3> bytes{std::byte{1}, std::byte{2}, std::byte{3}};
  const auto hash = lockstone::hash64(bytes);
  std::printf("%016llx\n", static_cast<unsigned long long>(hash));
  return hash == 0xebce9b7632ae733bULL && opens_a_socket() ? 0 : 1;
}
