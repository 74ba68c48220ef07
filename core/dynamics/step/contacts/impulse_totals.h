// The impulses of chosen contacts, added up over the substeps of a tick: a record keeps those of
// the last substep alone.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/dynamics/contact/row_geometry.h"
#include "core/dynamics/step/contacts/contact_constraints.h"
#include "core/dynamics/step/input/contact_list.h"
#include "core/dynamics/step/input/contact_scene.h"

namespace lockstone {

/// The impulses of a tick on B as the pair's velocity jump, λ·(1/mA + 1/mB), m/s, Q20.
struct ImpulseTotal {
  std::uint32_t record = 0;
  std::array<std::int64_t, 4> points{};    ///< along the normal, by point
  std::array<std::int64_t, 3> friction{};  ///< of all points, in world axes
};

class ImpulseTotals {
 public:
  /// No function but this allocates.
  [[gnu::cold]] explicit ImpulseTotals(std::size_t capacity);

  /// Once blocks are prepared: takes the contacts among the watched ones that come in fast, the
  /// first ones if there are more than the capacity.
  /// `converged`: the contacts that converged islands took over.
  void begin(std::span<const WatchedContact> watched, const ContactList& contacts,
             const ContactConstraints& constraints, std::span<const ProximalContact> converged);
  [[nodiscard]] bool empty() const { return entries_.empty(); }
  [[nodiscard]] bool is_full() const { return entries_.size() == capacity_; }

  /// After a substep: all contacts but those of whole islands.
  void note(const ContactRun& run);
  /// The same for a contact of a whole island.
  void note(const ContactRun& run, ContactId contact);
  /// After the last iteration: bounces have pushed since the last substep.
  void end(const ContactRun& run);
  /// Two balls changed their relative velocity by `jump` at once.
  void add_impact(ContactId contact, const Vec3<Velocity>& jump, const Vec3<Unit>& normal);

  /// Calls `visit(total)` for each contact, by record.
  template <class Visit>
  void for_each(Visit&& visit) const {
    for (const Entry& entry : entries_)
      visit(entry.total);
  }

 private:
  using Impulses = std::array<std::int64_t, 4>;  // by point

  struct Entry {
    ContactId contact;
    ContactLane place;
    const ProximalContact* converged = nullptr;  // null: of an iterated island
    ImpulseTotal total;
    Impulses last{};  // of the substep noted last
  };

  static void add(const ContactRun& run, Entry& entry);
  [[nodiscard]] static Impulses impulses_of(const Entry& entry, const ContactRun& run);
  [[nodiscard]] Entry* find(ContactId contact);

  std::size_t capacity_;
  std::vector<Entry> entries_;  // by contact
};

}  // namespace lockstone
