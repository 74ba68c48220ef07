/**
 * A quantity in SI units, made a fixed-point integer exactly and the same way on every machine:
 *
 * - a number: the nearest fixed-point value of the double, ties away from zero;
 * - text, "9.81", "-1e-3": the nearest one of the decimal;
 * - a bigint: the raw fixed-point integer itself.
 *
 * Literals, and `+ - * /` and `Math.sqrt` of them, are the same doubles everywhere. `Math.sin`,
 * `Math.pow` and their like are not: never let them into a world.
 */
export type Quantity = number | string | bigint;

/** x, y, z. */
export type Vector = readonly [Quantity, Quantity, Quantity];

/** A rotation as a quaternion x, y, z, w; normalised where it is used. */
export type Rotation = readonly [Quantity, Quantity, Quantity, Quantity];

/** x, y, z as they are read: numbers that hold the fixed-point values exactly, unless said otherwise. */
export type Numbers3 = [number, number, number];

/** A quaternion x, y, z, w as it is read. */
export type Numbers4 = [number, number, number, number];

const DECIMAL = /^([+-]?)(\d*)(?:\.(\d*))?(?:[eE]([+-]?\d{1,3}))?$/;

/** The value times 2^bits as an integral number or bigint. */
function scaled(value: Quantity, bits: number): number | bigint {
  if (typeof value === "bigint") return value;
  if (typeof value === "string") return fromDecimal(value, bits);
  const exact = value * 2 ** bits;
  const whole = Math.trunc(exact);
  return Math.abs(exact - whole) >= 0.5 ? whole + Math.sign(exact) : whole;
}

/** Decimal text times 2^bits to nearest, ties away from zero. */
export function fromDecimal(text: string, bits: number): bigint {
  const match = DECIMAL.exec(text.trim());
  const digits = (match?.[2] ?? "") + (match?.[3] ?? "");
  if (!match || digits === "") throw new SyntaxError(`not a decimal number: ${text}`);
  const exponent = Number(match[4] ?? 0) - (match[3] ?? "").length;
  const numerator = (BigInt(digits) << BigInt(bits)) * (exponent > 0 ? 10n ** BigInt(exponent) : 1n);
  const denominator = exponent < 0 ? 10n ** BigInt(-exponent) : 1n;
  const size = (2n * numerator + denominator) / (2n * denominator);
  return match[1] === "-" ? -size : size;
}

/** The raw 64-bit integer of a quantity; RangeError where it does not fit. */
export function raw64(value: Quantity, bits: number): bigint {
  const whole = scaled(value, bits);
  if (typeof whole === "number" && !Number.isFinite(whole)) throw new RangeError(`not a quantity: ${value}`);
  const raw = BigInt(whole);
  if (BigInt.asIntN(64, raw) !== raw) throw new RangeError(`${value} does not fit in 64 bits`);
  return raw;
}

/** The raw 32-bit integer of a quantity; RangeError where it does not fit. */
export function raw32(value: Quantity, bits: number): number {
  const raw = Number(scaled(value, bits));
  if ((raw | 0) !== raw) throw new RangeError(`${value} does not fit in 32 bits`);
  return raw;
}

/** A hash as sixteen hexadecimal digits, as the tools print it. */
export function hex(hash: bigint): string {
  return BigInt.asUintN(64, hash).toString(16).padStart(16, "0");
}
