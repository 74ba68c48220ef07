// An archive of files that are stored as they are: pictures are compressed already.

const LOCAL = 0x04034b50, ENTRY = 0x02014b50, END = 0x06054b50;
const VERSION = 20;
const DATE = 0x21; // 1 January 1980: equal pictures give an equal archive
const MOST_FILES = 65_535;
const MOST_BYTES = 0xffff_ffff;

const TABLE = Uint32Array.from({ length: 256 }, (_, byte) => {
  for (let bit = 0; bit < 8; ++bit) byte = byte & 1 ? (byte >>> 1) ^ 0xedb88320 : byte >>> 1;
  return byte;
});

function crcOf(bytes: Uint8Array): number {
  let crc = 0xffff_ffff;
  for (const byte of bytes) crc = (crc >>> 8) ^ TABLE[(crc ^ byte) & 255]!;
  return ~crc >>> 0;
}

/** Numbers of 16 and 32 bits, little-endian. */
function record(fields: readonly [bits: 16 | 32, value: number][], name: Uint8Array = new Uint8Array()): Uint8Array<ArrayBuffer> {
  const size = fields.reduce((sum, [bits]) => sum + bits / 8, 0);
  const bytes = new Uint8Array(size + name.length), view = new DataView(bytes.buffer);
  let at = 0;
  for (const [bits, value] of fields) {
    if (bits === 16) view.setUint16(at, value, true);
    else view.setUint32(at, value, true);
    at += bits / 8;
  }
  bytes.set(name, at);
  return bytes;
}

export class Zip {
  private readonly parts: Blob[] = [];
  private readonly entries: Uint8Array<ArrayBuffer>[] = [];
  private at = 0;

  get count(): number {
    return this.entries.length;
  }

  /** Whether another file of this size has room. */
  takes(bytes: number): boolean {
    return this.count < MOST_FILES && this.at + bytes + 100 * (this.count + 1) < MOST_BYTES;
  }

  /** `name`: ASCII. */
  add(name: string, bytes: Uint8Array<ArrayBuffer>): void {
    const letters = new TextEncoder().encode(name);
    const facts: [16 | 32, number][] = [[16, VERSION], [16, 0], [16, 0], [16, 0], [16, DATE], [32, crcOf(bytes)], [32, bytes.length], [32, bytes.length], [16, letters.length], [16, 0]];
    const head = record([[32, LOCAL], ...facts], letters);
    this.entries.push(record([[32, ENTRY], [16, VERSION], ...facts, [16, 0], [16, 0], [16, 0], [32, 0], [32, this.at]], letters));
    this.parts.push(new Blob([head, bytes]));
    this.at += head.length + bytes.length;
  }

  finish(): Blob {
    const size = this.entries.reduce((sum, entry) => sum + entry.length, 0);
    const end = record([[32, END], [16, 0], [16, 0], [16, this.count], [16, this.count], [32, size], [32, this.at], [16, 0]]);
    return new Blob([...this.parts, ...this.entries, end], { type: "application/zip" });
  }
}
