// node replay_data_test.mjs DATA_JS
// The script that reads a page's tracks: poses at and between samples, spins, plans, clock.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import vm from "node:vm";

vm.runInThisContext(readFileSync(process.argv[2], "utf8"));
const Replay = globalThis.VinerowReplay;

assert.deepEqual([...Replay.decodeBase64("Zm9vYg==")], [102, 111, 111, 98]);
assert.equal(Replay.clock(205.44), "03:25.4");
assert.equal(Replay.clock(59.96), "01:00.0");

// Three samples: 2 m along x and a quarter turn about z in 0.5 s, then half a second of the same turn
// told with the quaternion's other sign, as it is the same rotation.
const buffer = new ArrayBuffer(256), half = Math.SQRT1_2 * 32767;
new Uint32Array(buffer, 0, 3).set([0, 500, 1000]);
new Int32Array(buffer, 12, 9).set([1000, -2000, 500, 3000, -2000, 500, 3000, -2000, 1500]);
new Int16Array(buffer, 48, 12).set([0, 0, 0, 32767, 0, 0, half, half, 0, 0, -half, -half].map(Math.round));
new Int16Array(buffer, 72, 12).set([0, 0, 0, 32767, 0, half, 0, half, 0, 32767, 0, 0].map(Math.round));
new Int16Array(buffer, 96, 9).set([100, 0, 0, 200, 0, 0, 300, 0, 0]);
new Uint8Array(buffer, 116, 3).set([0, 1, 1]);
new Float32Array(buffer, 120, 6).set([0, 0, 0, 5, 5, 1]);
new Float32Array(buffer, 144, 3).set([0, 2, 4]);
const fixed = [0.5, 0, 0, 0, 0, 0, 1];
const [track] = Replay.readTracks({
  vehicles: [{
    name: "rover", samples: 3, times: 0, positions: 12, rotations: 48, heights: 144,
    links: [
      { name: "body", pose: fixed },
      { name: "wheel", pose: fixed, rotations: 72, positions: 96 },
      { name: "rotor", pose: fixed, spins: 116, axis: [0, 0, 1] },
    ],
    plans: [{ t: 0.25, points: 120, count: 2 }],
  }],
}, new Uint8Array(buffer));

const close = (a, b, within) => a.forEach((value, i) => assert.ok(Math.abs(value - b[i]) <= within, `${a} is not ${b}`));
const pose = (t) => {
  const p = [], q = [];
  track.poseAt(track.bracket(t), p, q);
  return [p, q];
};
for (const t of [-1, 0]) close(pose(t)[0], [1, -2, 0.5], 1e-12);
for (const t of [1, 7]) close(pose(t)[0], [3, -2, 1.5], 1e-12);
// A third of a quarter turn is 30 deg: half of it 15.
const [p, q] = pose(0.5 / 3);
close(p, [1 + 2 / 3, -2, 0.5], 1e-12);
close(q, [0, 0, Math.sin(Math.PI / 12), Math.cos(Math.PI / 12)], 1e-4);
// The same rotation with two signs stays where it is.
const turned = pose(0.75)[1];
assert.ok(Math.abs(Math.abs(turned[2]) - Math.SQRT1_2) < 1e-4 && Math.abs(turned[2] - turned[3]) < 1e-4);

const linkPose = (l, t) => {
  const lp = [], lq = [];
  const spins = track.linkPoseAt(track.bracket(t), l, lp, lq);
  return [lp, lq, spins];
};
close(linkPose(0, 0.4)[0], [0.5, 0, 0], 0);
close(linkPose(1, 0.25)[0], [0.15, 0, 0], 1e-12);
close(linkPose(1, 0.25)[1], [0, Math.sin(Math.PI / 8), 0, Math.cos(Math.PI / 8)], 1e-4);
assert.deepEqual([0.1, 0.6, 1.0].map((t) => linkPose(2, t)[2]), [false, true, false]);
assert.ok(Math.abs(track.speedAt(track.bracket(0.3)) - 4) < 1e-9);
// At the end, also where the last instant is there twice, and of a track of one instant alone.
assert.ok(Math.abs(track.speedAt(track.bracket(9)) - 2) < 1e-9);
const still = { links: [], plans: [] };
const twice = new ArrayBuffer(96);
new Uint32Array(twice, 0, 3).set([0, 500, 500]);
new Int32Array(twice, 12, 9).set([1000, 0, 0, 3000, 0, 0, 3000, 0, 0]);
new Int16Array(twice, 48, 12).set([0, 0, 0, 32767, 0, 0, 0, 32767, 0, 0, 0, 32767]);
for (const [samples, speed] of [[3, 4], [1, 0]]) {
  const entry = { name: "x", samples, times: 0, positions: 12, rotations: 48, ...still };
  const [short] = Replay.readTracks({ vehicles: [entry] }, new Uint8Array(twice));
  assert.equal(short.speedAt(short.bracket(0.5)), speed);
  assert.equal(short.speedAt(short.bracket(77)), speed);
}
new Uint32Array(twice, 0, 3).set([500, 500, 500]);
const [instant] = Replay.readTracks({
  vehicles: [{ name: "x", samples: 3, times: 0, positions: 12, rotations: 48, ...still }],
}, new Uint8Array(twice));
assert.equal(instant.speedAt(instant.bracket(0.5)), 0);
assert.ok(Math.abs(track.heightAt(track.bracket(0.25)) - 1) < 1e-6);
assert.deepEqual([0, 0.25, 9].map((t) => track.planAt(t)), [-1, 0, 0]);
assert.deepEqual([...track.plans[0].points], [0, 0, 0, 5, 5, 1]);
console.log("the page's tracks are read as they were written");
