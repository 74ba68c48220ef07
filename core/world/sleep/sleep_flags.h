// The flag that says whether a body is awake, and the data derived from it.
#pragma once

#include <cstdint>
#include <vector>

#include <lockstone/event.h>

#include "core/dynamics/body/rest.h"
#include "core/world/data/world_data.h"
#include "core/world/derived/index_set.h"

namespace lockstone {

/// Every change of the flag goes through this class: it keeps the set of awake bodies, the number
/// of sleeping ones, and the bodies whose flag changed in this tick.
class SleepFlags {
 public:
  /// No function but this allocates. `world` outlives this.
  explicit SleepFlags(WorldData& world);

  [[nodiscard]] const RestRules& rest_rules() const { return rest_rules_; }
  [[nodiscard]] std::uint32_t asleep_count() const { return asleep_count_; }
  [[nodiscard]] bool has_changed(std::uint32_t body) const { return changed_.has(body); }

  void set_awake(std::uint32_t body);
  void set_asleep(std::uint32_t body);
  /// For a body that is about to be destroyed.
  void forget(std::uint32_t body);

  /// Adds an event for each body whose flag is not as it was a tick ago.
  void add_events(std::vector<ContactEvent>& events);

  /// Derives all data from the records.
  void rebuild();
  /// The same for one record that was loaded; `set_asleep_count` follows once all are.
  void note_loaded(std::uint32_t body);
  void set_asleep_count(std::uint32_t count) { asleep_count_ = count; }

 private:
  void note_changed(std::uint32_t body);
  void finish_change(std::uint32_t body);

  WorldData& world_;
  const RestRules rest_rules_;
  std::uint32_t asleep_count_ = 0;
  IndexSet changed_;  // bodies whose records have k_body_changed_sleep
};

}  // namespace lockstone
