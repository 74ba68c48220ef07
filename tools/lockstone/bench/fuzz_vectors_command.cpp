#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tools/fuzz/vector_fuzz.h"
#include "tools/lockstone/bench/fuzz_options.h"
#include "tools/lockstone/commands.h"
#include "tools/lockstone/support/json_text.h"

namespace lockstone::tool {
namespace {

struct FuzzVectorsOptions {
  fuzz::VectorFuzzOptions run;
  bool json = false;
};

std::string reproducer(const FuzzVectorsOptions& options, const fuzz::VectorFailure& failure) {
  return fmt::format("lockstone fuzz-vectors --seed {} --first {} --count 1 --ticks {}",
                     options.run.seed, failure.index, failure.tick);
}

std::string_view name_of(const fuzz::VectorFailure& failure) {
  return failure.vectors.empty() ? "the default" : std::string_view(failure.vectors);
}

void print_text(const FuzzVectorsOptions& options, const fuzz::VectorFuzzReport& report) {
  fmt::print("seed {}, {} worlds, {} ticks, {} kinds of vectors beside scalar, {} failed\n",
             options.run.seed, report.worlds, report.ticks, report.kinds, report.failures.size());
  fmt::print("digest {:016x}\n", report.digest);
  for (const fuzz::VectorFailure& failure : report.failures)
    fmt::print("FAILED at tick {} with {}: {}\n  {}\n", failure.tick, name_of(failure),
               failure.what, reproducer(options, failure));
}

void print_json(const FuzzVectorsOptions& options, const fuzz::VectorFuzzReport& report) {
  nlohmann::ordered_json document{{"seed", options.run.seed},
                                  {"worlds", report.worlds},
                                  {"ticks", report.ticks},
                                  {"kinds", report.kinds},
                                  {"digest", fmt::format("{:016x}", report.digest)},
                                  {"failures", nlohmann::ordered_json::array()}};
  for (const fuzz::VectorFailure& failure : report.failures)
    document["failures"].push_back({{"index", failure.index},
                                    {"tick", failure.tick},
                                    {"vectors", name_of(failure)},
                                    {"what", failure.what},
                                    {"reproducer", reproducer(options, failure)}});
  write_json(document);
}

int run(const FuzzVectorsOptions& options) {
  const fuzz::VectorFuzzReport report = fuzz::fuzz_vectors(options.run);
  options.json ? print_json(options, report) : print_text(options, report);
  return report.failures.empty() ? k_ok : k_different;
}

}  // namespace

void add_fuzz_vectors_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<FuzzVectorsOptions>();
  CLI::App* command = app.add_subcommand(
      "fuzz-vectors", "Random worlds with every kind of vectors, compared with scalar ones");
  add_fuzz_options(*command, options->run, options->json, "worlds");
  command->add_option("--ticks", options->run.ticks, "Ticks of each")->capture_default_str();
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace lockstone::tool
