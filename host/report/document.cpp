#include "report/document.hpp"

#include <fmt/format.h>

#include "report/chart.hpp"

namespace clpv::report {
namespace {

const char* const kStyle = R"css(
:root { color-scheme: light dark; --ink: #1c1e21; --soft: #5d646e; --line: #d8dce1; --paper: #fff; --accent: #b3541e;
        --s0: #3b6fb6; --s1: #c2571a; --s2: #3d8f5f; --s3: #8a5aab; --s4: #a8862a; --s5: #767e88; }
@media (prefers-color-scheme: dark) { :root { --ink: #e7e9ec; --soft: #a2aab4; --line: #3a4048; --paper: #16181b;
        --accent: #f09a5f; --s0: #7eaae6; --s1: #f0935a; --s2: #79c898; --s3: #c39ae0; --s4: #dcbb62; --s5: #a2aab4; } }
* { box-sizing: border-box; }
body { margin: 0 auto; padding: 1.2rem; max-width: 66rem; background: var(--paper); color: var(--ink);
       font: 16px/1.5 system-ui, sans-serif; }
h1 { font-size: 1.7rem; margin: 0; } h2 { font-size: 1.25rem; margin: 2.4rem 0 .6rem; } h3 { font-size: 1rem; margin: 1.6rem 0 .5rem; }
p, figcaption { max-width: 48rem; } .soft, figcaption { color: var(--soft); font-size: .9rem; }
.scroll { overflow-x: auto; } table { border-collapse: collapse; font-variant-numeric: tabular-nums; font-size: .9rem; }
th, td { padding: .25rem .7rem; border-bottom: 1px solid var(--line); text-align: right; white-space: nowrap; }
th:first-child, td:first-child { text-align: left; } tr.marked td { color: var(--accent); font-weight: 600; }
figure { margin: 0; } img { display: block; width: 100%; height: auto; image-rendering: auto; background: #000; }
.row { display: grid; gap: .8rem; grid-template-columns: repeat(auto-fit, minmax(15rem, 1fr)); }
.wipe { position: relative; max-width: 48rem; touch-action: pan-y; } .wipe .over { position: absolute; inset: 0; clip-path: inset(0 0 0 50%); }
.wipe .names { display: flex; justify-content: space-between; } .wipe input { width: 100%; accent-color: var(--accent); }
.legend { display: flex; gap: .6rem; align-items: center; max-width: 24rem; } .legend img { height: .8rem; }
.chart { width: 100%; max-width: 48rem; height: auto; font: 12px system-ui, sans-serif; fill: var(--ink); }
.chart .grid { stroke: var(--line); } .chart .front { fill: none; stroke: var(--soft); stroke-dasharray: 4 3; }
.chart .label { font-weight: 600; } .chart .marked { stroke: var(--ink); stroke-width: 2; }
.s0 { fill: var(--s0); } .s1 { fill: var(--s1); } .s2 { fill: var(--s2); } .s3 { fill: var(--s3); } .s4 { fill: var(--s4); } .s5 { fill: var(--s5); }
@media print { body { max-width: none; font-size: 11px; } h2 { break-after: avoid; } figure, .chart, tr { break-inside: avoid; }
  .wipe .stack { display: flex; gap: .4rem; } .wipe .over { position: static; clip-path: none !important; } .wipe input { display: none; } }
)css";

const char* const kScript = R"js(
document.documentElement.dataset.width = document.documentElement.scrollWidth;  // what the screenshot test reads
for (const wipe of document.querySelectorAll('.wipe')) {
  const over = wipe.querySelector('.over'), slider = wipe.querySelector('input');
  const show = () => { over.style.clipPath = `inset(0 0 0 ${slider.value}%)`; };
  slider.addEventListener('input', show);
  wipe.querySelector('.stack').addEventListener('pointermove', event => {
    if (event.pointerType === 'touch' && !event.buttons) return;
    const box = wipe.querySelector('.stack').getBoundingClientRect();
    slider.value = 100 * (event.clientX - box.left) / box.width;
    show();
  });
  show();
}
)js";

}  // namespace

std::string document(const std::string& title, const std::string& body) {
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<title>{}</title>\n<style>{}</style>\n</head>\n<body>\n{}\n<script>{}</script>\n</body>\n</html>\n",
      escaped(title), kStyle, body, kScript);
}

std::string wipe(const std::string& left, const std::string& left_title, const std::string& right,
                 const std::string& right_title) {
  return fmt::format(
      "<figure class=\"wipe\"><div class=\"stack\" style=\"position:relative\">"
      "<img src=\"{0}\" alt=\"{1}\"><img class=\"over\" src=\"{2}\" alt=\"{3}\"></div>"
      "<input type=\"range\" min=\"0\" max=\"100\" value=\"50\" aria-label=\"{1} to the left, {3} to the "
      "right\">"
      "<figcaption class=\"names\"><span>{1}</span><span>{3}</span></figcaption></figure>\n",
      left, escaped(left_title), right, escaped(right_title));
}

}  // namespace clpv::report
