// A film of the picture, from one press of the button to the next.
import { saveFile } from "./dom.js";

const FRAMES_A_SECOND = 60;
const BITS_A_SECOND = 8e6;
const TYPES = ["video/webm;codecs=vp9", "video/webm;codecs=vp8", "video/webm", "video/mp4"];

export class Clip {
  private recorder: MediaRecorder | null = null;
  private from = 0;

  constructor(private readonly canvas: HTMLCanvasElement, private readonly button: HTMLElement, private readonly tick: () => number) {
    button.onclick = () => this.toggle();
    button.hidden = typeof MediaRecorder === "undefined";
  }

  /** Whether every frame is wanted. */
  get runs(): boolean {
    return this.recorder !== null;
  }

  toggle(): void {
    if (this.recorder) return this.recorder.stop();
    const mimeType = TYPES.find((type) => MediaRecorder.isTypeSupported(type));
    const recorder = new MediaRecorder(this.canvas.captureStream(FRAMES_A_SECOND), { mimeType, videoBitsPerSecond: BITS_A_SECOND });
    const parts: Blob[] = [];
    recorder.ondataavailable = ({ data }) => parts.push(data);
    recorder.onstop = () => this.finish(new Blob(parts, { type: recorder.mimeType }));
    recorder.start();
    this.recorder = recorder;
    this.from = this.tick();
    this.button.setAttribute("aria-pressed", "true");
  }

  private finish(film: Blob): void {
    this.recorder = null;
    this.button.setAttribute("aria-pressed", "false");
    saveFile(`lockstone-ticks-${this.from}-${this.tick()}.${film.type.includes("mp4") ? "mp4" : "webm"}`, film);
  }
}
