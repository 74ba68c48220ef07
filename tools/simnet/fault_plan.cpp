#include "tools/simnet/fault_plan.h"

#include <algorithm>

namespace lockstone::simnet {
namespace {

constexpr std::int64_t k_base_delay_us = 5'000;
constexpr std::int64_t k_reorder_us = 100'000;

void add_to(net::LinkFaults& faults, const FaultEvent& event) {
  switch (event.kind) {
    case FaultKind::loss:
      faults.loss_ppm = event.amount;
      break;
    case FaultKind::burst:
      faults.burst_start_ppm = event.amount;
      break;
    case FaultKind::duplicate:
      faults.duplicate_ppm = event.amount;
      break;
    case FaultKind::reorder:
      faults.reorder_ppm = event.amount;
      faults.reorder_us = k_reorder_us;
      break;
    case FaultKind::delay:
      faults.delay_us = std::int64_t{event.amount} * 1000;
      break;
    case FaultKind::jitter:
      faults.jitter_us = std::int64_t{event.amount} * 1000;
      break;
    case FaultKind::corrupt:
      faults.corrupt_ppm = event.amount;
      break;
    case FaultKind::truncate:
      faults.truncate_ppm = event.amount;
      break;
    default:
      break;
  }
}

}  // namespace

net::LinkFaults FaultPlan::faults_of(std::size_t client) const {
  net::LinkFaults faults;
  faults.delay_us = k_base_delay_us;
  for (std::size_t i = 0; i < schedule_.size(); ++i) {
    if (active_[i] && schedule_[i].client == client) add_to(faults, schedule_[i]);
  }
  return faults;
}

std::int64_t FaultPlan::dead_until_us(std::size_t client) const {
  std::int64_t until_us = 0;
  for (std::size_t i = 0; i < schedule_.size(); ++i) {
    const FaultEvent& event = schedule_[i];
    if (!active_[i] || event.kind != FaultKind::kill || event.client != client) continue;
    until_us = time_us(event.until_ms);
  }
  return until_us;
}

bool FaultPlan::has_just_come_back(std::size_t client, std::int64_t now_us) const {
  constexpr std::int64_t k_margin_us = 50'000;  // steps, and pauses between packets
  const std::int64_t since_us = now_us - 3 * (faults_of(client).delay_us + k_margin_us);
  return std::any_of(schedule_.begin(), schedule_.end(), [&](const FaultEvent& event) {
    return event.client == client && silences(event.kind) && time_us(event.from_ms) <= now_us &&
           time_us(event.until_ms) >= since_us;
  });
}

// Half of the forgeries look like messages.
ByteView FaultPlan::draw_forgery(std::uint32_t ppm) {
  if (!forgery_.chance(ppm)) return {};
  for (std::byte& byte : forged_)
    byte = static_cast<std::byte>(forgery_.below(256));
  if (forgery_.chance(500'000)) forged_[0] = static_cast<std::byte>(1 + forgery_.below(14));
  return ByteView(forged_).first(static_cast<std::size_t>(1 + forgery_.below(forged_.size())));
}

}  // namespace lockstone::simnet
