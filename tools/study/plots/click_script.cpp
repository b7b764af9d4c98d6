#include "tools/study/plots/click_script.h"

namespace vinerow::study {

const char* click_script() {
  return R"(
(function () {
  'use strict';
  var panel = document.createElement('div');
  panel.className = 'command-panel';
  panel.hidden = true;
  panel.setAttribute('role', 'region');
  panel.setAttribute('aria-label', 'command of the chosen cell');
  panel.setAttribute('aria-live', 'polite');
  function add(name, css, text) {
    var element = document.createElement(name);
    if (css) element.className = css;
    element.textContent = text;
    panel.appendChild(element);
    return element;
  }
  var about = add('div', 'about', ''), code = add('code', '', '');
  var copy = add('button', '', 'Copy'), close = add('button', '', 'Close');
  copy.type = close.type = 'button';
  document.body.appendChild(panel);
  var chosen = null;
  function markOf(event) {
    return event.target.closest ? event.target.closest('[data-cell]') : null;
  }
  function choose(mark) {
    if (chosen) chosen.classList.remove('chosen');
    chosen = mark;
    panel.hidden = !mark;
    document.body.style.paddingBottom = mark ? panel.offsetHeight + 'px' : '';
    if (!mark) return;
    mark.classList.add('chosen');
    var around = mark.closest('[data-command]'), title = mark.querySelector('title');
    about.textContent = title ? title.textContent.split('\n').join(' · ') : '';
    code.textContent = (around ? around.dataset.command + ' ' : '') + mark.dataset.cell;
    copy.textContent = 'Copy';
    document.body.style.paddingBottom = panel.offsetHeight + 'px';
  }
  function selectCode() {
    var range = document.createRange();
    range.selectNodeContents(code);
    var selection = window.getSelection();
    selection.removeAllRanges();
    selection.addRange(range);
  }
  // Not every browser gives pages from files access to the clipboard: fall back to execCommand, or
  // let the user copy.
  function copyByHand() {
    selectCode();
    copy.textContent = document.execCommand('copy') ? 'Copied' : 'Press Ctrl+C';
  }
  copy.addEventListener('click', function () {
    if (!navigator.clipboard) { copyByHand(); return; }
    function copied() { copy.textContent = 'Copied'; }
    navigator.clipboard.writeText(code.textContent).then(copied, copyByHand);
  });
  close.addEventListener('click', function () { choose(null); });
  document.addEventListener('click', function (event) {
    var mark = markOf(event);
    if (mark) choose(mark);
  });
  // One tab stop per plot; arrow keys move inside it.
  document.querySelectorAll('svg.study').forEach(function (svg) {
    var marks = Array.prototype.slice.call(svg.querySelectorAll('[data-cell]'));
    if (marks.length === 0) return;
    svg.setAttribute('role', 'group');
    marks.forEach(function (mark, k) {
      mark.setAttribute('tabindex', k === 0 ? '0' : '-1');
      mark.setAttribute('role', 'button');
    });
    svg.addEventListener('keydown', function (event) {
      var mark = markOf(event);
      if (!mark) return;
      if (event.key === 'Enter' || event.key === ' ') {
        event.preventDefault();
        choose(mark);
      }
      var step = {ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1}[event.key];
      if (!step) return;
      event.preventDefault();
      var next = marks[(marks.indexOf(mark) + step + marks.length) % marks.length];
      mark.setAttribute('tabindex', '-1');
      next.setAttribute('tabindex', '0');
      next.focus();
    });
  });
  document.addEventListener('keydown', function (event) {
    if (event.key === 'Escape') choose(null);
  });
}());
)";
}

}  // namespace vinerow::study
