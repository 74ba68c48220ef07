// Opens an address in the user's browser.
import { spawn } from "node:child_process";

const PROGRAMS = ["xdg-open", "sensible-browser"];

/** Starts a program with an address; false: there is none of that name. It may outlive this one, and its failure is none of ours. */
function start(program, address) {
  return new Promise((resolve) => {
    const child = spawn(program, [address], { stdio: "ignore", detached: true });
    child.on("error", () => resolve(false));
    child.on("spawn", () => (child.unref(), resolve(true)));
  });
}

/** Whether the address was given to a browser. Without a display nothing is done. */
export async function openInBrowser(address) {
  if (!process.env.DISPLAY && !process.env.WAYLAND_DISPLAY) return false;
  for (const program of PROGRAMS) if (await start(program, address)) return true;
  return false;
}
