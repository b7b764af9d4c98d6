#include "tools/vinerow/report/page_style.h"

namespace vinerow::tools::report {

const char* page_style() {
  return R"(
:root {
  color-scheme: light dark;
  --paper: #faf9f5; --card: #ffffff; --ink: #22282a; --soft: #5c6462; --line: #e3dfd3; --grid: #ebe7dc;
  --good: #2c6e2a; --good-soft: #e6f1e2; --bad: #b3261e; --bad-soft: #fbe7e5; --warn: #9a6a00; --warn-soft: #fbf1d9;
  --ground: #f3efe2; --row: #7ba05b; --parcel: #b9a27a; --turn: #d9d2bd;
  --s0: #1f6fb4; --s1: #d1495b; --s2: #2a9d6f; --s3: #c27c0e; --s4: #7b53b5; --s5: #0d8a94; --s6: #a8548e; --s7: #6b705c;
}
@media (prefers-color-scheme: dark) {
  :root {
    --paper: #16191a; --card: #1f2426; --ink: #e8e6df; --soft: #a3a9a5; --line: #363c3d; --grid: #2b3132;
    --good: #8fce86; --good-soft: #20331f; --bad: #ff9c92; --bad-soft: #41201d; --warn: #edc25e; --warn-soft: #3a2f14;
    --ground: #23261f; --row: #5d8044; --parcel: #8d7b58; --turn: #3a3829;
    --s0: #6fb3ee; --s1: #f08491; --s2: #63cfa1; --s3: #e8ac4d; --s4: #b79be8; --s5: #5cc5ce; --s6: #dd92c6; --s7: #aab09a;
  }
}
@media print {
  :root {
    color-scheme: light;
    --paper: #fff; --card: #fff; --ink: #111; --soft: #444; --line: #ccc; --grid: #e6e6e6;
    --good: #2c6e2a; --good-soft: #eef5ec; --bad: #b3261e; --bad-soft: #fbe7e5; --warn: #9a6a00; --warn-soft: #fbf1d9;
    --ground: #f7f5ee; --row: #7ba05b; --parcel: #b9a27a; --turn: #e4dfd0;
    --s0: #1f6fb4; --s1: #d1495b; --s2: #2a9d6f; --s3: #c27c0e; --s4: #7b53b5; --s5: #0d8a94; --s6: #a8548e; --s7: #6b705c;
  }
  nav { display: none !important; }
  body { font-size: 11pt; }
  figure, .card, tr, .verdict { break-inside: avoid; }
  h2, h3, h4 { break-after: avoid; }
}
* { box-sizing: border-box; }
html { scroll-behavior: smooth; }
body { margin: 0; background: var(--paper); color: var(--ink); font: 16px/1.5 "Helvetica Neue", Arial, "DejaVu Sans", sans-serif; }
main { max-width: 1200px; margin: 0 auto; padding: 16px 24px 64px; }
nav { position: sticky; top: 0; z-index: 5; background: var(--paper); border-bottom: 1px solid var(--line); font-size: 14px; }
nav div { max-width: 1200px; margin: 0 auto; padding: 7px 24px; display: flex; flex-wrap: wrap; gap: 4px 20px; }
nav a { color: var(--soft); text-decoration: none; }
nav a:hover { color: var(--ink); text-decoration: underline; }
section { scroll-margin-top: 44px; }
h1 { font-size: 30px; line-height: 1.2; margin: 0; overflow-wrap: anywhere; }
h2 { font-size: 23px; margin: 52px 0 14px; padding-top: 10px; border-top: 1px solid var(--line); }
h3 { font-size: 19px; margin: 34px 0 10px; }
h4 { font-size: 16px; margin: 0 0 2px; }
p.lead { margin: 2px 0 12px; color: var(--soft); font-size: 17px; max-width: 62em; }
code { font: 13px "DejaVu Sans Mono", Menlo, Consolas, monospace; color: var(--soft); overflow-wrap: anywhere; }
.verdict { display: flex; gap: 16px; align-items: center; border-radius: 8px; padding: 8px 20px; margin: 0 0 12px; border: 1px solid; }
.verdict strong { font-size: 23px; line-height: 1.25; display: block; }
.verdict p { margin: 0; color: var(--ink); }
.verdict .mark { font-size: 40px; line-height: 1; font-weight: 700; }
.verdict.met { background: var(--good-soft); border-color: var(--good); color: var(--good); }
.verdict.failed, .verdict.broken { background: var(--bad-soft); border-color: var(--bad); color: var(--bad); }
.verdict.open { background: var(--card); border-color: var(--line); color: var(--soft); }
.cards { display: grid; grid-template-columns: repeat(auto-fit, minmax(130px, 1fr)); gap: 10px; margin: 0 0 12px; }
.card { background: var(--card); border: 1px solid var(--line); border-radius: 8px; padding: 9px 14px; }
.card b { font-size: 22px; line-height: 1.25; display: block; }
.card > span { font-size: 13.5px; color: var(--soft); display: block; line-height: 1.3; }
.hero { display: grid; grid-template-columns: 1fr; gap: 14px; margin: 0 0 8px; }
@media (min-width: 860px) { .hero.both { grid-template-columns: 1.15fr 1fr; } }
figure { margin: 0; }
.hero figure { background: var(--card); border: 1px solid var(--line); border-radius: 8px; overflow: hidden; }
.hero img { width: 100%; height: auto; display: block; }
.hero figcaption { padding: 5px 12px 7px; margin: 0; } .hero .legend { margin: 0; }
figcaption { font-size: 13.5px; color: var(--soft); margin-top: 4px; line-height: 1.4; }
.figures { display: grid; margin: 0 0 20px; grid-template-columns: repeat(auto-fit, minmax(min(100%, 470px), 1fr)); gap: 26px 26px; }
.wide { grid-column: 1 / -1; }
figure.plot, figure.picture { background: var(--card); border: 1px solid var(--line); border-radius: 8px; padding: 12px 14px; position: relative; }
.figures img { width: 100%; height: auto; display: block; border-radius: 4px; cursor: zoom-in; }
figure.large { grid-column: 1 / -1; }
figure.large img { cursor: zoom-out; }
svg { display: block; width: 100%; height: auto; font: 13px "Helvetica Neue", Arial, "DejaVu Sans", sans-serif; }
svg svg { overflow: hidden; }
svg text { fill: var(--ink); }
svg .tick { fill: var(--soft); font-size: 12.5px; }
svg .label { fill: var(--ink); }
svg .mid { text-anchor: middle; }
svg .end:is(text) { text-anchor: end; }
svg .grid { stroke: var(--grid); stroke-width: 1; }
svg .axis { stroke: var(--soft); stroke-width: 1; }
svg .line { fill: none; stroke: var(--c); stroke-width: 1.6; stroke-linejoin: round; }
svg .line.ref { stroke-dasharray: 6 4; stroke-width: 1.4; }
svg .line.dash { stroke-dasharray: 6 4; }
svg .limit { stroke: var(--bad); stroke-width: 1.3; stroke-dasharray: 2 3; }
svg .band { fill: var(--c); opacity: 0.16; stroke: none; }
svg .span { fill: var(--turn); opacity: 0.45; }
svg .cursor { stroke: var(--soft); stroke-width: 1; }
.s0 { --c: var(--s0); } .s1 { --c: var(--s1); } .s2 { --c: var(--s2); } .s3 { --c: var(--s3); }
.s4 { --c: var(--s4); } .s5 { --c: var(--s5); } .s6 { --c: var(--s6); } .s7 { --c: var(--s7); }
.ref { --c: var(--ink); } .ground { --c: var(--parcel); }
.legend { margin: 0 0 4px; font-size: 13.5px; color: var(--soft); display: flex; flex-wrap: wrap; gap: 1px 16px; }
.legend span { white-space: nowrap; }
.key { display: inline-block; width: 22px; border-top: 3px solid var(--c); margin-right: 6px; vertical-align: 4px; }
.key.ref, .key.dash { border-top-style: dashed; border-top-width: 2px; }
.key.limit { --c: var(--bad); border-top-style: dotted; }
.key.area { border: 0; height: 11px; background: var(--c); vertical-align: -1px; opacity: 0.3; }
.key.area.span { --c: var(--turn); opacity: 1; } .key.area.row { --c: var(--row); opacity: 1; }
svg.map .ground { fill: var(--ground); } svg.map .parcel { fill: none; stroke: var(--parcel); stroke-width: 1.5; stroke-dasharray: 8 5; }
svg.map .row { fill: none; stroke: var(--row); stroke-linecap: round; opacity: 0.85; }
svg.map .row polyline { fill: none; }
svg.map .grid { opacity: 0.6; }
svg.map .track { fill: none; stroke: var(--c); stroke-width: 2.6; stroke-linejoin: round; opacity: 0.92; }
svg.map .plan { fill: none; stroke: var(--ink); stroke-width: 1; stroke-dasharray: 5 4; opacity: 0.75; }
svg.map .start { fill: var(--card); stroke: var(--c); stroke-width: 2.5; } svg.map .end:is(rect) { fill: var(--c); stroke: var(--card); stroke-width: 1.5; }
svg.map .paper { fill: var(--paper); opacity: 0.8; } svg.map .north { fill: var(--ink); } svg.map .scale { stroke: var(--ink); stroke-width: 2; }
svg.time { min-width: 620px; }
svg.time .lane { fill: var(--grid); } svg.time .bar { fill: var(--soft); }
svg.time .bar.met { fill: var(--good); } svg.time .bar.failed { fill: var(--bad); } svg.time .bar.stopped { fill: var(--warn); } svg.time .bar.waits { fill: var(--line); }
svg.time .bar.work { fill: var(--s2); } svg.time .bar.turn { fill: var(--s3); } svg.time .bar.transit { fill: var(--s0); } svg.time .bar.lift { fill: var(--s4); }
.key.work { --c: var(--s2); } .key.turn { --c: var(--s3); } .key.transit { --c: var(--s0); } .key.lift { --c: var(--s4); } .key.waits { --c: var(--line); }
.key.area.work, .key.area.turn, .key.area.transit, .key.area.lift, .key.area.waits { opacity: 1; }
svg.time .note.met { fill: var(--good); } svg.time .note.failed { fill: var(--bad); } svg.time .note.stopped { fill: var(--warn); } svg.time .note.waits { fill: var(--soft); }
.scroll { overflow-x: auto; margin: 0 0 14px; }
table { border-collapse: collapse; width: 100%; font-size: 14px; background: var(--card); }
th, td { padding: 6px 10px; border-bottom: 1px solid var(--line); text-align: left; vertical-align: top; }
th { font-weight: 600; color: var(--soft); font-size: 13px; vertical-align: bottom; }
td.num { text-align: right; white-space: nowrap; font-variant-numeric: tabular-nums; }
table.facts td:first-child { width: 260px; color: var(--soft); }
td.none { color: var(--soft); }
table.criteria td:nth-child(2) { min-width: 250px; } table.criteria td:last-child { min-width: 260px; color: var(--soft); }
.badge { display: inline-block; padding: 0 9px; border-radius: 10px; font-size: 13px; font-weight: 600; background: var(--grid); color: var(--soft); white-space: nowrap; }
.badge.met { background: var(--good-soft); color: var(--good); } .badge.failed { background: var(--bad-soft); color: var(--bad); }
.badge.stopped { background: var(--warn-soft); color: var(--warn); }
.source { color: var(--ink); font-style: italic; white-space: nowrap; }
details { margin: 0 0 12px; } summary { cursor: pointer; padding: 4px 0; white-space: nowrap; }
figure.map { margin: 0 0 20px; }
pre { background: var(--card); border: 1px solid var(--line); border-radius: 8px; padding: 14px 16px; overflow-x: auto; font: 12.5px/1.45 "DejaVu Sans Mono", Menlo, Consolas, monospace; max-height: 70vh; }
.readout { position: absolute; pointer-events: none; background: var(--card); color: var(--ink); border: 1px solid var(--line); border-radius: 6px; padding: 4px 9px; font-size: 12.5px; line-height: 1.4; box-shadow: 0 2px 8px #0003; display: none; white-space: nowrap; z-index: 3; }
footer { margin-top: 48px; font-size: 13px; color: var(--soft); }
)";
}

const char* page_script() {
  return R"(
(function () {
  'use strict';
  // The pointer's place on a plot becomes a time, and every line's value at it.
  function digits(span) { return Math.max(0, Math.min(6, 3 - Math.floor(Math.log10(span)))); }
  document.querySelectorAll('svg.plot').forEach(function (svg) {
    var X = svg.dataset.x.split(' ').map(Number), Y = svg.dataset.y.split(' ').map(Number);
    var lines = [];
    svg.querySelectorAll('polyline[data-label]').forEach(function (line) {
      var points = line.getAttribute('points').split(' ').map(function (p) { return p.split(',').map(Number); });
      lines.push({label: line.dataset.label, points: points});
    });
    var box = document.createElement('div');
    box.className = 'readout';
    svg.parentNode.appendChild(box);
    var cursor = document.createElementNS('http://www.w3.org/2000/svg', 'line');
    cursor.setAttribute('class', 'cursor');
    cursor.setAttribute('visibility', 'hidden');
    svg.appendChild(cursor);
    function value(points, x) {
      var last = points.length - 1;
      if (points[0][0] > x || x > points[last][0]) return null;
      var low = 0, high = last;
      while (high - low > 1) {
        var middle = (low + high) >> 1;
        if (points[middle][0] > x) high = middle; else low = middle;
      }
      var a = points[low], b = points[high];
      return a[1] + (b[0] > a[0] ? (x - a[0]) / (b[0] - a[0]) : 0) * (b[1] - a[1]);
    }
    function hide() { box.style.display = 'none'; cursor.setAttribute('visibility', 'hidden'); }
    svg.addEventListener('pointerleave', hide);
    svg.addEventListener('pointermove', function (event) {
      var at = new DOMPoint(event.clientX, event.clientY).matrixTransform(svg.getScreenCTM().inverse());
      if (X[2] > at.x || at.x > X[3]) { hide(); return; }
      ['x1', 'x2'].forEach(function (k) { cursor.setAttribute(k, at.x); });
      cursor.setAttribute('y1', Y[2]);
      cursor.setAttribute('y2', Y[3]);
      cursor.setAttribute('visibility', 'visible');
      var told = [(X[0] + (at.x - X[2]) / (X[3] - X[2]) * (X[1] - X[0])).toFixed(digits(X[1] - X[0]))], seen = {};
      lines.forEach(function (line) {
        var y = value(line.points, at.x);
        if (y === null || seen[line.label]) return;
        seen[line.label] = true;
        told.push(line.label + ': ' + (Y[0] + (y - Y[2]) / (Y[3] - Y[2]) * (Y[1] - Y[0])).toFixed(digits(Y[1] - Y[0])));
      });
      box.textContent = '';
      told.forEach(function (text) {
        var row = document.createElement('div');
        row.textContent = text;
        box.appendChild(row);
      });
      box.style.display = 'block';
      var frame = svg.parentNode.getBoundingClientRect();
      var right = event.clientX - frame.left + 14;
      if (right + box.offsetWidth > frame.width) right -= box.offsetWidth + 28;
      box.style.left = right + 'px';
      box.style.top = (event.clientY - frame.top + 12) + 'px';
    });
  });
  document.querySelectorAll('figure.picture').forEach(function (figure) {
    figure.addEventListener('click', function () { figure.classList.toggle('large'); });
  });
  // What depends on the machine stands in the timings alone; the first screen repeats it.
  document.querySelectorAll('[data-from]').forEach(function (place) {
    var source = document.getElementById(place.dataset.from);
    if (source) place.textContent = source.textContent;
  });
}());
)";
}

}  // namespace vinerow::tools::report
