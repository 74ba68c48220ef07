// tinyobjloader tells the statements apart. It tells neither the line of a fault nor that a number
// is none (it reads 0), and its doubles are not correctly rounded. So it is fed line by line, each
// line is checked before, and coordinates are read from their text.
#include "tools/assets/obj_reader.h"

#include <algorithm>
#include <array>
#include <istream>
#include <map>
#include <streambuf>

#include <fmt/format.h>
#define TINYOBJLOADER_IMPLEMENTATION
#include <tiny_obj_loader.h>

#include "tools/assets/polygon.h"

namespace lockstone::assets {
namespace {

using Words = std::vector<std::string_view>;

Words split(std::string_view line) {
  constexpr std::string_view k_blank = " \t";
  Words words;
  for (std::size_t at = line.find_first_not_of(k_blank); at != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(k_blank, at), line.size());
    words.push_back(line.substr(at, end - at));
    at = line.find_first_not_of(k_blank, end);
  }
  return words;
}

/// Text of the file in an error message: short, and printable.
std::string quoted(std::string_view text) {
  std::string shown(text.substr(0, 24));
  for (char& c : shown)
    if (c < ' ' || c > '~') c = '?';
  return fmt::format("'{}'", shown);
}

std::string refusal_of_vertex(const Words& words) {
  if (words.size() < 4 || words.size() > 8) return "a vertex needs three coordinates";
  for (std::size_t i = 1; i < words.size(); ++i)
    if (!read_scientific(words[i])) return fmt::format("{} is no number", quoted(words[i]));
  return {};
}

/// Digits, signs and slashes; numbers of up to nine digits.
bool is_corner(std::string_view word) {
  int digits = 0;
  for (const char c : word) {
    const bool digit = c >= '0' && c <= '9';
    digits = digit ? digits + 1 : 0;
    if (digits > 9 || (!digit && c != '-' && c != '/')) return false;
  }
  return true;
}

std::string refusal_of_face(const Words& words) {
  if (words.size() < 4) return "a face needs at least three corners";
  if (words.size() > 1 + k_max_face_corners)
    return fmt::format("a face has more than {} corners", k_max_face_corners);
  for (std::size_t i = 1; i < words.size(); ++i)
    if (!is_corner(words[i])) return fmt::format("{} is no vertex number", quoted(words[i]));
  return {};
}

/// Whether the model has a use for statements of this kind.
bool is_of_use(std::string_view keyword) {
  constexpr std::array<std::string_view, 5> k_used{"v", "f", "o", "g", "usemtl"};
  return std::ranges::find(k_used, keyword) != k_used.end();
}

/// Why the statement is not understood, or nothing.
std::string refusal_of(const Words& words) {
  constexpr std::array<std::string_view, 12> k_known{"v", "vn", "vt",     "f",      "o", "g",
                                                     "s", "l",  "usemtl", "mtllib", "p", "vp"};
  const std::string_view keyword = words.front();
  if (std::ranges::find(k_known, keyword) == k_known.end())
    return fmt::format("{} is no statement that can be imported", quoted(keyword));
  if (keyword == "v") return refusal_of_vertex(words);
  if (keyword == "f") return refusal_of_face(words);
  return {};
}

/// The file, line by line, for a reader that takes a line, handles it, and comes for the next.
class LineSource : public std::streambuf {
 public:
  explicit LineSource(std::string_view text) : rest_(text) {}

  [[nodiscard]] std::uint32_t number() const { return number_; }
  [[nodiscard]] const Words& words() const { return words_; }
  [[nodiscard]] const ImportOutcome& fault() const { return fault_; }

  /// The line is wrong; there will be no other.
  void refuse(std::string reason) {
    if (!fault_) fault_ = ImportFault{number_, std::move(reason)};
  }

 protected:
  int_type underflow() override {
    do {
      if (fault_ || rest_.empty()) return traits_type::eof();
      take_line();
    } while (!is_wanted());
    setg(line_.data(), line_.data(), line_.data() + line_.size());
    return traits_type::to_int_type(line_.front());
  }

 private:
  /// Lines end in LF, CR or both.
  void take_line() {
    const std::size_t end = std::min(rest_.find_first_of("\r\n"), rest_.size());
    line_.assign(rest_.substr(0, end));
    line_ += '\n';
    const bool both = rest_.substr(end, 2) == "\r\n";
    rest_.remove_prefix(std::min(end + (both ? 2 : 1), rest_.size()));
    ++number_;
  }

  /// Whether the line is for the loader; refuses a wrong one.
  bool is_wanted() {
    words_ = split(std::string_view(line_).substr(0, line_.size() - 1));
    if (line_.find('\0') != std::string::npos) refuse("a zero byte: this is no text");
    if (fault_ || words_.empty() || words_.front().front() == '#') return false;
    if (std::string why = refusal_of(words_); !why.empty()) refuse(std::move(why));
    return !fault_ && is_of_use(words_.front());
  }

  std::string_view rest_;
  std::string line_;
  Words words_;
  std::uint32_t number_ = 0;
  ImportOutcome fault_;
};

/// A list of names without repetition, and where its last statement stands in it.
class NameList {
 public:
  explicit NameList(std::vector<std::string>& names) : names_(names) {}

  void set(std::string_view name) {
    const auto last = name.find_last_not_of(" \t");
    name = name.substr(0, last == std::string_view::npos ? 0 : last + 1);
    const auto next = static_cast<std::uint32_t>(names_.size());
    const auto [at, added] = index_.emplace(name, next);
    if (added) names_.emplace_back(name);
    current_ = at->second;
  }
  [[nodiscard]] std::uint32_t current() const { return current_; }

 private:
  std::vector<std::string>& names_;
  std::map<std::string, std::uint32_t> index_{{"", 0}};
  std::uint32_t current_ = 0;
};

constexpr Length k_most_degrees = Length::from_integer(360);
constexpr std::int64_t k_degree_q38 = 4'797'524'517;  // π / 180

class ModelBuilder {
 public:
  ModelBuilder(LineSource& source, const ObjOptions& options, ObjModel& model)
      : source_(source),
        options_(options),
        model_(model),
        object_(model.objects),
        group_(model.groups),
        material_(model.materials) {}

  void add_vertex() {
    Vec3<Length> v;
    const Words& words = source_.words();
    for (int axis = 0; axis < 3; ++axis) {  // a weight or a colour may follow
      const std::string_view word = words[static_cast<std::size_t>(axis) + 1];
      const auto length = scaled_length(read_scientific(word).value(), options_.scale);
      if (!length)
        return source_.refuse(fmt::format("{} times the scale is beyond 512 m", quoted(word)));
      v[axis] = *length;
    }
    if (model_.vertices.size() == k_max_mesh_vertices) return source_.refuse("too many vertices");
    if (options_.banks && !add_bank()) return;
    model_.vertices.push_back(options_.z_up ? Vec3<Length>{v.x, v.z, -v.y} : v);
    model_.vertex_lines.push_back(source_.number());
  }

  void add_face(std::span<const tinyobj::index_t> indices) {
    const Words& words = source_.words();
    if (indices.size() != words.size() - 1) return source_.refuse("a face that is not understood");
    face_.clear();
    for (std::size_t i = 0; i < indices.size(); ++i)
      if (!add_corner(words[i + 1], indices[i].vertex_index)) return;
    face_.size() == 3 ? add_triangle({0, 1, 2}) : add_polygon();
  }

  void set_object(std::string_view name) { object_.set(name); }
  void set_group(std::string_view name) { group_.set(name); }
  void set_material(std::string_view name) { material_.set(name); }

 private:
  bool add_bank() {
    const Words& words = source_.words();
    if (words.size() != 5) {
      source_.refuse("a vertex with a bank needs four numbers");
      return false;
    }
    const auto degrees = scaled_length(read_scientific(words[4]).value(), {false, 1, 0});
    if (!degrees || abs(*degrees) > k_most_degrees) {
      source_.refuse(fmt::format("{} is beyond 360 degrees", quoted(words[4])));
      return false;
    }
    model_.banks.push_back(Angle::from_raw(
        static_cast<std::int32_t>(raw::round_shift(degrees->raw * k_degree_q38, 31))));
    return true;
  }

  bool add_corner(std::string_view word, int index) {
    const std::string_view text = word.substr(0, word.find('/'));
    // The loader must have read the very text of the file.
    if (index == 0 || text != std::to_string(index)) {
      source_.refuse(fmt::format("{} is no vertex number", quoted(word)));
      return false;
    }
    const auto count = static_cast<std::int64_t>(model_.vertices.size());
    const std::int64_t vertex = index > 0 ? index - std::int64_t{1} : count + index;
    if (vertex < 0 || vertex >= count) {
      source_.refuse(fmt::format("vertex {} of {} so far", index, count));
      return false;
    }
    face_.push_back(static_cast<std::uint32_t>(vertex));
    return true;
  }

  void add_polygon() {
    std::vector<Vec3<Length>> corners;
    for (const std::uint32_t vertex : face_)
      corners.push_back(model_.vertices[vertex]);
    const auto triangles = triangulate(corners);
    if (!triangles) return source_.refuse("a polygon that crosses itself or has no area");
    for (const CornerTriple& t : *triangles)
      add_triangle(t);
  }

  void add_triangle(const CornerTriple& t) {
    if (model_.triangles.size() == k_max_mesh_triangles)
      return source_.refuse(fmt::format("more than {} triangles", k_max_mesh_triangles));
    const TriangleIndices corners{face_[t[0]], face_[t[1]], face_[t[2]]};
    model_.triangles.push_back(
        {corners, source_.number(), object_.current(), group_.current(), material_.current()});
  }

  LineSource& source_;
  const ObjOptions& options_;
  ObjModel& model_;
  std::vector<std::uint32_t> face_;
  NameList object_;
  NameList group_;
  NameList material_;
};

ModelBuilder& builder(void* user) {
  return *static_cast<ModelBuilder*>(user);
}

tinyobj::callback_t callbacks() {
  tinyobj::callback_t callback;
  callback.vertex_cb = [](void* user, tinyobj::real_t, tinyobj::real_t, tinyobj::real_t,
                          tinyobj::real_t) { builder(user).add_vertex(); };
  callback.index_cb = [](void* user, tinyobj::index_t* indices, int count) {
    builder(user).add_face({indices, static_cast<std::size_t>(count)});
  };
  callback.usemtl_cb = [](void* user, const char* name, int) { builder(user).set_material(name); };
  callback.group_cb = [](void* user, const char** names, int count) {
    builder(user).set_group(count > 0 ? names[0] : "");
  };
  callback.object_cb = [](void* user, const char* name) { builder(user).set_object(name); };
  return callback;
}

}  // namespace

ImportOutcome read_obj(std::string_view text, const ObjOptions& options, ObjModel& model) {
  LineSource source(text);
  std::istream stream(&source);
  ModelBuilder into(source, options, model);
  (void)tinyobj::LoadObjWithCallback(stream, callbacks(), &into);
  if (!source.fault() && model.vertices.empty()) return ImportFault{0, "no vertices"};
  return source.fault();
}

}  // namespace lockstone::assets
