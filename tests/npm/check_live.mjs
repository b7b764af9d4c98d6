// node check_live.mjs COMMAND SCENARIO.yaml FOLDER
// Runs a scenario live and uses its server as Foxglove does, with the official client: the same channels, schemas and bytes as
// in the log; services, parameters, commands. Then a run with 20 clients, some of which stall, leave or send garbage, and its memory.
// Exit status 77 (skipped) where `npm ci` has not been run here.
import assert from "node:assert/strict";
import { spawn, spawnSync } from "node:child_process";
import { existsSync, mkdirSync, readdirSync, readFileSync, rmSync } from "node:fs";
import net from "node:net";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));
if (!existsSync(join(here, "node_modules", "@foxglove", "ws-protocol"))) {
  console.log("skipped: node_modules is absent or old; run `npm ci` in tests/npm");
  process.exit(77);
}
const { default: protocol } = await import("@foxglove/ws-protocol");
const { FoxgloveClient } = protocol;
const { default: WebSocket } = await import("ws");
const { default: rosmsg } = await import("@foxglove/rosmsg");
const { default: rosmsg2 } = await import("@foxglove/rosmsg2-serialization");
const { readRecords } = await import("./mcap_log.mjs");

const [command, scenario, folder] = process.argv.slice(2);
rmSync(folder, { recursive: true, force: true });
mkdirSync(folder, { recursive: true });
const pause = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

/** A run in the background: {port, ended: promise of {status, output}}. */
async function start(name, ...options) {
  const out = join(folder, name);
  const run = spawn(command, ["run", scenario, "--out", out, "--no-pictures", "--no-report", "--quiet", ...options]);
  let output = "";
  for (const stream of [run.stdout, run.stderr]) stream.on("data", (bytes) => (output += bytes));
  const ended = new Promise((resolve) => run.once("exit", (status) => resolve({ status, output })));
  for (let i = 0; i < 600 && !/live +http:\/\/localhost:\d+/.test(output); ++i) await pause(50);
  const address = output.match(/live +(http:\/\/localhost:(\d+)\/\S*)/);
  assert.ok(address, output);
  return { port: Number(address[2]), address: address[1], out, ended, process: run };
}
const digestOf = (output) => output.match(/digest +(\w+)/)[1];

/** The official client, with everything the server has said. */
class Client {
  channels = new Map();
  services = new Map();
  parameters = {};
  statuses = [];
  messages = [];
  calls = new Map();
  #call = 1;
  #subscriptions = new Map();

  constructor(port, protocol = FoxgloveClient.SUPPORTED_SUBPROTOCOL) {
    this.socket = new WebSocket(`ws://localhost:${port}/`, [protocol]);
    this.client = new FoxgloveClient({ ws: this.socket });
    this.greeted = new Promise((resolve) => this.client.on("advertiseServices", (services) => {
      for (const service of services) this.services.set(service.name, service);
      resolve();
    }));
    this.closed = new Promise((resolve) => this.client.on("close", resolve));
    this.client.on("error", () => {});
    this.client.on("serverInfo", (info) => (this.info = info));
    this.client.on("status", (status) => this.statuses.push(status));
    this.client.on("advertise", (channels) => {
      for (const channel of channels) this.channels.set(channel.topic, channel);
    });
    this.client.on("parameterValues", ({ parameters }) => {
      for (const { name, value } of parameters) this.parameters[name] = value;
    });
    this.client.on("message", ({ subscriptionId, timestamp, data }) => {
      this.messages.push({ topic: this.#subscriptions.get(subscriptionId), logTime: timestamp, data: new Uint8Array(data.buffer.slice(data.byteOffset, data.byteOffset + data.byteLength)) });
    });
    this.client.on("serviceCallResponse", (response) => this.calls.get(response.callId)?.(response));
    this.client.on("serviceCallFailure", (failure) => this.calls.get(failure.callId)?.(failure));
  }

  /** Waits for the run: a client may come before it is built, and is greeted again then. */
  async begun() {
    await this.greeted;
    while (this.channels.size === 0) await pause(5);
  }

  subscribeAll(topics = [...this.channels.keys()]) {
    for (const channel of topics.map((topic) => this.channels.get(topic))) this.#subscriptions.set(this.client.subscribe(channel.id), channel.topic);
  }

  /** Calls a service with CDR, by the definitions that the server has sent. */
  async call(name, request) {
    const service = this.services.get(name), callId = this.#call++;
    const definitions = (message) => rosmsg.parse(message.schema, { ros2: true });
    const bytes = service.request.schema === "" ? new Uint8Array([0, 1, 0, 0, 0])
      : new rosmsg2.MessageWriter(definitions(service.request)).writeMessage(request);
    const answer = new Promise((resolve) => this.calls.set(callId, resolve));
    this.client.sendServiceCallRequest({ serviceId: service.id, callId, encoding: "cdr", data: new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength) });
    const response = await answer;
    if (response.op === "serviceCallFailure") throw new Error(response.message);
    return new rosmsg2.MessageReader(definitions(service.response)).readMessage(response.data);
  }
}

const textOf = (value) => new TextEncoder().encode(JSON.stringify(value));

async function sameAsTheLog() {
  const run = await start("same", "--live", "--live-port", "0", "--paused", "--speed", "max", "--set", "duration_s=4");
  const client = new Client(run.port);
  await client.begun();
  assert.deepEqual([...client.info.capabilities].sort(), ["clientPublish", "parameters", "parametersSubscribe", "services", "time"]);
  client.subscribeAll();
  client.client.getParameters(["scenario", "paused", "command_topics"]);

  const step = () => client.call("/run/step_simulation", { steps: 1000n });
  const stateOf = async () => (await client.call("/run/get_simulation_state", {})).state.state;
  assert.equal(await stateOf(), 2);
  assert.equal(client.parameters.scenario, "vineyard_teleop");
  assert.equal(client.parameters.paused, true);

  const driving = client.client.advertise({ topic: "/rover/cmd_vel", encoding: "json", schemaName: "geometry_msgs/msg/Twist" });
  client.client.sendMessage(driving, textOf({ linear: { x: 0.8 }, angular: { z: 0.3 } }));
  // Exactly 1000 steps of 1 ms.
  assert.equal((await step()).result.result, 1);
  const entity = await client.call("/run/get_entity_state", { entity: "rover" });
  assert.deepEqual(entity.state.header.stamp, { sec: 0, nsec: 999_000_000 });
  // The page is made when it is asked for.
  while ((await fetch(run.address)).status === 503) await pause(20);
  assert.equal((await fetch(run.address)).status, 200);
  for (const file of ["live.js", "index.json", "scene.glb", "textures.bin"]) assert.equal((await fetch(run.address + file)).status, 200, file);
  assert.equal((await fetch(run.address + "absent")).status, 404);
  assert.equal((await fetch(run.address, { method: "POST" })).status, 405);

  client.client.sendMessage(driving, textOf({ linear: { x: 0.4 }, angular: { z: -0.3 } }));
  assert.equal((await client.call("/run/set_simulation_state", { state: { state: 1 } })).result.result, 1);
  const { status, output } = await run.ended;
  await client.closed;
  assert.equal(status, 0, output);
  assert.deepEqual(client.statuses.filter(({ level }) => level > 0), []);

  const log = await readRecords(join(run.out, "log.mcap"));
  const described = (channel) => ({ topic: channel.topic, encoding: channel.encoding, type: channel.schemaName, schema: channel.schema });
  assert.deepEqual([...client.channels.values()].map(described), log.channels);
  const key = ({ topic, logTime }) => `${topic} ${logTime}`;
  const sorted = (messages) => messages.map((m) => [key(m), Buffer.from(m.data).toString("base64")]).sort();
  // The log ends with the run's last event, which no client can have.
  const last = (m) => m.topic === "/run/events" && new TextDecoder().decode(m.data).includes("duration is over");
  assert.deepEqual(sorted(client.messages.filter((m) => !last(m))), sorted(log.messages.filter((m) => !last(m))));
  const readers = new Map(log.channels.map(({ topic, schema }) => [topic, new rosmsg2.MessageReader(rosmsg.parse(schema, { ros2: true }))]));
  for (const { topic, data } of client.messages) readers.get(topic).readMessage(data);

  const replay = spawnSync(command, ["run", scenario, "--set", "duration_s=4", "--replay-commands", run.out, "--out", join(folder, "replay"), "--no-pictures", "--no-report", "--quiet"], { encoding: "utf8" });
  assert.equal(replay.status, 0, replay.stdout + replay.stderr);
  assert.match(replay.stdout, /replay +of 2 commands: the same digest as the log/);
  assert.equal(digestOf(replay.stdout), digestOf(output));
  console.log(`${client.messages.length} messages on ${log.channels.length} channels are those of the log`);
}

// A leak of 1 kB for each of 1,000 connections would be seen.
const MOST_GROWTH_MB = 1;
// 8 MB of messages wait for a client at most; the run itself needs some as well.
const MOST_OF_STALLED_MB = 8 + 4;
const residentMB = (run) => Number(readFileSync(`/proc/${run.process.pid}/status`, "utf8").match(/VmRSS:\s+(\d+) kB/)[1]) / 1024;
const descriptors = (run) => readdirSync(`/proc/${run.process.pid}/fd`).length;

let seed = 1;
const random = () => (seed = (seed * 1103515245 + 12345) % 2147483648) / 2147483648;

/** Connections that leave in different states, 50 at a time: silent, no HTTP, half a request, a WebSocket with garbage. */
async function connections(port, count) {
  for (let i = 0; i < count; i += 50) {
    await Promise.all(Array.from({ length: 50 }, () => new Promise((resolve) => {
      const socket = net.connect(port, "localhost", () => {
        const kind = Math.floor(random() * 4);
        if (kind === 1) socket.write(Buffer.from(Array.from({ length: 200 }, () => Math.floor(random() * 256))));
        if (kind === 2) socket.write("GET / HTTP/1.1\r\nHost: x\r\nUpgrade: websocket\r\n");
        if (kind === 3) socket.write("GET / HTTP/1.1\r\nHost: x\r\nConnection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Protocol: foxglove.sdk.v1\r\n\r\n\xff\xfe\x00garbage");
        setTimeout(() => { socket.destroy(); resolve(); }, 5);
      });
      socket.on("error", resolve);
    })));
  }
}

/** Memory of a paused run after 1,000 and after 2,000 connections, and its file descriptors. The first ones fill buffers that stay. */
async function connectionsLeaveNothing(run) {
  const before = descriptors(run);
  const awaitDescriptors = async () => {
    for (let i = 0; i < 200 && descriptors(run) > before; ++i) await pause(50);
    assert.equal(descriptors(run), before, "file descriptors");
  };
  await connections(run.port, 1000);
  await awaitDescriptors();
  const early = residentMB(run);
  await connections(run.port, 1000);
  await awaitDescriptors();
  const late = residentMB(run);
  console.log(`resident memory: ${early.toFixed(1)} MB after 1000 connections, ${late.toFixed(1)} MB after 2000; ${before} file descriptors before and after`);
  assert.ok(late - early < MOST_GROWTH_MB, "memory grows with connections");
}

async function crowd() {
  const settings = ["--set", "duration_s=150"];
  const alone = spawnSync(command, ["run", scenario, ...settings, "--out", join(folder, "alone"), "--no-pictures", "--no-report", "--quiet"], { encoding: "utf8" });
  const run = await start("crowd", "--live", "--live-port", "0", "--paused", "--speed", "10", ...settings);
  const clients = Array.from({ length: 20 }, (_, i) => new Client(run.port, i % 2 ? "foxglove.sdk.v1" : undefined));
  await Promise.all(clients.map((client) => client.begun()));
  // As many messages as this script can read in time.
  clients.forEach((client, i) => client.subscribeAll(i < 10 ? undefined : ["/rover/truth", "/rover/links"]));
  await connectionsLeaveNothing(run);
  // Five read nothing any more.
  for (const client of clients.slice(0, 5)) client.socket._socket.pause();
  const baseline = residentMB(run);
  let highest = baseline;
  const watch = setInterval(() => {
    try { highest = Math.max(highest, residentMB(run)); } catch { clearInterval(watch); } // the run has ended
  }, 100);
  await clients[19].call("/run/set_simulation_state", { state: { state: 1 } });
  // While the run goes on, too.
  await connections(run.port, 200);
  // Damaged frames of a client that is greeted.
  const odd = new Client(run.port);
  await odd.begun();
  for (let i = 0; i < 500 && odd.socket.readyState === WebSocket.OPEN; ++i) {
    const bytes = Buffer.from(Array.from({ length: Math.floor(random() * 60) }, () => Math.floor(random() * 256)));
    odd.socket.send(i % 2 ? bytes : `{"op": ${bytes.toString("base64").slice(0, 9)}`, { binary: i % 2 === 1 });
  }
  const { status, output } = await run.ended;
  clearInterval(watch);
  assert.equal(status, 0, output);
  assert.equal(digestOf(output), digestOf(alone.stdout), "nobody has commanded");
  console.log(`resident memory: ${baseline.toFixed(1)} MB before the run, at most ${highest.toFixed(1)} MB with 5 stalled clients`);
  assert.ok(highest < baseline + 5 * MOST_OF_STALLED_MB, "memory grows with stalled clients");
  const received = clients.slice(5).map((client) => client.messages.length);
  console.log(`20 clients, 5 of them stalled, 2200 connections: the same digest; the others received ${Math.min(...received)} to ${Math.max(...received)} messages`);
  for (const client of clients) client.socket.terminate();
}

async function refusals() {
  const run = await start("refused", "--live", "--live-port", "0", "--live-token", "a b", "--paused");
  // A page that comes before the run is built says so, and tries again.
  while ((await fetch(run.address)).status === 503) await pause(20);
  assert.equal((await fetch(run.address)).status, 200);
  assert.match(await (await fetch(run.address)).text(), /live\.js\?token=a%20b/);
  for (const token of ["", "?token=a", "?token=a%20b2"]) {
    const answer = await fetch(`http://localhost:${run.port}/${token}`);
    assert.equal(answer.status, 401);
    assert.match(await answer.text(), /The token is missing or wrong/);
  }
  const second = spawnSync(command, ["run", scenario, "--live", "--live-port", String(run.port), "--out", join(folder, "second"), "--quiet"], { encoding: "utf8" });
  assert.equal(second.status, 2);
  assert.match(second.stderr, /^vinerow: port \d+ is in use: another run, or another program; --live-port gives this run another one, 0 any free one\n$/);
  const refused = (headers, protocols) => new Promise((resolve) => {
    const socket = new WebSocket(`ws://localhost:${run.port}/?token=a%20b`, protocols, { headers });
    socket.on("unexpected-response", (_, response) => resolve(response.statusCode));
    socket.on("open", () => { socket.close(); resolve("open"); });
    socket.on("error", () => {});
  });
  assert.equal(await refused({}, ["chat"]), 400);
  assert.equal(await refused({ Origin: "https://example.com" }, ["foxglove.sdk.v1"]), "open", "the token suffices");
  run.process.kill("SIGINT");
  const { status, output } = await run.ended;
  assert.equal(status, 3, output);
}

await sameAsTheLog();
await refusals();
await crowd();
process.exit(0);
