// node check_ground_station.mjs COMMAND FOLDER
// A ground station with node-mavlink before a run with two vehicles: reads every frame of the telemetry, downloads a plan, uploads a
// mission, starts it, and pauses the run. The same run again from its log alone has the same digest.
// Exit status 77 (skipped) where `npm ci` has not been run here.
import assert from "node:assert/strict";
import { spawn, spawnSync } from "node:child_process";
import dgram from "node:dgram";
import { existsSync, mkdirSync, rmSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { PassThrough } from "node:stream";
import { fileURLToPath } from "node:url";

if (!existsSync(join(dirname(fileURLToPath(import.meta.url)), "node_modules", "node-mavlink"))) {
  console.log("skipped: node_modules is absent; run `npm ci` in tests/npm");
  process.exit(77);
}
const { MavLinkPacketParser, MavLinkPacketSplitter, MavLinkProtocolV2, common, minimal, standard } = (await import("node-mavlink")).default;
const registry = { ...minimal.REGISTRY, ...standard.REGISTRY, ...common.REGISTRY };

const [command, folder] = process.argv.slice(2);
rmSync(folder, { recursive: true, force: true });
mkdirSync(folder, { recursive: true });
const scenario = join(folder, "field.yaml");
writeFileSync(
  scenario,
  `vinerow: 1
name: field
duration_s: 120
stop_when_finished: false
world: {type: vineyard, row_count: 3, row_length_m: 20, relief_m: 0, waves_m: 0, leaf_cards_per_m: 10, plant_variants: 1,
        origin_latitude_deg: 45, origin_longitude_deg: 9}
vehicles:
  tractor:
    type: diff_drive_rover
    spawn: {alley: 0, offset_m: 3}
    sensors: {gps: {type: gps, rate_Hz: 5}}
    planner: {type: coverage, alleys: [0]}
    controller: {type: path_follower}
  scout:
    type: diff_drive_rover
    spawn: {alley: 1, offset_m: 4}
    guidance: {type: remote_goal}
    controller: {type: path_follower}
`,
);

// The ground station: everything it hears, by system and message.
const socket = dgram.createSocket("udp4");
await new Promise((done) => socket.bind(0, "127.0.0.1", done));
const protocol = new MavLinkProtocolV2(255, 190);
const heard = [];
let peer, sequence = 0, datagrams = 0;
const stream = new PassThrough();
const parser = stream.pipe(new MavLinkPacketSplitter()).pipe(new MavLinkPacketParser());
parser.on("data", (packet) => {
  const definition = registry[packet.header.msgid];
  assert.ok(definition, `message ${packet.header.msgid} exists`);
  heard.push({ system: packet.header.sysid, name: definition.MSG_NAME, data: packet.protocol.data(packet.payload, definition), seq: packet.header.seq });
});
socket.on("message", (bytes, from) => {
  peer = from;
  ++datagrams;
  stream.write(bytes);
});
const send = (Message, fields) => {
  const message = Object.assign(new Message(), fields);
  socket.send(protocol.serialize(message, sequence++ & 255), peer.port, peer.address);
};
const pause = (ms) => new Promise((done) => setTimeout(done, ms));
/** The first message since `from` that fits. */
async function hear(system, name, fits = () => true, from = 0, seconds = 30) {
  for (let k = 0; k < 20 * seconds; ++k) {
    const found = heard.slice(from).find((message) => message.system === system && message.name === name && fits(message.data));
    if (found) return found.data;
    await pause(50);
  }
  assert.fail(`nothing like ${name} of system ${system}; heard ${[...new Set(heard.map(({ name }) => name))]}; ${output}`);
}

const out = join(folder, "run");
const run = spawn(command, ["run", scenario, "--out", out, "--no-pictures", "--no-report", "--quiet", "--mavlink", "--mavlink-port",
                            String(socket.address().port), "--speed", "8"]);
let output = "";
for (const pipe of [run.stdout, run.stderr]) pipe.on("data", (bytes) => (output += bytes));
const ended = new Promise((done) => run.once("exit", done));
const tractor = 1, scout = 2;

// Telemetry of both, as a vehicle's.
const heartbeat = await hear(tractor, "HEARTBEAT");
assert.equal(heartbeat.type, minimal.MavType.GROUND_ROVER);
assert.equal(heartbeat.autopilot, minimal.MavAutopilot.GENERIC);
for (const name of ["ATTITUDE", "GLOBAL_POSITION_INT", "VFR_HUD", "SYS_STATUS", "LOCAL_POSITION_NED", "HOME_POSITION"]) {
  await hear(tractor, name);
  await hear(scout, name);
}
await hear(tractor, "GPS_RAW_INT", ({ fixType }) => fixType >= 3);
await hear(tractor, "STATUSTEXT", ({ text }) => text.startsWith("planned "));
// 45 N, 9 E is the world's origin: the vehicles are within 200 m of it.
const place = await hear(scout, "GLOBAL_POSITION_INT");
assert.ok(Math.abs(place.lat - 450000000) < 18000 && Math.abs(place.lon - 90000000) < 26000, `${place.lat} ${place.lon}`);

// The plan of the one that follows its scenario can be downloaded, but not replaced.
send(common.MissionRequestList, { targetSystem: tractor, targetComponent: 1 });
const { count } = await hear(tractor, "MISSION_COUNT");
assert.ok(count >= 1);
for (let seq = 0; seq < count; ++seq) {
  send(common.MissionRequestInt, { targetSystem: tractor, targetComponent: 1, seq });
  const item = await hear(tractor, "MISSION_ITEM_INT", (data) => data.seq === seq);
  assert.ok(Math.abs(item.x - 450000000) < 18000, `item ${seq} lies in the field`);
}
async function upload(system, items) {
  const from = heard.length;
  send(common.MissionCount, { targetSystem: system, targetComponent: 1, count: items.length });
  for (let seq = 0; seq < items.length; ++seq) {
    await hear(system, "MISSION_REQUEST_INT", (data) => data.seq === seq, from);
    send(common.MissionItemInt, { targetSystem: system, targetComponent: 1, seq, frame: 3, command: 16, autocontinue: 1, ...items[seq] });
  }
  return (await hear(system, "MISSION_ACK", () => true, from)).type;
}
const start = await hear(scout, "GLOBAL_POSITION_INT");
// Two places in the alley before it, which runs 10 degrees north of east. A unit is 1.11 cm of latitude.
const ahead = (metres) => ({
  x: start.lat + Math.round((metres * Math.sin(Math.PI / 18)) / 0.0111318845),
  y: start.lon + Math.round((metres * Math.cos(Math.PI / 18)) / (0.0111318845 * Math.cos(Math.PI / 4))),
});
const goals = [ahead(8), ahead(14)];
assert.equal(await upload(tractor, goals), common.MavMissionResult.DENIED);
await hear(tractor, "STATUSTEXT", ({ text }) => text.includes("follows its scenario"));
assert.equal(await upload(scout, [{ ...goals[0], command: 21 }]), common.MavMissionResult.DENIED);
assert.equal(await upload(scout, goals), common.MavMissionResult.ACCEPTED);

// Started, it drives there.
const order = async (system, number, fields = {}) => {
  const from = heard.length;
  send(common.CommandLong, { targetSystem: system, targetComponent: 1, command: number, ...fields });
  return (await hear(system, "COMMAND_ACK", (data) => data.command === number, from)).result;
};
assert.equal(await order(scout, 300), common.MavResult.ACCEPTED);
await hear(scout, "MISSION_ITEM_REACHED", ({ seq }) => seq === 0);
await hear(scout, "MISSION_ITEM_REACHED", ({ seq }) => seq === 1);
const there = heard.filter(({ system, name }) => system === scout && name === "GLOBAL_POSITION_INT").at(-1).data;
assert.ok(Math.abs(there.lon - goals[1].y) < 200, `${there.lon} is at ${goals[1].y}`);

// Paused, nothing moves, and the vehicles stay alive.
assert.equal(await order(tractor, 193, { _param1: 0 }), common.MavResult.ACCEPTED);
await pause(500);
const positions = () => heard.filter(({ name }) => name === "ATTITUDE").length;
const before = positions(), at = heard.length;
await hear(tractor, "HEARTBEAT", () => true, at);
assert.equal(positions(), before);
assert.equal(await order(tractor, 193, { _param1: 1 }), common.MavResult.ACCEPTED);
assert.equal(await order(tractor, 9999), common.MavResult.UNSUPPORTED);
// A parameter with the run's speed: as fast as it goes.
const from = heard.length;
send(common.ParamSet, { targetSystem: tractor, targetComponent: 1, paramId: "SIM_SPEED", paramValue: 0, paramType: 9 });
await hear(tractor, "PARAM_VALUE", ({ paramId, paramValue }) => paramId === "SIM_SPEED" && paramValue === 0, from);

await ended;
assert.equal(run.exitCode, 0, output);
// Each datagram was one frame, and node-mavlink has read them all; numbers run on for each system.
assert.equal(heard.length, datagrams);
for (const system of [tractor, scout]) {
  const numbers = heard.filter((message) => message.system === system).map(({ seq }) => seq);
  const gaps = numbers.slice(1).filter((seq, k) => seq !== ((numbers[k] + 1) & 255)).length;
  assert.equal(gaps, 0, `frames of system ${system} run on`);
}
const digestOf = (text) => text.match(/digest +(\w+)/)[1];
const again = spawnSync(command, ["run", scenario, "--out", `${out}_again`, "--no-pictures", "--no-report", "--quiet", "--replay-commands", out],
                        { encoding: "utf8" });
assert.equal(again.status, 0, again.stdout + again.stderr);
assert.equal(digestOf(again.stdout), digestOf(output));
console.log(`${heard.length} frames of telemetry, a plan of ${count} items, a mission of ${goals.length}`);
socket.close();
