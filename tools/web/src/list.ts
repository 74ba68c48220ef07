import { LKS_BUFFER_TOO_SMALL } from "./declarations.js";
import type { Heap } from "./heap.js";

/** Elements that a function of the C interface lists: memory for them is taken, and taken again where it is too small. */
export function list<Element>(
  heap: Heap,
  elementBytes: number,
  call: (out: number, capacity: number, count: number) => number,
  read: (address: number) => Element,
  capacity = 64,
): Element[] {
  const room = heap.allocate(capacity * elementBytes);
  try {
    const status = call(room, capacity, heap.output);
    const count = heap.getWord(heap.output);
    if (status === LKS_BUFFER_TOO_SMALL) return list(heap, elementBytes, call, read, Math.max(count, 2 * capacity));
    heap.check(status);
    return Array.from({ length: count }, (_, i) => read(room + i * elementBytes));
  } finally {
    heap.f.free(room);
  }
}

/** As `list`, for functions that write as many as fit and say no more: asks again while the memory is full. */
export function listAll<Element>(
  heap: Heap,
  elementBytes: number,
  call: (out: number, capacity: number, count: number) => number,
  read: (address: number) => Element,
): Element[] {
  for (let capacity = 64; ; capacity *= 4) {
    const found = list(heap, elementBytes, call, read, capacity);
    if (found.length < capacity) return found;
  }
}
