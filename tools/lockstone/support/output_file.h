// Files that the command writes. None replaces another unless --force was given, none is left
// behind half written, and a directory, a FIFO or a device is an error at once.
#pragma once

#include <memory>
#include <string>

#include <CLI/App.hpp>

#include <lockstone/replay/sink.h>

namespace lockstone::tool {

/// Where to write, and whether a file that is there may be replaced.
struct Output {
  std::string path;
  bool force = false;
};

/// --force, for every output of the command.
void add_force_option(CLI::App& command, bool& force);

/// Before long work: true when `output` may be written, else a complaint. An empty path may.
[[nodiscard]] bool may_write(const Output& output);

/// Writes the whole file. False, with a complaint, when it may not or the system refuses.
[[nodiscard]] bool write_text_file(const Output& output, const std::string& text);

/// A log that stands beside its place under another name until it is kept; otherwise it is removed.
class PendingLog {
 public:
  /// Null, with a complaint, when `output` may not be written.
  [[nodiscard]] static std::unique_ptr<PendingLog> create(const Output& output);

  ~PendingLog();
  PendingLog(const PendingLog&) = delete;
  PendingLog& operator=(const PendingLog&) = delete;

  [[nodiscard]] replay::Sink& sink() { return *sink_; }

  /// Puts it into its place. False, with a complaint, when the system refuses, or when there is a
  /// file by now that may not be replaced.
  [[nodiscard]] bool keep();

 private:
  PendingLog(const Output& output, std::string pending)
      : output_(output), pending_(std::move(pending)) {}

  Output output_;
  std::string pending_;  ///< the name until then; empty once it is kept
  std::unique_ptr<replay::FileSink> sink_;
};

}  // namespace lockstone::tool
