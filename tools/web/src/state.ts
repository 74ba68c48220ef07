import * as c from "./declarations.js";
import { hex } from "./units.js";
import type { World } from "./world.js";

/** The hashes of a world and of its parts. Of a scene with players `total` is the world's alone. */
export interface PartHashes {
  total: string;
  header: string;
  bodies: string;
  contacts: string;
  joints: string;
}

export function partHashes({ heap, address }: World): PartHashes {
  heap.check(heap.f.lks_part_hashes(address, heap.output));
  const at = (place: number) => hex(heap.getId(heap.output + place));
  const { total, header, bodies, contacts, joints } = c.lks_hashes;
  return { total: at(total), header: at(header), bodies: at(bodies), contacts: at(contacts), joints: at(joints) };
}

function mostBytes({ heap, address }: World, kind: number): number {
  heap.check(heap.f.lks_snapshot_bytes_max(address, kind, heap.output));
  return heap.getWord(heap.output);
}

/** The state as bytes for files and for other machines; `loadState` checks every byte. */
export function saveState(world: World): Uint8Array {
  const { heap, address } = world;
  const most = mostBytes(world, c.LKS_CANONICAL);
  const room = heap.allocate(most);
  try {
    heap.check(heap.f.lks_save(address, c.LKS_CANONICAL, room, most, heap.output));
    return heap.u8.slice(room, room + heap.getWord(heap.output));
  } finally {
    heap.f.free(room);
  }
}

/** Replaces the state by one that `saveState` wrote, anywhere, of a world with the same definition and assets. */
export function loadState(world: World, bytes: Uint8Array): void {
  const { heap, address } = world;
  const room = heap.allocate(bytes.length);
  try {
    heap.u8.set(bytes, room);
    heap.check(heap.f.lks_load(address, c.LKS_CANONICAL, room, bytes.length));
  } finally {
    heap.f.free(room);
  }
}

/**
 * The first difference between two saved states of the world, for people, or null: `body 17 "crate", velocity.y: …`.
 * Needs the module of `loadFull`.
 */
export function describeDifference(world: World, here: Uint8Array, there: Uint8Array): string | null {
  const { heap, address } = world;
  heap.needs("lks_describe_difference");
  const room = heap.allocate(here.length + there.length);
  const text = heap.output + 8;
  try {
    heap.u8.set(here, room);
    heap.u8.set(there, room + here.length);
    heap.check(heap.f.lks_describe_difference(address, room, here.length, room + here.length, there.length,
      heap.output, text, 1000));
    return heap.getWord(heap.output) === 1 ? heap.text(text) : null;
  } finally {
    heap.f.free(room);
  }
}

const forgotten = new FinalizationRegistry<() => void>((free) => free());

/** A state kept in the module's memory, for rollback and rewinding: about as fast as a copy. */
export class Snapshot {
  private readonly room: number;
  /** Bytes of memory that it holds. */
  capacity: number;
  private bytes = 0;

  /** Room for a state of the world; empty until `save`. */
  constructor(readonly world: World) {
    const { heap } = world;
    this.capacity = mostBytes(world, c.LKS_NATIVE);
    const room = (this.room = heap.allocate(this.capacity));
    forgotten.register(this, () => heap.f.free(room), this);
  }

  save(): void {
    const { heap, address } = this.world;
    heap.check(heap.f.lks_save(address, c.LKS_NATIVE, this.room, this.capacity, heap.output));
    this.bytes = heap.getWord(heap.output);
  }

  load(): void {
    const { heap, address } = this.world;
    heap.check(heap.f.lks_load(address, c.LKS_NATIVE, this.room, this.bytes));
  }

  destroy(): void {
    if (!forgotten.unregister(this)) return; // twice
    this.world.heap.f.free(this.room);
    this.capacity = this.bytes = 0;
  }
}
