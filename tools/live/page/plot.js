"use strict";
// Drawing of curves over simulated time on a canvas: axes with round ticks, and a line at the pointer.
(function (root) {
  const Live = (root.VinerowLive = root.VinerowLive || {});

  const kFont = '11px "Helvetica Neue", Arial, "DejaVu Sans", sans-serif';
  const kMargin = { left: 40, right: 10, top: 8, bottom: 20 };  // the left one grows with the numbers
  const kInk = "#c7ced4", kGrid = "rgba(255, 255, 255, .09)", kPointer = "rgba(255, 255, 255, .5)";

  /** Colours that remain distinct on dark ground, also for eyes that confuse red and green (Okabe and Ito 2008, lightened). */
  Live.kColours = ["#e8a33d", "#5ab8ea", "#33c493", "#f4e45a", "#7d9cf0", "#f07a4a", "#e08fbf", "#d7dde2"];

  /** Range of finite values in view, at least some width. */
  function rangeOf(curves, from) {
    let low = Infinity, high = -Infinity;
    for (const { series } of curves) {
      for (let i = series.first(from); i < series.count; ++i) {
        const value = series.value(i);
        if (value < low && value > -Infinity) low = value;
        if (value > high && value < Infinity) high = value;
      }
    }
    if (low > high) return { low: 0, high: 1 };
    // A constant is a line in the middle; its last digits are no signal.
    const size = Math.max(Math.abs(low), Math.abs(high)), least = 1e-4 * size;
    const margin = high - low > least ? 0.06 * (high - low) : size > 0 ? 0.1 * size : 1;
    return { low: low - margin, high: high + margin };
  }

  function tickLabel(tick, digits) {
    const text = Math.abs(tick) >= 1e7 || digits > 6 ? tick.toExponential(2) : tick.toFixed(digits);
    return text.replace(/^-(0(\.0*)?(e\+0)?)$/, "$1");
  }

  /** Points of a curve on the canvas. Within a column of pixels only first, least, greatest and last count. */
  function trace(context, series, from, x, y) {
    let column = NaN, low = 0, high = 0, last = 0, isOpen = false;
    const close = () => {
      if (!isOpen) return;
      context.lineTo(column, y(low));
      context.lineTo(column, y(high));
      context.lineTo(column, y(last));
    };
    context.beginPath();
    for (let i = Math.max(series.first(from) - 1, 0); i < series.count; ++i) {
      const value = series.value(i), at = Math.round(2 * x(series.time(i))) / 2;
      if (!Number.isFinite(value)) {
        close();
        isOpen = false;
        continue;
      }
      if (!isOpen) context.moveTo(at, y(value));
      else if (at !== column) {
        close();
        context.lineTo(at, y(value));
      }
      if (!isOpen || at !== column) low = high = value;
      low = Math.min(low, value);
      high = Math.max(high, value);
      last = value;
      column = at;
      isOpen = true;
    }
    close();
    context.stroke();
  }

  /**
   * @param curves [{series, colour}] @param to right end of the time axis, s @param window its length, s
   * @param pointer x of the pointer on the canvas or null
   * @returns time at the pointer, or null
   */
  Live.drawPlot = function (canvas, curves, to, window_s, pointer) {
    const width = canvas.clientWidth, height = canvas.clientHeight, ratio = Math.min(root.devicePixelRatio || 1, 2);
    if (width === 0 || height === 0) return null;
    if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
      canvas.width = Math.round(width * ratio);
      canvas.height = Math.round(height * ratio);
    }
    const context = canvas.getContext("2d"), from = to - window_s;
    const box = { right: width - kMargin.right, top: kMargin.top, bottom: height - kMargin.bottom };
    const { low, high } = rangeOf(curves, from);
    const rows = Live.roundTicks(low, high, Math.max(2, Math.floor((box.bottom - box.top) / 32)));
    const labels = rows.ticks.map((tick) => tickLabel(tick, rows.digits));
    context.font = kFont;
    box.left = Math.max(kMargin.left, ...labels.map((label) => Math.ceil(context.measureText(label).width) + 10));
    const x = (t) => box.left + ((t - from) / window_s) * (box.right - box.left);
    const y = (value) => box.bottom - ((value - low) / (high - low)) * (box.bottom - box.top);
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, width, height);
    context.font = kFont;
    context.lineWidth = 1;
    context.strokeStyle = kGrid;
    context.fillStyle = kInk;
    context.textBaseline = "middle";
    context.textAlign = "right";
    const line = (x0, y0, x1, y1) => {
      context.beginPath();
      context.moveTo(Math.round(x0) + 0.5, Math.round(y0) + 0.5);
      context.lineTo(Math.round(x1) + 0.5, Math.round(y1) + 0.5);
      context.stroke();
    };
    rows.ticks.forEach((tick, i) => {
      line(box.left, y(tick), box.right, y(tick));
      context.fillText(labels[i], box.left - 6, y(tick));
    });
    const columns = Live.roundTicks(from, to, Math.max(2, Math.floor((box.right - box.left) / 58)));
    context.textAlign = "center";
    for (const tick of columns.ticks) {
      if (tick < -1e-9) continue;
      line(x(tick), box.top, x(tick), box.bottom);
      const text = tick.toFixed(columns.digits) + " s", half = 0.5 * context.measureText(text).width;
      context.fillText(text, Math.min(x(tick), width - half - 1), box.bottom + 11);
    }
    context.save();
    context.beginPath();
    context.rect(box.left, box.top - 2, box.right - box.left, box.bottom - box.top + 4);
    context.clip();
    context.lineWidth = 1.5;
    context.lineJoin = "round";
    for (const { series, colour } of curves) {
      context.strokeStyle = colour;
      trace(context, series, from, x, y);
    }
    context.restore();
    if (pointer === null || pointer < box.left || pointer > box.right) return null;
    context.strokeStyle = kPointer;
    context.lineWidth = 1;
    line(pointer, box.top, pointer, box.bottom);
    return from + ((pointer - box.left) / (box.right - box.left)) * window_s;
  };
})(typeof window === "undefined" ? globalThis : window);
