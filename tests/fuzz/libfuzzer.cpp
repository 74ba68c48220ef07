// A target as a libFuzzer program: half of its mutations get their checksums set right.
//   fuzz_NAME tests/fuzz/corpus/NAME        fuzz_NAME FILE         runs one input

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>

#include <lockstone/assert.h>

#include "tests/fuzz/target.h"

using lockstone::fuzz::Bytes;
using lockstone::fuzz::Target;

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace {

const Target& target() {
  LKS_CHECK(lockstone::fuzz::targets().size() == 1);
  return lockstone::fuzz::targets()[0];
}

// `fuzz_NAME --seeds FOLDER` writes the good examples and ends.
void write_seeds(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  int number = 0;
  for (const Bytes& seed : target().seeds()) {
    std::ofstream file(folder / ("seed" + std::to_string(number++)), std::ios::binary);
    file.write(reinterpret_cast<const char*>(seed.data()),
               static_cast<std::streamsize>(seed.size()));
  }
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* count, char*** arguments) {
  if (*count == 3 && std::strcmp((*arguments)[1], "--seeds") == 0) {
    write_seeds((*arguments)[2]);
    std::exit(0);
  }
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  (void)target().run(std::as_bytes(std::span(data, size)));
  return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t max_size, unsigned seed) {
  size = LLVMFuzzerMutate(data, size, max_size);
  if (target().mend == nullptr || seed % 2 == 0) return size;
  const auto bytes = std::as_bytes(std::span(data, size));
  Bytes mended(bytes.begin(), bytes.end());
  target().mend(mended);
  const std::size_t mended_size = std::min(mended.size(), max_size);
  if (mended_size > 0) std::memcpy(data, mended.data(), mended_size);
  return mended_size;
}
