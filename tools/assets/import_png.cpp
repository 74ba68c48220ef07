#include <lockstone/height_field.h>

#include "tools/assets/import.h"
#include "tools/assets/png_reader.h"

namespace lockstone::assets {
namespace {

/// The samples 0 … 65535 over the whole height, each to nearest.
std::vector<Length> heights_of(const GreyImage& image, Length height) {
  std::vector<Length> heights;
  heights.reserve(image.samples.size());
  for (const std::uint16_t sample : image.samples) {
    const std::int64_t raw = raw::round_divide(std::int64_t{height.raw} * sample, 65535);
    heights.push_back(Length::from_raw(static_cast<std::int32_t>(raw)));
  }
  return heights;
}

/// Where a row of `count` samples about 0 begins, never beyond the range of lengths.
Length first_of(std::uint32_t count, Length cell) {
  const std::int64_t width = std::int64_t{cell.raw} * (count - 1);
  return Length::from_raw(raw::saturate<std::int32_t>(-width / 2));
}

}  // namespace

ImportOutcome import_png(ByteView file, const PngImport& options, Imported& out) {
  GreyImage image;
  if (ImportOutcome fault = read_png(file, image)) return fault;
  const std::vector<Length> heights = heights_of(image, options.height);
  HeightFieldDef def;
  def.columns = image.columns;
  def.rows = image.rows;
  def.origin = {first_of(image.columns, options.cell), options.base,
                first_of(image.rows, options.cell)};
  def.cell_x = def.cell_z = options.cell;
  def.heights = heights;
  const HeightFieldResult built = HeightField::build(def);
  if (!built.ok()) return ImportFault{0, std::string(to_string(built.fault))};
  out.asset = built.height_field;
  return std::nullopt;
}

}  // namespace lockstone::assets
