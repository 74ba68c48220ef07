// What the parts of direct contacts share: formats and bounds.
#pragma once

#include "core/dynamics/block_words.h"
#include "core/dynamics/direct_contacts.h"

namespace lockstone {

/// What pushes overlap out gives way to its impulse by this part of a row's own response: where
/// points say the same, each takes a share.
inline constexpr int k_give_shift = 17;

/// What a row's speed and what is asked of it are held within, Q50.
inline constexpr std::int64_t k_direct_bound = std::int64_t{1} << 60;

/// No solving for what is slower, Q50: 3.8 µm/s.
inline constexpr std::int64_t k_direct_slow = std::int64_t{1} << 32;

}  // namespace lockstone
