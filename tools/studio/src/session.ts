// What the command was asked to show: it serves that beside the page.

/** The answer to `lockstone bisect`, and of where the states of both sides are known. */
export interface Desync {
  found: boolean;
  tick: number;
  stage?: string;
  /** The tick of the states `state/here` and `state/there`. */
  state_at?: number;
  store?: string;
  object?: number;
  name?: string;
  field?: string;
  here?: string;
  there?: string;
  note?: string;
  line: string;
  has_states: boolean;
}

/** A match that runs. */
export interface Live {
  /** "ws://127.0.0.1:9000/" */
  url: string;
  /** null: the match is insecure. */
  token: string | null;
  name: string;
  /** The seat to begin with. */
  role: "spectator" | "player";
}

/** A game that shows its world. */
export interface WatchedWorld {
  /** "ws://127.0.0.1:9000/" */
  url: string;
  token: string;
}

export interface Session {
  views: string[];
  /** Names of the logs: one, or two. */
  logs: string[];
  desync: Desync | null;
  live: Live | null;
  world: WatchedWorld | null;
}

async function fetched(path: string): Promise<Response> {
  const response = await fetch(new URL(path, document.baseURI));
  if (!response.ok) throw new Error(`${path}: ${response.status} ${response.statusText}`);
  return response;
}

export async function bytesOf(path: string): Promise<Uint8Array> {
  return new Uint8Array(await (await fetched(path)).arrayBuffer());
}

export async function sessionOf(): Promise<Session> {
  return (await (await fetched("session.json")).json()) as Session;
}
