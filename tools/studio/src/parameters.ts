// Numbers that a scene is made with, besides its seed.
import { make } from "./dom.js";
import type { SceneParameter } from "./engine.js";

/** Values by name; one that is not there is the usual one. */
export type Values = Readonly<Record<string, number>>;

const TITLES: Readonly<Record<string, string>> = { gravity: "gravity, cm/s²" };

/** All values in the scene's order, each within its range; empty where all are usual. */
export function valuesOf(parameters: readonly SceneParameter[], given: Values): number[] {
  const values = parameters.map(({ name, usual, least, most }) => Math.min(Math.max(Math.round(given[name] ?? usual), least), most));
  return values.every((value, i) => value === parameters[i]!.usual) ? [] : values;
}

/** A number to enter for each parameter. */
export class ParameterFields {
  readonly element = make("div", { id: "parameters", class: "fields" });

  constructor(private readonly changed: (values: Values) => void) {}

  show(parameters: readonly SceneParameter[], values: readonly number[]): void {
    const fields = parameters.map(({ name, usual, least, most }, i) => {
      const input = make("input", { type: "number", id: `parameter-${name.replaceAll(" ", "-")}`, min: String(least), max: String(most), value: String(values[i] ?? usual) });
      input.title = `${least} … ${most}, usually ${usual}`;
      return { name, input };
    });
    const read = () => this.changed(Object.fromEntries(fields.filter(({ input }) => input.value !== "").map(({ name, input }) => [name, Number(input.value)])));
    for (const { input } of fields) input.onchange = read;
    this.element.replaceChildren(...fields.map(({ name, input }) => make("label", { class: "field" }, make("span", {}, TITLES[name] ?? name), input)));
  }
}
