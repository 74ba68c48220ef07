// Hosts a match of the arena for this machine: bots, and seats for browser tabs. See tools/demo.sh --play.
//
// usage: node host.mjs [--bots N] [--tabs N] [--port PORT] [--no-open]
import { parseArgs } from "node:util";

import { serve } from "../test/server.mjs";
import { withMatch } from "../test/processes.mjs";
import { openInBrowser } from "./open.mjs";

const { values } = parseArgs({ options: {
  bots: { type: "string", default: "3" }, tabs: { type: "string", default: "2" }, port: { type: "string", default: "0" },
  "no-open": { type: "boolean", default: false },
} });
const bots = Number(values.bots), tabs = Number(values.tabs);
const stopped = new Promise((resolve) => ["SIGINT", "SIGTERM"].forEach((signal) => process.on(signal, resolve)));

await withMatch(["--players", `${bots + tabs}`, "--start-players", `${bots}`, "--ticks", "0", "--input-delay", "3"], async (match) => {
  const seats = new Map();
  for (let seat = 0; seat < tabs; ++seat) seats.set(`/seat/${seat}`, { url: match.url, token: match.backend.tokenText(seat) });
  const pages = await serve(Number(values.port), seats);
  for (let slot = tabs; slot < tabs + bots; ++slot)
    match.run("join", "--token", match.backend.token(slot), "--server", `127.0.0.1:${match.port}`, "--name", `bot ${slot}`, "--quiet");
  await match.server.says(/the match begins/);
  const addresses = Array.from({ length: tabs }, (_, seat) => `http://127.0.0.1:${pages.address().port}/play/index.html?seat=${seat}`);
  addresses.forEach((address, seat) => console.log(`seat ${seat}: ${address}`));
  if (addresses[0] && !values["no-open"] && await openInBrowser(addresses[0])) console.log("Seat 0 opens in your browser.");
  console.log("Ctrl-C ends the match.");
  await Promise.race([stopped, match.server.ended]);
  pages.close();
});
process.exit(0);
