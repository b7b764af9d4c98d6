"use strict";
// Time of the picture: follows the simulated time of the samples smoothly, a little behind the last one, so that there
// are samples on both sides to interpolate between, however irregularly they arrive.
(function (root) {
  const Live = (root.VinerowLive = root.VinerowLive || {});

  const kWindow_s = 1;  // wall time over which the rate is measured
  const kMargin = 1.15;  // lag as a multiple of the longest gap between samples
  const kSettle_s = 0.3;  // time constant of corrections
  const kIdle_s = 0.25;  // without samples for longer than this, the picture moves on to the last one
  const kFarBehind_s = 0.6;  // wall time; beyond it the picture jumps

  class Clock {
    constructor() {
      this.clear();
    }

    clear() {
      this.t = null;  // s of simulated time; null: no sample yet
      this.latest = null;
      this.marks = [];  // {wall, t} of new latest samples within the window
    }

    /** A sample has arrived. @param t its simulated time, s @param wall s */
    arrive(t, wall) {
      if (this.latest === null) this.t = t;
      else if (t <= this.latest) return;
      this.latest = t;
      this.marks.push({ wall, t });
      while (this.marks[0].wall < wall - kWindow_s) this.marks.shift();
    }

    /** Simulated seconds per second of the samples that arrived lately. */
    rate() {
      const first = this.marks[0], last = this.marks[this.marks.length - 1];
      return this.marks.length > 1 && last.wall > first.wall ? (last.t - first.t) / (last.wall - first.wall) : 0;
    }

    /** Longest gap between samples, s of wall time and of simulated time. */
    gaps() {
      let wall = 0, simulated = 0;
      for (let i = 1; i < this.marks.length; ++i) {
        wall = Math.max(wall, this.marks[i].wall - this.marks[i - 1].wall);
        simulated = Math.max(simulated, this.marks[i].t - this.marks[i - 1].t);
      }
      return { wall, simulated };
    }

    /** Next frame. @param dt s of wall time since the last frame @returns whether the time has changed */
    advance(dt, wall) {
      if (this.t === null) return false;
      const before = this.t, rate = this.rate(), gaps = this.gaps();
      const idle = this.marks.length < 2 || wall - this.marks[this.marks.length - 1].wall > Math.max(kIdle_s, 2 * gaps.wall);
      if (idle) {
        this.t += (this.latest - this.t) * Math.min(1, dt / (0.2 * kSettle_s));
        if (this.latest - this.t < 1e-4) this.t = this.latest;
      } else {
        const target = this.latest - kMargin * Math.max(gaps.simulated, gaps.wall * rate);
        const error = target - this.t;
        if (error > kFarBehind_s * Math.max(rate, 1)) this.t = target;
        else this.t += Math.max(0, rate * dt + error * Math.min(1, dt / kSettle_s));
      }
      this.t = Math.min(this.t, this.latest);
      return this.t !== before;
    }
  }
  Live.Clock = Clock;
})(typeof window === "undefined" ? globalThis : window);
