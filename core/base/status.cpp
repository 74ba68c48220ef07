#include <cstdio>
#include <cstdlib>

#include <lockstone/status.h>

namespace lockstone {

void no_value(Status error) {
  const char* hint = error == Status::invalid_argument || error == Status::capacity_exhausted
                         ? "; of a world, World::explain says which field"
                         : "";
  std::fprintf(stderr,
               "lockstone: Result::value: there is no value but an error, \"%s\": check "
               "ok() first%s\n",
               to_string(error).data(), hint);
  std::abort();
}

std::string_view to_string(Status status) {
  switch (status) {
    case Status::ok:
      return "ok";
    case Status::capacity_exhausted:
      return "capacity exhausted";
    case Status::stale_handle:
      return "stale handle";
    case Status::invalid_argument:
      return "invalid argument";
    case Status::truncated:
      return "truncated";
    case Status::malformed:
      return "malformed";
    case Status::checksum_mismatch:
      return "checksum mismatch";
    case Status::unsupported_version:
      return "unsupported version";
    case Status::incompatible:
      return "incompatible";
    case Status::io_error:
      return "input/output error";
    case Status::not_found:
      return "not found";
  }
  return "unknown status";
}

}  // namespace lockstone
