// libpng returns from a fault by longjmp, which skips destructors: the functions that call setjmp,
// and those below them, hold only trivial objects.
#include "tools/assets/png_reader.h"

#include <algorithm>
#include <csetjmp>
#include <cstdio>
#include <cstring>

#include <fmt/format.h>
#include <png.h>

#include <lockstone/height_field.h>

namespace lockstone::assets {
namespace {

struct Input {
  ByteView rest;
  char reason[96] = {};
};

struct Head {
  png_uint_32 columns = 0;
  png_uint_32 rows = 0;
  int depth = 0;
  int colour = 0;
};

[[noreturn]] void on_error(png_structp png, png_const_charp message) {
  auto* input = static_cast<Input*>(png_get_error_ptr(png));
  std::snprintf(input->reason, sizeof input->reason, "%s", message);
  png_longjmp(png, 1);
}

void on_warning(png_structp, png_const_charp) {}

void on_read(png_structp png, png_bytep out, std::size_t count) {
  auto* input = static_cast<Input*>(png_get_io_ptr(png));
  if (count > input->rest.size()) png_error(png, "the file ends early");
  std::memcpy(out, input->rest.data(), count);
  input->rest = input->rest.subspan(count);
}

/// libpng's objects for one file.
class Reader {
 public:
  explicit Reader(Input& input)
      : png_(png_create_read_struct(PNG_LIBPNG_VER_STRING, &input, on_error, on_warning)),
        info_(png_ != nullptr ? png_create_info_struct(png_) : nullptr) {
    if (png_ != nullptr) png_set_read_fn(png_, &input, on_read);
  }
  ~Reader() { png_destroy_read_struct(&png_, &info_, nullptr); }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  [[nodiscard]] bool ok() const { return info_ != nullptr; }

  /// False when libpng found a fault.
  [[nodiscard]] bool read_head(Head& head) {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    png_set_crc_action(png_, PNG_CRC_ERROR_QUIT, PNG_CRC_ERROR_QUIT);
    png_set_benign_errors(png_, 0);
    png_read_info(png_, info_);
    (void)png_get_IHDR(png_, info_, &head.columns, &head.rows, &head.depth, &head.colour, nullptr,
                       nullptr, nullptr);
    return true;
  }

  /// Both bytes of every sample, the high one first; false when libpng found a fault.
  [[nodiscard]] bool read_rows(png_bytepp rows) {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    png_read_image(png_, rows);
    png_read_end(png_, nullptr);
    return true;
  }

 private:
  png_structp png_;
  png_infop info_;
};

ImportOutcome refuse(std::string reason) {
  return ImportFault{0, std::move(reason)};
}

ImportOutcome judge(const Head& head) {
  if (head.colour != PNG_COLOR_TYPE_GRAY) return refuse("not greyscale without transparency");
  if (head.depth != 16) return refuse(fmt::format("{} bits a sample, not 16", head.depth));
  const auto fits = [](png_uint_32 n) { return n >= 2 && n <= k_max_height_field_samples; };
  if (fits(head.columns) && fits(head.rows)) return std::nullopt;
  return refuse(fmt::format("{} by {} samples; a side has 2 … {}", head.columns, head.rows,
                            k_max_height_field_samples));
}

}  // namespace

ImportOutcome read_png(ByteView file, GreyImage& image) {
  Input input{file};
  Reader reader(input);
  Head head;
  if (!reader.ok()) return refuse("libpng is out of memory");
  if (!reader.read_head(head)) return refuse(fmt::format("damaged PNG: {}", input.reason));
  if (ImportOutcome fault = judge(head)) return fault;
  std::vector<png_byte> bytes(2 * std::size_t{head.columns} * head.rows);
  std::vector<png_bytep> rows;
  for (std::size_t row = 0; row < head.rows; ++row)
    rows.push_back(bytes.data() + 2 * head.columns * row);
  if (!reader.read_rows(rows.data())) return refuse(fmt::format("damaged PNG: {}", input.reason));
  image.columns = head.columns;
  image.rows = head.rows;
  image.samples.resize(bytes.size() / 2);
  for (std::size_t i = 0; i < image.samples.size(); ++i)
    image.samples[i] = static_cast<std::uint16_t>(bytes[2 * i] << 8 | bytes[2 * i + 1]);
  return std::nullopt;
}

}  // namespace lockstone::assets
