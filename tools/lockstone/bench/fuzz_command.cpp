#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tools/fuzz/fuzz_run.h"
#include "tools/fuzz/pair_checks.h"
#include "tools/lockstone/bench/fuzz_options.h"
#include "tools/lockstone/commands.h"
#include "tools/lockstone/support/console.h"
#include "tools/lockstone/support/json_text.h"

namespace lockstone::tool {
namespace {

using Json = nlohmann::ordered_json;
using fuzz::Check;
using fuzz::Figure;
using fuzz::Kind;

constexpr std::size_t k_printed_failures = 20;

struct FuzzPairsOptions {
  fuzz::FuzzOptions run;
  std::vector<std::string> kinds;
  std::int64_t only = -1;
  bool special = false;
  bool json = false;
};

fuzz::CheckText text_of(std::size_t check) {
  return fuzz::text_of(static_cast<Check>(check));
}

std::string reproducer(const FuzzPairsOptions& options, std::uint64_t index) {
  const std::string kinds =
      options.kinds.empty() ? "" : fmt::format("--kinds {} ", fmt::join(options.kinds, ","));
  const std::string_view places = options.special ? "--special " : "";
  return fmt::format("lockstone fuzz-pairs --seed {} {}{}--only {}", options.run.seed, kinds,
                     places, index);
}

template <class Visit>
void for_kind_pairs(const fuzz::FuzzReport& report, Visit visit) {
  for (std::size_t a = 0; a < fuzz::k_kinds; ++a) {
    for (std::size_t b = a; b < fuzz::k_kinds; ++b) {
      if (report.kinds[a][b] == 0) continue;
      visit(fmt::format("{}-{}", name_of(static_cast<Kind>(a)), name_of(static_cast<Kind>(b))),
            report.kinds[a][b]);
    }
  }
}

void print_figures(const std::array<Figure, fuzz::k_checks>& figures) {
  fmt::print("{:<10} {:>12} {:>8} {:>12} {:>8} {:>10}  allowed\n", "check", "figures", "failed",
             "worst", "share", "of pair");
  for (std::size_t i = 0; i < fuzz::k_checks; ++i) {
    const Figure& f = figures[i];
    if (f.count == 0) continue;
    fmt::print("{:<10} {:>12} {:>8} {:>12.3e} {:>8.3f} {:>10}  {}\n", text_of(i).name, f.count,
               f.failures, f.worst, f.worst_share, f.worst_index, text_of(i).bound);
  }
}

std::string failed_checks(const fuzz::Verdict& verdict) {
  std::string text;
  for (std::size_t i = 0; i < fuzz::k_checks; ++i) {
    const Figure& f = verdict.figures()[i];
    if (f.failures == 0) continue;
    text += text.empty() ? "" : ", ";
    text +=
        fmt::format("{} ({:.3g}, {:.3g} of the allowed)", text_of(i).name, f.worst, f.worst_share);
  }
  return text;
}

void print_table(const FuzzPairsOptions& options, const fuzz::FuzzReport& report) {
  fmt::print("seed {}, {} pairs, {} failed\n", options.run.seed, report.pairs, report.failed_pairs);
  for_kind_pairs(report, [](const std::string& name, std::uint64_t count) {
    fmt::print("  {:<20} {:>10}\n", name, count);
  });
  print_figures(report.figures);
  for (std::size_t i = 0; i < std::min(report.failures.size(), k_printed_failures); ++i) {
    const fuzz::PairFailure& failure = report.failures[i];
    fmt::print("FAILED {}\n  {}\n", failed_checks(failure.verdict),
               reproducer(options, failure.index));
  }
}

void print_json(const FuzzPairsOptions& options, const fuzz::FuzzReport& report) {
  Json json{{"seed", options.run.seed}, {"pairs", report.pairs},   {"failed", report.failed_pairs},
            {"kinds", Json::object()},  {"checks", Json::array()}, {"failures", Json::array()}};
  for_kind_pairs(
      report, [&](const std::string& name, std::uint64_t count) { json["kinds"][name] = count; });
  for (std::size_t i = 0; i < fuzz::k_checks; ++i) {
    const Figure& f = report.figures[i];
    json["checks"].push_back({{"check", text_of(i).name},
                              {"allowed", text_of(i).bound},
                              {"figures", f.count},
                              {"failed", f.failures},
                              {"worst", f.worst},
                              {"worst_share", f.worst_share},
                              {"worst_index", f.worst_index}});
  }
  for (const fuzz::PairFailure& failure : report.failures) {
    json["failures"].push_back({{"checks", failed_checks(failure.verdict)},
                                {"reproducer", reproducer(options, failure.index)}});
  }
  write_json(json);
}

int run_one(const FuzzPairsOptions& options) {
  const auto index = static_cast<std::uint64_t>(options.only);
  fuzz::HullPool pool(options.run.seed);
  const fuzz::Pair pair =
      make_pair(pool, options.run.seed, index, options.run.kinds, options.run.places);
  fuzz::Verdict verdict(index);
  check_pair(pair, verdict);
  const fuzz::Answers answers(pair);
  fmt::print("{}distance {:.9g} m, {} points", describe(pair), answers.signed_distance(),
             answers.manifold.count);
  if (answers.manifold.count > 0) fmt::print(", the least separation {:.9g} m", answers.least());
  fmt::print("\n");
  print_figures(verdict.figures());
  return verdict.failed() ? k_different : k_ok;
}

int run(FuzzPairsOptions& options) {
  for (const std::string& name : options.kinds)
    options.run.kinds.push_back(*fuzz::kind_named(name));
  if (options.special) options.run.places = fuzz::Places::special;
  if (options.run.kinds.empty()) options.run.kinds = fuzz::all_kinds();
  const std::vector<Kind>& kinds = options.run.kinds;
  if (std::ranges::none_of(kinds, [](Kind kind) { return do_meet(kind, kind); })) {
    complain("triangles and half-spaces do not meet each other: name a solid kind");
    return k_usage;
  }
  if (options.only >= 0) return run_one(options);
  const fuzz::FuzzReport report = fuzz_pairs(options.run);
  options.json ? print_json(options, report) : print_table(options, report);
  return report.failed_pairs == 0 ? k_ok : k_different;
}

std::string check_kind(const std::string& name) {
  return fuzz::kind_named(name) ? std::string() : "no kind of shape: " + name;
}

}  // namespace

void add_fuzz_pairs_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<FuzzPairsOptions>();
  CLI::App* command = app.add_subcommand(
      "fuzz-pairs",
      "Random pairs of shapes: contacts, distances, depths, casts against each other");
  add_fuzz_options(*command, options->run, options->json, "pairs");
  command
      ->add_option("--kinds", options->kinds,
                   "Sphere, capsule, box, hull, triangle, half-space, cylinder, cone, "
                   "tapered-capsule, rounded-box, rounded-hull; default: all")
      ->delimiter(',')
      ->check(CLI::Validator(check_kind, "KIND"));
  command->add_option("--only", options->only, "Check this index alone and print its pair");
  command->add_flag("--special", options->special,
                    "Only special positions: coaxial, across, nearly parallel, edge on edge, "
                    "point on face");
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace lockstone::tool
