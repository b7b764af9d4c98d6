// A Chromium of this machine, for tests of pages.
import { spawnSync } from "node:child_process";
import { existsSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

/** The program's name. Without it, or without a package of `npm ci`, ends this process with the status of a skipped test. */
export function chromiumOrSkip(...packages) {
  const modules = join(dirname(fileURLToPath(import.meta.url)), "node_modules");
  const program = ["chromium", "chromium-browser", "google-chrome"].find((name) => spawnSync("sh", ["-c", "command -v " + name]).status === 0);
  if (program && packages.every((name) => existsSync(join(modules, name)))) return program;
  console.log("skipped: chromium or node_modules is absent");
  process.exit(77);
}
