"use strict";
// Data of the run in the page: tracks by vehicle, plans, textures. Uses no browser function except atob, so that tests
// can run it elsewhere. tools/replay/replay_tracks.h documents the layout.
(function (root) {
  const Replay = (root.VinerowReplay = root.VinerowReplay || {});

  /** Bytes of a base64 text. */
  Replay.decodeBase64 = function (text) {
    const characters = atob(text);
    const bytes = new Uint8Array(characters.length);
    for (let i = 0; i < characters.length; ++i) bytes[i] = characters.charCodeAt(i);
    return bytes;
  };

  /** out[0..3] = rotation between a[i..] and b[j..] at a share from 0 to 1, at constant rate. */
  function slerp(out, a, i, b, j, share) {
    let dot = 0;
    for (let c = 0; c < 4; ++c) dot += a[i + c] * b[j + c];
    let from = 1 - share, to = dot < 0 ? -share : share;
    const cosine = Math.min(Math.abs(dot), 1);
    if (cosine < 0.9995) {
      const angle = Math.acos(cosine), sine = Math.sin(angle);
      from = Math.sin((1 - share) * angle) / sine;
      to = ((dot < 0 ? -1 : 1) * Math.sin(share * angle)) / sine;
    }
    let square = 0;
    for (let c = 0; c < 4; ++c) {
      out[c] = from * a[i + c] + to * b[j + c];
      square += out[c] * out[c];
    }
    for (let c = 0; c < 4; ++c) out[c] /= Math.sqrt(square);
  }
  Replay.slerp = slerp;

  function normalised(values) {
    const out = new Float32Array(values.length);
    for (let i = 0; i < values.length; i += 4) {
      const length = Math.hypot(values[i], values[i + 1], values[i + 2], values[i + 3]) || 1;
      for (let c = 0; c < 4; ++c) out[i + c] = values[i + c] / length;
    }
    return out;
  }

  function scaled(values, factor) {
    const out = new Float64Array(values.length);
    for (let i = 0; i < values.length; ++i) out[i] = values[i] * factor;
    return out;
  }

  /** One vehicle's poses over time. */
  class Track {
    constructor(entry, bytes) {
      const n = entry.samples, buffer = bytes.buffer, at = bytes.byteOffset;
      this.name = entry.name;
      this.entry = entry;
      this.times = scaled(new Uint32Array(buffer, at + entry.times, n), 1e-3);
      this.positions = scaled(new Int32Array(buffer, at + entry.positions, 3 * n), 1e-3);
      this.rotations = normalised(new Int16Array(buffer, at + entry.rotations, 4 * n));
      this.heights = entry.heights === undefined ? null : new Float32Array(buffer, at + entry.heights, n);
      this.links = entry.links.map((link) => ({
        name: link.name,
        pose: link.pose,
        axis: link.axis,
        positions: link.positions === undefined ? null
          : scaled(new Int16Array(buffer, at + link.positions, 3 * n), 1e-3),
        rotations: link.rotations === undefined ? null
          : normalised(new Int16Array(buffer, at + link.rotations, 4 * n)),
        spins: link.spins === undefined ? null : new Uint8Array(buffer, at + link.spins, n),
      }));
      this.plans = entry.plans.map((plan) => ({
        t: plan.t,
        points: new Float32Array(buffer, at + plan.points, 3 * plan.count),
      }));
    }

    /** {index, next, share} of the samples around t, s since the run's start. */
    bracket(t) {
      const last = this.times.length - 1;
      if (t <= this.times[0]) return { index: 0, next: 0, share: 0 };
      if (t >= this.times[last]) return { index: last, next: last, share: 0 };
      let low = 0, high = last;
      while (high - low > 1) {
        const middle = (low + high) >> 1;
        if (this.times[middle] <= t) low = middle;
        else high = middle;
      }
      return { index: low, next: high, share: (t - this.times[low]) / (this.times[high] - this.times[low]) };
    }

    /** Place (3) and rotation (4, x y z w) of the vehicle in W at a bracket. */
    poseAt(at, position, rotation) {
      for (let c = 0; c < 3; ++c) {
        const a = this.positions[3 * at.index + c], b = this.positions[3 * at.next + c];
        position[c] = a + at.share * (b - a);
      }
      slerp(rotation, this.rotations, 4 * at.index, this.rotations, 4 * at.next, at.share);
    }

    /** The same of a link in its vehicle; returns whether it spins. */
    linkPoseAt(at, l, position, rotation) {
      const link = this.links[l];
      for (let c = 0; c < 3; ++c) {
        if (link.positions) {
          const a = link.positions[3 * at.index + c], b = link.positions[3 * at.next + c];
          position[c] = a + at.share * (b - a);
        } else {
          position[c] = link.pose[c];
        }
      }
      if (link.rotations) {
        slerp(rotation, link.rotations, 4 * at.index, link.rotations, 4 * at.next, at.share);
      } else {
        for (let c = 0; c < 4; ++c) rotation[c] = link.pose[3 + c];
      }
      return link.spins !== null && link.spins[at.index] === 1 && at.index !== at.next;
    }

    /** Speed over the samples around t, m/s. */
    speedAt(at) {
      const b = at.next;
      let a = Math.max(b - 1, 0);
      // The last instant may be in the track twice; two samples of the same time give no speed.
      while (a > 0 && this.times[a] === this.times[b]) --a;
      if (this.times[a] === this.times[b]) return 0;
      const p = this.positions;
      return Math.hypot(p[3 * b] - p[3 * a], p[3 * b + 1] - p[3 * a + 1], p[3 * b + 2] - p[3 * a + 2]) /
        (this.times[b] - this.times[a]);
    }

    /** Height above the ground, m; null if the data lack it. */
    heightAt(at) {
      if (!this.heights) return null;
      return this.heights[at.index] + at.share * (this.heights[at.next] - this.heights[at.index]);
    }

    /** Number of the plan valid at t, -1: none yet. */
    planAt(t) {
      let found = -1;
      for (let i = 0; i < this.plans.length && this.plans[i].t <= t; ++i) found = i;
      return found;
    }
  }
  Replay.Track = Track;

  /** Tracks of an index (parsed) and its bytes. */
  Replay.readTracks = function (index, bytes) {
    return index.vehicles.map((entry) => new Track(entry, bytes));
  };

  /** "03:25.4" */
  Replay.clock = function (t) {
    const tenths = Math.max(0, Math.round(10 * t));
    const minutes = Math.floor(tenths / 600), rest = (tenths % 600) / 10;
    return String(minutes).padStart(2, "0") + ":" + rest.toFixed(1).padStart(4, "0");
  };
})(typeof window === "undefined" ? globalThis : window);
