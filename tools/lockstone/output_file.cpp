#include "tools/lockstone/output_file.h"

#include <cerrno>
#include <cstring>
#include <utility>

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tools/lockstone/console.h"

namespace lockstone::tool {
namespace {

bool refuse(const std::string& path, const char* why) {
  complain(fmt::format("cannot write {}: {}", path, why));
  return false;
}

// Of this process alone, in the same folder, so that it can be renamed.
std::string pending_name(const std::string& path) {
  return fmt::format("{}.{}.part", path, getpid());
}

// Puts a finished file into its place. A link, other than a rename, replaces nothing.
bool put_in_place(const std::string& pending, const Output& output) {
  const char* from = pending.c_str();
  const char* to = output.path.c_str();
  if (output.force) return std::rename(from, to) == 0;
  if (link(from, to) == 0) return unlink(from) == 0;
  if (errno == EEXIST) return false;
  // Not every file system has links.
  return may_write(output) && std::rename(from, to) == 0;
}

}  // namespace

void add_force_option(CLI::App& command, bool& force) {
  command.add_flag("--force", force, "Replace files that are there already");
}

bool may_write(const Output& output) {
  struct stat status {};
  if (output.path.empty() || stat(output.path.c_str(), &status) != 0) return true;
  if (!S_ISREG(status.st_mode)) return refuse(output.path, "it is no file");
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
    refuse(output.path, std::strerror(errno));
    return nullptr;
  }
  log->sink_ = std::move(sink).value();
  return log;
}

PendingLog::~PendingLog() {
  if (!pending_.empty() && sink_ != nullptr) unlink(pending_.c_str());
}

bool PendingLog::keep() {
  if (!put_in_place(pending_, output_)) return refuse(output_.path, std::strerror(errno));
  pending_.clear();
  return true;
}

}  // namespace lockstone::tool
