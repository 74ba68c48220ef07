// The connection to a WorldServer of a game: docs/reference/wire-format.md, "Viewers of a world".

const CHANNEL = 0; // reliable
const MORE = 1;
const Kind = { description: 1, state: 2 } as const;

export interface WorldNews {
  description(bytes: Uint8Array): void;
  state(bytes: Uint8Array): void;
  /** The game has ended, or never took the token. */
  ended(): void;
}

export class WorldLink {
  private readonly socket: WebSocket;
  private parts: Uint8Array[] = [];

  constructor(url: string, token: string, private readonly news: WorldNews) {
    this.socket = new WebSocket(url, "lockstone");
    this.socket.binaryType = "arraybuffer";
    this.socket.onopen = () => this.socket.send(new Uint8Array([CHANNEL, ...new TextEncoder().encode(token)]));
    this.socket.onmessage = ({ data }: MessageEvent<ArrayBuffer>) => this.take(new Uint8Array(data));
    this.socket.onclose = () => news.ended();
  }

  close(): void {
    this.socket.onclose = this.socket.onmessage = null;
    this.socket.close();
  }

  private take(packet: Uint8Array): void {
    this.parts.push(packet.subarray(2));
    if (packet[1] === MORE) return;
    const message = new Uint8Array(this.parts.reduce((sum, part) => sum + part.length, 0));
    let at = 0;
    for (const part of this.parts) {
      message.set(part, at);
      at += part.length;
    }
    this.parts = [];
    if (message[0] === Kind.description) this.news.description(message);
    else if (message[0] === Kind.state) this.news.state(message.subarray(1));
  }
}
