// Where two states first differ, down to the field.

#include <array>
#include <string>
#include <vector>

#include "core/world/snapshot_format.h"

namespace lockstone {
namespace {

struct Field {
  std::string name;
  std::string value;
};

template <class T>
std::string hexadecimal(T value) {
  constexpr char k_digits[] = "0123456789abcdef";
  auto bits = static_cast<std::make_unsigned_t<T>>(value);
  std::string text(sizeof(T) * 2, '0');
  for (std::size_t i = text.size(); i-- > 0; bits = static_cast<decltype(bits)>(bits >> 4)) {
    text[i] = k_digits[bits & 0xf];
  }
  return text.insert(0, "0x");
}

template <class Record>
std::vector<Field> fields_of(Record record) {
  std::vector<Field> fields;
  visit_fields(record, [&](const char* name, const char* suffix, auto& integer) {
    fields.push_back({std::string(name) + suffix, hexadecimal(integer)});
  });
  return fields;
}

template <class Record>
StateDifference compare(const char* store, std::uint64_t object, const Record& here,
                        const Record& there) {
  const std::vector<Field> a = fields_of(here), b = fields_of(there);
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i].value == b[i].value) continue;
    return {true, store, object, "", a[i].name, a[i].value, b[i].value};
  }
  return {};
}

StateDifference unreadable(const char* side, Status status) {
  return {true, "snapshot", 0, side, "bytes", std::string(to_string(status)), ""};
}

StateDifference compare_bodies(const SnapshotView& here, const SnapshotView& there) {
  const std::uint32_t limit = std::max(here.header.body_limit, there.header.body_limit);
  for (std::uint32_t i = 0; i < limit; ++i) {
    const BodyRecord a = i < here.header.body_limit ? here.body(i) : BodyRecord{};
    const BodyRecord b = i < there.header.body_limit ? there.body(i) : BodyRecord{};
    if (const StateDifference found = compare("body", i, a, b); found.differs) return found;
  }
  return {};
}

StateDifference compare_contacts(const SnapshotView& here, const SnapshotView& there) {
  const std::uint32_t limit = std::max(here.header.contact_count, there.header.contact_count);
  for (std::uint32_t i = 0; i < limit; ++i) {
    const ContactRecord a = i < here.header.contact_count ? here.contact(i) : ContactRecord{};
    const ContactRecord b = i < there.header.contact_count ? there.contact(i) : ContactRecord{};
    StateDifference found = compare("contact", i, a, b);
    if (!found.differs) continue;
    found.name = std::to_string(a.body_a).append("-").append(std::to_string(a.body_b));
    return found;
  }
  return {};
}

StateDifference compare_joints(const SnapshotView& here, const SnapshotView& there) {
  const std::uint32_t limit = std::max(here.header.joint_limit, there.header.joint_limit);
  for (std::uint32_t i = 0; i < limit; ++i) {
    const JointRecord a = i < here.header.joint_limit ? here.joint(i) : JointRecord{};
    const JointRecord b = i < there.header.joint_limit ? there.joint(i) : JointRecord{};
    if (const StateDifference found = compare("joint", i, a, b); found.differs) return found;
  }
  return {};
}

}  // namespace

StateDifference World::describe_difference(ByteView here, ByteView there) const {
  const Result<SnapshotView> a = SnapshotView::open(here, impl_->def, *impl_->assets);
  if (!a.ok()) return unreadable("here", a.status());
  const Result<SnapshotView> b = SnapshotView::open(there, impl_->def, *impl_->assets);
  if (!b.ok()) return unreadable("there", b.status());
  WorldHeader common = b.value().header;  // store sizes differ because records do: name those first
  common.body_limit = a.value().header.body_limit;
  common.contact_count = a.value().header.contact_count;
  common.joint_limit = a.value().header.joint_limit;
  StateDifference found = compare("world", 0, a.value().header, common);
  if (!found.differs) found = compare_bodies(a.value(), b.value());
  if (!found.differs) found = compare_contacts(a.value(), b.value());
  if (!found.differs) found = compare_joints(a.value(), b.value());
  return found;
}

}  // namespace lockstone
