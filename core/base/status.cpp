#include <lockstone/status.h>

namespace lockstone {

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
