#include "tools/lockstone/support/tar.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>

#include <fmt/format.h>

namespace lockstone::tool {
namespace {

constexpr std::size_t k_block_bytes = 512;
constexpr int k_octal = 8;

// Offsets of a header's fields.
constexpr std::size_t k_mode = 100;
constexpr std::size_t k_user = 108;
constexpr std::size_t k_group = 116;
constexpr std::size_t k_size = 124;
constexpr std::size_t k_time = 136;
constexpr std::size_t k_checksum = 148;
constexpr std::size_t k_type = 156;
constexpr std::size_t k_magic = 257;

void put(std::array<char, k_block_bytes>& header, std::size_t at, std::string_view text) {
  std::copy(text.begin(), text.end(), header.begin() + static_cast<std::ptrdiff_t>(at));
}

std::array<char, k_block_bytes> header_of(const TarEntry& entry) {
  std::array<char, k_block_bytes> header{};
  put(header, 0, std::string_view(entry.name).substr(0, k_mode - 1));
  put(header, k_mode, "0000644");
  put(header, k_user, "0000000");
  put(header, k_group, "0000000");
  put(header, k_size, fmt::format("{:011o}", entry.bytes.size()));
  put(header, k_time, "00000000000");
  put(header, k_checksum, "        ");  // counted as blanks
  put(header, k_type, "0");
  put(header, k_magic, std::string_view("ustar\00000", 8));
  unsigned sum = 0;
  for (char c : header)
    sum += static_cast<unsigned char>(c);
  put(header, k_checksum, fmt::format("{:06o}", sum));
  header[k_checksum + 6] = '\0';
  return header;
}

std::size_t whole_blocks(std::size_t bytes) {
  return (bytes + k_block_bytes - 1) / k_block_bytes * k_block_bytes;
}

// Up to the first zero.
std::string text_at(ByteView archive, std::size_t at, std::size_t room) {
  const auto* letters = reinterpret_cast<const char*>(archive.data() + at);
  return {letters, strnlen(letters, room)};
}

}  // namespace

std::vector<std::byte> make_tar(const std::vector<TarEntry>& entries) {
  std::vector<std::byte> archive;
  for (const TarEntry& entry : entries) {
    for (char c : header_of(entry))
      archive.push_back(static_cast<std::byte>(c));
    archive.insert(archive.end(), entry.bytes.begin(), entry.bytes.end());
    archive.resize(whole_blocks(archive.size()));
  }
  archive.resize(archive.size() + 2 * k_block_bytes);
  return archive;
}

std::vector<TarEntry> read_tar(ByteView archive) {
  std::vector<TarEntry> entries;
  while (archive.size() >= k_block_bytes) {
    const std::string name = text_at(archive, 0, k_mode);
    const std::string size_text = text_at(archive, k_size, k_time - k_size);
    char* end = nullptr;
    const std::uint64_t size = std::strtoull(size_text.c_str(), &end, k_octal);
    archive = archive.subspan(k_block_bytes);
    if (name.empty() || end == size_text.c_str() || size > archive.size()) break;
    const ByteView bytes = archive.first(static_cast<std::size_t>(size));
    entries.push_back({name, {bytes.begin(), bytes.end()}});
    archive = archive.subspan(std::min(archive.size(), whole_blocks(bytes.size())));
  }
  return entries;
}

}  // namespace lockstone::tool
