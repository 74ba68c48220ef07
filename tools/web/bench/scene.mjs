// The scene that all engines play: a pyramid of boxes on a floor, each row one box shorter than the
// one below. Metres, kilograms, seconds.
export const ROWS = 20;
export const TICKS = 300;
export const HALF = 0.5;
export const FRICTION = 0.6;
export const DENSITY = 1000;
export const GRAVITY = -9.81;
export const FLOOR = { half: [50, 1, 50], position: [0, -1, 0] };

/** The centres of the boxes. */
export function pyramid() {
  const places = [];
  for (let row = 0; row < ROWS; ++row) {
    for (let i = 0; i < ROWS - row; ++i) places.push([(i - (ROWS - row - 1) / 2) * 1.05, HALF + row * 2 * HALF, 0]);
  }
  return places;
}
