"use strict";
// Driving: keys, buttons and the left stick of a gamepad become speed and yaw rate, published 20 times a second.
(function (root) {
  const Live = (root.VinerowLive = root.VinerowLive || {});
  const Replay = root.VinerowReplay;

  const kPeriod_ms = 50;
  const kDeadZone = 0.12;  // of a stick, which is never exactly in its centre
  const kKeys = {
    w: "ahead", ArrowUp: "ahead", s: "back", ArrowDown: "back", a: "left", ArrowLeft: "left", d: "right", ArrowRight: "right",
  };
  const kTypes = { "geometry_msgs/msg/TwistStamped": true, "geometry_msgs/msg/Twist": false };  // value: has a header
  const kDefaultSpeed_mps = 1, kDefaultYawRate_radps = 0.8;

  const keyOf = (event) => kKeys[event.key.length === 1 ? event.key.toLowerCase() : event.key];

  class Drive {
    /** @param time function that returns the simulated time, s @param stage element that shows that driving is on */
    constructor(panel, stage, socket, time) {
      Object.assign(this, { panel, stage, socket, time });
      this.find = (name) => panel.querySelector(".vl-" + name);
      this.on = false;
      this.held = new Set();
      this.commands = [];  // {topic, type, vehicle}
      this.wasMoving = false;
      this.limits = {};  // by vehicle: {speed, yaw}
      this.vehicles = new Map();
      this.find("drive").addEventListener("click", () => this.turn(!this.on));
      this.find("vehicle").addEventListener("change", () => {
        this.stop();
        this.showLimits();
      });
      for (const name of ["speed", "yaw"]) {
        this.find("max-" + name).addEventListener("input", () => {
          const value = Number(this.find("max-" + name).value);
          if (this.chosen && value > 0) this.limitsOf(this.chosen.vehicle)[name] = value;
        });
      }
      for (const button of panel.querySelectorAll("[data-move]")) this.listenToButton(button);
      document.addEventListener("keydown", (event) => this.press(event), true);
      document.addEventListener("keyup", (event) => {
        if (this.held.delete(keyOf(event))) this.send();
      }, true);
      // Key releases do not arrive here while another window has the focus.
      window.addEventListener("blur", () => this.release());
      document.addEventListener("visibilitychange", () => this.release());
      socket.addEventListener("parameters", () => this.listCommands());
      socket.addEventListener("state", () => {
        if (socket.state !== "open") this.turn(false);
      });
      this.listCommands();
    }

    /** @param vehicles of the index: maximum speeds */
    setVehicles(vehicles) {
      this.vehicles = new Map(vehicles.map((vehicle) => [vehicle.name, vehicle]));
      this.limits = {};
      this.showLimits();
    }

    get chosen() {
      return this.commands.find((command) => command.topic === this.find("vehicle").value) || this.commands[0];
    }

    limitsOf(name) {
      if (!this.limits[name]) {
        const { max_speed_mps: most } = this.vehicles.get(name) || {};
        this.limits[name] = { speed: most > 0 ? Math.min(most, kDefaultSpeed_mps) : kDefaultSpeed_mps, yaw: kDefaultYawRate_radps };
      }
      return this.limits[name];
    }

    /** Vehicles that accept commands, from the parameter "command_topics": a list, or the same as JSON. */
    listCommands() {
      let topics = this.socket.parameters.command_topics;
      try {
        if (typeof topics === "string") topics = JSON.parse(topics);
      } catch (error) {
        topics = [];
      }
      const commands = (Array.isArray(topics) ? topics : []).filter((each) => each && typeof each.topic === "string" && each.type in kTypes)
        .map(({ topic, type }) => ({ topic, type, vehicle: topic.split("/")[1] || topic }));
      if (JSON.stringify(commands) !== JSON.stringify(this.commands)) {
        this.commands = commands;
        const list = this.find("vehicle"), before = list.value;
        list.replaceChildren(...commands.map((command) => new Option(command.vehicle, command.topic)));
        if (commands.some((command) => command.topic === before)) list.value = before;
        this.showLimits();
      }
      if (commands.length === 0) this.turn(false);
      this.find("none").hidden = commands.length > 0;
      this.find("controls").hidden = commands.length === 0;
      this.find("vehicle-label").hidden = commands.length < 2;
    }

    showLimits() {
      if (!this.chosen) return;
      const { speed, yaw } = this.limitsOf(this.chosen.vehicle);
      this.find("max-speed").value = String(speed);
      this.find("max-yaw").value = String(yaw);
      const { max_speed_mps: most } = this.vehicles.get(this.chosen.vehicle) || {};
      this.find("max-speed").max = most > 0 ? String(most) : "";
      this.show();
    }

    turn(on) {
      if (on === this.on || (on && !this.chosen)) return;
      if (!on) this.release();
      this.on = on;
      window.clearInterval(this.timer);
      if (on) this.timer = window.setInterval(() => this.tick(), kPeriod_ms);
      else for (const { topic } of this.commands) this.socket.unpublish(topic);
      this.show();
    }

    press(event) {
      if (!this.on || event.ctrlKey || event.altKey || event.metaKey) return;
      if (event.key === "Escape") {
        this.turn(false);
        return;
      }
      const move = keyOf(event);
      if (!move || Replay.usesKeys(event.target) || event.target.type === "range") return;
      event.preventDefault();
      event.stopPropagation();
      if (event.repeat || this.held.has(move)) return;
      this.held.add(move);
      this.send();
    }

    listenToButton(button) {
      const { move } = button.dataset;
      button.addEventListener("pointerdown", (event) => {
        button.setPointerCapture(event.pointerId);
        this.turn(true);
        this.held.add(move);
        this.send();
      });
      for (const kind of ["pointerup", "pointercancel", "lostpointercapture"]) {
        button.addEventListener(kind, () => {
          if (this.held.delete(move)) this.send();
        });
      }
    }

    release() {
      this.held.clear();
      this.stop();
      this.show();
    }

    /** Left stick of the first gamepad that is moved, {ahead, left} from -1 to 1. */
    stick() {
      for (const pad of navigator.getGamepads ? navigator.getGamepads() : []) {
        if (!pad || pad.axes.length < 2) continue;
        const [x, y] = pad.axes, size = Math.hypot(x, y);
        if (size < kDeadZone) continue;
        const scale = Math.min(1, (size - kDeadZone) / (1 - kDeadZone)) / size;
        return { ahead: -y * scale, left: -x * scale };
      }
      return { ahead: 0, left: 0 };
    }

    /** Wanted motion as a share of the limits. */
    wanted() {
      const { ahead, left } = this.stick(), is = (move) => (this.held.has(move) ? 1 : 0);
      const limit = (value) => Math.min(Math.max(value, -1), 1);
      return { ahead: limit(ahead + is("ahead") - is("back")), left: limit(left + is("left") - is("right")) };
    }

    tick() {
      if (document.hidden) return;
      const { ahead, left } = this.wanted();
      if (ahead !== 0 || left !== 0 || this.held.size > 0 || this.wasMoving) this.send();
    }

    /** Publishes the wanted motion; the first one after a release is zero, then silence. */
    send() {
      if (!this.on) return;
      const { ahead, left } = this.wanted(), { speed, yaw } = this.limitsOf(this.chosen.vehicle);
      this.publish(ahead * speed, left * yaw);
      this.wasMoving = ahead !== 0 || left !== 0;
      this.show();
    }

    stop() {
      if (this.on && this.wasMoving) this.publish(0, 0);
      this.wasMoving = false;
    }

    publish(speed, yawRate) {
      // Another vehicle may have been chosen since: the one that moves gets the command.
      const command = (this.wasMoving && this.moving) || this.chosen, t = Math.max(this.time(), 0);
      const twist = { linear: { x: speed, y: 0, z: 0 }, angular: { x: 0, y: 0, z: yawRate } };
      const stamp = { sec: Math.floor(t), nanosec: Math.floor((t % 1) * 1e9) };
      const header = { stamp, frame_id: command.vehicle + "/base_link" };
      this.moving = command;
      this.last = { speed, yawRate };
      this.socket.publish(command.topic, command.type, kTypes[command.type] ? { header, twist } : twist);
    }

    show() {
      const banner = this.stage.querySelector(".vl-driving"), name = this.chosen ? this.chosen.vehicle : "";
      const { speed, yawRate } = this.wasMoving && this.last ? this.last : { speed: 0, yawRate: 0 };
      const words = speed.toFixed(2) + " m/s, " + yawRate.toFixed(2) + " rad/s";
      this.stage.classList.toggle("vl-drives", this.on);
      this.find("drive").setAttribute("aria-pressed", String(this.on));
      this.find("drive").textContent = this.on ? "Stop driving " + name : "Drive " + name;
      this.find("command").textContent = this.on ? words : "";
      banner.textContent = this.on ? "Driving " + name + ": " + words + " · W A S D or arrows · Esc ends" : "";
      for (const button of this.panel.querySelectorAll("[data-move]")) button.classList.toggle("vl-held", this.held.has(button.dataset.move));
    }
  }
  Live.Drive = Drive;
})(window);
