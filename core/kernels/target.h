// Which vectors the kernels use. A choice of speed alone: every target computes the same bits.
#pragma once

#include <span>
#include <string_view>

#include <lockstone/status.h>

namespace lockstone::lanes {

/// The targets that this build has and this processor can run, the best last. The first is
/// `scalar`; others are named `sse4`, `avx2`, `avx512`, `neon`, `wasm`.
[[nodiscard]] std::span<const std::string_view> supported_targets();

/// The one in force: the best supported unless another is forced.
[[nodiscard]] std::string_view current_target();

/// Forces a target for the whole process, even where narrower vectors hold all there is; with an
/// empty name, none any more. To be called before worlds are stepped on other threads.
/// Errors: not_found when it is not among the supported ones; then nothing changes.
Status set_target(std::string_view name);

}  // namespace lockstone::lanes
