import * as c from "./declarations.js";
import type { Heap } from "./heap.js";

/** The log of a client's ticks, in memory: `Client.record` begins it, `verifyLog` and `lockstone verify` read it. */
export class Recording {
  /** `address`: a recorder that the C interface made, which this object destroys. */
  constructor(private readonly heap: Heap, private address: number) {}

  /** Writes the end of the log. Nothing is recorded afterwards. */
  finish(reason = "completed"): void {
    this.heap.check(this.heap.f.lks_recorder_finish(this.address, this.heap.putText(reason)));
  }

  /** The log so far: a file with the ending `.lks`. */
  bytes(): Uint8Array {
    const { heap } = this;
    const { f, output } = heap;
    const status = f.lks_recorder_bytes(this.address, 0, 0, output);
    if (status !== c.LKS_BUFFER_TOO_SMALL) heap.check(status);
    const size = heap.getWord(output);
    const room = heap.allocate(size);
    try {
      heap.check(f.lks_recorder_bytes(this.address, room, size, output));
      return heap.u8.slice(room, room + size);
    } finally {
      f.free(room);
    }
  }

  destroy(): void {
    this.heap.f.lks_recorder_destroy(this.address);
    this.address = 0;
  }
}
