#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tools/lockstone/commands.h"
#include "tools/lockstone/support/console.h"
#include "tools/lockstone/support/json_text.h"
#include "tools/simnet/batch.h"
#include "tools/simnet/toy_game.h"
#include "tools/tool/tool_command.h"

namespace lockstone::tool {
namespace {

// A game of integers alone, for trying out the session itself.
constexpr const char* k_toy = "toy";

struct SimnetOptions {
  simnet::BatchOptions batch;
  std::string faults = "all";
  std::string schedule;
  std::string scene;
  std::string control;
  std::uint32_t bodies = 60;
  bool json = false;
};

MatchRequest request_of(const GameDef& game, const SimnetOptions& options, std::uint64_t seed,
                        std::size_t players) {
  return {.scene = options.scene == game.name ? std::string_view() : options.scene,
          .seed = seed,
          .players = static_cast<std::uint8_t>(players),
          .bodies = options.bodies};
}

// Every client plays the game that has this scene. A match that it refuses fails.
simnet::Game scene_game(const Games& games, const SimnetOptions& options, std::uint64_t seed) {
  const GameDef* game = games.of_scene(options.scene);
  Result<std::vector<std::byte>> config =
      game->configure(request_of(*game, options, seed, options.batch.clients));
  if (!config) return {{}, game->make, game->make};
  return {std::move(config).value(), game->make, game->make};
}

simnet::GameMaker game_maker(const Games& games, const SimnetOptions& options) {
  return [&games, &options](std::uint64_t seed, std::optional<simnet::Control>& control) {
    if (options.scene != k_toy) return scene_game(games, options, seed);
    const simnet::Defect defect = options.control == "flip"      ? simnet::Defect::flipped_bit
                                  : options.control == "unsaved" ? simnet::Defect::unsaved
                                                                 : simnet::Defect::none;
    return simnet::make_toy_game(seed, options.batch.clients, options.batch.ticks, defect, control);
  };
}

// Chooses the usual number of players where none was asked for. True when the game can make such
// matches; else a complaint.
bool check_game(const Games& games, SimnetOptions& options) {
  std::size_t& players = options.batch.clients;
  if (options.scene == k_toy) {
    if (players == 0) players = simnet::BatchOptions{}.clients;
    return true;
  }
  const GameDef* game = games.of_scene(options.scene);
  if (game == nullptr || !game->configure) {
    complain(fmt::format("no game here makes matches of the scene {}", options.scene));
    return false;
  }
  const auto usual = players_of(*game, request_of(*game, options, options.batch.first_seed, 0));
  if (players == 0) players = usual.value_or(0);
  const auto made =
      players_of(*game, request_of(*game, options, options.batch.first_seed, players));
  if (made && *made == players && players > 0) return true;
  complain(fmt::format("the game '{}' refuses --players {}{}", game->name, players,
                       usual ? fmt::format("; its usual number is {}", *usual) : ""));
  return false;
}

std::string repeat_command(const SimnetOptions& options, const simnet::BatchFailure& failure) {
  std::string line =
      fmt::format("{} simnet --first-seed {} --seeds 1 --players {} --ticks {}", program_name(),
                  failure.seed, options.batch.clients, options.batch.ticks);
  if (options.scene != k_toy) {
    line += fmt::format(" --scene {} --bodies {}", options.scene, options.bodies);
  }
  if (!options.control.empty()) line += " --control " + options.control;
  if (options.batch.lie != simnet::Lie::none) {
    const bool kicks = options.batch.policy == net::DesyncPolicy::kick;
    line += fmt::format(" --liar {} --on-desync {}", to_string(options.batch.lie),
                        kicks ? "kick" : "resync");
  }
  return line + fmt::format(" --schedule '{}'", to_text(failure.schedule));
}

void print_json(const SimnetOptions& options, const simnet::BatchTotals& totals, double seconds) {
  nlohmann::ordered_json failures = nlohmann::ordered_json::array();
  for (const simnet::BatchFailure& failure : totals.failures) {
    failures.push_back({{"seed", failure.seed},
                        {"what", failure.what},
                        {"mode", to_text(failure.mode)},
                        {"schedule", to_text(failure.schedule)},
                        {"command", repeat_command(options, failure)}});
  }
  const nlohmann::ordered_json json{{"matches", totals.matches},
                                    {"ticks", totals.ticks},
                                    {"client_ticks", totals.client_ticks},
                                    {"comparisons", totals.comparisons},
                                    {"faults", totals.faults},
                                    {"kills", totals.kills},
                                    {"entries", totals.entries},
                                    {"too_late", totals.too_late},
                                    {"rollbacks", totals.rollbacks},
                                    {"substituted_inputs", totals.substituted_inputs},
                                    {"resends", totals.resends},
                                    {"refused_packets", totals.refused_packets},
                                    {"peak_bytes_in_flight", totals.peak_bytes},
                                    {"hash", hash_text(totals.hash)},
                                    {"seconds", seconds},
                                    {"failures", failures}};
  write_json(json);
}

void print_text(const SimnetOptions& options, const simnet::BatchTotals& totals, double seconds) {
  fmt::print("{} matches, {} ticks, {} client-ticks, {} comparisons in {:.1f} s\n", totals.matches,
             totals.ticks, totals.client_ticks, totals.comparisons, seconds);
  fmt::print("{} entries into running matches, {} overtaken by the end, {} rollbacks\n",
             totals.entries, totals.too_late, totals.rollbacks);
  fmt::print("{} faults, {} kills, {} inputs replaced, {} resends, {} damaged packets refused\n",
             totals.faults, totals.kills, totals.substituted_inputs, totals.resends,
             totals.refused_packets);
  fmt::print("at most {} bytes on their way; hash of all final states {}\n", totals.peak_bytes,
             hash_text(totals.hash));
  for (const simnet::BatchFailure& failure : totals.failures) {
    fmt::print("seed {} ({}): {}\n  {}\n", failure.seed, to_text(failure.mode), failure.what,
               repeat_command(options, failure));
  }
  if (totals.failures.empty()) fmt::print("all as it must be\n");
}

int simulate(const Games& games, SimnetOptions options) {
  if (!check_game(games, options)) return k_usage;
  const std::optional<simnet::FaultMask> faults = simnet::parse_faults(options.faults);
  if (!faults) {
    complain("unknown kind of fault in " + options.faults);
    return k_usage;
  }
  options.batch.faults = *faults;
  if (!options.schedule.empty()) {
    options.batch.schedule = simnet::parse_schedule(options.schedule);
    if (!options.batch.schedule) {
      complain("not a schedule: " + options.schedule);
      return k_usage;
    }
  }
  Progress bar;
  const Stopwatch watch;
  const simnet::BatchTotals totals =
      run_batch(options.batch, game_maker(games, options),
                [&](std::uint64_t done) { bar.show("matches", done, options.batch.seeds); });
  bar.clear();
  if (options.json) {
    print_json(options, totals, watch.seconds());
  } else {
    print_text(options, totals, watch.seconds());
  }
  return totals.failures.empty() ? k_ok : k_different;
}

}  // namespace

void add_simnet_command(CLI::App& app, Tool& tool) {
  auto options = std::make_shared<SimnetOptions>();
  CLI::App* command =
      app.add_subcommand("simnet", "Play matches over a simulated network full of faults");
  simnet::BatchOptions& batch = options->batch;
  command->add_option("--seeds", batch.seeds, "Number of matches, each with a seed of its own")
      ->capture_default_str();
  command->add_option("--first-seed", batch.first_seed, "Seed of the first match")
      ->capture_default_str();
  batch.clients = 0;
  command->add_option("--players", batch.clients, "Players of each match; 0: the usual number")
      ->check(CLI::Range(std::size_t{0}, k_max_players))
      ->capture_default_str();
  command->add_option("--ticks", batch.ticks, "Ticks of each match")
      ->check(CLI::Range(60, 1'000'000))
      ->capture_default_str();
  command->add_option("--faults", options->faults, "all, none, or kinds: loss,burst,delay,kill …")
      ->capture_default_str();
  command->add_option("--schedule", options->schedule, "Apply these faults instead of random ones");
  command->add_option("--threads", batch.threads, "Matches to play at the same time")
      ->check(CLI::Range(1, 256))
      ->capture_default_str();
  command
      ->add_option("--scene", options->scene,
                   "toy: integers of a few lines; or a game or scene that this tool knows")
      ->default_str(tool.simnet_scene.empty() ? "the first game" : tool.simnet_scene);
  command->add_option("--bodies", options->bodies, "Loose bodies, in games that take such a number")
      ->capture_default_str();
  command
      ->add_option(
          "--control", options->control,
          "A fault that must be caught (toy): flip, one bit of one state; unsaved, a field")
      ->check(CLI::IsMember({"flip", "unsaved"}));
  command
      ->add_option_function<std::string>(
          "--liar",
          [options](const std::string& text) { options->batch.lie = *simnet::parse_lie(text); },
          "How the last client lies about its states")
      ->check(
          CLI::IsMember({"once", "always", "alternately", "parts", "silence", "future", "dumps"}));
  command
      ->add_option_function<std::string>(
          "--on-desync",
          [options](const std::string& text) {
            options->batch.policy =
                text == "kick" ? net::DesyncPolicy::kick : net::DesyncPolicy::resync;
          },
          "How the server treats a liar")
      ->check(CLI::IsMember({"kick", "resync"}));
  command->add_flag_callback(
      "--no-shrink", [options] { options->batch.shrink = false; },
      "Print failing schedules as they are");
  command->add_flag("--json", options->json, "Print the result as JSON");
  command->callback([options, &tool] {
    if (options->scene.empty()) {
      options->scene =
          tool.simnet_scene.empty() ? tool.games.list().front().name : tool.simnet_scene;
    }
    tool.exit_code = simulate(tool.games, *options);
  });
}

}  // namespace lockstone::tool
