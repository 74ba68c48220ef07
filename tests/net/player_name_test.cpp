#include <gtest/gtest.h>

#include <lockstone/net/player_name.h>

#include "tests/net/match_fixture.h"

namespace lockstone::net::test {
namespace {

bool is_name(std::string_view text) {
  return PlayerName::from_bytes(std::as_bytes(std::span(text))).ok();
}

TEST(PlayerName, TakesTextOfAnyScript) {
  for (const std::string_view text :
       {"", "Ann", "a b", "\u00e9\u00df", "\u0416\u0434", "\u6f22\u5b57", "\U0001f600", "\u00a0",
        "\u2027", "\u202f", "\u2065", "\u206a"}) {
    EXPECT_TRUE(is_name(text)) << text;
    EXPECT_EQ(PlayerName(text).view(), text);
  }
}

TEST(PlayerName, RefusesControlsAndChangesOfDirection) {
  for (const std::string_view text :
       {"\n", "\x1b[31m", "\x7f", "\xc2\x80", "\xc2\x9f", "\u2028", "\u2029", "\u202a", "\u202e",
        "\u2066", "\u2069", "\xff", "\xc3", "\xed\xa0\x80", "A\tB"}) {
    EXPECT_FALSE(is_name(text));
  }
  EXPECT_FALSE(is_name(std::string_view("A\0B", 3)));
  EXPECT_FALSE(is_name(std::string(k_max_name_bytes + 1, 'a')));
  EXPECT_TRUE(is_name(std::string(k_max_name_bytes, 'a')));
}

TEST(PlayerName, ReplacesEachForbiddenCharacterOnce) {
  EXPECT_EQ(PlayerName("A\tB").view(), "A?B");
  EXPECT_EQ(PlayerName("A\u202eB").view(), "A?B");
  EXPECT_EQ(PlayerName("A\xff\xfe"
                       "B")
                .view(),
            "A??B");
}

TEST(PlayerName, IsCutAfterAWholeCharacter) {
  const std::string full(k_max_name_bytes - 1, 'a');
  EXPECT_EQ(PlayerName(full + "\u00e9").view(), full);
  EXPECT_EQ(PlayerName(full + "bc").view(), full + 'b');
}

TEST(PlayerName, OfAnyBytesIsAName) {
  TestRandom random{7};
  for (int round = 0; round < 20'000; ++round) {
    std::array<std::byte, 48> bytes{};
    random.fill(bytes);
    for (std::byte& byte : bytes) {  // mostly characters of several bytes, or nearly
      if (std::to_integer<unsigned>(byte) % 3 == 0) byte = (byte & std::byte{0x3f}) | std::byte{0x80};
    }
    const PlayerName name(std::string_view(reinterpret_cast<const char*>(bytes.data()), 48));
    ASSERT_TRUE(is_name(name.view())) << "round " << round;
  }
}

TEST(PlayerName, StandsBesideTheSlot) {
  EXPECT_EQ(player_text(2, "Ann"), "player 2 \"Ann\"");
  EXPECT_EQ(player_text(2, ""), "player 2");
}

MatchOptions named_match() {
  MatchOptions options = match_of(3, 900, 11);
  options.client.name = "Zo\u00eb";
  options.faults = rough(200'000);
  options.server.max_spectators = 1;
  options.server.start_players = 2;
  return options;
}

TEST(PlayerNames, ReachEverybodyThroughLoss) {
  Match match(named_match());
  match.players[2].paused = true;  // comes late
  match.run_for(4 * k_second_us);
  match.players[2].paused = false;
  match.add_player(k_spectator_slot);
  match.run_for(6 * k_second_us);
  for (const Match::Player& player : match.players) {
    for (std::uint8_t slot = 0; slot < 3; ++slot)
      EXPECT_EQ(player.client->player_name(slot), "Zo\u00eb" + std::to_string(slot));
    EXPECT_EQ(player.client->player_name(3), "");
  }
  EXPECT_EQ(match.server->player_name(1), "Zo\u00eb1");
  ASSERT_TRUE(match.run(40 * k_second_us));
  match.expect_all_equal();
}

TEST(PlayerNames, StayWhenThePlayerLeaves) {
  Match match(named_match());
  match.run_for(3 * k_second_us);
  match.players[1].client->leave();
  match.run_for(3 * k_second_us);
  EXPECT_EQ(match.server->player_name(1), "Zo\u00eb1");
  EXPECT_EQ(match.players[0].client->player_name(1), "Zo\u00eb1");
}

TEST(PlayerNames, StandInTheLineOfADesync) {
  MatchOptions options = match_of(3, 400, 5);
  options.client.name = "Ann";
  options.flips = {{}, {{150, "body", "velocity.x", 12, 7}}};
  Match match(options);
  ASSERT_TRUE(match.run(60 * k_second_us));
  ASSERT_EQ(match.server_log.reports.size(), 1U);
  EXPECT_EQ(match.server_log.reports[0].name, "Ann1");
  EXPECT_NE(match.server_log.reports[0].to_line().find("player 1 \"Ann1\", body"),
            std::string::npos);
  ASSERT_FALSE(match.players[0].log->reports.empty());
  EXPECT_EQ(match.players[0].log->reports[0].name, "Ann1");
}

}  // namespace
}  // namespace lockstone::net::test
