// Bodies of the arena's players.
import type { World } from "../../web/src/world.js";

const PLAYER_TAG = 1; // in a body's user data, above it the slot: tools/arena/tags.h

/** Of the camera that goes along with one, in radii of the scene. */
export const NEAR = 0.7;

/** The id; 0: the player has none. */
export function bodyOfPlayer(world: World, slot: number): bigint {
  const tag = PLAYER_TAG + 256 * slot;
  return [...world.bodies()].find((body) => Number(body.view.userData & 0xffffffn) === tag)?.id ?? 0n;
}
