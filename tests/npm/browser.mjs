// A headless Chromium, by the DevTools protocol: open a page, evaluate, press keys, take pictures, collect complaints.
import { spawn } from "node:child_process";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const require = createRequire(join(process.env.LIVE_MODULES ?? dirname(fileURLToPath(import.meta.url)), "package.json"));
const { WebSocket } = require("ws");
const pause = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

export class Browser {
  complaints = [];  // errors of scripts, console.error and console.warn
  #next = 1;
  #waiting = new Map();

  static async open(program = "chromium") {
    const browser = new Browser();
    browser.profile = mkdtempSync(join(tmpdir(), "live_browser_"));
    // Without a graphics card, a network beyond this machine, and with a profile of its own.
    browser.process = spawn(program, ["--headless=new", "--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
      "--disable-gpu-watchdog", "--host-resolver-rules=MAP * ~NOTFOUND, EXCLUDE localhost, EXCLUDE 127.0.0.1", "--hide-scrollbars",
      "--remote-debugging-port=0", "--user-data-dir=" + browser.profile, "about:blank"], { stdio: ["ignore", "ignore", "pipe"], detached: true });
    process.on("exit", () => browser.#kill());
    const port = await new Promise((resolve, reject) => {
      let text = "";
      browser.process.stderr.on("data", (data) => {
        text += data;
        const found = /DevTools listening on ws:\/\/[^:]+:(\d+)/.exec(text);
        if (found) resolve(found[1]);
      });
      browser.process.on("exit", () => reject(new Error("the browser ended: " + text)));
    });
    const targets = await (await fetch(`http://127.0.0.1:${port}/json`)).json();
    browser.socket = new WebSocket(targets.find((target) => target.type === "page").webSocketDebuggerUrl);
    await new Promise((resolve) => browser.socket.on("open", resolve));
    browser.socket.on("message", (data) => browser.#receive(JSON.parse(data)));
    for (const domain of ["Page", "Runtime", "Log"]) await browser.call(domain + ".enable");
    return browser;
  }

  call(method, params = {}) {
    const id = this.#next++;
    this.socket.send(JSON.stringify({ id, method, params }));
    return new Promise((resolve, reject) => this.#waiting.set(id, { resolve, reject, method }));
  }

  #receive({ id, result, error, method, params }) {
    if (id) {
      const { resolve, reject, method: called } = this.#waiting.get(id);
      this.#waiting.delete(id);
      if (error) reject(new Error(called + ": " + error.message));
      else resolve(result);
    } else if (method === "Runtime.exceptionThrown") {
      this.complaints.push(params.exceptionDetails.exception?.description ?? params.exceptionDetails.text);
    } else if (method === "Runtime.consoleAPICalled" && ["error", "warning", "assert"].includes(params.type)) {
      this.complaints.push(params.args.map((arg) => arg.value ?? arg.description).join(" "));
    } else if (method === "Log.entryAdded" && ["error", "warning"].includes(params.entry.level)) {
      // A driver's remarks on speed are none of the page's.
      if (!/GL Driver Message/.test(params.entry.text)) this.complaints.push(params.entry.text + " " + (params.entry.url ?? ""));
    }
  }

  async size(width, height, mobile = false) {
    await this.call("Emulation.setDeviceMetricsOverride", { width, height, deviceScaleFactor: 1, mobile });
  }

  async go(url) {
    await this.call("Page.navigate", { url });
  }

  /** Value of an expression in the page. */
  async evaluate(expression) {
    const { result, exceptionDetails } = await this.call("Runtime.evaluate", { expression, awaitPromise: true, returnByValue: true });
    if (exceptionDetails) throw new Error(exceptionDetails.exception?.description ?? exceptionDetails.text);
    return result.value;
  }

  /** Waits until an expression holds. */
  async until(expression, seconds = 30) {
    const end = Date.now() + 1000 * seconds;
    for (;;) {
      const value = await this.evaluate(expression).catch(() => undefined);
      if (value) return value;
      if (Date.now() > end) throw new Error(`not within ${seconds} s: ${expression}`);
      await pause(100);
    }
  }

  async key(type, key, code = key) {
    await this.call("Input.dispatchKeyEvent", { type, key, code, ...(type === "keyDown" && key.length === 1 && { text: key }) });
  }

  async press(key) {
    await this.key("keyDown", key);
    await this.key("keyUp", key);
  }

  /** Presses the mouse button in the middle of an element. */
  async click(selector, type = "click") {
    const [x, y] = await this.evaluate(`(() => { const e = document.querySelector(${JSON.stringify(selector)}); e.scrollIntoView({ block: "nearest" });
      const b = e.getBoundingClientRect(); return [b.left + b.width / 2, b.top + b.height / 2]; })()`);
    const send = (kind) => this.call("Input.dispatchMouseEvent", { type: kind, x, y, button: "left", clickCount: 1 });
    if (type !== "up") await send("mousePressed");
    if (type !== "down") await send("mouseReleased");
  }

  /** @param file .png or .jpg */
  async picture(file) {
    const kind = file.endsWith(".jpg") ? { format: "jpeg", quality: 85 } : { format: "png" };
    const { data } = await this.call("Page.captureScreenshot", kind);
    writeFileSync(file, Buffer.from(data, "base64"));
  }

  async close() {
    this.socket.close();
    const ended = new Promise((resolve) => this.process.once("exit", resolve));
    this.process.kill();
    await ended;
    this.#kill();
    // A helper that has left the group may still write. rmSync's own retries do not look for new files, hence this loop.
    for (let attempt = 1; ; ++attempt) {
      try {
        return rmSync(this.profile, { recursive: true, force: true });
      } catch (error) {
        if (attempt === 100) throw error;
        await pause(200);
      }
    }
  }

  /** Ends the browser and its helpers, which are one group of processes. */
  #kill() {
    try {
      process.kill(-this.process.pid, "SIGKILL");
    } catch {
      // No process of the group is left.
    }
  }
}
