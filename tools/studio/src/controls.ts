// Keys and a gamepad as inputs of the arena: tools/arena/input.h.
const KEYS: Record<string, string> = {
  KeyW: "up", ArrowUp: "up", KeyS: "down", ArrowDown: "down", KeyA: "left", ArrowLeft: "left", KeyD: "right", ArrowRight: "right",
  Space: "jump", KeyE: "push", KeyF: "grab", KeyX: "throw", KeyR: "ride",
};
const BUTTONS = ["jump", "push", "grab", "throw", "ride"] as const; // bit by bit; the pad's first five buttons
const DEAD_ZONE = 0.2; // of a stick
const INPUT_BYTES = 8;
const TURN = 65536;

export class Controls {
  private readonly held = new Set<string>();
  private yaw = 0;
  private readonly ending = new AbortController();

  constructor() {
    const { signal } = this.ending;
    // Before the keys of the page.
    addEventListener("keydown", (event) => this.press(event, true), { signal, capture: true });
    addEventListener("keyup", (event) => this.press(event, false), { signal, capture: true });
    addEventListener("blur", () => this.held.clear(), { signal });
  }

  /** The input that is pressed now; `turn`: of the camera, rad. */
  bytes(turn: number): Uint8Array {
    const pad = navigator.getGamepads().find((one) => one !== null) ?? null;
    const stick = (axis: number) => (pad && Math.abs(pad.axes[axis] ?? 0) > DEAD_ZONE ? pad.axes[axis]! : 0);
    const ahead = this.axis("up", "down") - stick(1), aside = this.axis("right", "left") + stick(0);
    const [sin, cos] = [Math.sin(turn), Math.cos(turn)];
    const x = -sin * ahead + cos * aside, z = -cos * ahead - sin * aside;
    const length = Math.max(Math.hypot(x, z), 1);
    if (x !== 0 || z !== 0) this.yaw = Math.round((Math.atan2(z, x) / (2 * Math.PI)) * TURN);
    const bytes = new DataView(new ArrayBuffer(INPUT_BYTES));
    bytes.setInt8(0, Math.round((127 * x) / length));
    bytes.setInt8(1, Math.round((127 * z) / length));
    bytes.setInt16(2, this.yaw, true);
    bytes.setUint8(4, BUTTONS.reduce((set, name, i) => (this.held.has(name) || pad?.buttons[i]?.pressed ? set | (1 << i) : set), 0));
    return new Uint8Array(bytes.buffer);
  }

  destroy(): void {
    this.ending.abort();
  }

  private axis(plus: string, minus: string): number {
    return Number(this.held.has(plus)) - Number(this.held.has(minus));
  }

  private press(event: KeyboardEvent, down: boolean): void {
    const name = KEYS[event.code];
    const { target } = event;
    const typing = target instanceof HTMLInputElement && target.type === "text";
    if (name === undefined || (down && (typing || event.ctrlKey || event.metaKey || event.altKey))) return;
    if (down) this.held.add(name);
    else this.held.delete(name);
    if (typing) return;
    event.preventDefault();
    event.stopPropagation();
  }
}
