#include "core/world/phases/vehicle/tyre_curve.h"

#include <array>

namespace lockstone {
namespace {

// sin(C·atan(tan(π/2C)·x)) for x = 0, 1/8 … 8, 30 fraction bits; C = 1.65 along and 1.3 across.
// clang-format off
constexpr std::array<std::int32_t, 65> k_along{
    0, 303658794, 567711101, 770085859, 909323452, 996260790, 1044943910,
    1067701477, 1073741824, 1069405723, 1058873978, 1044837362, 1029001724, 1012435203,
    995796923, 979484727, 963729887, 948657749, 934326633, 920752856, 907926869,
    895823691, 884409634, 873646632, 863495003, 853915177, 844868753, 836319112,
    828231748, 820574399, 813317075, 806432000, 799893514, 793677952, 787763509,
    782130104, 776759245, 771633900, 766738375, 762058201, 757580028, 753291528,
    749181309, 745238832, 741454340, 737818787, 734323784, 730961535, 727724795,
    724606822, 721601334, 718702474, 715904775, 713203126, 710592752, 708069180,
    705628218, 703265938, 700978650, 698762888, 696615393, 694533099, 692513117,
    690552724, 688649351};
constexpr std::array<std::int32_t, 65> k_across{
    0, 431841156, 737897764, 911381325, 1000161414, 1043528502, 1063624813,
    1071780879, 1073741824, 1072476705, 1069559202, 1065842510, 1061796553, 1057681639,
    1053640708, 1049749772, 1046046227, 1042545086, 1039248459, 1036151167, 1033244094,
    1030516195, 1027955696, 1025550804, 1023290109, 1021162804, 1019158792, 1017268720,
    1015483973, 1013796648, 1012199509, 1010685941, 1009249896, 1007885852, 1006588760,
    1005354002, 1004177351, 1003054935, 1001983203, 1000958894, 999979011, 999040795,
    998141703, 997279391, 996451690, 995656598, 994892258, 994156950, 993449075,
    992767150, 992109793, 991475717, 990863723, 990272691, 989701575, 989149394,
    988615234, 988098234, 987597589, 987112541, 986642379, 986186435, 985744078,
    985314714, 984897783};
// clang-format on

// On straight lines; beyond the table its last value.
Real value_at(const std::array<std::int32_t, 65>& table, Real x) {
  constexpr int k_step_bits = 29;  // an eighth
  const auto at = static_cast<std::uint64_t>(x.raw) >> k_step_bits;
  if (at >= table.size() - 1) return {std::int64_t{table.back()} << 2};
  const Real rest{x.raw - static_cast<std::int64_t>(at << k_step_bits)};
  const Real low{std::int64_t{table[at]} << 2}, high{std::int64_t{table[at + 1]} << 2};
  return low + (high - low) * Real{rest.raw << 3};
}

}  // namespace

// Where both are small the curves are lines through zero.
Grip grip_of(Real along, Real across) {
  constexpr Real k_small{std::int64_t{1} << 26};
  const Real slip = length_real(along, across);
  const Real at = slip > k_small ? slip : k_small;
  const Real inverse = k_real_one / at;
  const Real part = along * inverse, other = across * inverse;
  const Real share = clamp_real(part * part, Real{}, k_real_one);
  const Real size = value_at(k_along, at) * share + value_at(k_across, at) * (k_real_one - share);
  return {part * size, other * size};
}

}  // namespace lockstone
