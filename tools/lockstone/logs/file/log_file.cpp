#include "tools/lockstone/logs/file/log_file.h"

#include <random>

#include <fmt/format.h>

#include <lockstone/replay/log_reader.h>

#include "tools/lockstone/support/console.h"

namespace lockstone::tool {
namespace {

template <class Key>
std::optional<Key> read_key(const std::string& path, const char* what) {
  const std::optional<std::string> text = read_file(path);
  const std::string digits = text ? text->substr(0, text->find_first_of(" \r\n")) : std::string();
  const Result<Key> key = Key::from_text(digits);
  if (key) return key.value();
  complain(fmt::format("{}: holds no {} key", path, what));
  return std::nullopt;
}

}  // namespace

std::unique_ptr<replay::FileSource> open_log(const std::string& path) {
  auto source = replay::FileSource::open(path);
  if (source) return std::move(source).value();
  complain(fmt::format("{}: {}", path, to_string(source.status())));
  return nullptr;
}

GameLog find_game_log(const Games& games, const std::string& path) {
  GameLog log;
  auto source = replay::FileSource::open(path);
  if (!source) {
    log.what = to_string(source.status());
    log.exit_code = k_corrupt;
    return log;
  }
  log.source = std::move(source).value();
  log.game = &games.list().front();
  replay::LogReader reader(*log.source);
  if (reader.open() != Status::ok) return log;
  const replay::LogHeader header = reader.header();
  log.match = header.match;
  const bool has_config = header.match.game.empty() && reader.next() == replay::LogItem::scene;
  log.game = games.of_log(header, has_config ? reader.config() : ByteView());
  if (log.game != nullptr) return log;
  log.source = nullptr;
  log.what = foreign_game_text(header.match, games);
  log.exit_code = k_incompatible;
  return log;
}

GameLog open_game_log(const Games& games, const std::string& path) {
  GameLog log = find_game_log(games, path);
  if (log.source == nullptr) complain(fmt::format("{}: {}", path, log.what));
  return log;
}

std::unique_ptr<replay::FileSink> create_log(const Output& output) {
  if (!may_write(output)) return nullptr;
  auto sink = replay::FileSink::create(output.path, output.force);
  if (sink) return std::move(sink).value();
  complain(fmt::format("cannot write {}: {}", output.path, to_string(sink.status())));
  return nullptr;
}

std::uint64_t random_match_id() {
  std::random_device random;
  return std::uint64_t{random()} << 32 | random();
}

std::optional<replay::SigningKey> read_signing_key(const std::string& path) {
  return read_key<replay::SigningKey>(path, "secret");
}

std::optional<replay::PublicKey> read_public_key(const std::string& path) {
  return read_key<replay::PublicKey>(path, "public");
}

}  // namespace lockstone::tool
