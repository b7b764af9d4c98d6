"use strict";
// Poses of one vehicle as they arrive: the part of the replay's Track (data.js) that a scene reads, over the last samples.
(function (root) {
  const Live = (root.VinerowLive = root.VinerowLive || {});
  const Replay = (root.VinerowReplay = root.VinerowReplay || {});

  const kSamples = 128;  // kept of each kind; interpolation needs those around the picture's time
  const kPoints = 8192;  // of a trail; then every second one is dropped
  const kFixed_rad = 2e-3, kSpin_rad = 1;  // as in replay_tracks.cpp
  const kResolved_s = 0.11;  // samples farther apart do not show whether a link spins

  const poseOf = ({ translation: p, rotation: q }) => [p.x, p.y, p.z, q.x, q.y, q.z, q.w];

  /** Samples around t in a list with ascending times: {index, next, share, t}. */
  function bracket(samples, t) {
    let next = samples.length - 1;
    while (next > 0 && samples[next - 1].t >= t) --next;
    const index = Math.max(next - 1, 0), a = samples[index].t, b = samples[next].t;
    return { index, next, share: b > a ? Math.min(Math.max((t - a) / (b - a), 0), 1) : 1, t };
  }

  /** Appends a sample; false if it is not newer than the last one. */
  function append(samples, sample) {
    if (samples.length > 0 && sample.t <= samples[samples.length - 1].t) return false;
    samples.push(sample);
    if (samples.length > 2 * kSamples) samples.splice(0, kSamples);
    return true;
  }

  /** out = rotation q^-1 * r of lists with x, y, z, w. */
  function relative(q, r) {
    const [x, y, z, w] = [-q[0], -q[1], -q[2], q[3]];
    return [
      w * r[0] + x * r[3] + y * r[2] - z * r[1], w * r[1] - x * r[2] + y * r[3] + z * r[0],
      w * r[2] + x * r[1] - y * r[0] + z * r[3], w * r[3] - x * r[0] - y * r[1] - z * r[2],
    ];
  }

  class Track {
    /** @param entry vehicle of the index: name, colour, size, links with the pose in which the page was built */
    constructor(entry) {
      this.entry = entry;
      this.name = entry.name;
      this.links = entry.links.map((link) => ({ name: link.name, pose: link.pose, axis: undefined, spinning: 0, spins: false }));
      this.numbers = new Map(this.links.map((link, l) => [entry.name + "/" + link.name, l]));
      this.body = entry.name + "/base_link";
      this.times = [];  // a replay's whole track, which the view of the whole scene includes; none here
      this.positions = [];
      this.ground = null;  // plane of the ground below it, {point, normal}; set by the scene
      this.clear();
    }

    clear() {
      this.samples = [{ t: -1, p: this.entry.pose.slice(0, 3), q: this.entry.pose.slice(3) }];
      this.poses = [];  // of links: {t, values (7 numbers each), inWorld}
      this.plans = [];  // at most one: {points}
      this.trail = { times: [], points: [], spacing: Math.max(0.05, 0.08 * this.entry.size_m) };
      this.isStart = true;  // only the pose of the page, no sample
    }

    /** True pose of the body. @param p, q  lists */
    addPose(t, p, q) {
      if (this.isStart) this.samples = [];
      this.isStart = false;
      if (append(this.samples, { t, p, q })) this.extendTrail(t, p);
    }

    addOdometry(message, t) {
      const { position: p, orientation: q } = message.pose.pose;
      this.addPose(t, [p.x, p.y, p.z], [q.x, q.y, q.z, q.w]);
    }

    /** Poses of links: relative to the body, whose pose comes first, or all in the world. */
    addLinks(message, t) {
      const values = new Float64Array(7 * this.links.length).fill(NaN);
      let inWorld = false;
      for (const { header, child_frame_id: child, transform } of message.transforms) {
        const pose = poseOf(transform);
        if (child === this.body) this.addPose(t, pose.slice(0, 3), pose.slice(3));
        const l = this.numbers.get(child);
        if (l === undefined) continue;
        if (header.frame_id !== this.body) inWorld = true;
        values.set(pose, 7 * l);
      }
      const last = this.poses[this.poses.length - 1], sample = { t, values, inWorld };
      if (append(this.poses, sample) && last && !inWorld && !last.inWorld && t - last.t < kResolved_s) this.watchSpin(last, sample);
    }

    /** Finds links that turn too fast for the samples, as rotors do, and the axis of the link about which they turn. */
    watchSpin(before, now) {
      this.links.forEach((link, l) => {
        const from = before.values.subarray(7 * l + 3, 7 * l + 7), to = now.values.subarray(7 * l + 3, 7 * l + 7);
        const turn = relative(from, to), angle = 2 * Math.acos(Math.min(1, Math.abs(turn[3])));
        link.spins = angle > kFixed_rad;
        if (!link.spins || link.axis) return;
        link.spinning += angle > kSpin_rad ? 1 : -1;
        if (link.spinning < 4) {
          link.spinning = Math.max(link.spinning, 0);
          return;
        }
        const size = turn.slice(0, 3).map(Math.abs), largest = size.indexOf(Math.max(...size));
        link.axis = [0, 1, 2].map((c) => (c === largest ? 1 : 0));
      });
    }

    addPlan(message) {
      const points = new Float32Array(3 * message.poses.length);
      message.poses.forEach(({ pose }, i) => points.set([pose.position.x, pose.position.y, pose.position.z], 3 * i));
      this.plans = message.poses.length > 1 ? [{ points }] : [];
      this.hasNewPlan = true;
    }

    /** Points of the trail are some distance apart. Beyond kPoints every second one is dropped, so a long run fits. */
    extendTrail(t, p) {
      const { times, points, spacing } = this.trail, n = points.length;
      if (n > 0 && Math.hypot(p[0] - points[n - 3], p[1] - points[n - 2], p[2] - points[n - 1]) < spacing) return;
      times.push(t);
      points.push(p[0], p[1], p[2]);
      this.trail.isNew = true;
      if (times.length < kPoints) return;
      this.trail = { spacing: 2 * spacing, times: times.filter((_, i) => i % 2 === 0), points: points.filter((_, i) => i % 6 < 3), isNew: true };
    }

    // What Replay.Scene asks of a track.

    bracket(t) {
      return bracket(this.samples, t);
    }

    poseAt(at, position, rotation) {
      const a = this.samples[at.index], b = this.samples[at.next];
      for (let c = 0; c < 3; ++c) position[c] = a.p[c] + at.share * (b.p[c] - a.p[c]);
      Replay.slerp(rotation, a.q, 0, b.q, 0, at.share);
    }

    linkPoseAt(at, l, position, rotation) {
      const link = this.links[l], fixed = link.pose;
      for (let c = 0; c < 3; ++c) position[c] = fixed[c];
      for (let c = 0; c < 4; ++c) rotation[c] = fixed[3 + c];
      if (this.poses.length === 0) return false;
      const between = bracket(this.poses, at.t), a = this.poses[between.index], b = this.poses[between.next];
      if (Number.isNaN(a.values[7 * l]) || Number.isNaN(b.values[7 * l])) return false;
      for (let c = 0; c < 3; ++c) position[c] = a.values[7 * l + c] + between.share * (b.values[7 * l + c] - a.values[7 * l + c]);
      if (link.axis) return link.spins && at.t < this.poses[this.poses.length - 1].t;
      Replay.slerp(rotation, a.values, 7 * l + 3, b.values, 7 * l + 3, between.share);
      return false;
    }

    /** Whether the poses of links at an instant are in the world, not in the body. */
    areLinksInWorld(at) {
      return this.poses.length > 0 && this.poses[bracket(this.poses, at.t).next].inWorld;
    }

    speedAt(at) {
      const a = this.samples[at.index], b = this.samples[at.next];
      return b.t > a.t ? Math.hypot(b.p[0] - a.p[0], b.p[1] - a.p[1], b.p[2] - a.p[2]) / (b.t - a.t) : 0;
    }

    heightAt(at) {
      if (this.ground === null) return null;
      const { point, normal } = this.ground, p = [0, 0, 0];
      this.poseAt(at, p, [0, 0, 0, 1]);
      return p[2] - point.z + (normal.x * (p[0] - point.x) + normal.y * (p[1] - point.y)) / normal.z;
    }

    planAt() {
      return this.plans.length - 1;
    }
  }
  Track.kPoints = kPoints;
  Live.Track = Track;
})(typeof window === "undefined" ? globalThis : window);
