import * as c from "./declarations.js";
import type { Heap } from "./heap.js";

/** The part of a browser's WebSocket that is used: the class of the package `ws` has it too. */
export interface WebSocketLike {
  binaryType: string;
  readonly readyState: number;
  readonly bufferedAmount: number;
  onopen: ((event: never) => void) | null;
  onmessage: ((event: { data: unknown }) => void) | null;
  onclose: ((event: { code: number }) => void) | null;
  onerror: ((event: never) => void) | null;
  send(data: Uint8Array): void;
  close(code?: number): void;
}
export type WebSocketClass = new (url: string, protocol: string) => WebSocketLike;

const OPEN = 1;
const MESSAGE_BYTES = 49_217;
/** More than this is kept by the library, which replaces what is outdated. */
const MOST_BUFFERED = 64 * 1024;

/** The transport of a client, and the WebSocket under it. */
export class Socket {
  /** Of the C interface. A client keeps it alive. */
  readonly transport: number;
  private readonly room: number;
  private socket: WebSocketLike | null = null;

  constructor(private readonly heap: Heap, private readonly url: string, token: string | undefined,
    private readonly WebSocket: WebSocketClass) {
    this.room = heap.allocate(MESSAGE_BYTES);
    try {
      heap.check(heap.f.lks_carried_create(token === undefined ? 0 : this.putToken(token), heap.output));
    } catch (error) {
      heap.f.free(this.room);
      throw error;
    }
    this.transport = heap.getWord(heap.output);
  }

  private putToken(token: string): number {
    const { read, written } = new TextEncoder().encodeInto(token.trim(), this.heap.u8.subarray(this.room, this.room + 2048));
    if (read < token.trim().length) throw new RangeError("the token is too long");
    this.heap.u8[this.room + written] = 0;
    return this.room;
  }

  /** Opens a WebSocket; returns the number of its connection. */
  call(): number {
    const { heap } = this;
    this.abandon();
    heap.check(heap.f.lks_carried_call(this.transport, heap.output));
    const connection = heap.getWord(heap.output);
    const socket = (this.socket = new this.WebSocket(this.url, "lockstone"));
    socket.binaryType = "arraybuffer";
    socket.onopen = () => heap.check(heap.f.lks_carried_opened(this.transport));
    socket.onmessage = ({ data }) => this.receive(socket, data);
    socket.onclose = ({ code }) => {
      this.socket = null;
      heap.check(heap.f.lks_carried_closed(this.transport, code));
    };
    socket.onerror = () => {}; // `onclose` follows
    return connection;
  }

  /** Sends all that the library has, as long as the WebSocket takes it. */
  send(): void {
    const { heap, socket, room } = this;
    if (socket === null) return;
    const count = heap.output;
    while (socket.readyState === OPEN && socket.bufferedAmount < MOST_BUFFERED) {
      heap.check(heap.f.lks_carried_take(this.transport, room, MESSAGE_BYTES, count));
      const bytes = heap.getWord(count);
      if (bytes === 0) break;
      socket.send(heap.u8.slice(room, room + bytes));
    }
    heap.check(heap.f.lks_carried_is_open(this.transport, count));
    if (heap.getWord(count) === 0) socket.close(1000);
  }

  private receive(socket: WebSocketLike, data: unknown): void {
    const { heap, room } = this;
    const bytes = data instanceof ArrayBuffer ? new Uint8Array(data) : new Uint8Array();
    if (bytes.length === 0 || bytes.length > MESSAGE_BYTES) return socket.close(1000);
    heap.u8.set(bytes, room);
    const status = heap.f.lks_carried_receive(this.transport, room, bytes.length);
    if (status === c.LKS_MALFORMED) return socket.close(1000);
    heap.check(status);
  }

  /** Closes the WebSocket and hears no more of it. */
  private abandon(): void {
    const { socket } = this;
    if (socket === null) return;
    socket.onopen = socket.onmessage = socket.onclose = null;
    socket.close(1000);
    this.socket = null;
  }

  destroy(): void {
    this.abandon();
    this.heap.f.lks_transport_destroy(this.transport);
    this.heap.f.free(this.room);
  }
}
