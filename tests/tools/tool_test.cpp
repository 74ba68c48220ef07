#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include <lockstone/game_library.h>
#include <lockstone/replay/snapshot_file.h>

#include "tools/lockstone/logs/state/canonical_bytes.h"
#include "tools/lockstone/logs/state/hash_compare.h"
#include "tools/tool/game_loader.h"
#include "tools/tool/games.h"
#include "tools/toy/toy_simulation.h"

namespace lockstone::tool {
namespace {

using toy::ToyConfig;
using toy::ToySimulation;

Result<std::vector<std::byte>> configure_toy(const MatchRequest& request) {
  ToyConfig config;
  config.seed = request.seed;
  if (request.players != 0) config.player_count = request.players;
  if (request.bodies) config.body_count = static_cast<std::uint16_t>(*request.bodies);
  return config.encode();
}

bool press_toy(const BotView& view, std::span<std::byte> out) {
  if (view.slot == 1) return false;
  toy::toy_input(view.seed, view.slot, view.tick, out);
  return true;
}

GameDef toy_game() {
  return {
      .name = "toy",
      .version = "2.1",
      .make = toy::toy_factory(),
      .configure = configure_toy,
      .scenes = {{.name = "small", .description = "a few bodies", .ticks = 20}, {.name = "large"}},
      .bot = press_toy};
}

GameDef picky_game() {
  return {.name = "picky", .make = [](ByteView) -> Result<std::unique_ptr<Simulation>> {
            return Status::malformed;
          }};
}

// Two players, no more and no fewer.
GameDef pair_game() {
  GameDef game = toy_game();
  game.name = "pair";
  game.configure = [](const MatchRequest& request) -> Result<std::vector<std::byte>> {
    if (request.players != 0 && request.players != 2) return Status::invalid_argument;
    return configure_toy(request);
  };
  return game;
}

// Runs a command on the pair game: its complaint, and its exit code after a space.
std::string run_on_pair(std::vector<std::string> words) {
  words.insert(words.begin(), "pair");
  std::vector<char*> pointers;
  for (std::string& word : words)
    pointers.push_back(word.data());
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  const int code = tool_main(static_cast<int>(pointers.size()), pointers.data(), pair_game());
  static_cast<void>(testing::internal::GetCapturedStdout());
  return testing::internal::GetCapturedStderr() + ' ' + std::to_string(code);
}

TEST(Simnet, PlaysWithTheUsualNumberOfPlayers) {
  const std::vector<std::string> words = {"simnet", "--seeds", "1", "--ticks", "60"};
  EXPECT_EQ(run_on_pair(words), " 0");
}

TEST(Simnet, NamesTheOptionOfANumberThatTheGameRefuses) {
  const std::string said = run_on_pair({"simnet", "--seeds", "1", "--players", "4"});
  EXPECT_NE(said.find("the game 'pair' refuses --players 4; its usual number is 2"),
            std::string::npos)
      << said;
  EXPECT_TRUE(said.ends_with(" 64")) << said;
}

#if defined(LOCKSTONE_WITH_ENET)
TEST(SiegeCommand, SaysHowManySeatsItNeeds) {
  const std::string said = run_on_pair({"siege", "--players", "1"});
  EXPECT_NE(said.find("siege --players 1 needs 1 + 2 seats; pair has 2"), std::string::npos)
      << said;
  EXPECT_TRUE(said.ends_with(" 64")) << said;
}
#endif

replay::LogHeader header_of(std::string game) {
  replay::LogHeader header;
  header.match.game = std::move(game);
  header.match.game_version = "1.2";
  return header;
}

TEST(Games, ALogGoesToTheGameThatItsHeaderNames) {
  const Games games({picky_game(), toy_game()});
  EXPECT_EQ(games.of_log(header_of("toy"), {})->name, "toy");
  EXPECT_EQ(games.of_log(header_of("picky"), {})->name, "picky");
  EXPECT_EQ(games.of_log(header_of("sumo"), {}), nullptr);
}

TEST(Games, ALogThatNamesNoGameGoesToTheOneThatTakesItsConfiguration) {
  const Games games({picky_game(), toy_game()});
  EXPECT_EQ(games.of_log(header_of(""), ToyConfig{}.encode())->name, "toy");
  EXPECT_EQ(games.of_log(header_of(""), {})->name, "picky") << "no game takes it: the first";
}

TEST(Games, ARefusalNamesTheLogsGameAndTheToolsGames) {
  const Games games({picky_game(), toy_game()});
  EXPECT_EQ(foreign_game_text(header_of("sumo").match, games),
            "this log is of game 'sumo' 1.2; this tool knows picky, toy; use --game");
}

TEST(Games, StartsTheSceneThatAGameKnows) {
  const Games games({picky_game(), toy_game()});
  const Result<Match> match = games.start({.scene = "large", .seed = 3, .players = 4});
  ASSERT_TRUE(match.ok());
  EXPECT_EQ(match.value().simulation->info().player_count, 4);
  EXPECT_EQ(games.start({.scene = "toy"}).value().game->name, "toy");
  EXPECT_EQ(games.start({.scene = "huge"}).status(), Status::not_found);
  EXPECT_EQ(games.start({}).status(), Status::unsupported_version) << "picky configures nothing";
  EXPECT_EQ(games.start({.scene = "small", .players = 200}).status(), Status::invalid_argument);
}

TEST(Games, ABotThatDeclinesLeavesItsSlotAbsent) {
  const GameDef game = toy_game();
  ToySimulation simulation(ToyConfig{});
  MatchInputs inputs(game, 1);
  const auto pressed = inputs.next(simulation);
  ASSERT_EQ(pressed.size(), 2U);
  EXPECT_EQ(pressed[0].origin, InputOrigin::received);
  EXPECT_EQ(pressed[1].origin, InputOrigin::absent);
}

// The toy as a library would give it.
GameDef loaded_toy() {
  std::string why;
  Result<GameDef> game = game_of_table(game_table(toy_game), why);
  EXPECT_TRUE(game.ok()) << why;
  return std::move(game).value();
}

TEST(GameTable, CarriesTheWholeGame) {
  const GameDef game = loaded_toy();
  EXPECT_EQ(game.name, "toy");
  EXPECT_EQ(game.version, "2.1");
  ASSERT_EQ(game.scenes.size(), 2U);
  EXPECT_EQ(game.scenes[0].description, "a few bodies");
  EXPECT_EQ(game.scenes[0].ticks, 20U);
  EXPECT_EQ(game.configure({.seed = 9, .players = 3}).value(),
            configure_toy({.seed = 9, .players = 3}).value());
  EXPECT_FALSE(game.draw) << "the toy has no picture";
}

TEST(GameTable, StepsSavesLoadsAndHashesAsTheGameItself) {
  const GameDef game = loaded_toy();
  const ToyConfig config{.seed = 5, .player_count = 3};
  ToySimulation own(config);
  const auto loaded = std::move(game.make(config.encode())).value();
  EXPECT_EQ(loaded->info(), own.info());
  MatchInputs inputs(game, 5);
  const GameDef direct = toy_game();
  MatchInputs direct_inputs(direct, 5);
  std::vector<std::byte> before(own.snapshot_bytes_max(SnapshotKind::canonical));
  before.resize(own.save(SnapshotKind::canonical, before));
  for (int tick = 0; tick < 60; ++tick) {
    loaded->step(inputs.next(*loaded));
    own.step(direct_inputs.next(own));
    ASSERT_EQ(loaded->hash(), own.hash()) << tick;
  }
  std::array<PartHash, k_max_state_parts> parts{}, own_parts{};
  const std::size_t count = loaded->part_hashes(parts);
  ASSERT_EQ(count, own.part_hashes(own_parts));
  for (std::size_t i = 0; i < count; ++i) {
    EXPECT_EQ(parts[i].name, own_parts[i].name);
    EXPECT_EQ(parts[i].hash, own_parts[i].hash);
  }
  std::vector<std::byte> after(own.snapshot_bytes_max(SnapshotKind::canonical));
  after.resize(loaded->save(SnapshotKind::canonical, after));
  EXPECT_EQ(loaded->describe(before, after).to_line(), own.describe(before, after).to_line());
  EXPECT_EQ(loaded->load(SnapshotKind::canonical, before), Status::ok);
  EXPECT_EQ(loaded->tick(), 0U);
  EXPECT_EQ(loaded->load(SnapshotKind::canonical, ByteView(before).first(10)),
            own.load(SnapshotKind::canonical, ByteView(before).first(10)));
}

TEST(GameTable, AConfigurationThatTheGameRefusesIsATypedError) {
  const GameDef game = loaded_toy();
  const std::array<std::byte, 3> bytes{};
  EXPECT_EQ(game.make(bytes).status(), toy::toy_factory()(bytes).status());
}

TEST(GameTable, OfAnotherAbiIsRefusedWithAClearText) {
  lockstone_game_table table = *game_table(toy_game);
  table.abi = LOCKSTONE_GAME_ABI + 1;
  std::string why;
  EXPECT_EQ(game_of_table(&table, why).status(), Status::unsupported_version);
  EXPECT_NE(why.find("it is a game of ABI 2; this tool loads ABI 1"), std::string::npos) << why;
  EXPECT_EQ(game_of_table(nullptr, why).status(), Status::unsupported_version);
}

TEST(GameTable, WithoutARequiredFunctionIsRefused) {
  std::string why;
  for (int missing = 0; missing < 4; ++missing) {
    lockstone_game_table table = *game_table(toy_game);
    if (missing == 0) table.create = nullptr;
    if (missing == 1) table.hash = nullptr;
    if (missing == 2) table.name = "";
    if (missing == 3) table.bytes = offsetof(lockstone_game_table, hash);
    EXPECT_EQ(game_of_table(&table, why).status(), Status::malformed) << missing;
  }
}

TEST(GameTable, OptionalFunctionsThatAnOlderLibraryLacksAreTakenForNone) {
  lockstone_game_table table = *game_table(toy_game);
  table.bytes = offsetof(lockstone_game_table, describe);  // it ends with part_hashes
  std::string why;
  const Result<GameDef> game = game_of_table(&table, why);
  ASSERT_TRUE(game.ok()) << why;
  EXPECT_FALSE(game.value().configure);
  EXPECT_FALSE(game.value().bot);
  EXPECT_TRUE(game.value().scenes.empty());
  EXPECT_FALSE(game.value().make(ToyConfig{}.encode()).value()->describe({}, {}).differs);
}

TEST(GameTable, AMatchOutsideTheLimitsIsMalformed) {
  lockstone_game_table table = *game_table(toy_game);
  table.info = [](const void*, lockstone_game_info* out) { *out = {}; };
  std::string why;
  const Result<GameDef> game = game_of_table(&table, why);
  ASSERT_TRUE(game.ok()) << why;
  EXPECT_EQ(game.value().make(ToyConfig{}.encode()).status(), Status::malformed);
}

TEST(GameLibrary, ThatIsNotThereIsAnErrorWithItsName) {
  std::string why;
  EXPECT_EQ(load_game("nowhere.so", why).status(), Status::io_error);
  EXPECT_NE(why.find("nowhere.so"), std::string::npos) << why;
}

LogHashes machine(std::string name, std::map<std::uint64_t, std::string> hashes) {
  LogHashes file;
  file.name = std::move(name);
  file.hashes = std::move(hashes);
  return file;
}

TEST(HashCompare, EqualChainsAreOneGroup) {
  const Games games({toy_game()});
  const auto result = compare_log_hashes(
      {machine("a", {{1, "x"}, {2, "y"}}), machine("b", {{1, "x"}, {2, "y"}})}, games);
  EXPECT_TRUE(result.same());
  EXPECT_EQ(result.to_line(), "all equal, 2 ticks");
}

TEST(HashCompare, GroupsByTheFirstTickThatDiffersTheLargestFirst) {
  const Games games({toy_game()});
  const auto result = compare_log_hashes(
      {machine("odd", {{1, "x"}, {2, "w"}, {3, "z"}}), machine("b", {{1, "x"}, {2, "y"}, {3, "z"}}),
       machine("c", {{1, "x"}, {2, "y"}, {3, "v"}})},
      games);
  ASSERT_EQ(result.groups.size(), 2U);
  EXPECT_EQ(result.groups[0].files, (std::vector<std::size_t>{1, 2}));
  EXPECT_EQ(result.groups[1].files, (std::vector<std::size_t>{0}));
  EXPECT_EQ(result.first_tick, 1U) << "whose inputs led to the states after 2 ticks";
  EXPECT_EQ(result.ticks, 1U);
}

TEST(HashCompare, AChainThatEndsEarlyDiffersThere) {
  const Games games({toy_game()});
  const auto result =
      compare_log_hashes({machine("a", {{1, "x"}, {2, "y"}}), machine("b", {{1, "x"}})}, games);
  ASSERT_EQ(result.groups.size(), 2U);
  EXPECT_EQ(result.groups[1].hash, "ends");
}

TEST(HashCompare, NamesThePartOfTheNextStateThatBothHashed) {
  const Games games({toy_game()});
  LogHashes here = machine("a", {{1, "x"}, {2, "y"}}), there = machine("b", {{1, "x"}, {2, "w"}});
  here.parts = {{1, {{"bodies", "q"}}}, {2, {{"bodies", "p"}, {"rules", "r"}}}};
  there.parts = {{1, {{"bodies", "other"}}}, {2, {{"bodies", "p"}, {"rules", "s"}}}};
  const auto result = compare_log_hashes({here, there}, games);
  EXPECT_EQ(result.part, "rules");
  EXPECT_EQ(result.part_tick, 2U);
  EXPECT_NE(result.note.find("states were not kept"), std::string::npos);
}

TEST(HashCompare, SaysThatADifferenceHealed) {
  const Games games({toy_game()});
  LogHashes here = machine("a", {{1, "x"}, {2, "y"}, {3, "z"}, {4, "z"}}), there = here;
  there.hashes[2] = "w";
  here.parts = there.parts = {{3, {{"bodies", "p"}}}, {4, {{"bodies", "p"}}}};
  const auto result = compare_log_hashes({here, there}, games);
  EXPECT_EQ(result.part, "");
  EXPECT_TRUE(result.note.starts_with(
      "the states are equal again at tick 3: hash again with --parts-every 1; "))
      << result.note;
}

TEST(HashCompare, SaysThatNoPartShowsTheDifference) {
  const Games games({toy_game()});
  LogHashes here = machine("a", {{1, "x"}, {2, "y"}}), there = machine("b", {{1, "x"}, {2, "w"}});
  here.parts = there.parts = {{2, {{"bodies", "p"}}}};
  const auto result = compare_log_hashes({here, there}, games);
  EXPECT_TRUE(result.note.starts_with("the game shows no difference between the states at tick 2"))
      << result.note;
}

// A game that needs no configuration, as the one of the tutorial.
GameDef plain_game() {
  GameDef game = toy_game();
  game.name = "plain";
  game.make = [](ByteView config) -> Result<std::unique_ptr<Simulation>> {
    if (!config.empty()) return Status::malformed;
    return toy::toy_factory()(ToyConfig{}.encode());
  };
  return game;
}

// The notes on files of the plain game whose configuration is this text.
std::string note_of_configuration(std::optional<std::string> text) {
  LogHashes here = machine("a", {{1, "y"}}), there = machine("b", {{1, "w"}});
  here.path = "a.json";
  here.game = there.game = "plain";
  here.config = there.config = std::move(text);
  here.states = there.states = "nowhere";
  return compare_log_hashes({here, there}, Games({plain_game()})).note;
}

TEST(HashCompare, SaysWhyAConfigurationMakesNoGame) {
  const auto says = [](const std::string& note, const std::string& why) {
    return note.find(why) != std::string::npos;
  };
  EXPECT_TRUE(says(note_of_configuration(""), "no state after this tick was kept by both"));
  EXPECT_TRUE(says(note_of_configuration("4"), "the configuration in a.json is damaged"));
  EXPECT_TRUE(says(note_of_configuration("4x"), "the configuration in a.json is damaged"));
  EXPECT_TRUE(says(note_of_configuration("40"), "the game refuses the configuration in a.json"));
  EXPECT_TRUE(says(note_of_configuration(std::nullopt), "a.json holds no configuration"));
}

// A file of the plain game whose state after tick 1 is kept.
LogHashes keep_state(const std::string& name, const Simulation& game) {
  LogHashes file = machine(name, {{1, name}});
  file.game = "plain";
  file.config = "";
  file.states = testing::TempDir() + "/hash_compare_" + name;
  std::filesystem::create_directories(file.states);
  const std::vector<std::byte> bytes = replay::pack_snapshot(canonical_bytes(game));
  std::ofstream out(state_file(file.states, 1), std::ios::binary);
  out.write(reinterpret_cast<const char*>(bytes.data()),
            static_cast<std::streamsize>(bytes.size()));
  return file;
}

TEST(HashCompare, NamesTheFieldOfAGameWithoutAConfiguration) {
  ToySimulation game(ToyConfig{});
  const LogHashes here = keep_state("here", game);
  ASSERT_TRUE(game.flip_bit("body", 1, "position.x", 0));
  const LogHashes there = keep_state("there", game);
  const auto result = compare_log_hashes({here, there}, Games({plain_game()}));
  ASSERT_TRUE(result.field) << result.note;
  EXPECT_EQ(result.field->field, "position.x");
  EXPECT_EQ(result.field->object, 1U);
}

}  // namespace
}  // namespace lockstone::tool
