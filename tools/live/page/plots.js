"use strict";
// Panel of plots: choosing fields of channels, keeping their samples, legends with values.
(function (root) {
  const Live = (root.VinerowLive = root.VinerowLive || {});
  const { element } = root.VinerowReplay;

  const kWindows_s = [10, 30, 120];
  const kSettle_ms = 100;  // channels are listed once they have all come or gone
  const kRedraw_s = 0.05;  // wall time between two drawings; a curve does not need 60 of them

  class Plots {
    /** @param changed is called when the choice of plots has changed */
    constructor(panel, socket, changed) {
      Object.assign(this, { panel, socket, changed });
      this.find = (name) => panel.querySelector(".vl-" + name);
      this.plots = [];  // {element, canvas, legend, curves, pointer}
      this.ends = [];  // functions that end subscriptions
      this.endPeek = null;
      this.window_s = kWindows_s[1];
      this.now = 0;  // right end of the time axes
      this.topic = null;  // chosen by the user, as is the field's path; null: not yet
      this.path = null;
      this.wait = 0;
      for (const window_s of kWindows_s) this.find("window").append(new Option(window_s + " s", String(window_s)));
      this.find("window").addEventListener("change", () => this.setWindow(Number(this.find("window").value)));
      this.find("channel").addEventListener("change", () => {
        this.topic = this.find("channel").value;
        this.path = null;
        this.peek();
      });
      this.find("field").addEventListener("change", () => (this.path = this.find("field").value));
      this.find("form").addEventListener("submit", (event) => {
        event.preventDefault();
        this.addChosen();
      });
      // A closed panel costs nothing: no subscription, no drawing.
      panel.addEventListener("toggle", () => this.subscribe());
      socket.addEventListener("channels", () => {
        window.clearTimeout(this.settling);
        this.settling = window.setTimeout(() => this.listChannels(), kSettle_ms);
      });
      this.setWindow(this.window_s);
      this.listPlots();
    }

    setWindow(window_s) {
      if (!kWindows_s.includes(window_s)) return;
      this.window_s = window_s;
      this.find("window").value = String(window_s);
      this.isDirty = true;
      this.changed();
    }

    /** Channels with numbers that can be read. A lost connection keeps the list, as its channels return. */
    listChannels() {
      const topics = [...this.socket.channels.values()].filter((channel) => {
        try {
          return Live.listFields(this.socket.schemaOf(channel), null) !== null;
        } catch (error) {
          return false;
        }
      }).map((channel) => channel.topic).sort();
      const list = this.find("channel");
      if (topics.length === 0) return;
      if ([...list.options].map((option) => option.value).join("\n") === topics.join("\n")) return;
      list.replaceChildren(...topics.map((topic) => new Option(topic, topic)));
      const truth = topics.find((topic) => topic.endsWith("/truth"));
      list.value = topics.includes(this.topic) ? this.topic : truth || topics[0];
      this.peek();
    }

    /** Lists the fields of the chosen channel; one message of it gives the lengths of its lists and their names. */
    peek() {
      const topic = this.find("channel").value, channel = this.socket.channels.get(topic);
      if (this.endPeek) this.endPeek();
      this.endPeek = null;
      if (!channel) return;
      const schema = this.socket.schemaOf(channel);
      const fill = (message) => {
        const list = this.find("field");
        list.replaceChildren(...Live.listFields(schema, message).map(({ path, label }) => new Option(label, path)));
        if ([...list.options].some((option) => option.value === this.path)) list.value = this.path;
        this.find("add").disabled = list.options.length === 0;
      };
      fill(null);
      if (!this.panel.open) return;
      this.endPeek = this.socket.want(topic, (message) => {
        fill(message);
        if (this.endPeek) this.endPeek();
        this.endPeek = null;
      });
    }

    addChosen() {
      const topic = this.find("channel").value, path = this.find("field").value, target = this.find("target").value;
      if (!topic || !path) return;
      this.add(topic, path, target === "new" ? this.plots.length : Number(target));
    }

    /** Adds a curve. @param number of its plot; a new one if there are not so many */
    add(topic, path, number) {
      const plot = this.plots[number] || this.addPlot();
      if (plot.curves.some((curve) => curve.topic === topic && curve.path === path)) return;
      const used = new Set(plot.curves.map((curve) => curve.colour));
      const colour = Live.kColours.find((each) => !used.has(each)) || Live.kColours[plot.curves.length % Live.kColours.length];
      const curve = { topic, path, colour, read: Live.fieldReader(path), series: new Live.Series() };
      const row = element("li"), swatch = element("span", "vl-swatch"), remove = element("button", "vl-remove", "×");
      swatch.style.background = colour;
      curve.value = element("output", "vl-value", "–");
      remove.type = "button";
      remove.title = "remove this curve";
      remove.setAttribute("aria-label", "remove " + topic + " " + path);
      remove.addEventListener("click", () => this.remove(plot, curve));
      curve.name = element("span", "vl-name", topic + "." + path);
      curve.name.title = topic + "." + path;
      row.append(swatch, curve.name, curve.value, remove);
      curve.row = row;
      plot.legend.append(row);
      plot.curves.push(curve);
      this.choiceChanged();
      this.find("target").value = String(this.plots.indexOf(plot));
    }

    addPlot() {
      const plot = { element: element("div", "vl-plot"), canvas: element("canvas"), legend: element("ul", "vl-legend"), curves: [], pointer: null };
      plot.canvas.setAttribute("role", "img");
      plot.canvas.setAttribute("aria-label", "plot over simulated time; its legend has the values");
      const point = (event) => {
        plot.pointer = event ? event.offsetX : null;
        this.isDirty = true;
      };
      plot.canvas.addEventListener("pointermove", point);
      plot.canvas.addEventListener("pointerleave", () => point(null));
      plot.element.append(plot.canvas, plot.legend);
      this.find("plots").append(plot.element);
      this.plots.push(plot);
      return plot;
    }

    remove(plot, curve) {
      plot.curves = plot.curves.filter((each) => each !== curve);
      curve.row.remove();
      if (plot.curves.length === 0) {
        plot.element.remove();
        this.plots = this.plots.filter((each) => each !== plot);
      }
      this.choiceChanged();
      this.find("channel").focus();
    }

    choiceChanged() {
      this.listPlots();
      this.subscribe();
      this.changed();
    }

    listPlots() {
      const list = this.find("target"), before = list.value;
      list.replaceChildren(...this.plots.map((plot, i) => new Option("plot " + (i + 1), String(i))), new Option("new plot", "new"));
      list.value = before !== "" && Number(before) < this.plots.length ? before : this.plots.length > 0 ? "0" : "new";
      this.find("target-label").hidden = this.plots.length === 0;
      this.find("empty").hidden = this.plots.length > 0;
    }

    /** Subscribes to exactly the channels of the curves in view. */
    subscribe() {
      const ends = this.ends, byTopic = new Map();
      this.ends = [];
      for (const plot of this.panel.open ? this.plots : []) {
        for (const curve of plot.curves) byTopic.set(curve.topic, [...(byTopic.get(curve.topic) || []), curve]);
      }
      for (const [topic, curves] of byTopic) {
        this.ends.push(this.socket.want(topic, (message, t, channel) => {
          for (const curve of curves) {
            if (!curve.isNamed) this.nameCurve(curve, channel, message);
            curve.series.push(t, curve.read(message));
          }
          this.isDirty = true;
        }));
      }
      // After the new ones, so that a channel that stays is not left and joined again.
      for (const end of ends) end();
      this.isDirty = true;
      if (!this.panel.open) {
        for (const plot of this.plots) for (const { series } of plot.curves) series.interrupt();
        return;
      }
      if (this.find("field").options.length === 0) this.listChannels();
      else this.peek();
    }

    /** Adds the name that an element of a list has: "/rover/wheels.value[0] wheel_fl_speed_radps". */
    nameCurve(curve, channel, message) {
      const field = Live.listFields(this.socket.schemaOf(channel), message).find(({ path }) => path === curve.path);
      curve.isNamed = true;
      if (field) curve.name.title = curve.name.textContent = curve.topic + "." + field.label;
    }

    clear() {
      for (const plot of this.plots) for (const curve of plot.curves) curve.series.clear();
      this.now = 0;
      this.isDirty = true;
    }

    /** Draws if something has changed. @param now simulated time, s @param dt wall time, s */
    frame(now, dt) {
      this.wait -= dt;
      if (now !== this.now) this.isDirty = true;
      if (!this.isDirty || !this.panel.open || this.wait > 0) return;
      this.isDirty = false;
      this.wait = kRedraw_s;
      this.now = now;
      for (const plot of this.plots) {
        const t = Live.drawPlot(plot.canvas, plot.curves, Math.max(this.now, this.window_s), this.window_s, plot.pointer);
        for (const { series, value } of plot.curves) value.textContent = Live.shortNumber(series.at(t === null ? Infinity : t));
      }
    }

    /** Choice as a text for the page's address: plots apart by "|", curves by ",". */
    toText() {
      return this.plots.map((plot) => plot.curves.map(({ topic, path }) => topic + "." + path).join(",")).join("|");
    }

    fromText(text) {
      text.split("|").forEach((plot, number) => {
        for (const curve of plot.split(",")) {
          const [, topic, path] = /^([^.]+)\.(.+)$/.exec(curve) || [];
          if (topic) this.add(topic, path, number);
        }
      });
    }
  }
  Live.Plots = Plots;
})(window);
