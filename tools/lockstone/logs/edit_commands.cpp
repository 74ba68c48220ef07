// repair, cut, keygen: commands that write logs and keys.
#include <cstdio>
#include <limits>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <lockstone/replay/log_edit.h>
#include <lockstone/replay/signature.h>

#include "tools/lockstone/commands.h"
#include "tools/lockstone/logs/file/log_file.h"
#include "tools/lockstone/logs/log_commands.h"
#include "tools/lockstone/support/console.h"
#include "tools/tool/tool_command.h"

namespace lockstone::tool {
namespace {

struct EditOptions {
  std::string file;
  std::string out;
  std::uint64_t begin = 0;
  std::uint64_t end = std::numeric_limits<std::uint64_t>::max();
  bool force = false;
  bool plain = false;
};

int repair(const EditOptions& options) {
  const auto source = open_log(options.file);
  if (source == nullptr) return k_corrupt;
  const auto log = PendingLog::create({options.out, options.force});
  if (log == nullptr) return k_unavailable;
  const replay::RepairReport report = replay::repair(*source, log->sink());
  if (report.status != Status::ok) {
    complain(fmt::format("{}: {}", options.file,
                         report.what.empty() ? to_string(report.status) : report.what));
    return report.status == Status::io_error ? static_cast<int>(k_unavailable)
                                             : exit_code_of(report.status);
  }
  if (!log->keep()) return k_unavailable;
  if (report.was_whole) {
    fmt::print("{}: nothing to repair, copied\n", options.file);
    return k_ok;
  }
  fmt::print("{}: {} ticks saved, {} bytes lost: {}\n", options.out, report.kept_ticks,
             report.lost_bytes,
             report.damage ? fmt::format("byte {}: {}", report.damage->offset, report.damage->what)
                           : "it had no end");
  return k_ok;
}

int cut(const Games& games, const EditOptions& options) {
  const GameLog of = open_game_log(games, options.file);
  if (of.source == nullptr) return of.exit_code;
  const auto log = PendingLog::create({options.out, options.force});
  if (log == nullptr) return k_unavailable;
  const replay::CutReport report = replay::cut(*of.source, of.game->make, options.begin,
                                               options.end, log->sink(), !options.plain);
  if (report.status == Status::ok && !log->keep()) return k_unavailable;
  if (report.status == Status::ok) {
    fmt::print("{}: {} ticks from tick {}\n", options.out, report.ticks, options.begin);
    return k_ok;
  }
  complain(fmt::format("{}: {}", options.file,
                       report.what.empty() ? to_string(report.status) : report.what));
  if (report.status == Status::invalid_argument) return k_usage;
  return report.status == Status::io_error ? static_cast<int>(k_unavailable)
                                           : exit_code_of(report.status);
}

// Keys are never replaced.
int keygen(const std::string& path) {
  const Result<replay::SigningKey> key = replay::make_signing_key();
  if (!key) {
    complain("this build cannot sign: it has no libsodium");
    return k_unavailable;
  }
  for (const std::string& name : {path, path + ".pub"}) {
    if (access(name.c_str(), F_OK) != 0) continue;
    complain(fmt::format("{} is there already", name));
    return k_usage;
  }
  const mode_t others = umask(077);
  const bool secret_written = write_text_file({path}, key.value().to_text() + "\n");
  umask(others);
  const bool written =
      secret_written && write_text_file({path + ".pub"}, key.value().public_key().to_text() + "\n");
  if (!written) return k_unavailable;
  fmt::print("{}: secret, {}.pub: public\n", path, path);
  return k_ok;
}

}  // namespace

void add_repair_command(CLI::App& app, Tool& tool) {
  auto options = std::make_shared<EditOptions>();
  CLI::App* command =
      app.add_subcommand("repair", "Save the good part of a damaged or unfinished log");
  command->add_option("file", options->file, "A .lks log")->required();
  command->add_option("out", options->out, "The log to write")->required();
  add_force_option(*command, options->force);
  command->callback([options, &tool] { tool.exit_code = repair(*options); });
}

void add_cut_command(CLI::App& app, Tool& tool) {
  auto options = std::make_shared<EditOptions>();
  CLI::App* command = app.add_subcommand("cut", "Make a log of some of a log's ticks");
  command->add_option("file", options->file, "A .lks log")->required();
  command->add_option("out", options->out, "The log to write")->required();
  command->add_option("--from", options->begin, "First tick")->capture_default_str();
  command->add_option("--to", options->end, "The tick after the last; default: the log's end");
  command->add_flag("--plain", options->plain, "Compress nothing, so that every build can read it");
  add_force_option(*command, options->force);
  command->callback([options, &tool] { tool.exit_code = cut(tool.games, *options); });
}

void add_keygen_command(CLI::App& app, Tool& tool) {
  auto path = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("keygen", "Make a key pair to sign logs with");
  command->add_option("file", *path, "Gets the secret key; FILE.pub gets the public one")
      ->required();
  command->callback([path, &tool] { tool.exit_code = keygen(*path); });
}

}  // namespace lockstone::tool
