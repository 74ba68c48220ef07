#include "tools/numerics/vectors.h"

#include <charconv>
#include <optional>

namespace lockstone::numerics {
namespace {

constexpr int k_lines_each = 60;
constexpr std::string_view k_head =
    "# Golden vectors of docs/explanation/numerics.md, by `lockstone numerics --write FILE`:\n"
    "# function inputs = outputs, raw whole numbers; words above 2^63 stand as negative ones.\n";

/// Steele, Lea and Flood, Fast splittable pseudorandom number generators (SplitMix64).
class Source {
 public:
  explicit Source(std::string_view seed) {
    for (const char c : seed)
      state_ = (state_ ^ static_cast<unsigned char>(c)) * 0x100000001b3U;
  }

  std::uint64_t next() {
    state_ += 0x9e3779b97f4a7c15U;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
    return z ^ (z >> 31);
  }

  /// Of any width: uniform in the number of bits; one in four a power of two or next to one.
  std::int64_t in(const Domain& domain) {
    const int width = static_cast<int>(next() % 65);
    std::uint64_t bits = width == 0 ? 0 : next() >> (64 - width);
    if (next() % 4 == 0 && width > 0) {
      bits = (std::uint64_t{1} << (width - 1)) + next() % 3 - 1;
    }
    return clamp(static_cast<std::int64_t>(next() % 2 == 0 ? bits : 0 - bits), domain);
  }

  /// A value outside is wrapped into the domain.
  static std::int64_t clamp(std::int64_t value, const Domain& domain) {
    if (value >= domain.low && value <= domain.high) return value;
    const auto low = static_cast<std::uint64_t>(domain.low);
    const std::uint64_t span = static_cast<std::uint64_t>(domain.high) - low + 1;
    return static_cast<std::int64_t>(low + static_cast<std::uint64_t>(value) % span);
  }

 private:
  std::uint64_t state_ = 0xcbf29ce484222325U;
};

/// The first lines take all inputs from the ends, 0, 1 and −1; then any of them; then all random.
std::int64_t choose(Source& source, const Domain& domain, int line) {
  const std::int64_t special[] = {domain.low, domain.high, 0, 1, -1};
  if (line < 5) return Source::clamp(special[line], domain);
  if (line < 20 && source.next() % 2 == 0) {
    return Source::clamp(special[source.next() % 5], domain);
  }
  return source.in(domain);
}

std::string line_of(const Function& function, const Words& inputs) {
  std::string line = function.name;
  for (const std::int64_t word : inputs)
    line += ' ' + std::to_string(word);
  line += " =";
  for (const std::int64_t word : function.evaluate(inputs))
    line += ' ' + std::to_string(word);
  return line;
}

const Function* find(std::string_view name) {
  for (const Function& function : functions())
    if (name == function.name) return &function;
  return nullptr;
}

std::string_view take_token(std::string_view& line) {
  const std::size_t end = line.find(' ');
  const std::string_view token = line.substr(0, end);
  line.remove_prefix(end == std::string_view::npos ? line.size() : end + 1);
  return token;
}

/// The inputs of a line, when they are numbers within the function's domain.
std::optional<Words> inputs_of(std::string_view rest, const Function& function) {
  Words inputs;
  for (const Domain& domain : function.inputs) {
    const std::string_view token = take_token(rest);
    std::int64_t word = 0;
    const auto [end, error] = std::from_chars(token.data(), token.data() + token.size(), word);
    if (error != std::errc{} || end != token.data() + token.size()) return std::nullopt;
    if (function.prepare == nullptr && (word < domain.low || word > domain.high)) {
      return std::nullopt;
    }
    inputs.push_back(word);
  }
  if (take_token(rest) != "=") return std::nullopt;
  if (function.prepare == nullptr) return inputs;
  // Preparing prepared inputs again changes nothing: inputs that would change are out of the
  // domain.
  Words again = inputs;
  function.prepare(again);
  return again == inputs ? std::optional(inputs) : std::nullopt;
}

/// The correct form of the line; nothing when it cannot be read.
std::optional<std::string> expected_line(std::string_view line) {
  std::string_view rest = line;
  const Function* function = find(take_token(rest));
  if (function == nullptr) return std::nullopt;
  const std::optional<Words> inputs = inputs_of(rest, *function);
  if (!inputs) return std::nullopt;
  return line_of(*function, *inputs);
}

void compare(std::string_view line, std::size_t number, CheckResult& result) {
  if (line.empty() || line.front() == '#') return;
  ++result.lines;
  const std::optional<std::string> right = expected_line(line);
  if (right && *right == line) return;
  ++(right ? result.different : result.malformed);
  if (result.first_line != 0) return;
  result.first_line = number;
  result.expected = line;
  result.found = right ? *right : "no function and inputs of its domain";
}

}  // namespace

const std::vector<Function>& functions() {
  static const std::vector<Function> all = [] {
    std::vector<Function> list;
    for (auto part : {arithmetic_functions, root_functions, angle_functions, structure_functions,
                      predicate_functions, game_functions}) {
      for (Function& function : part())
        list.push_back(std::move(function));
    }
    return list;
  }();
  return all;
}

std::string golden_text() {
  std::string text(k_head);
  for (const Function& function : functions()) {
    Source source(function.name);
    for (int line = 0; line < k_lines_each; ++line) {
      Words inputs;
      for (const Domain& domain : function.inputs)
        inputs.push_back(choose(source, domain, line));
      if (function.prepare != nullptr) function.prepare(inputs);
      text += line_of(function, inputs) + '\n';
    }
  }
  return text;
}

CheckResult check(std::string_view text) {
  CheckResult result;
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::size_t end = text.find('\n');
    compare(text.substr(0, end), number, result);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  return result;
}

}  // namespace lockstone::numerics
