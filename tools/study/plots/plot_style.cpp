#include "tools/study/plots/plot_style.h"

namespace vinerow::study {

std::string study_plot_style() {
  // Rules that begin with "svg" also apply to files of single plots; the others need a page.
  return R"(
.study-scroll { overflow-x: auto; }
figure.study { min-width: 0; }
figure.study svg { margin: 0 auto; }
svg.study text.value { font-size: 12px; text-anchor: middle; pointer-events: none; }
svg.study text.on-dark { fill: #ffffff; }
svg.study text.on-light { fill: #000000; }
svg.study text.halo { paint-order: stroke; stroke: var(--card); stroke-width: 4px;
  stroke-linejoin: round; pointer-events: none; }
svg.study .sharp { shape-rendering: crispEdges; }
svg.study .missing { fill: var(--grid); }
svg.study .hatch { fill: none; stroke: var(--soft); stroke-width: 1; opacity: 0.6;
  pointer-events: none; }
svg.study .reach { fill: none; stroke: none; pointer-events: all; }
svg.study .line { pointer-events: none; }
svg.study .line.ref { stroke-width: 1.6; }
svg.study .whisker { stroke: var(--c); stroke-width: 1.6; }
svg.study .dot { fill: var(--c); stroke: var(--card); stroke-width: 1; }
svg.study .ring { stroke: var(--c); fill: var(--card); stroke-width: 1.8; }
svg.study .speck { fill: var(--c); fill-opacity: 0.75; }
svg.study .box { stroke: var(--c); fill: var(--c); fill-opacity: 0.14; stroke-width: 1.4; }
svg.study .median { stroke: var(--c); stroke-width: 3; }
svg.study .way { fill: none; stroke-width: 1.5; stroke-linejoin: round; }
svg.study .uncoloured { stroke: var(--soft); }
.key.area.missing { opacity: 1; background: repeating-linear-gradient(135deg, var(--grid) 0 3px,
  var(--soft) 3px 4px); }
.study [data-cell] { cursor: pointer; }
.study [data-cell]:focus { outline: none; }
.study .tile[data-cell]:is(:hover, :focus-visible, .chosen) { stroke: var(--ink);
  stroke-width: 2.5; }
.study .mark[data-cell]:is(:hover, :focus-visible, .chosen) .dot { stroke: var(--ink);
  stroke-width: 2.2; }
.study .mark[data-cell]:is(:hover, :focus-visible, .chosen) .reach:is(rect) { fill: var(--turn);
  fill-opacity: 0.35; }
.study circle[data-cell]:is(:hover, :focus-visible, .chosen) { stroke: var(--ink);
  stroke-width: 2.2; fill-opacity: 1; }
.study .way[data-cell]:is(:hover, :focus-visible, .chosen) { stroke-width: 4; stroke-opacity: 1; }
.command-panel { position: fixed; left: 0; right: 0; bottom: 0; z-index: 8;
  background: var(--card); border-top: 2px solid var(--s0); box-shadow: 0 -4px 16px #0003;
  padding: 10px 24px; display: flex; flex-wrap: wrap; gap: 6px 16px; align-items: center; }
.command-panel[hidden] { display: none; }
.command-panel .about { flex: 1 1 100%; color: var(--soft); font-size: 13.5px; }
.command-panel code { flex: 1 1 300px; color: var(--ink); font-size: 14px; }
.command-panel button { font: inherit; font-size: 14px; color: var(--ink);
  background: var(--grid); border: 1px solid var(--line); border-radius: 6px; padding: 4px 14px;
  cursor: pointer; }
/* The darkest colours of the scale are hard to see on a dark page. */
@media screen and (prefers-color-scheme: dark) { .study .ways {
  filter: contrast(0.7) brightness(1.2); } }
@media screen and (max-width: 700px) { .command-panel { padding: 10px 12px; } }
@media print {
  .command-panel { display: none; } .study-scroll { overflow: visible; }
  .study svg { min-width: 0 !important; }
  svg { print-color-adjust: exact; -webkit-print-color-adjust: exact; }
}
)";
}

}  // namespace vinerow::study
