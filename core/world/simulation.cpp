#include <lockstone/simulation.h>

namespace lockstone {

std::string StateDifference::to_line() const {
  if (!differs) return "no difference";
  std::string line = store + ' ' + std::to_string(object);
  if (!name.empty()) line += " \"" + name + '"';
  line += ", " + field + ": " + here + " here, " + there + " there";
  return line;
}

}  // namespace lockstone
