// The output of `lockstone bench size`.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "tools/bench/size/size_run.h"

namespace lockstone::tool {

/// The table's first line.
[[nodiscard]] std::string size_head(std::string_view clock_name);

[[nodiscard]] std::string size_line(const bench::SizeFigures& figures);

/// The table as Markdown, with a head that describes it. `chart`: the name of the chart beside it;
/// empty: none.
[[nodiscard]] std::string size_page(std::span<const bench::SizeFigures> all,
                                    std::string_view clock_name, std::string_view command,
                                    std::string_view chart);

/// Time and memory over the number of bodies, a line a kind, as one SVG.
[[nodiscard]] std::string size_sheet(std::span<const bench::SizeFigures> all);

void print_size_json(std::span<const bench::SizeFigures> all, std::string_view clock_name);

}  // namespace lockstone::tool
