#include "tools/tool/loaded_simulation.h"

#include <algorithm>
#include <string_view>
#include <utility>

namespace lockstone::tool {
namespace {

constexpr std::size_t k_most_stages = 64;

const std::uint8_t* bytes_of(ByteView view) {
  return reinterpret_cast<const std::uint8_t*>(view.data());
}

std::uint32_t number_of(SnapshotKind kind) {
  return kind == SnapshotKind::native ? LOCKSTONE_GAME_NATIVE : LOCKSTONE_GAME_CANONICAL;
}

template <std::size_t N>
std::string field_text(const char (&text)[N]) {
  return {text, std::find(text, text + N, '\0')};
}

// Interned: a PartHash is a view of a name that lives as long as the program.
std::string_view lasting(const char* name) {
  static thread_local std::array<std::unique_ptr<std::string>, 64> names;
  const std::string_view wanted = name == nullptr ? "" : name;
  for (std::unique_ptr<std::string>& kept : names) {
    if (kept == nullptr) kept = std::make_unique<std::string>(wanted);
    if (*kept == wanted) return *kept;
  }
  return "part";
}

// The members that every table of this ABI has, up to the last required one.
constexpr std::size_t k_required_bytes = offsetof(lockstone_game_table, part_hashes);

bool is_complete(const lockstone_game_table& table) {
  return table.name != nullptr && *table.name != '\0' && table.create != nullptr &&
         table.destroy != nullptr && table.info != nullptr && table.tick != nullptr &&
         table.step != nullptr && table.snapshot_bytes_max != nullptr && table.save != nullptr &&
         table.load != nullptr && table.hash != nullptr;
}

}  // namespace

Status game_status(std::int32_t code) {
  const bool known = code >= 0 && code <= static_cast<std::int32_t>(Status::not_found);
  return known ? static_cast<Status>(code) : Status::malformed;
}

Result<std::shared_ptr<const lockstone_game_table>> full_table(const lockstone_game_table* table,
                                                               std::string& why) {
  if (table == nullptr || table->abi != LOCKSTONE_GAME_ABI) {
    why = "it is a game of ABI " + std::to_string(table == nullptr ? 0 : table->abi) +
          "; this tool loads ABI " + std::to_string(LOCKSTONE_GAME_ABI) +
          ": build the game with the lockstone/game_abi.h of this tool";
    return Status::unsupported_version;
  }
  if (table->bytes < k_required_bytes || !is_complete(*table)) {
    why = "its table of functions lacks a required one: see lockstone/game_abi.h";
    return Status::malformed;
  }
  auto full = std::make_shared<lockstone_game_table>();
  const std::size_t bytes = std::min<std::size_t>(table->bytes, sizeof(lockstone_game_table));
  std::copy_n(reinterpret_cast<const std::byte*>(table), bytes,
              reinterpret_cast<std::byte*>(full.get()));
  return std::shared_ptr<const lockstone_game_table>(std::move(full));
}

LoadedSimulation::LoadedSimulation(std::shared_ptr<const lockstone_game_table> table, void* match)
    : table_(std::move(table)), match_(match) {
  lockstone_game_info info{};
  table_->info(match_, &info);
  info_ = {.abi = info.abi,
           .config_hash = info.config_hash,
           .scene_hash = info.scene_hash,
           .canary = info.canary,
           .tick_rate = info.tick_rate,
           .player_count = info.player_count,
           .input_bytes = info.input_bytes};
}

bool LoadedSimulation::in_range() const {
  return info_.tick_rate > 0 && info_.player_count > 0 && info_.player_count <= k_max_players &&
         info_.input_bytes > 0 && info_.input_bytes <= k_max_input_bytes;
}

void LoadedSimulation::step(std::span<const PlayerInput> inputs) {
  table_->step(match_, pass(inputs), inputs.size());
}

void LoadedSimulation::command(const PlayerCommand& command) {
  if (table_->command == nullptr) return;
  table_->command(match_, command.slot, bytes_of(command.bytes), command.bytes.size());
}

std::size_t LoadedSimulation::snapshot_bytes_max(SnapshotKind kind) const {
  return table_->snapshot_bytes_max(match_, number_of(kind));
}

std::size_t LoadedSimulation::save(SnapshotKind kind, std::span<std::byte> out) const {
  auto* bytes = reinterpret_cast<std::uint8_t*>(out.data());
  return std::min(table_->save(match_, number_of(kind), bytes, out.size()), out.size());
}

Status LoadedSimulation::load(SnapshotKind kind, ByteView bytes) {
  return game_status(table_->load(match_, number_of(kind), bytes_of(bytes), bytes.size()));
}

const lockstone_game_input* LoadedSimulation::pass(std::span<const PlayerInput> inputs) {
  for (std::size_t slot = 0; slot < inputs.size(); ++slot) {
    passed_[slot] = {bytes_of(inputs[slot].bytes), static_cast<std::uint32_t>(inputs[slot].origin)};
  }
  return passed_.data();
}

std::size_t LoadedSimulation::part_hashes(std::span<PartHash, k_max_state_parts> out) const {
  static_assert(LOCKSTONE_GAME_MAX_PARTS == k_max_state_parts);
  if (table_->part_hashes == nullptr) return 0;
  std::array<lockstone_game_hash, k_max_state_parts> parts{};
  const std::size_t count = std::min(table_->part_hashes(match_, parts.data()), parts.size());
  for (std::size_t i = 0; i < count; ++i)
    out[i] = {lasting(parts[i].name), {.low = parts[i].low, .high = parts[i].high}};
  return count;
}

StateDifference LoadedSimulation::describe(ByteView here, ByteView there) const {
  StateDifference difference;
  if (table_->describe == nullptr) return difference;
  lockstone_game_difference found{};
  difference.differs = table_->describe(match_, bytes_of(here), here.size(), bytes_of(there),
                                        there.size(), &found) != 0;
  difference.object = found.object;
  difference.store = field_text(found.store);
  difference.name = field_text(found.name);
  difference.field = field_text(found.field);
  difference.here = field_text(found.here);
  difference.there = field_text(found.there);
  return difference;
}

StageTrace LoadedSimulation::step_traced(std::span<const PlayerInput> inputs) {
  StageTrace trace;
  if (table_->step_traced == nullptr) {
    step(inputs);
    return trace;
  }
  std::array<lockstone_game_hash, k_most_stages> stages{};
  const std::size_t count =
      table_->step_traced(match_, pass(inputs), inputs.size(), stages.data(), stages.size());
  for (std::size_t i = 0; i < std::min(count, stages.size()); ++i)
    trace.push_back({stages[i].name == nullptr ? "" : stages[i].name, stages[i].low});
  return trace;
}

Result<std::unique_ptr<Simulation>> make_loaded(
    const std::shared_ptr<const lockstone_game_table>& table, ByteView config) {
  void* match = nullptr;
  const Status status = game_status(table->create(bytes_of(config), config.size(), &match));
  if (status != Status::ok) return status;
  if (match == nullptr) return Status::malformed;
  auto made = std::make_unique<LoadedSimulation>(table, match);
  if (!made->in_range()) return Status::malformed;
  return std::unique_ptr<Simulation>(std::move(made));
}

}  // namespace lockstone::tool
