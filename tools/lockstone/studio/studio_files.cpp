#include "tools/lockstone/studio/studio_files.h"

#include <filesystem>
#include <memory>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <lockstone/replay/log_reader.h>

#include "tools/lockstone/commands.h"
#include "tools/lockstone/logs/bisect/bisect.h"
#include "tools/lockstone/logs/file/log_file.h"
#include "tools/lockstone/studio/page_files.h"
#include "tools/lockstone/studio/plain_log.h"
#include "tools/lockstone/support/console.h"
#include "tools/lockstone/support/tar.h"

namespace lockstone::tool {
namespace {

using nlohmann::ordered_json;

constexpr char k_bytes_type[] = "application/octet-stream";

std::string type_of(std::string_view name) {
  const std::string_view ending = name.substr(name.rfind('.') + 1);
  if (ending == "html") return "text/html; charset=utf-8";
  if (ending == "css") return "text/css; charset=utf-8";
  if (ending == "js") return "text/javascript; charset=utf-8";
  if (ending == "svg") return "image/svg+xml";
  return ending == "wasm" ? "application/wasm" : k_bytes_type;
}

ServedFiles page() {
  ServedFiles files;
  for (const PageFile& file : page_files())
    files[std::string(file.name)] = {type_of(file.name), std::string(file.bytes), true};
  return files;
}

std::string text_of(ByteView bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

bool is_bundle(const std::string& path) {
  return std::filesystem::path(path).extension() == ".tar";
}

/// Collects the files, and describes them to the page.
class Collector {
 public:
  Collector(const Games& games, int& exit_code) : games_(games), exit_code_(exit_code) {
    session_["views"] = ordered_json::array();
    session_["logs"] = ordered_json::array();
    session_["desync"] = nullptr;
    session_["live"] = nullptr;
    session_["world"] = nullptr;
  }

  [[nodiscard]] bool add_log(const std::string& path) {
    GameLog log = open_game_log(games_, path);
    if (log.source == nullptr) return fail(log.exit_code);
    return add_source(*log.source, std::filesystem::path(path).filename().string());
  }

  [[nodiscard]] bool add_source(replay::Source& source, const std::string& name) {
    std::optional<std::string> bytes = plain_log(source);
    if (!bytes) {
      complain(fmt::format("{}: the log has no part that can be read", name));
      return fail(k_corrupt);
    }
    add_bytes(fmt::format("log/{}", session_["logs"].size()), std::move(*bytes));
    session_["logs"].push_back(name);
    return true;
  }

  [[nodiscard]] bool add_desync(const std::string& here, const std::string& there) {
    const BisectReport report = bisect_logs(games_, here, there);
    if (report.exit_code != k_ok && !report.found) return fail(report.exit_code);
    session_["desync"] = report.to_json();
    add_states(report.state_here, report.state_there);
    if (!report.found) session_["desync"]["line"] = report.to_line();
    return true;
  }

  /// The archive that `serve --bundle` writes.
  [[nodiscard]] bool add_bundle(const std::string& path) {
    const std::optional<std::string> archive = read_file(path);
    const std::vector<TarEntry> entries =
        archive ? read_tar(std::as_bytes(std::span(*archive))) : std::vector<TarEntry>();
    const auto entry = [&](std::string_view name) {
      for (const TarEntry& one : entries)
        if (one.name == name) return ByteView(one.bytes);
      return ByteView();
    };
    replay::MemorySource log(entry("match.lks"));
    if (log.size() == 0) {
      complain(fmt::format("{}: no bundle of a desync", path));
      return fail(k_corrupt);
    }
    const std::string name = std::filesystem::path(path).filename().string();
    if (!add_source(log, name) || !add_source(log, name)) return false;
    describe_bundle(log, entry("report.txt"), entry("here.snapshot"), entry("there.snapshot"));
    return true;
  }

  void add_live(const LiveMatch& live) {
    ordered_json& match = session_["live"];
    match["url"] = live.origin + '/';
    match["token"] = live.token.empty() ? ordered_json() : ordered_json(live.token);
    match["name"] = live.name;
    match["role"] = live.plays ? "player" : "spectator";
    add_view("live");
  }

  void add_world(const WatchedWorld& world) {
    session_["world"] = {{"url", world.origin + '/'}, {"token", world.token}};
    add_view("world");
  }

  void add_view(const char* name) { session_["views"].push_back(name); }

  [[nodiscard]] ServedFiles finish() && {
    const auto replace = ordered_json::error_handler_t::replace;
    files_["session.json"] = {"application/json", session_.dump(-1, ' ', false, replace)};
    return std::move(files_);
  }

 private:
  [[nodiscard]] bool fail(int exit_code) {
    exit_code_ = exit_code;
    return false;
  }

  void add_bytes(const std::string& path, std::string bytes) {
    files_[path] = {k_bytes_type, std::move(bytes)};
  }

  void add_states(ByteView here, ByteView there) {
    const bool known = !here.empty() && !there.empty();
    session_["desync"]["has_states"] = known;
    if (!known) return;
    add_bytes("state/here", text_of(here));
    add_bytes("state/there", text_of(there));
  }

  // The report's first line names the tick; the states are those after it.
  void describe_bundle(replay::Source& log, ByteView report, ByteView here, ByteView there) {
    const std::string text = text_of(report);
    const std::string line = text.substr(0, text.find('\n'));
    BisectReport found;
    found.found = true;
    found.note = text;
    const std::size_t digits = line.find("tick ");
    if (digits != std::string::npos)
      found.tick = std::strtoull(line.c_str() + digits + 5, nullptr, 10);
    found.difference_tick = found.tick + 1;
    if (!here.empty() && !there.empty()) found.difference = describe(log, here, there);
    session_["desync"] = found.to_json();
    session_["desync"]["line"] = line;
    add_states(here, there);
  }

  [[nodiscard]] StateDifference describe(replay::Source& source, ByteView here,
                                         ByteView there) const {
    replay::LogReader reader(source);
    if (reader.open() != Status::ok || reader.next() != replay::LogItem::scene) return {};
    const GameDef* game = games_.of_log(reader.header(), reader.config());
    if (game == nullptr) return {};
    const auto simulation = game->make(reader.config());
    return simulation.ok() ? simulation.value()->describe(here, there) : StateDifference{};
  }

  const Games& games_;
  int& exit_code_;
  ServedFiles files_ = page();
  ordered_json session_;
};

bool collect(Collector& collector, const std::vector<std::string>& paths) {
  if (paths.size() == 1 && is_bundle(paths[0])) {
    collector.add_view("log");
    collector.add_view("desync");
    return collector.add_bundle(paths[0]);
  }
  for (const std::string& path : paths)
    if (!collector.add_log(path)) return false;
  if (!paths.empty()) collector.add_view("log");
  if (paths.size() < 2) return true;
  collector.add_view("desync");
  return collector.add_desync(paths[0], paths[1]);
}

}  // namespace

std::optional<ServedFiles> studio_files(const Games& games, const std::vector<std::string>& paths,
                                        const Connections& connections, int& exit_code) {
  Collector collector(games, exit_code);
  if (!collect(collector, paths)) return std::nullopt;
  if (connections.live) collector.add_live(*connections.live);
  if (connections.world) collector.add_world(*connections.world);
  return std::move(collector).finish();
}

}  // namespace lockstone::tool
