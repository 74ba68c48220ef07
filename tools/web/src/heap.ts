import type { Functions } from "./declarations.js";
import { LockstoneError } from "./errors.js";
import { type Numbers3, type Numbers4, type Quantity, type Rotation, type Vector, raw32, raw64 } from "./units.js";

const SCRATCH_BYTES = 2048;
const decoder = new TextDecoder();
const encoder = new TextEncoder();

/** The functions of the module, and those of the C library. */
export interface Exports extends Functions {
  readonly memory: WebAssembly.Memory;
  malloc(bytes: number): number;
  free(address: number): void;
  _initialize?(): void;
}

/**
 * The module's memory. Addresses are in bytes; those of structures are multiples of 8. The arrays
 * are made again when the memory grows, which only calls that make something do.
 */
export class Heap {
  u8!: Uint8Array;
  i32!: Int32Array;
  u32!: Uint32Array;
  i64!: BigInt64Array;
  u64!: BigUint64Array;
  f32!: Float32Array;
  /** Rises when the memory grows: arrays from before have no elements any more. */
  generation = 0;
  /** Room for the arguments of one call, 1 KiB, … */
  readonly input: number;
  /** … and for its results, 1 KiB. */
  readonly output: number;

  constructor(readonly f: Exports) {
    this.refresh();
    f._initialize?.();
    this.input = this.allocate(SCRATCH_BYTES);
    this.output = this.input + SCRATCH_BYTES / 2;
  }

  refresh(): void {
    const { buffer } = this.f.memory;
    this.u8 = new Uint8Array(buffer);
    this.i32 = new Int32Array(buffer);
    this.u32 = new Uint32Array(buffer);
    this.i64 = new BigInt64Array(buffer);
    this.u64 = new BigUint64Array(buffer);
    this.f32 = new Float32Array(buffer);
    ++this.generation;
  }

  /** Zeroed memory, to be freed with `f.free`. */
  allocate(bytes: number): number {
    const address = this.f.malloc(Math.max(bytes, 8)) >>> 0;
    if (address === 0) throw new LockstoneError(68, "out of memory", `no ${bytes} bytes`);
    this.u8.fill(0, address, address + bytes);
    return address;
  }

  /** Throws where the module lacks the function: that of `load` has fewer than that of `loadFull`. */
  needs(name: keyof Functions): void {
    if (!(name in this.f)) throw new Error(`Lockstone: ${name} needs the module of loadFull() (lockstone/full)`);
  }

  /** Throws where a status is not LKS_OK. */
  check(status: number): void {
    if (status !== 0) {
      throw new LockstoneError(status, this.text(this.f.lks_status_name(status)), this.text(this.f.lks_last_error()));
    }
  }

  text(address: number): string {
    const start = address >>> 0;
    return decoder.decode(this.u8.subarray(start, this.u8.indexOf(0, start)));
  }

  /** Writes terminated text of at most 1 KiB to `input`. */
  putText(text: string): number {
    const room = this.u8.subarray(this.input, this.output - 1);
    const { read, written } = encoder.encodeInto(text, room);
    if (read < text.length) throw new RangeError("the text is too long");
    room[written] = 0;
    return this.input;
  }

  put64(address: number, value: Quantity, bits: number): void {
    this.i64[address >>> 3] = raw64(value, bits);
  }
  put32(address: number, value: Quantity, bits: number): void {
    this.i32[address >>> 2] = raw32(value, bits);
  }
  /** An unsigned or signed integer. */
  putWord(address: number, value: number): void {
    this.u32[address >>> 2] = value;
  }
  putVector64(address: number, [x, y, z]: Vector, bits: number): void {
    this.put64(address, x, bits);
    this.put64(address + 8, y, bits);
    this.put64(address + 16, z, bits);
  }
  putVector32(address: number, [x, y, z]: Vector, bits: number): void {
    this.put32(address, x, bits);
    this.put32(address + 4, y, bits);
    this.put32(address + 8, z, bits);
  }
  putRotation(address: number, [x, y, z, w]: Rotation): void {
    this.putVector32(address, [x, y, z], 30);
    this.put32(address + 12, w, 30);
  }

  /** A 64-bit fixed-point value as a number: exact below 2^53 raw. */
  get64(address: number, bits: number): number {
    const at = address >>> 2;
    return (this.i32[at + 1]! * 2 ** 32 + this.u32[at]!) / 2 ** bits;
  }
  get32(address: number, bits: number): number {
    return this.i32[address >>> 2]! / 2 ** bits;
  }
  getWord(address: number): number {
    return this.u32[address >>> 2]!;
  }
  getId(address: number): bigint {
    return this.u64[address >>> 3]!;
  }
  getVector64(address: number, bits: number): Numbers3 {
    return [this.get64(address, bits), this.get64(address + 8, bits), this.get64(address + 16, bits)];
  }
  getVector32(address: number, bits: number): Numbers3 {
    return [this.get32(address, bits), this.get32(address + 4, bits), this.get32(address + 8, bits)];
  }
  getRotation(address: number): Numbers4 {
    return [...this.getVector32(address, 30), this.get32(address + 12, 30)];
  }
}
