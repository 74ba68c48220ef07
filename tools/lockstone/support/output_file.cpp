#include "tools/lockstone/support/output_file.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <span>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

#include "tools/lockstone/support/console.h"

namespace lockstone::tool {
namespace {

bool refuse(const std::string& path, const std::string& why) {
  complain(fmt::format("cannot write {}: {}", path, why));
  return false;
}

// Of this process alone, in the same folder, so that it can be renamed.
std::string pending_name(const std::string& path) {
  return fmt::format("{}.{}.part", path, getpid());
}

// Puts a finished file into its place. A link, other than a rename, replaces nothing.
std::error_code put_in_place(const std::string& pending, const Output& output) {
  std::error_code error;
  if (!output.force) {
    std::filesystem::create_hard_link(pending, output.path, error);
    if (!error) std::filesystem::remove(pending, error);
    if (!error || error == std::errc::file_exists) return error;
    // Not every file system has links.
    if (std::filesystem::exists(output.path)) return error;
  }
  std::filesystem::rename(pending, output.path, error);
  return error;
}

}  // namespace

void add_force_option(CLI::App& command, bool& force) {
  command.add_flag("--force", force, "Replace files that are there already");
}

bool may_write(const Output& output) {
  std::error_code ignored;
  const std::filesystem::file_status status = std::filesystem::status(output.path, ignored);
  if (output.path.empty() || !std::filesystem::exists(status)) return true;
  if (!std::filesystem::is_regular_file(status)) return refuse(output.path, "it is no file");
  return output.force || refuse(output.path, "it is there already; --force replaces it");
}

bool write_text_file(const Output& output, const std::string& text) {
  const std::unique_ptr<PendingLog> file = PendingLog::create(output);
  if (file == nullptr) return false;
  const Status status = file->sink().append(std::as_bytes(std::span(text)));
  if (status != Status::ok) return refuse(output.path, std::strerror(errno));
  return file->keep();
}

std::unique_ptr<PendingLog> PendingLog::create(const Output& output) {
  if (!may_write(output)) return nullptr;
  std::unique_ptr<PendingLog> log(new PendingLog(output, pending_name(output.path)));
  auto sink = replay::FileSink::create(log->pending_);
  if (!sink) {
    log->pending_.clear();
    refuse(output.path, std::strerror(errno));
    return nullptr;
  }
  log->sink_ = std::move(sink).value();
  return log;
}

PendingLog::~PendingLog() {
  if (pending_.empty()) return;
  sink_.reset();
  std::error_code ignored;
  std::filesystem::remove(pending_, ignored);
}

bool PendingLog::keep() {
  sink_.reset();  // not every system renames an open file
  const std::error_code error = put_in_place(pending_, output_);
  if (error) return refuse(output_.path, error.message());
  pending_.clear();
  return true;
}

}  // namespace lockstone::tool
