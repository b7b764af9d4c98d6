#include "tools/report/page_style.h"

#include <fmt/format.h>

#include "engine/playback/vehicle_colours.h"

namespace vinerow::tools::report {

namespace {

/// CSS variables --v0, --v1, ... with the vehicles' colours, as in frames and replay.
std::string vehicle_style() {
  std::string paper, dark, classes;
  for (std::size_t v = 0; v < playback::kVehicleColours.size(); ++v) {
    paper += fmt::format("--v{}: {}; ", v, playback::kVehicleColours[v].on_paper);
    dark += fmt::format("--v{}: {}; ", v, playback::hex_colour(playback::kVehicleColours[v].rgb));
    classes += fmt::format(".v{0} {{ --c: var(--v{0}); }}\n", v);
  }
  return fmt::format(
      ":root {{ {} }}\n@media screen and (prefers-color-scheme: dark) {{ :root {{ {} }} }}\n{}",
      paper, dark, classes);
}

constexpr const char* kStyle = R"(
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
  nav, p.hint { display: none !important; } .tall { max-height: none !important; }
  body { font-size: 11pt; }
  figure, .card, tr, .verdict { break-inside: avoid; }
  h2, h3, h4 { break-after: avoid; }
}
* { box-sizing: border-box; }
html { scroll-behavior: smooth; }
body { margin: 0; background: var(--paper); color: var(--ink); font: 16px/1.5 "Helvetica Neue", Arial, "DejaVu Sans", sans-serif; }
main { max-width: 1200px; margin: 0 auto; padding: 16px 24px 64px; }
nav { position: sticky; top: 0; z-index: 5; background: var(--paper); border-bottom: 1px solid var(--line); font-size: 14px; }
nav div { max-width: 1200px; margin: 0 auto; padding: 7px 24px; display: flex; gap: 4px 20px; overflow-x: auto; white-space: nowrap; scrollbar-width: none; }
nav a { color: var(--soft); text-decoration: none; }
nav a:hover { color: var(--ink); text-decoration: underline; }
section { scroll-margin-top: 44px; }
h1 { font-size: 30px; line-height: 1.2; margin: 0; overflow-wrap: anywhere; }
h2 { font-size: 23px; margin: 52px 0 14px; padding-top: 10px; border-top: 1px solid var(--line); }
h3 { font-size: 19px; margin: 34px 0 10px; overflow-wrap: anywhere; }
h4 { font-size: 16px; margin: 0 0 2px; }
p.lead { margin: 2px 0 12px; color: var(--soft); font-size: 17px; max-width: 62em; }
code { font: 13px "DejaVu Sans Mono", Menlo, Consolas, monospace; color: var(--soft); overflow-wrap: anywhere; }
.verdict { display: flex; gap: 16px; align-items: center; border-radius: 8px; padding: 8px 20px; margin: 0 0 12px; border: 1px solid; }
.verdict strong { font-size: 23px; line-height: 1.25; display: block; }
.verdict div { min-width: 0; overflow-wrap: anywhere; } .verdict p { margin: 0; color: var(--ink); }
.verdict p.remark { color: var(--soft); font-size: 14px; }
.verdict .mark { font-size: 40px; line-height: 1; font-weight: 700; }
.verdict.met { background: var(--good-soft); border-color: var(--good); color: var(--good); }
.verdict.failed, .verdict.broken { background: var(--bad-soft); border-color: var(--bad); color: var(--bad); }
.verdict.open { background: var(--card); border-color: var(--line); color: var(--soft); }
.cards { display: grid; grid-template-columns: repeat(auto-fit, minmax(140px, 1fr)); gap: 10px; margin: 0 0 12px; }
.card { background: var(--card); border: 1px solid var(--line); border-radius: 8px; padding: 9px 14px; min-width: 0; overflow: hidden; }
.card b { font-size: 21px; line-height: 1.25; display: block; }
.card > span { font-size: 13.5px; color: var(--soft); display: block; line-height: 1.3; overflow-wrap: anywhere; }
.hero { display: grid; grid-template-columns: 1fr; gap: 14px; margin: 0 0 8px; }
@media (min-width: 860px) { .hero.both { grid-template-columns: 1.15fr 1fr; } }
figure { margin: 0; }
.hero figure { background: var(--card); border: 1px solid var(--line); border-radius: 8px; overflow: hidden; }
.hero img { width: 100%; height: auto; display: block; }
.hero figcaption { padding: 5px 12px 7px; margin: 0; } .hero .legend { margin: 0; }
figcaption { font-size: 13.5px; color: var(--soft); margin-top: 4px; line-height: 1.4; overflow-wrap: anywhere; }
.figures { display: grid; margin: 0 0 20px; grid-template-columns: repeat(auto-fit, minmax(min(100%, 470px), 1fr)); gap: 26px 26px; }
.wide { grid-column: 1 / -1; }
figure.plot, figure.picture { background: var(--card); border: 1px solid var(--line); border-radius: 8px; padding: 12px 14px; position: relative; }
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
.badge { display: inline-block; padding: 0 9px; border-radius: 10px; font-size: 13px; font-weight: 600; background: var(--grid); color: var(--soft); white-space: nowrap; }
.badge.met { background: var(--good-soft); color: var(--good); } .badge.failed { background: var(--bad-soft); color: var(--bad); }
.badge.stopped { background: var(--warn-soft); color: var(--warn); }
details { margin: 0 0 12px; } summary { cursor: pointer; padding: 4px 0; overflow-wrap: anywhere; } td:not(.what) summary { overflow-wrap: normal; }
figure.map { margin: 0 0 20px; }
pre { background: var(--card); border: 1px solid var(--line); border-radius: 8px; padding: 14px 16px; overflow-x: auto; font: 12.5px/1.45 "DejaVu Sans Mono", Menlo, Consolas, monospace; max-height: 70vh; }
.readout { position: absolute; pointer-events: none; background: var(--card); color: var(--ink); border: 1px solid var(--line); border-radius: 6px; padding: 4px 9px; font-size: 12.5px; line-height: 1.4; box-shadow: 0 2px 8px #0003; display: none; white-space: nowrap; z-index: 3; }
p.hint { margin: 0 0 8px; font-size: 13.5px; color: var(--soft); }
h2.quiet { font-size: 17px; margin: 18px 0 6px; padding: 0; border: 0; }
a.cite { color: var(--soft); text-decoration: none; white-space: nowrap; } a.cite:hover { text-decoration: underline; }
.notice { border: 1px solid var(--warn); background: var(--warn-soft); border-radius: 8px; padding: 7px 16px; margin: 0 0 12px; font-size: 14px; }
.notice.grave { border-color: var(--bad); background: var(--bad-soft); }
.notice p { margin: 0; } .notice ul { margin: 2px 0 0; padding: 0; list-style: none; } .notice li { overflow-wrap: anywhere; }
.notice a { color: inherit; margin-left: 8px; } .notice b { font-variant-numeric: tabular-nums; }
table.setup .sensors { color: var(--soft); }
table.setup td { padding: 4px 10px; } table.facts.setup td:first-child { width: 110px; }
th .num, th.num { display: block; text-align: right; } th.num { display: table-cell; }
table.criteria td { padding: 3px 10px; } table.criteria details { margin: 0; } table.criteria summary { padding: 1px 0; }
table.criteria p { margin: 0 0 4px; max-width: 60em; color: var(--soft); font-size: 13.5px; }
table.events td.words { overflow-wrap: anywhere; } table.events code { white-space: nowrap; } .tall { max-height: 640px; overflow: auto; } table.events details { margin: 0; } table.events summary { padding: 0; } table.events tr.grave { background: var(--warn-soft); } table.events th.num { white-space: nowrap; }
table.events.grave-only tbody tr:not(.grave) { display: none; }
.gallery { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(100%, 265px), 1fr)); gap: 14px; margin: 0 0 14px; }
.gallery figure.picture { padding: 0; overflow: hidden; } .gallery figcaption { padding: 4px 10px 7px; margin: 0; }
.gallery img { width: 100%; height: auto; aspect-ratio: 16 / 9; object-fit: cover; object-position: 50% 40%; display: block; }
.gallery img, figure.opens img { cursor: zoom-in; }
details.more { margin: 0 0 20px; } details.more > summary { color: var(--soft); margin-bottom: 8px; }
dialog.picture { border: 0; padding: 0; margin: 0; width: 100vw; height: 100vh; height: 100dvh; max-width: none; max-height: none; background: #0e1214; color: #eceae4; }
dialog.picture[open] { display: flex; align-items: center; justify-content: space-between; }
dialog.picture figure { flex: 1; min-width: 0; height: 100%; display: flex; flex-direction: column; align-items: center; justify-content: center; padding: 10px 0; }
dialog.picture img { max-width: 100%; width: 100%; min-height: 0; flex: 1; object-fit: contain; cursor: zoom-out; }
dialog.picture figcaption { color: #b9beba; padding: 4px 12px; flex: none; }
dialog.picture button { font: 34px/1 Arial, sans-serif; color: #fff; background: none; border: 0; padding: 12px; cursor: pointer; flex: none; opacity: 0.8; }
dialog.picture button:hover { opacity: 1; } dialog.picture form { position: absolute; right: 0; top: 0; z-index: 1; }
ul.sources { padding-left: 0; list-style: none; } ul.sources li { margin: 0 0 8px; scroll-margin-top: 60px; }
.narrow-only { display: none; }
/* A telephone: texts of charts grow as the charts shrink, tables stand as lists, wide ones scroll inside themselves. */
@media screen and (max-width: 700px) {
  .wide-only { display: none; } .narrow-only { display: block; }
  main { padding: 12px 12px 48px; } nav div { padding: 7px 12px; }
  h1 { font-size: 25px; } p.lead { font-size: 16px; }
  .verdict { padding: 8px 12px; gap: 10px; } .verdict strong { font-size: 20px; } .verdict .mark { font-size: 30px; }
  .cards { grid-template-columns: repeat(auto-fit, minmax(150px, 1fr)); } .card { padding: 7px 10px; } .card b { font-size: 18px; }
  figure.plot { padding: 10px 8px; } figure.picture, .hero figure, figure.plot, .figures { min-width: 0; }
  .gallery { grid-template-columns: 1fr 1fr; gap: 10px; } .gallery figcaption { font-size: 12.5px; }
  svg.plot, svg.map, svg.canopy { overflow: visible; } figure.plot { overflow-x: clip; }
  svg.plot .tick, svg.map .tick, svg.plot .label, svg.map .label { font-size: 18px; }
  svg.plot .tick:nth-of-type(even):not(.end) { visibility: hidden; }
  figure.wide-chart { overflow-x: auto; }
  .wide-chart svg { width: 720px; }
  .legend { overflow-wrap: anywhere; } .legend span { white-space: normal; }
  table { font-size: 13.5px; } th, td { padding: 5px 7px; }
  table.facts td:first-child, table.facts.setup td:first-child { width: 96px; } table.facts td { overflow-wrap: anywhere; }
  table.criteria thead { display: none; }
  table.criteria tr { display: flex; flex-wrap: wrap; align-items: baseline; border-bottom: 1px solid var(--line); padding: 4px 0; }
  table.criteria td { border: 0; padding: 1px 7px; text-align: left; } table.criteria td:nth-child(1) { order: 2; }
  table.criteria td.what { order: 1; flex: 0 0 100%; }
  table.criteria td:nth-child(3) { order: 3; } table.criteria td:nth-child(4) { order: 4; } table.criteria td:nth-child(5) { order: 5; }
  table.criteria td:nth-child(5) { color: var(--soft); } table.criteria td:nth-child(4):empty { display: none; }
  table.events thead { display: none; } table.events tr { display: block; border-bottom: 1px solid var(--line); padding: 4px 0; }
  table.events td { display: inline-block; border: 0; padding: 1px 7px; } table.events td.words { display: block; } table.events code { white-space: normal; }
  table.events td.num::after { content: " s"; }
  dialog.picture { flex-direction: column; } dialog.picture figure { width: 100%; } dialog.picture .before, dialog.picture .after { position: absolute; bottom: 0; }
  dialog.picture .before { left: 0; } dialog.picture .after { right: 0; }
}
)";

}  // namespace

std::string page_style() {
  return kStyle + vehicle_style();
}

const char* picture_dialog() {
  return R"html(<dialog class="picture" aria-label="picture"><form method="dialog"><button class="close" title="close (Esc)">×</button></form>
<button type="button" class="before" title="previous (←)">‹</button><figure><img alt="" src="data:,"/><figcaption></figcaption></figure><button type="button" class="after" title="next (→)">›</button></dialog>
)html";
}

const char* page_script() {
  return R"(
(function () {
  'use strict';
  // Read-out: the pointer's position on a plot gives a time, and the value of every line at it.
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
  // A picture opens over the page, as large as the window; arrow keys show the next.
  var dialog = document.querySelector('dialog.picture'), shown = 0;
  var pictures = Array.prototype.slice.call(document.querySelectorAll('figure.opens img, figure.picture img')).filter(function (image) { return !dialog.contains(image); });
  function show(k) {
    shown = (k + pictures.length) % pictures.length;
    var figure = pictures[shown].closest('figure'), large = dialog.querySelector('img');
    large.src = pictures[shown].src;
    large.alt = pictures[shown].alt;
    dialog.querySelector('figcaption').textContent = figure.querySelector('figcaption').textContent;
    if (!dialog.open) dialog.showModal();
  }
  pictures.forEach(function (image, k) {
    image.tabIndex = 0;
    image.addEventListener('click', function () { show(k); });
    image.addEventListener('keydown', function (event) { if (event.key === 'Enter') show(k); });
  });
  dialog.querySelector('.before').addEventListener('click', function () { show(shown - 1); });
  dialog.querySelector('.after').addEventListener('click', function () { show(shown + 1); });
  dialog.querySelector('img').addEventListener('click', function () { dialog.close(); });
  dialog.addEventListener('keydown', function (event) {
    if (event.key === 'ArrowLeft') show(shown - 1);
    if (event.key === 'ArrowRight') show(shown + 1);
  });
  document.querySelectorAll('.grave-only').forEach(function (box) {
    box.addEventListener('change', function () {
      document.querySelector('table.events').classList.toggle('grave-only', box.checked);
    });
  });
  // For printing, open everything.
  window.addEventListener('beforeprint', function () {
    document.querySelectorAll('details.more').forEach(function (more) { more.open = true; });
  });
  // Values that depend on the machine are in Timings only; the first screen copies them.
  document.querySelectorAll('[data-from]').forEach(function (place) {
    var source = document.getElementById(place.dataset.from);
    if (source) place.textContent = source.textContent;
  });
}());
)";
}

}  // namespace vinerow::tools::report
