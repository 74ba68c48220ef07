#include "tools/lockstone/support/suggestion.h"

#include <algorithm>

#include <CLI/App.hpp>

namespace lockstone::tool {
namespace {

// The least number of letters to insert, drop, change or swap with the next one.
std::size_t mistakes(std::string_view a, std::string_view b) {
  std::vector<std::vector<std::size_t>> cost(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) {
    for (std::size_t j = 0; j <= b.size(); ++j) {
      if (i == 0 || j == 0) {
        cost[i][j] = i + j;
        continue;
      }
      const std::size_t changed = cost[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      cost[i][j] = std::min({cost[i - 1][j] + 1, cost[i][j - 1] + 1, changed});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) cost[i][j] = std::min(cost[i][j], cost[i - 2][j - 2] + 1);
    }
  }
  return cost[a.size()][b.size()];
}

std::vector<std::string> command_names(CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({}))
    names.push_back(command->get_name());
  return names;
}

std::vector<std::string> option_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames())
      names.push_back("--" + name);
  }
  return names;
}

std::string text(std::string_view kind, const std::string& word,
                 const std::vector<std::string>& candidates) {
  std::string line = "unknown " + std::string(kind) + " '" + word + '\'';
  const std::string near = nearest(word, candidates);
  if (!near.empty()) line += "; did you mean '" + near + "'?";
  return line;
}

}  // namespace

std::string nearest(std::string_view word, const std::vector<std::string>& candidates) {
  std::string best;
  std::size_t least = std::max<std::size_t>(1, word.size() / 3) + 1;
  for (const std::string& candidate : candidates) {
    const std::size_t count = mistakes(word, candidate);
    if (count >= least) continue;
    least = count;
    best = candidate;
  }
  return best;
}

std::string unknown_argument(CLI::App& app) {
  CLI::App* command = &app;
  while (!command->get_subcommands().empty())
    command = command->get_subcommands().back();
  const std::vector<std::string> rest = app.remaining(true);
  const auto is_option = [](const std::string& word) { return word.size() > 1 && word[0] == '-'; };
  const auto option = std::ranges::find_if(rest, is_option);
  const std::vector<std::string> commands = command_names(*command);
  if (!rest.empty() && !is_option(rest.front()) && !commands.empty())
    return text("command", rest.front(), commands);
  if (option == rest.end()) return {};
  return text("option", option->substr(0, option->find('=')), option_names(*command));
}

}  // namespace lockstone::tool
