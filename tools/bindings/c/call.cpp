#include "tools/bindings/c/call.h"

#include <algorithm>

namespace lockstone::c {

void throw_status(lks_status status, std::string_view message) {
  throw Failure{status, std::string(message)};
}

void throw_failure(Status status, const Refusal& refusal) {
  throw_status(static_cast<lks_status>(status),
               refusal ? refusal.to_line() : std::string(to_string(status)));
}

void throw_invalid(std::string_view field, std::string_view rule) {
  std::string message(field);
  message += ": ";
  message += rule;
  throw_status(LKS_INVALID_ARGUMENT, message);
}

void throw_null(std::string_view name) {
  throw_status(LKS_NULL_ARGUMENT, std::string(name) + " is null");
}

void throw_wrong_size(std::string_view name, std::size_t size, std::size_t least,
                      std::size_t most) {
  throw_status(LKS_WRONG_SIZE, std::string(name) + ".size: " + std::to_string(size) + ", must be " +
                                   std::to_string(least) + " … " + std::to_string(most));
}

void throw_number(std::string_view field, std::uint32_t number, std::string_view fault) {
  throw_invalid(field, std::to_string(number) + ' ' + std::string(fault));
}

bool flag(std::uint32_t number, std::string_view field) {
  if (number > 1) throw_invalid(field, "must be 0 or 1");
  return number == 1;
}

void check_bits(std::uint32_t bits, std::uint32_t known, std::string_view field) {
  if ((bits & ~known) != 0) throw_invalid(field, "has an unknown bit");
}

void give_count(std::size_t found, std::size_t capacity, std::size_t& count,
                std::string_view what) {
  count = found;
  if (found <= capacity) return;
  throw_status(LKS_BUFFER_TOO_SMALL,
               "there are " + std::to_string(found) + ' ' + std::string(what));
}

void write_text(std::string_view text, char* out, std::size_t capacity) {
  if (capacity == 0) return;
  std::size_t bytes = std::min(text.size(), capacity - 1);
  const auto continues = [&] {
    return bytes < text.size() && (static_cast<unsigned char>(text[bytes]) & 0xc0) == 0x80;
  };
  while (bytes > 0 && continues())
    --bytes;
  if (bytes > 0) std::memcpy(out, text.data(), bytes);
  out[bytes] = '\0';
}

}  // namespace lockstone::c
