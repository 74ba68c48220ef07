// The output and the page of `lockstone bench general`.
#pragma once

#include <span>
#include <string>

#include "tools/bench/general/run.h"
#include "tools/lockstone/support/output_file.h"

namespace lockstone::tool {

/// A line a family and engine.
[[nodiscard]] std::string general_table(std::span<const bench::FamilyRun> runs);

/// How each of our failing seeds is played again, a line each; `settings` are options of the
/// command.
[[nodiscard]] std::string general_failures(std::span<const bench::FamilyRun> runs,
                                           std::uint64_t first_seed, std::string_view settings);

/// The table as Markdown, with a head that describes it. `contacts`: the name of a chart beside it;
/// empty: none.
[[nodiscard]] std::string general_page(std::span<const bench::FamilyRun> runs,
                                       std::string_view command, std::string_view contacts);

/// A chart a family into a folder: the errors of each engine, in order. False when the system
/// refuses.
[[nodiscard]] bool plot_general(std::span<const bench::FamilyRun> runs, const Output& folder);

/// The worst error of each engine over the number of contacts of its scenes, a chart a family, as
/// one SVG.
[[nodiscard]] std::string contacts_sheet(std::span<const bench::FamilyRun> runs);

void print_general_json(std::span<const bench::FamilyRun> runs, std::uint64_t first_seed);

}  // namespace lockstone::tool
