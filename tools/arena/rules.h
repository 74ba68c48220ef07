// The rules of the game. A tick is: machines are driven, players act, the world steps, events
// score.
#pragma once

#include <cstdint>
#include <span>

#include <lockstone/character.h>
#include <lockstone/simulation.h>

#include "tools/arena/arena.h"
#include "tools/arena/input.h"

namespace lockstone::arena {

inline constexpr std::int32_t k_max_score = 1'000'000'000;

/// One whole tick. Every entry of `inputs` is k_input_bytes long.
StepReport advance(Arena& arena, std::span<const PlayerInput> inputs);

/// Applies one player's input: aim, walk, jump, push, carry, shoot.
void control_player(Arena& arena, std::size_t slot, const PlayerInput& input);

/// A player on foot: its shape, its mass, and the steps and slopes that it walks.
[[nodiscard]] CharacterDef character_def();

/// Walks the player's character for a tick, and jumps where `jumps` and it stands on ground: pushes
/// the bodies that stop it and is pushed by those that run into it.
void walk(Arena& arena, std::size_t slot, const Input& input, bool jumps);

/// Changes the velocity of a player's character.
void knock(PlayerRecord& player, const Vec3<SolverVelocity>& change);

/// The collision filter of a player who is on foot.
[[nodiscard]] CollisionFilter filter_on_foot(std::size_t slot);

/// Carry and throw, of which control_player makes use.
void carry(Arena& arena, std::size_t slot, bool wants);

/// Puts down the object that a player holds.
void release(Arena& arena, std::size_t slot);

/// Ends every hold on a body.
void release_from_all(Arena& arena, BodyHandle body);

/// The player that touches a body last: a loose one is its own, a player its victim.
void claim(Arena& arena, BodyHandle body, std::size_t slot);

/// Gets into the buggy or out of it where the player asks for it, and drives it. Returns whether
/// the player sits in it.
bool ride(Arena& arena, std::size_t slot, const Input& input, std::uint8_t pressed);

/// Leaves the buggy, if the player sits in it.
void leave_buggy(Arena& arena, std::size_t slot);

/// A loose body becomes the property of the player or snowball that touches it.
void touch(Arena& arena, BodyHandle by, BodyHandle body);

/// After the step: snowballs that hit players knock them.
void knock_by_snowballs(Arena& arena);

/// After the step: the buggy's hits, and its return when it lies on its back or fell off.
void look_after_buggy(Arena& arena);

/// Scores the step's events: touches, goals, the hill.
void score_events(Arena& arena);

/// Puts back objects that fell off and melts old snowballs.
void retire(Arena& arena);

void add_score(PlayerRecord& player, std::int32_t points);

}  // namespace lockstone::arena
