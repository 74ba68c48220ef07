// The part of a panel that chooses overlays and colours.
import { make, section, select, toggle } from "./dom.js";
import { OVERLAYS } from "./overlays.js";
import { COLOURINGS, type Colouring } from "./paint.js";

export const SWITCHES = [...OVERLAYS, "sleeping", "triggers"] as const;

/** Keeps `shown` up to date. `names`: of switches that have others than their own. */
export function showSection(shown: Set<string>, colour: Colouring, setColour: (colour: Colouring) => void,
  names: Record<string, string> = { masses: "centre of mass" }): HTMLElement {
  const switches = SWITCHES.map((name) => toggle(names[name] ?? name, `show-${name}`, shown.has(name),
    (on) => void (on ? shown.add(name) : shown.delete(name))));
  return section("Show", make("div", { class: "row" }, ...switches),
    select("colour", COLOURINGS, colour, (name) => setColour(name as Colouring), "colour by"));
}
