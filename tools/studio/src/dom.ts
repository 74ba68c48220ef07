// Elements of the page.

type Child = Node | string | null;

/** An element with properties and children. */
export function make<Name extends keyof HTMLElementTagNameMap>(
  name: Name, properties: Partial<Omit<HTMLElementTagNameMap[Name], "style">> & { class?: string } = {}, ...children: Child[]
): HTMLElementTagNameMap[Name] {
  const { class: names, ...rest } = properties;
  const element = Object.assign(document.createElement(name), rest);
  if (names) element.className = names;
  element.append(...children.filter((child) => child !== null));
  return element;
}

export function byId<Kind extends HTMLElement = HTMLElement>(id: string): Kind {
  const element = document.getElementById(id);
  if (!element) throw new Error(`the page has no element ${id}`);
  return element as Kind;
}

export function button(text: string, title: string, press: () => void, id = ""): HTMLButtonElement {
  const element = make("button", { type: "button", title, id, onclick: press }, text);
  element.setAttribute("aria-label", title);
  return element;
}

/** A labelled box to tick. */
export function toggle(text: string, id: string, on: boolean, change: (on: boolean) => void): HTMLLabelElement {
  const box = make("input", { type: "checkbox", checked: on, id });
  box.onchange = () => change(box.checked);
  return make("label", { class: "toggle" }, box, text);
}

export function select(id: string, options: readonly string[], value: string, change: (value: string) => void, label: string): HTMLLabelElement {
  const list = make("select", { id }, ...options.map((option) => new Option(option)));
  list.value = value;
  list.onchange = () => change(list.value);
  return make("label", { class: "field" }, make("span", {}, label), list);
}

export function section(title: string, ...children: Child[]): HTMLElement {
  return make("section", {}, make("h2", {}, title), ...children);
}

/** A canvas of as many pixels as the page gives it, to draw on; null: it is not shown. */
export function sheetOf(canvas: HTMLCanvasElement): { pen: CanvasRenderingContext2D; width: number; height: number } | null {
  const { clientWidth: width, clientHeight: height } = canvas;
  if (width === 0) return null;
  if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
  return { pen: canvas.getContext("2d")!, width, height };
}

/** Rows of a name and a value; `set` fills them. */
export class Facts {
  readonly element = make("dl", { class: "facts" });
  private readonly values = new Map<string, HTMLElement>();

  constructor(idPrefix: string, names: readonly string[]) {
    for (const name of names) {
      const value = make("dd", { id: `${idPrefix}-${name.replaceAll(" ", "-")}` });
      this.values.set(name, value);
      this.element.append(make("dt", {}, name), value);
    }
  }

  set(name: string, text: string): void {
    const value = this.values.get(name);
    if (value && value.textContent !== text) value.textContent = text;
  }
}

export function saveFile(name: string, blob: Blob): void {
  const url = URL.createObjectURL(blob);
  make("a", { href: url, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(url), 10_000);
}
