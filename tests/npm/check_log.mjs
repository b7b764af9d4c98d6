// node check_log.mjs FILE [--allow-truncated]
// Opens a log with the official MCAP reader and decodes every message by the definitions inside the
// log. Prints counts per topic and each topic's last message as JSON; exit status 1 where anything
// is wrong, also where a frame is not reached from "map".
import { plain, readLog } from "./mcap_log.mjs";

const files = process.argv.slice(2).filter((word) => !word.startsWith("--"));
const allowTruncated = process.argv.includes("--allow-truncated");
if (files.length !== 1) {
  console.error("usage: node check_log.mjs FILE [--allow-truncated]");
  process.exit(2);
}
try {
  const log = await readLog(files[0], { allowTruncated });
  if (log.lostFrames.length > 0) throw new Error(`no transform leads to ${log.lostFrames.join(", ")}`);
  const abridge = (message) => {
    const text = JSON.stringify(message, plain);
    return text.length < 2000 ? JSON.parse(text) : text.slice(0, 200) + " ...";
  };
  const last = Object.fromEntries(Object.entries(log.last).map(([k, v]) => [k, abridge(v)]));
  console.log(JSON.stringify({ ...log, first: undefined, last }, plain, 1));
} catch (error) {
  console.error(`${files[0]}: ${error.message}`);
  process.exit(1);
}
