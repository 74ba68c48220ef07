#include "tests/fuzz/target.h"

namespace lockstone::fuzz {

std::vector<Target>& targets() {
  static std::vector<Target> all;
  return all;
}

}  // namespace lockstone::fuzz
