#include "tools/lockstone/support/tar.h"

#include <gtest/gtest.h>

namespace lockstone::tool {
namespace {

std::vector<TarEntry> some_entries() {
  return {{"report.txt", std::vector<std::byte>(700, std::byte{'r'})},
          {"empty", {}},
          {"match.lks", std::vector<std::byte>(512, std::byte{7})}};
}

TEST(Tar, ReadsItsOwnArchives) {
  const std::vector<TarEntry> made = some_entries(), read = read_tar(make_tar(made));
  ASSERT_EQ(read.size(), made.size());
  for (std::size_t i = 0; i < made.size(); ++i) {
    EXPECT_EQ(read[i].name, made[i].name);
    EXPECT_EQ(read[i].bytes, made[i].bytes);
  }
}

TEST(Tar, ReadsTheWholeFilesOfACutArchive) {
  const std::vector<std::byte> archive = make_tar(some_entries());
  for (std::size_t bytes = 0; bytes < archive.size(); bytes += 37) {
    const std::vector<TarEntry> read = read_tar(ByteView(archive).first(bytes));
    EXPECT_EQ(read.empty(), bytes < 512 + 700) << bytes;
  }
}

TEST(Tar, RefusesSizesBeyondTheArchive) {
  std::vector<std::byte> archive = make_tar(some_entries());
  for (std::size_t i = 124; i < 135; ++i)
    archive[i] = std::byte{'7'};
  EXPECT_TRUE(read_tar(archive).empty());
}

}  // namespace
}  // namespace lockstone::tool
