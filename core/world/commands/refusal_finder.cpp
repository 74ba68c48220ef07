#include "core/world/commands/refusal_finder.h"

#include "core/math/rotation_log.h"

namespace lockstone {

std::string joined(std::initializer_list<std::string_view> pieces) {
  std::string text;
  for (const std::string_view piece : pieces)
    text += piece;
  return text;
}

std::string RefusalFinder::number_text(std::int64_t raw, Format format) {
  const std::string number = format_decimal(raw, format.bits);
  return format.unit.empty() ? number : joined({number, " ", format.unit});
}

std::string RefusalFinder::handle_text(std::uint32_t index, std::uint32_t generation) {
  return joined({"{", std::to_string(index), ", ", std::to_string(generation), "}"});
}

void RefusalFinder::note(std::string_view field, std::string_view value, std::string_view rule) {
  found_ = {joined({prefix_, field}), std::string(value), joined({"must be ", rule})};
}

void RefusalFinder::note_range(std::string_view field, std::int64_t value, std::int64_t low,
                               std::int64_t high, Format format) {
  if (done()) return;
  note(field, number_text(value, format),
       joined({format_decimal(low, format.bits), " … ", number_text(high, format)}));
}

void RefusalFinder::note_least(std::string_view field, std::int64_t value, std::int64_t low,
                               Format format) {
  if (done()) return;
  note(field, number_text(value, format), joined({"at least ", number_text(low, format)}));
}

void RefusalFinder::note_positive(std::string_view field, std::int64_t value, Format format) {
  if (done()) return;
  note(field, number_text(value, format), joined({"above 0 ", format.unit}));
}

void RefusalFinder::note_unknown(std::string_view field, int value, Named first, Named last) {
  if (done()) return;
  note(field, std::to_string(value),
       joined({first.name, " … ", last.name, " (", std::to_string(first.number), " … ",
               std::to_string(last.number), ")"}));
}

void RefusalFinder::direction(std::string_view field, const Quat& q) {
  if (has_direction(q)) return;
  require(false, field,
          joined({"(", text(q.x), ", ", text(q.y), ", ", text(q.z), ", ", text(q.w), ")"}),
          "a quaternion of a norm well above 0");
}

}  // namespace lockstone
