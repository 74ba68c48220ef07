// Pictures of every tick, from one press of the button to the next, as PNG files in an archive.
import { saveFile } from "./dom.js";
import { Zip } from "./zip.js";

export class Sequence {
  private zip: Zip | null = null;
  private taken = -1;
  private waiting = false; // for a picture that is being compressed
  private ending = false;

  constructor(private readonly canvas: HTMLCanvasElement, private readonly button: HTMLElement) {
    button.onclick = () => this.toggle();
  }

  get runs(): boolean {
    return this.zip !== null;
  }

  /** Whether the next tick may be played: the picture of the last one is kept. */
  get ready(): boolean {
    return this.runs && !this.waiting && !this.ending;
  }

  toggle(): void {
    if (!this.zip) {
      this.zip = new Zip();
      this.taken = -1;
      this.ending = false;
      this.button.setAttribute("aria-pressed", "true");
    } else if (this.waiting) {
      this.ending = true;
    } else {
      this.finish();
    }
  }

  /** Keeps the picture as it is drawn now, unless it has the tick already. */
  take(tick: number): void {
    if (!this.ready || tick === this.taken) return;
    this.taken = tick;
    this.waiting = true;
    this.canvas.toBlob((picture) => void this.add(tick, picture), "image/png");
  }

  private async add(tick: number, picture: Blob | null): Promise<void> {
    const full = picture !== null && !this.zip!.takes(picture.size);
    if (picture && !full) this.zip!.add(`tick-${String(tick).padStart(6, "0")}.png`, new Uint8Array(await picture.arrayBuffer()));
    this.waiting = false;
    if (this.ending || full) this.finish();
  }

  private finish(): void {
    const zip = this.zip!;
    this.zip = null;
    this.button.setAttribute("aria-pressed", "false");
    if (zip.count > 0) saveFile(`lockstone-${zip.count}-ticks.zip`, zip.finish());
  }
}
