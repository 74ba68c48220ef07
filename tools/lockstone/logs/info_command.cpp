#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <lockstone/replay/log_info.h>
#include <lockstone/replay/log_map.h>
#include <lockstone/replay/signature.h>
#include <lockstone/replay/source.h>

#include "tools/lockstone/commands.h"
#include "tools/lockstone/logs/file/log_file.h"
#include "tools/lockstone/support/console.h"
#include "tools/lockstone/support/json_text.h"
#include "tools/tool/tool_command.h"

namespace lockstone::tool {
namespace {

using nlohmann::ordered_json;
using replay::LogInfo;

struct InfoOptions {
  std::string file;
  bool json = false;
  bool events = false;
};

ordered_json header_json(const replay::LogHeader& header) {
  const SimulationInfo& info = header.info;
  return {{"abi", info.abi},
          {"config_hash", hash_text(info.config_hash)},
          {"scene_hash", hash_text(info.scene_hash)},
          {"canary", hash_text(info.canary)},
          {"tick_rate", info.tick_rate},
          {"players", info.player_count},
          {"input_bytes", info.input_bytes},
          {"match_id", hash_text(header.match.match_id)},
          {"seed", header.match.seed},
          {"start_tick", header.match.start_tick},
          {"build", header.match.build},
          {"game", header.match.game},
          {"game_version", header.match.game_version}};
}

ordered_json damage_json(const replay::Damage& damage) {
  return {{"status", to_string(damage.status)},
          {"offset", damage.offset},
          {"chunk", to_string(damage.type)},
          {"what", damage.what}};
}

ordered_json events_json(const LogInfo& info) {
  ordered_json events = ordered_json::array();
  for (const replay::LogEvent& event : info.events) {
    events.push_back({{"tick", event.tick},
                      {"kind", to_string(event.kind)},
                      {"slot", event.slot},
                      {"text", event.text}});
  }
  return events;
}

/// Facts that a reader of chunks passes over.
struct Extras {
  bool index = false;
  replay::SignatureReport signature;
};

void print_json(const LogInfo& info, const Extras& extras) {
  ordered_json json{{"header", header_json(info.header)},
                    {"file_bytes", info.file_bytes},
                    {"ticks", info.ticks},
                    {"duration_milliseconds", info.duration_milliseconds},
                    {"last_hash", hash_text(info.last_hash)},
                    {"keyframe_ticks", info.keyframe_ticks},
                    {"complete", info.complete},
                    {"torn_tail", info.torn_tail},
                    {"end_reason", info.end_reason},
                    {"inputs_by_origin", info.inputs_by_origin},
                    {"player_names", info.player_names},
                    {"commands", info.commands},
                    {"command_bytes", info.command_bytes}};
  for (const replay::ChunkTypeTotals& totals : info.chunk_types) {
    json["chunks"].push_back({{"type", to_string(totals.type)},
                              {"count", totals.chunks},
                              {"raw_bytes", totals.raw_bytes},
                              {"stored_bytes", totals.stored_bytes}});
  }
  json["events"] = events_json(info);
  json["index"] = extras.index;
  json["signature"] = {{"state", to_string(extras.signature.state)},
                       {"covered_ticks", extras.signature.covered_ticks},
                       {"covers_end", extras.signature.covers_end},
                       {"key", extras.signature.key.to_text()}};
  if (info.damage) json["damage"] = damage_json(*info.damage);
  write_json(json);
}

std::string game_text(const replay::MatchMetadata& match) {
  if (match.game.empty()) return "not named";
  return match.game_version.empty() ? match.game : match.game + ' ' + match.game_version;
}

void print_header(const replay::LogHeader& header) {
  const SimulationInfo& info = header.info;
  fmt::print("game          {}\n", game_text(header.match));
  fmt::print("build         {}\n", header.match.build);
  fmt::print("match         {}, seed {}\n", hash_text(header.match.match_id), header.match.seed);
  fmt::print("simulation    abi {:#x}, config {}, scene {}\n", info.abi,
             hash_text(info.config_hash), hash_text(info.scene_hash));
  fmt::print("players       {}, {} input bytes each, {} ticks a second\n", info.player_count,
             info.input_bytes, info.tick_rate);
}

std::string signature_text(const replay::SignatureReport& report) {
  if (report.state != replay::SignatureState::good) return std::string(to_string(report.state));
  return fmt::format("good up to {}, by {}",
                     report.covers_end ? "the end" : fmt::format("tick {}", report.covered_ticks),
                     report.key.to_text());
}

void print_text(const InfoOptions& options, const LogInfo& info, const Extras& extras) {
  print_header(info.header);
  fmt::print("ticks         {} ({:.1f} s), last hash {}\n", info.ticks,
             static_cast<double>(info.duration_milliseconds) / 1000, hash_text(info.last_hash));
  for (std::size_t slot = 0; slot < info.player_names.size(); ++slot) {
    const std::string& name = info.player_names[slot];
    if (!name.empty()) fmt::print("  player {:<4} {}\n", slot, name);
  }
  if (info.commands > 0)
    fmt::print("commands      {}, {} bytes\n", info.commands, info.command_bytes);
  const auto& origins = info.inputs_by_origin;
  fmt::print("inputs        {} received, {} repeated, {} neutral, {} absent\n", origins[0],
             origins[1], origins[2], origins[3]);
  fmt::print("keyframes     {}{}\n", info.keyframe_ticks.size(),
             extras.index ? ", with an index" : "");
  fmt::print("signature     {}\n", signature_text(extras.signature));
  fmt::print("file          {} bytes\n", info.file_bytes);
  for (const replay::ChunkTypeTotals& totals : info.chunk_types) {
    fmt::print("  {:<11} {:>6} chunks {:>10} bytes\n", to_string(totals.type), totals.chunks,
               totals.stored_bytes);
  }
  fmt::print("end           {}\n", info.complete    ? info.end_reason
                                   : info.torn_tail ? "missing, and the last chunk is cut off"
                                                    : "missing");
  if (info.damage)
    fmt::print("damage        byte {}: {}\n", info.damage->offset, info.damage->what);
  if (!options.events) return;
  for (const replay::LogEvent& event : info.events) {
    fmt::print("  tick {:>8}  {:<12} {:>3}  {}\n", event.tick, to_string(event.kind), event.slot,
               event.text);
  }
}

int info(const InfoOptions& options) {
  const auto source = replay::FileSource::open(options.file);
  if (!source) {
    complain(fmt::format("{}: {}", options.file, to_string(source.status())));
    return k_corrupt;
  }
  replay::Damage damage;
  const Result<LogInfo> info = replay::read_log_info(*source.value(), &damage);
  if (!info) {
    complain(fmt::format("{}: {}, byte {}: {}", options.file, to_string(info.status()),
                         damage.offset, damage.what));
    return exit_code_of(info.status());
  }
  const Extras extras{replay::read_index(*source.value()).ok(),
                      replay::check_signatures(*source.value())};
  options.json ? print_json(info.value(), extras) : print_text(options, info.value(), extras);
  return info.value().damage && !info.value().torn_tail ? k_corrupt : k_ok;
}

}  // namespace

void add_info_command(CLI::App& app, Tool& tool) {
  auto options = std::make_shared<InfoOptions>();
  CLI::App* command = app.add_subcommand("info", "Summarise a log");
  command->add_option("file", options->file, "A .lks log")->required();
  command->add_flag("--json", options->json, "Print JSON");
  command->add_flag("--events", options->events, "List joins, leaves and substituted inputs");
  command->callback([options, &tool] { tool.exit_code = info(*options); });
}

}  // namespace lockstone::tool
