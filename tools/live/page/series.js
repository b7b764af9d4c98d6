"use strict";
// One curve's samples, the newest ones, in rings of numbers; and round ticks of axes.
(function (root) {
  const Live = (root.VinerowLive = root.VinerowLive || {});

  const kFirst = 1024, kMost = 1 << 17;  // samples: 131 s at 1 kHz

  class Series {
    constructor() {
      this.clear();
    }

    clear() {
      this.times = new Float64Array(kFirst);
      this.values = new Float64Array(kFirst);
      this.begin = 0;
      this.count = 0;
    }

    /** After a time before the last one, only newer samples count: the run was reset. */
    push(t, value) {
      if (this.count > 0 && t < this.time(this.count - 1)) this.clear();
      if (this.count === this.times.length && this.count < kMost) this.grow();
      const at = (this.begin + this.count) % this.times.length;
      this.times[at] = t;
      this.values[at] = value;
      if (this.count < this.times.length) ++this.count;
      else this.begin = (this.begin + 1) % this.times.length;
    }

    /** Samples are missing from here on: the curve has a gap. */
    interrupt() {
      if (this.count > 0) this.push(this.time(this.count - 1), NaN);
    }

    grow() {
      const { times, values, begin, count } = this;
      this.times = new Float64Array(2 * times.length);
      this.values = new Float64Array(2 * times.length);
      for (let i = 0; i < count; ++i) {
        this.times[i] = times[(begin + i) % times.length];
        this.values[i] = values[(begin + i) % times.length];
      }
      this.begin = 0;
    }

    time(i) {
      return this.times[(this.begin + i) % this.times.length];
    }

    value(i) {
      return this.values[(this.begin + i) % this.times.length];
    }

    /** Number of the first sample at or after t; count if there is none. */
    first(t) {
      let low = 0, high = this.count;
      while (low < high) {
        const middle = (low + high) >> 1;
        if (this.time(middle) < t) low = middle + 1;
        else high = middle;
      }
      return low;
    }

    /** Value of the last sample at or before t, or undefined. */
    at(t) {
      const next = this.first(t + 1e-12);
      return next > 0 ? this.value(next - 1) : undefined;
    }
  }
  Live.Series = Series;

  /** Multiples of 1, 2 or 5 times a power of ten in a range: {step, ticks, digits}, at most `most` of them. */
  Live.roundTicks = function (low, high, most) {
    const rough = Math.max(high - low, 1e-300) / Math.max(most, 1), power = Math.pow(10, Math.floor(Math.log10(rough)));
    const step = power * [1, 2, 5, 10].find((factor) => factor * power >= rough * (1 - 1e-9));
    const ticks = [];
    for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; ++k) ticks.push(k * step);
    return { step, ticks, digits: Math.max(0, Math.min(12, -Math.floor(Math.log10(step) + 1e-9))) };
  };

  /** A number in a few characters. */
  Live.shortNumber = function (value) {
    if (value === undefined) return "–";
    if (!Number.isFinite(value)) return String(value).replace("Infinity", "∞");
    const size = Math.abs(value);
    if (size !== 0 && (size >= 1e6 || size < 1e-3)) return value.toExponential(3);
    return value.toFixed(size >= 1000 ? 1 : size >= 10 ? 2 : 4);
  };
})(typeof window === "undefined" ? globalThis : window);
