// The game's own state, next to the world's: scores, cool-downs, held objects.
//
// Each record is declared by its manifest, and the same manifest gives save, load, hash and
// describe their fields: a field cannot exist without being saved, hashed and compared.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include <lockstone/body.h>
#include <lockstone/simulation.h>
#include <lockstone/units.h>
#include <lockstone/vec3.h>

namespace lockstone::arena {

inline constexpr std::size_t k_shots_per_player = 4;
inline constexpr std::size_t k_max_shots = k_max_players * k_shots_per_player;

// clang-format off
#define ARENA_GAME_FIELDS(X) \
  X(std::uint64_t, random)    /* of the rules: where things reappear */ \
  X(std::uint32_t, goals)     /* bodies brought into a goal */ \
  X(std::uint32_t, falls)     /* players who fell off */ \
  X(std::uint32_t, driver)    /* slot + 1 of the player in the buggy, or 0 */ \
  X(std::uint32_t, lying_ticks)  /* in which the buggy lay on its side or back */

#define ARENA_PLAYER_FIELDS(X) \
  X(BodyHandle, body)              /* kinematic: other players and snowballs meet it */ \
  X(Vec3<SolverVelocity>, velocity) /* of the character, in the world */ \
  X(BodyHandle, held)              /* the body it carries, or null */ \
  X(std::int32_t, score) \
  X(std::int16_t, yaw)             /* aim of the last tick */ \
  X(std::uint8_t, buttons)         /* of the last tick: a press is a change */ \
  X(std::uint8_t, jump_wait)       /* ticks until it may jump again */ \
  X(std::uint8_t, push_wait) \
  X(std::uint8_t, shot_wait) \
  X(std::uint8_t, rival)           /* slot + 1 of the player that pushed it last, or 0 */ \
  X(std::uint16_t, rival_ticks)    /* until that is forgotten */ \
  X(std::uint16_t, respawn_ticks)  /* until a fallen player returns, 0: it plays */ \
  X(std::uint16_t, hill_ticks)     /* on the hill since the last point for it */

#define ARENA_SHOT_FIELDS(X) \
  X(BodyHandle, body) \
  X(std::uint16_t, ticks_left)     /* until it melts */
// clang-format on

#define ARENA_DECLARE(Type, name) Type name{};
#define ARENA_VISIT(Type, name) visitor.field(#name, record.name);
#define ARENA_RECORD(Record, FIELDS)                                \
  struct Record {                                                   \
    FIELDS(ARENA_DECLARE)                                           \
    friend bool operator==(const Record&, const Record&) = default; \
  };                                                                \
  template <class Visitor>                                          \
  void visit_fields(Record& record, Visitor& visitor) {             \
    FIELDS(ARENA_VISIT)                                             \
  }                                                                 \
  template <class Visitor>                                          \
  void visit_fields(const Record& record, Visitor& visitor) {       \
    FIELDS(ARENA_VISIT)                                             \
  }

ARENA_RECORD(GameRecord, ARENA_GAME_FIELDS)
ARENA_RECORD(PlayerRecord, ARENA_PLAYER_FIELDS)
ARENA_RECORD(ShotRecord, ARENA_SHOT_FIELDS)

#undef ARENA_RECORD
#undef ARENA_VISIT
#undef ARENA_DECLARE

/// Records of slots beyond the match's players stay zero and are not part of the state.
struct GameState {
  GameRecord game;
  std::array<PlayerRecord, k_max_players> players{};
  std::array<ShotRecord, k_max_shots> shots{};  ///< k_shots_per_player for each slot

  friend bool operator==(const GameState&, const GameState&) = default;
};

/// An upper bound on the encoded state.
inline constexpr std::size_t k_max_state_bytes = sizeof(GameState);

/// Visits every record in canonical order: `visitor.record(store, index)`, then its fields.
template <class State, class Visitor>
void visit_state(State& state, std::size_t players, Visitor& visitor) {
  visitor.record("game", 0);
  visit_fields(state.game, visitor);
  for (std::size_t i = 0; i < players; ++i) {
    visitor.record("player", i);
    visit_fields(state.players[i], visitor);
  }
  for (std::size_t i = 0; i < players * k_shots_per_player; ++i) {
    visitor.record("shot", i);
    visit_fields(state.shots[i], visitor);
  }
}

}  // namespace lockstone::arena
