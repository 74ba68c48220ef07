// The target of a fuzzer: one parser of bytes from outside.
//
// A target's file defines a Target and registers it. The same file is linked into `fuzz_test`,
// which tries all targets with its own mutations for a moment, and, with LOCKSTONE_FUZZERS, into a
// libFuzzer program of its own, `fuzz_NAME`.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include <lockstone/bytes.h>

namespace lockstone::fuzz {

using Bytes = std::vector<std::byte>;

struct Target {
  std::string_view name;  ///< its corpus is tests/fuzz/corpus/NAME

  /// Good examples, made by this build: files alone would end at the first check of a version.
  std::vector<Bytes> (*seeds)() = nullptr;

  /// Corrects the fields whose rejection would hide all code behind them: checksums, versions,
  /// keys. Null when there is none.
  void (*mend)(Bytes& bytes) = nullptr;

  /// Parses, uses accepted input, and returns whether any was accepted. A violation stops the
  /// program: LKS_CHECK, asserts, sanitizers.
  bool (*run)(ByteView bytes) = nullptr;
};

/// All targets of this program, in no order.
[[nodiscard]] std::vector<Target>& targets();

/// `const Registration k_registration{{.name = …}};`
struct Registration {
  explicit Registration(const Target& target) { targets().push_back(target); }
};

}  // namespace lockstone::fuzz
