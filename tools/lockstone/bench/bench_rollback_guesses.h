// Goals of `lockstone bench rollback`, and its tables of wrong guesses.
#pragma once

#include <vector>

#include <nlohmann/json.hpp>

#include "tools/bench/rollback/wrong_guess.h"

namespace lockstone::tool {

/// A goal for one figure.
struct Goal {
  const char* name;
  double figure;
  double at_most;
  const char* unit;

  [[nodiscard]] bool met() const { return figure <= at_most; }
};

void print_goals(const std::vector<Goal>& goals);
[[nodiscard]] nlohmann::ordered_json goal_json(const Goal& goal);

void print_guesses(const bench::WrongGuessReport& report, int ticks);
[[nodiscard]] nlohmann::ordered_json guesses_json(const bench::WrongGuessReport& report);

/// Whether both ways came to the same hashes.
[[nodiscard]] bool are_equal(const bench::WrongGuessReport& report);

}  // namespace lockstone::tool
