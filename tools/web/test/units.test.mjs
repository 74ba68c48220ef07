import assert from "node:assert/strict";
import { pathToFileURL } from "node:url";
import { test } from "node:test";

import { folder, full } from "./support.mjs";

const { fromDecimal, raw32, raw64 } = await import(pathToFileURL(`${folder}/dist/units.js`));

test("decimals are rounded as the C interface rounds them", async () => {
  const { heap } = await full.loadFull();
  for (const text of ["0", "9.81", "-9.81", "0.1", "-0.1", "0.000000001", "123456.789", "-1.5", "1000"]) {
    for (const bits of [0, 1, 8, 20, 30, 32]) {
      heap.check(heap.f.lks_from_decimal(heap.putText(text), bits, heap.output));
      assert.equal(fromDecimal(text, bits), heap.i64[heap.output >>> 3], `${text} with ${bits} bits`);
    }
  }
});

test("decimals may have an exponent", () => {
  assert.equal(fromDecimal("1.5e3", 0), 1500n);
  assert.equal(fromDecimal("-25e-1", 0), -3n);
});

test("numbers go to the nearest raw value, ties away from zero", () => {
  assert.equal(raw32(2.5, 0), 3);
  assert.equal(raw32(-2.5, 0), -3);
  assert.equal(raw32(0.25, 20), 1 << 18);
  assert.equal(raw64(1 / 3, 32), 1431655765n);
  assert.equal(raw64(-(2 ** 20), 32), -(1n << 52n));
});

test("a bigint is the raw value itself", () => {
  assert.equal(raw64(7n, 32), 7n);
  assert.equal(raw32(-7n, 20), -7);
});

test("values that are no quantities or do not fit are refused", () => {
  for (const wrong of [Number.NaN, Infinity, 2 ** 31, "1e10"]) assert.throws(() => raw64(wrong, 32), RangeError);
  for (const wrong of [2048, -2049, Number.NaN, 1n << 31n]) assert.throws(() => raw32(wrong, 20), RangeError);
  for (const wrong of ["", ".", "1,5", "0x10", "ten"]) assert.throws(() => raw64(wrong, 32), SyntaxError);
});
