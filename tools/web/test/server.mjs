// Serves files of the package, its tests and its testbed: for the tests in a browser, and by hand.
//
// usage: node server.mjs [PORT]
import { createServer } from "node:http";
import { readFile } from "node:fs/promises";
import { extname, join, normalize } from "node:path";
import { fileURLToPath } from "node:url";

const root = fileURLToPath(new URL("../../..", import.meta.url));
const package_ = process.env.LOCKSTONE_WEB_PACKAGE ?? join(root, "build/web/package");
const FOLDERS = {
  lockstone: package_,
  play: join(root, "tools/web/play"),
  testbed: join(root, "tools/web/testbed"),
  test: join(root, "tools/web/test"),
  golden: join(root, "tests/golden"),
  three: join(root, "build/web/node/node_modules/three/build"),
};
const TYPES = {
  ".html": "text/html; charset=utf-8", ".js": "text/javascript", ".mjs": "text/javascript",
  ".json": "application/json", ".wasm": "application/wasm",
};

async function answer(request, response, more) {
  const { pathname } = new URL(request.url, "http://localhost");
  if (more.has(pathname)) {
    response.writeHead(200, { "content-type": TYPES[".json"] }).end(JSON.stringify(more.get(pathname)));
    return;
  }
  if (pathname === "/") {
    response.writeHead(302, { location: "/testbed/index.html" }).end();
    return;
  }
  const [, folder, ...rest] = normalize(decodeURIComponent(pathname)).split("/");
  try {
    const text = await readFile(join(FOLDERS[folder] ?? "/nowhere", ...rest));
    response.writeHead(200, { "content-type": TYPES[extname(pathname)] ?? "application/octet-stream" }).end(text);
  } catch {
    response.writeHead(404).end();
  }
}

/** A server on this machine alone; port 0: any that is free. `more`: values to give as JSON, by their paths. */
export function serve(port = 0, more = new Map()) {
  const server = createServer((request, response) => answer(request, response, more));
  return new Promise((resolve) => server.listen(port, "127.0.0.1", () => resolve(server)));
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  const server = await serve(Number(process.argv[2] ?? 8000));
  console.log(`http://127.0.0.1:${server.address().port}/`);
}
