#include "tools/lockstone/bench/bench_rollback_guesses.h"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include "tools/lockstone/support/json_text.h"

namespace lockstone::tool {
namespace {

// Of the full way, for each share of the islands that a wrong guess touches.
struct RatioGoal {
  double share, at_most;
};
constexpr RatioGoal k_ratio_goals[] = {{0, 0.03}, {0.01, 0.06}, {0.05, 0.12}, {0.2, 0.3}, {1, 1.1}};
constexpr double k_load_goal_us = 100;

std::vector<Goal> goals_of(const bench::WrongGuessReport& report) {
  std::vector<Goal> goals{{"load", report.load_us, k_load_goal_us, "us"}};
  for (const bench::WrongGuess& guess : report.guesses) {
    const auto* goal = std::ranges::find(k_ratio_goals, guess.share, &RatioGoal::share);
    if (goal != std::end(k_ratio_goals))
      goals.push_back({"by history", guess.ratio(), goal->at_most, "of the full way"});
  }
  return goals;
}

}  // namespace

void print_goals(const std::vector<Goal>& goals) {
  for (const Goal& goal : goals) {
    fmt::print("{:<7} {:<10} {:>8.3f} of at most {:g} {}\n", goal.met() ? "met" : "MISSED",
               goal.name, goal.figure, goal.at_most, goal.unit);
  }
}

nlohmann::ordered_json goal_json(const Goal& goal) {
  return {{"name", goal.name},
          {"figure", goal.figure},
          {"at_most", goal.at_most},
          {"unit", goal.unit},
          {"met", goal.met()}};
}

void print_guesses(const bench::WrongGuessReport& report, int ticks) {
  fmt::print("\n{} bodies in {} islands, {} touching pairs, a snapshot of {} bytes\n",
             report.bodies, report.islands, report.contacts, report.snapshot_bytes);
  fmt::print("load {:.1f} us, save {:.1f} us, hash {:.1f} us\none tick in full:", report.load_us,
             report.save_us, report.hash_us);
  for (std::size_t stage = 0; stage < k_step_stages; ++stage)
    fmt::print(" {} {:.1f}", name_of(static_cast<StepStage>(stage)), report.stage_us[stage]);
  fmt::print(" us\n{} ticks again, by the islands that the wrong guess touched\n", ticks);
  fmt::print("{:>8} {:>8} {:>10} {:>10} {:>8} {:>10} {:>10}  {}\n", "share", "islands", "full us",
             "history us", "ratio", "computed", "recalled", "final hash");
  for (const bench::WrongGuess& guess : report.guesses) {
    fmt::print("{:>7.0f}% {:>8} {:>10.1f} {:>10.1f} {:>8.4f} {:>10} {:>10}  {}{}\n",
               100 * guess.share, guess.touched, guess.full_us, guess.history_us, guess.ratio(),
               guess.computed, guess.recalled, hash_text(guess.hash),
               guess.are_equal ? "" : " DIFFERS");
  }
  print_goals(goals_of(report));
}

nlohmann::ordered_json guesses_json(const bench::WrongGuessReport& report) {
  nlohmann::ordered_json json{{"bodies", report.bodies},     {"islands", report.islands},
                              {"contacts", report.contacts}, {"load_us", report.load_us},
                              {"save_us", report.save_us},   {"hash_us", report.hash_us}};
  for (std::size_t stage = 0; stage < k_step_stages; ++stage)
    json["stage_us"][name_of(static_cast<StepStage>(stage))] = report.stage_us[stage];
  for (const bench::WrongGuess& guess : report.guesses) {
    json["guesses"].push_back({{"share", guess.share},
                               {"touched_islands", guess.touched},
                               {"full_us", guess.full_us},
                               {"history_us", guess.history_us},
                               {"ratio", guess.ratio()},
                               {"computed_islands", guess.computed},
                               {"recalled_islands", guess.recalled},
                               {"final_hash", hash_text(guess.hash)},
                               {"equal", guess.are_equal}});
  }
  for (const Goal& goal : goals_of(report))
    json["goals"].push_back(goal_json(goal));
  return json;
}

bool are_equal(const bench::WrongGuessReport& report) {
  return std::ranges::all_of(report.guesses, &bench::WrongGuess::are_equal);
}

}  // namespace lockstone::tool
