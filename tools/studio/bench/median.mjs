/** The middle of numbers, which it sorts. */
export function median(numbers) {
  return numbers.sort((a, b) => a - b)[numbers.length >> 1];
}
