"use strict";
// List of what happened: events of the run, messages of the server and of this page. The newest is first.
(function (root) {
  const Live = (root.VinerowLive = root.VinerowLive || {});
  const { element, clock } = root.VinerowReplay;

  const kMost = 200;
  const kKinds = ["info", "warning", "error"];

  class Events {
    constructor(panel) {
      this.list = panel.querySelector(".vl-list");
      this.empty = panel.querySelector(".vl-empty");
      this.unread = panel.querySelector(".vl-unread");
      this.panel = panel;
      panel.addEventListener("toggle", () => this.count(0));
      this.missed = 0;
    }

    /** Number of entries that arrived while the list was closed. */
    count(missed) {
      this.missed = this.panel.open ? 0 : missed;
      this.unread.textContent = this.missed > 0 ? String(this.missed) : "";
    }

    /** @param level 0 info, 1 warning, 2 error @param t simulated time, s; null: none @param id removes it later */
    add(level, t, source, text, id) {
      // A message with the number of an earlier one replaces it.
      if (id !== undefined) this.remove([id]);
      const kind = kKinds[Math.min(Math.max(Number(level) || 0, 0), 2)], first = this.list.firstElementChild;
      this.empty.hidden = true;
      // The same again, as from a vehicle that reports every second: counted.
      if (first && first.dataset.text === source + text && first.dataset.kind === kind) {
        first.dataset.times = String(Number(first.dataset.times || 1) + 1);
        first.querySelector(".vl-times").textContent = "× " + first.dataset.times;
        first.querySelector(".vl-at").textContent = t === null ? "" : clock(t);
        return;
      }
      const entry = element("li", "vl-" + kind);
      entry.dataset.text = source + text;
      entry.dataset.kind = kind;
      if (id !== undefined) entry.dataset.id = String(id);
      const words = element("span", "vl-words");
      words.append(source ? element("b", "", source) : "", (source ? " " : "") + text);
      // Levels by a word too, not only by colour.
      if (kind !== "info") words.prepend(element("span", "vl-kind", kind + " "));
      entry.append(element("span", "vl-at", t === null ? "" : clock(t)), words, element("span", "vl-times"));
      this.list.prepend(entry);
      while (this.list.childElementCount > kMost) this.list.lastElementChild.remove();
      this.count(this.missed + 1);
    }

    /** An event of the run, rcl_interfaces/msg/Log: 10 debug, 20 info, 30 warning, 40 error, 50 fatal. */
    addLog(message, t) {
      const { level } = message;
      this.add(level >= 40 ? 2 : level >= 30 ? 1 : 0, t, message.name, message.msg);
    }

    remove(ids) {
      const gone = new Set(ids.map(String));
      for (const entry of [...this.list.children]) if (gone.has(entry.dataset.id)) entry.remove();
    }

    clear() {
      this.list.replaceChildren();
      this.empty.hidden = false;
      this.count(0);
    }
  }
  Live.Events = Events;
})(window);
