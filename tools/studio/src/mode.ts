// A view of the studio: testbed, log, desync or live.
import type * as three from "three";
import type { Hit } from "../../web/src/queries.js";
import type { Diorama } from "./picture.js";
import type { Stage } from "./stage.js";

export interface Mode {
  /** Drawn beside each other. The first one leads. */
  readonly dioramas: readonly Diorama[];
  readonly lead: Stage;
  readonly panel: HTMLElement;
  /** Above the transport; null: the slider is enough. */
  readonly lane: HTMLElement | null;
  /** Names under the halves of the picture. */
  readonly labels: readonly string[];
  /** Names of overlays that are shown. */
  readonly shown: ReadonlySet<string>;
  /** Of the way to the last tick, where the view moves on by itself. */
  readonly fraction?: number;
  /** The tick that is being computed, frame by frame; null: it is reached. */
  readonly goal?: number | null;
  step(): void;
  seek(tick: number): void;
  /** Once a frame, after the picture. Not every picture wants figures and charts. */
  refresh(wantsFigures: boolean): void;
  /** A body was clicked; null: none. `part`: which half of the picture. */
  choose(hit: Hit | null, part: number): void;
  /** Takes a body at the point of the hit; false: it cannot be pulled. */
  grab?(hit: Hit): boolean;
  /** Where the hand is, from here on. */
  drag?(to: three.Vector3): void;
  release?(): void;
  /** A key that the view knows. */
  key?(key: string): boolean;
  /** A file was dropped on the picture. */
  openFile?(file: File): Promise<void>;
  /** The fragment of the address that shows the same. */
  link?(): string;
  destroy(): void;
}
