// node live_parts_test.mjs FOLDER_OF_SCRIPTS DATA_JS
// Parts of the live page that need no browser: clock, tracks, series, ticks, fields.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import vm from "node:vm";

const [folder, data] = process.argv.slice(2);
vm.runInThisContext(readFileSync(data, "utf8"));
for (const name of ["cdr.js", "clock.js", "track.js", "series.js", "fields.js"]) vm.runInThisContext(readFileSync(join(folder, name), "utf8"));
const Live = globalThis.VinerowLive;
const close = (a, b, within = 1e-9) => assert.ok(Math.abs(a - b) <= within, `${a} is not ${b}`);

// ---- clock: 20 Hz samples with jitter of the network at twice real time, frames at 60 Hz.
{
  const clock = new Live.Clock();
  let random = 1;
  const jitter = () => ((random = (random * 16807) % 2147483647) / 2147483647) * 0.03;
  const arrivals = Array.from({ length: 400 }, (_, k) => ({ t: 0.05 * k, wall: 0.025 * k + jitter() }));
  let next = 0, slowest = Infinity, fastest = 0, behind = 0, before = null;
  for (let frame = 0; frame < 550; ++frame) {
    const wall = frame / 60;
    while (next < arrivals.length && arrivals[next].wall <= wall) clock.arrive(arrivals[next].t, arrivals[next++].wall);
    clock.advance(1 / 60, wall);
    if (wall > 2) {
      slowest = Math.min(slowest, (clock.t - before) * 60);
      fastest = Math.max(fastest, (clock.t - before) * 60);
      behind = Math.max(behind, clock.latest - clock.t);
    }
    before = clock.t;
  }
  assert.ok(slowest > 1.3 && fastest < 2.7, `speed of the picture from ${slowest} to ${fastest}`);
  assert.ok(behind < 0.35, `${behind} s behind`);
  // The run pauses: the picture comes to its last sample, and stays.
  for (let frame = 0; frame < 90; ++frame) clock.advance(1 / 60, 10.5 + frame / 60);
  close(clock.t, clock.latest);
  assert.equal(clock.advance(1 / 60, 13), false);
  // One step later.
  clock.arrive(clock.latest + 0.005, 20);
  for (let frame = 0; frame < 60; ++frame) clock.advance(1 / 60, 20 + frame / 60);
  close(clock.t, clock.latest);
  // After seconds without frames it jumps instead of racing.
  for (let k = 1; k <= 200; ++k) clock.arrive(clock.latest + 0.05, 30 + 0.05 * k);
  clock.advance(1 / 60, 40);
  assert.ok(clock.latest - clock.t < 0.3);
  clock.clear();
  assert.equal(clock.advance(1, 50), false);
}

// ---- track
const entry = {
  name: "rover", size_m: 1, pose: [1, 2, 3, 0, 0, 0, 1], flies: false,
  links: [{ name: "wheel", pose: [0.5, 0, 0, 0, 0, 0, 1] }, { name: "rotor", pose: [0, 0, 1, 0, 0, 0, 1] }],
};
const about = (axis, angle) => Object.fromEntries(["x", "y", "z"].map((c) => [c, c === axis ? Math.sin(angle / 2) : 0]).concat([["w", Math.cos(angle / 2)]]));
const links = (t, parent, x, wheel, rotor) => ({
  transforms: [
    { header: { frame_id: "map" }, child_frame_id: "rover/base_link", transform: { translation: { x, y: 0, z: 0 }, rotation: about("z", 0) } },
    { header: { frame_id: parent }, child_frame_id: "rover/wheel", transform: { translation: { x: 0.5, y: 0, z: 0 }, rotation: about("y", wheel) } },
    { header: { frame_id: parent }, child_frame_id: "rover/rotor", transform: { translation: { x: 0, y: 0, z: 1 }, rotation: about("z", rotor) } },
    { header: { frame_id: parent }, child_frame_id: "rover/unknown", transform: { translation: { x: 0, y: 0, z: 1 }, rotation: about("z", rotor) } },
  ],
});
{
  const track = new Live.Track(entry), p = [], q = [];
  track.poseAt(track.bracket(0), p, q);
  assert.deepEqual(p, [1, 2, 3]);
  assert.equal(track.linkPoseAt(track.bracket(0), 0, p, q), false);
  assert.deepEqual(p, [0.5, 0, 0]);
  for (let k = 0; k < 10; ++k) track.addLinks(links(0.05 * k, "rover/base_link", 0.1 * k, 0.2 * k, 2.1 * k), 0.05 * k);
  const at = track.bracket(0.125);
  track.poseAt(at, p, q);
  close(p[0], 0.25);
  close(track.speedAt(at), 2);
  assert.equal(track.areLinksInWorld(at), false);
  track.linkPoseAt(at, 0, p, q);
  close(2 * Math.asin(q[1]), 0.5, 1e-6);
  // The rotor turns too fast for the samples; the wheel does not.
  assert.deepEqual([track.links[0].axis, track.links[1].axis], [undefined, [0, 0, 1]]);
  assert.equal(track.linkPoseAt(at, 1, p, q), true);
  assert.equal(track.heightAt(at), null);
  assert.deepEqual(track.trail.times.length, 10);
  // The same stamp from two channels is one sample.
  track.addOdometry({ pose: { pose: { position: { x: 9, y: 9, z: 9 }, orientation: about("z", 0) } } }, 0.45);
  close(track.samples[track.samples.length - 1].p[0], 0.9);
  track.clear();
  assert.equal(track.poses.length, 0);
  assert.equal(track.trail.times.length, 0);
}
{
  const track = new Live.Track(entry);
  track.addLinks(links(1, "map", 0, 0, 0), 1);
  assert.equal(track.areLinksInWorld(track.bracket(1)), true);
  // A long run fits: the trail stays bounded and keeps its ends.
  for (let k = 0; k < 50000; ++k) track.addPose(2 + k, [k, 0, 0], [0, 0, 0, 1]);
  assert.ok(track.trail.times.length < 8192 && track.trail.points.length === 3 * track.trail.times.length);
  assert.ok(track.trail.points[track.trail.points.length - 3] > 49900);
  assert.ok(track.samples.length <= 256);
  track.addPlan({ poses: [1, 2].map((x) => ({ pose: { position: { x, y: 0, z: 0 } } })) });
  assert.deepEqual([...track.plans[track.planAt(0)].points], [1, 0, 0, 2, 0, 0]);
  track.addPlan({ poses: [] });
  assert.equal(track.planAt(0), -1);
}

// ---- series
{
  const series = new Live.Series();
  for (let k = 0; k < 200000; ++k) series.push(k, 2 * k);
  assert.equal(series.count, 1 << 17);
  close(series.time(0), 200000 - (1 << 17));
  close(series.at(150000.5), 300000);
  assert.equal(series.at(0), undefined);
  assert.equal(series.first(1e9), series.count);
  series.push(5, 1);
  assert.deepEqual([series.count, series.at(Infinity)], [1, 1]);
}

// ---- ticks
for (const [low, high, most, step, first] of [[0, 10, 5, 2, 0], [-0.013, 0.04, 4, 0.02, 0], [90, 120, 5, 10, 90], [1e5 + 0.2, 1e5 + 0.9, 4, 0.2, 1e5 + 0.2]]) {
  const made = Live.roundTicks(low, high, most);
  close(made.step, step, 1e-12);
  close(made.ticks[0], first, 1e-6);
  assert.ok(made.ticks.length <= most + 1);
}
assert.equal(Live.roundTicks(0, 1, 5).digits, 1);
assert.equal(Live.roundTicks(0, 1000, 5).digits, 0);
assert.deepEqual([undefined, 0, 1234.56, 0.00001, NaN, -Infinity].map(Live.shortNumber), ["–", "0.0000", "1234.6", "1.000e-5", "NaN", "-∞"]);

// ---- fields
{
  const schema = Live.parseSchema(`std_msgs/Header header
string[] name
float64[] value
float64[2] pair
bool on
geometry_msgs/Point[] points
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
================================================================================
MSG: geometry_msgs/Point
float64 x`);
  const none = Live.listFields(schema, null).map((field) => field.path);
  assert.deepEqual(none, ["pair[0]", "pair[1]", "on", "header.stamp.sec", "header.stamp.nanosec"]);
  const message = { header: { stamp: { sec: 1, nanosec: 2 }, frame_id: "" }, name: ["a", "<b>"], value: [3, 4], pair: [5, 6], on: true, points: [{ x: 7 }] };
  const labels = Live.listFields(schema, message).map((field) => field.label);
  assert.deepEqual(labels.slice(0, 3), ["value[0] a", "value[1] <b>", "pair[0] a"]);
  const values = Live.listFields(schema, message).map((field) => Live.fieldReader(field.path)(message));
  assert.deepEqual(values, [3, 4, 5, 6, 1, 7, 1, 2]);
  assert.ok(Number.isNaN(Live.fieldReader("value[9]")(message)) && Number.isNaN(Live.fieldReader("none.x")(message)));
}
// ---- socket, with a server of our own
{
  const timers = [], sockets = [];
  globalThis.window = { setTimeout: (action, ms) => timers.push({ action, ms }) };
  globalThis.CustomEvent ??= class extends Event { constructor(kind, { detail }) { super(kind); this.detail = detail; } };
  globalThis.WebSocket = class {
    sent = [];
    constructor(url, protocols) { Object.assign(this, { url, protocols }); sockets.push(this); }
    send(data) { this.sent.push(typeof data === "string" ? JSON.parse(data) : data); }
  };
  vm.runInThisContext(readFileSync(join(folder, "socket.js"), "utf8").replace("})(window)", "})(globalThis)"));
  const socket = new Live.Socket("ws://x/"), emitted = [], heard = [];
  socket.parameterNames = ["paused"];
  for (const kind of ["state", "session", "time", "status", "malformed"]) socket.addEventListener(kind, (event) => emitted.push([kind, event.detail]));
  const end = socket.want("/a", (message, t) => heard.push([message.x, t]));
  socket.connect();
  const server = sockets[0], receive = (data) => server.onmessage({ data: typeof data === "object" && !(data instanceof ArrayBuffer) ? JSON.stringify(data) : data });
  assert.deepEqual(server.protocols, ["foxglove.websocket.v1", "foxglove.sdk.v1"]);
  server.onopen();
  const channel = { id: 7, topic: "/a", encoding: "cdr", schemaName: "p/msg/A", schemaEncoding: "ros2msg", schema: "int32 x" };
  const info = (sessionId) => ({ op: "serverInfo", name: "s", capabilities: ["time", "parameters"], sessionId });
  const data = (subscription, x) => {
    const view = new DataView(new ArrayBuffer(21));
    view.setUint8(0, 1); view.setUint32(1, subscription, true); view.setBigUint64(5, 1500000000n, true); view.setUint8(14, 1); view.setInt32(17, x, true);
    return view.buffer;
  };
  receive(info("1"));
  receive({ op: "advertise", channels: [channel] });
  const subscription = server.sent.find((sent) => sent.op === "subscribe").subscriptions[0];
  assert.equal(subscription.channelId, 7);
  receive(data(subscription.id, -3));
  // A reset as the program does it: a greeting with a new session, then the same channels with the same numbers.
  receive(info("2"));
  receive(data(subscription.id, 99));  // still on its way: belongs to the old session
  receive({ op: "advertise", channels: [channel] });
  const again = server.sent.filter((sent) => sent.op === "subscribe")[1].subscriptions[0];
  assert.ok(again.channelId === 7 && again.id !== subscription.id);
  receive(data(subscription.id, 99));
  receive(data(again.id, 4));
  assert.deepEqual(heard, [[-3, 1.5], [4, 1.5]]);
  assert.deepEqual(emitted.filter(([kind]) => kind === "session").map(([, detail]) => detail), [{ first: true, same_connection: false }, { first: false, same_connection: true }]);
  assert.equal(server.sent.filter((sent) => sent.op === "getParameters").length, 2);
  assert.equal(server.sent.filter((sent) => sent.op === "subscribeParameterUpdates").length, 1);
  // A service: the request's bytes, the answer, a failure, none.
  receive({ op: "advertiseServices", services: [{ id: 5, name: "/run/s", type: "t" }] });
  const answer = socket.call("/run/s", { steps: 3 }), bytes = server.sent[server.sent.length - 1], view = new DataView(bytes.buffer);
  assert.deepEqual([bytes[0], view.getUint32(1, true), view.getUint32(9, true), Buffer.from(bytes.subarray(13)).toString()], [2, 5, 4, 'json{"steps":3}']);
  const back = Buffer.concat([Buffer.from([3]), Buffer.from(bytes.subarray(1, 13)), Buffer.from('json{"result":{"result":1}}')]);
  receive(back.buffer.slice(back.byteOffset, back.byteOffset + back.length));
  assert.deepEqual(await answer, { result: { result: 1 } });
  const refused = socket.call("/run/s", {});
  receive({ op: "serviceCallFailure", serviceId: 5, callId: socket.next - 1, message: "no" });
  await assert.rejects(refused, /^Error: no$/);
  await assert.rejects(socket.call("/run/none", {}), /no service/);
  // Damage.
  for (const frame of ["{", "null", '{"op":"toString"}', new ArrayBuffer(0), new Uint8Array([1, 2]).buffer, data(again.id, 1).slice(0, 18)]) receive(frame);
  assert.equal(socket.malformed, 6);
  assert.equal(heard.length, 2);
  end();
  assert.deepEqual(server.sent[server.sent.length - 1], { op: "unsubscribe", subscriptionIds: [again.id] });
  // The server goes: calls fail, a second later the next attempt.
  const lost = socket.call("/run/s", {});
  server.onclose();
  await assert.rejects(lost, /connection/);
  assert.equal(socket.state, "closed");
  timers.find((timer) => timer.ms === 1000).action();
  assert.equal(sockets.length, 2);
}
console.log("the live page's parts are right");
