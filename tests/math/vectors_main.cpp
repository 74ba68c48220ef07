// The golden vectors against core/math as compiled at another optimisation level: a level that
// drops a store or a sign must not go unseen (g++ 12 did, at -O1 and -O2, in a first form of
// Transform).
#include <cstdio>
#include <fstream>
#include <iterator>
#include <string>

#include "tools/numerics/vectors.h"

int main(int argc, char** argv) {
  if (argc != 2) return 64;
  std::ifstream file(argv[1], std::ios::binary);
  const std::string text(std::istreambuf_iterator<char>(file), {});
  const lockstone::numerics::CheckResult result = lockstone::numerics::check(text);
  std::printf("%zu vectors, %zu different, %zu unreadable\nline %zu\n  file %s\n  here %s\n",
              result.lines, result.different, result.malformed, result.first_line,
              result.expected.c_str(), result.found.c_str());
  return result.lines > 0 && result.different + result.malformed == 0 ? 0 : 1;
}
