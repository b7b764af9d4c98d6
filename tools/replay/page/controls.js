"use strict";
// Buttons, lists, keys, time line and vehicle names.
(function (root) {
  const Replay = (root.VinerowReplay = root.VinerowReplay || {});

  function element(tag, className, text) {
    const made = document.createElement(tag);
    if (className) made.className = className;
    if (text !== undefined) made.textContent = text;
    return made;
  }

  /** "1,2,3" as a point, or null. */
  function pointOf(text) {
    const numbers = (text || "").split(",").map(Number);
    return numbers.length === 3 && numbers.every(Number.isFinite) ? new THREE.Vector3().fromArray(numbers) : null;
  }

  class Controls {
    constructor(player) {
      this.player = player;
      this.find = player.find;
      const index = player.index;
      const words = index.name.replace(/_/g, " ");
      this.find("title").textContent = words.charAt(0).toUpperCase() + words.slice(1);
      this.find("notes").hidden = index.notes.length === 0;
      this.find("notes").querySelector("p").textContent = index.notes.join("; ") + ".";
      this.find("length").textContent = "/ " + Replay.clock(index.duration_s);
      const slider = this.find("slider");
      slider.max = String(index.duration_s);
      slider.addEventListener("input", () => player.seek(Number(slider.value)));
      this.makeVehicles();
      this.makePhases();
      this.makeCameraList();
      this.makeButtons();
      this.listenToKeys();
      this.listenToWheel();
    }

    makeVehicles() {
      this.labels = [];
      this.rows = this.player.scene.vehicles.map((vehicle) => {
        const row = element("tr"), name = element("td"), dot = element("span", "vr-dot");
        dot.style.background = vehicle.colour;
        name.append(dot, vehicle.name);
        row.title = "follow " + vehicle.name;
        row.append(name, element("td"), element("td"));
        row.addEventListener("click", () => this.follow(vehicle, false));
        this.find("vehicles").append(row);
        const label = element("div", "vr-label", vehicle.name);
        label.style.borderColor = vehicle.colour;
        this.find("labels").append(label);
        this.labels.push(label);
        return row;
      });
    }

    /** Draws the phases; overlapping phases are in lanes below each other. */
    makePhases() {
      const { phases, duration_s } = this.player.index, strip = this.find("phases"), ends = [];
      for (const phase of phases) {
        const width = Math.max(phase.end - phase.begin, 0);
        let lane = ends.findIndex((end) => end <= phase.begin + 1e-9);
        if (lane < 0) lane = ends.push(0) - 1;
        ends[lane] = phase.begin + width;
        const bar = element("div", "vr-phase vr-" + phase.state, width > 0 ? phase.name : "");
        if (width === 0) bar.classList.add("vr-moment");
        bar.style.left = (100 * phase.begin) / duration_s + "%";
        bar.style.width = (100 * width) / duration_s + "%";
        bar.style.top = 16 * lane + "px";
        bar.title = phase.name + ": " + Replay.clock(phase.begin) + " to " + Replay.clock(phase.end) +
          (phase.state ? ", " + phase.state : "");
        bar.addEventListener("click", () => this.player.seek(phase.begin));
        strip.append(bar);
      }
      strip.style.height = 16 * ends.length + "px";
    }

    makeCameraList() {
      const list = this.find("camera");
      list.append(new Option("free", "free"));
      this.player.scene.vehicles.forEach((vehicle, v) => {
        list.append(new Option("follow " + vehicle.name, "with " + v), new Option("behind " + vehicle.name, "behind " + v));
      });
      list.addEventListener("change", () => {
        const [kind, v] = list.value.split(" ");
        if (kind === "free") this.player.eye.free();
        else this.follow(this.player.scene.vehicles[Number(v)], kind === "behind");
        this.player.stage.focus({ preventScroll: true });
      });
    }

    makeButtons() {
      const player = this.player;
      const press = (name, action) => this.find(name).addEventListener("click", () => {
        action();
        player.dirty = true;
        player.stage.focus({ preventScroll: true });
      });
      press("play", () => player.play(!player.playing));
      press("whole", () => this.whole());
      press("above", () => this.above());
      press("full", () => this.fullScreen());
      this.find("menu").addEventListener("click", () => {
        const open = player.stage.classList.toggle("vr-open");
        this.find("menu").setAttribute("aria-expanded", String(open));
      });
      this.find("simple").addEventListener("change", () => player.setQuality(this.find("simple").checked ? 0 : 2));
      const speeds = this.find("speed");
      for (const speed of Replay.kSpeeds) speeds.append(new Option(speed + "×", String(speed)));
      speeds.addEventListener("change", () => {
        player.speed = Number(speeds.value);
        player.stage.focus({ preventScroll: true });
      });
      for (const box of player.stage.querySelectorAll("[data-show]")) {
        box.addEventListener("change", () => {
          player.show[box.dataset.show] = box.checked;
          player.dirty = true;
        });
      }
    }

    whole(atOnce) {
      this.player.eye.whole(this.player.index.ground, this.player.scene.sun.userData.direction, atOnce);
    }

    above(atOnce) {
      this.player.eye.above(this.player.index.ground, atOnce);
    }

    follow(vehicle, behind, atOnce) {
      this.player.eye.follow(vehicle, behind, atOnce);
      this.player.dirty = true;
    }

    fullScreen() {
      if (document.fullscreenElement) document.exitFullscreen();
      else if (this.player.stage.requestFullscreen) this.player.stage.requestFullscreen();
    }

    listenToKeys() {
      const player = this.player;
      const actions = {
        " ": () => player.play(!player.playing),
        ArrowLeft: () => player.seek(player.t - Replay.kStep_s),
        ArrowRight: () => player.seek(player.t + Replay.kStep_s),
        Home: () => player.seek(0),
        End: () => player.seek(player.index.duration_s),
        "+": () => player.changeSpeed(1),
        "-": () => player.changeSpeed(-1),
        h: () => this.whole(),
        t: () => this.above(),
        f: () => this.fullScreen(),
      };
      player.stage.addEventListener("keydown", (event) => {
        if (event.ctrlKey || event.altKey || event.metaKey || event.target.tagName === "SELECT") return;
        const number = Number(event.key);
        const vehicle = event.key !== " " && number >= 1 ? player.scene.vehicles[number - 1] : undefined;
        const action = vehicle ? () => this.follow(vehicle, event.shiftKey) : actions[event.key];
        if (!action || (event.key === " " && event.target.tagName === "BUTTON")) return;
        event.preventDefault();
        action();
      });
    }

    /** The wheel scrolls the page until the replay is clicked, and again after the pointer leaves it. */
    listenToWheel() {
      const stage = this.player.stage, controls = this.player.eye.controls, alone = document.body.children[0] === stage ||
        stage.parentElement === document.body && stage.clientHeight >= window.innerHeight;
      controls.enableZoom = alone;
      this.player.canvas.addEventListener("pointerdown", () => {
        stage.focus({ preventScroll: true });
        stage.classList.add("vr-touched");
        controls.enableZoom = true;
      });
      stage.addEventListener("mouseleave", () => (controls.enableZoom = alone));
      stage.addEventListener("mouseenter", () => {
        if (document.activeElement === stage) controls.enableZoom = true;
      });
    }

    /**
     * "#replay:t=52;follow=drone;hide=canopy,plans;speed=8;play=1" opens the page at that instant; "behind=drone",
     * "view=above" and "eye=x,y,z;look=x,y,z" (m in W) select other views.
     */
    readAddress() {
      const player = this.player, address = decodeURIComponent(window.location.hash);
      if (!address.startsWith("#replay:")) return;
      const wanted = {};
      for (const part of address.slice(8).split(";")) {
        const [key, value] = part.split("=");
        wanted[key] = value === undefined ? "" : value;
      }
      if (Number.isFinite(Number(wanted.t))) player.seek(Number(wanted.t));
      const vehicle = player.scene.vehicles.find((v) => v.name === (wanted.follow || wanted.behind));
      if (vehicle) this.follow(vehicle, wanted.behind !== undefined, true);
      else if (wanted.view === "above") this.above(true);
      const eye = pointOf(wanted.eye), look = pointOf(wanted.look);
      if (eye && look) {
        player.eye.free();
        player.eye.go(eye, look, true);
      }
      if (["0", "1", "2"].includes(wanted.quality)) player.setQuality(Number(wanted.quality));
      if (wanted.speed && Replay.kSpeeds.includes(Number(wanted.speed))) player.speed = Number(wanted.speed);
      for (const name of (wanted.hide || "").split(",")) {
        const box = player.stage.querySelector("[data-show='" + name.replace(/[^a-z]/g, "") + "']");
        if (box) player.show[box.dataset.show] = box.checked = false;
      }
      if (wanted.play === "1") player.play(true);
    }

    update() {
      const { player, find } = this;
      find("slider").value = String(player.t);
      find("time").textContent = Replay.clock(player.index.first_s + player.t);
      find("play").classList.toggle("vr-playing", player.playing);
      find("speed").value = String(player.speed);
      find("simple").checked = player.quality === 0;
      const running = player.index.phases.filter((phase) => phase.begin <= player.t && player.t < phase.end);
      find("now").textContent = running.map((phase) => phase.name).join(" · ");
      player.scene.vehicles.forEach((vehicle, v) => {
        const cells = this.rows[v].cells;
        cells[1].textContent = vehicle.speed.toFixed(1) + " m/s";
        cells[2].textContent = vehicle.height === null ? "" : vehicle.height.toFixed(1) + " m up";
        this.rows[v].classList.toggle("vr-followed", player.eye.followed === vehicle);
      });
      const followed = player.scene.vehicles.indexOf(player.eye.followed);
      find("camera").value = followed < 0 ? "free" : (player.eye.behind ? "behind " : "with ") + followed;
    }

    /** Places names above the vehicles, or at the edge of the picture towards vehicles out of sight. */
    placeLabels(camera) {
      const { player } = this, width = player.stage.clientWidth, height = player.stage.clientHeight;
      const foot = this.find("foot").offsetHeight, placed = [];
      const tangent = Math.tan((0.5 * camera.fov * Math.PI) / 180);
      player.scene.vehicles.forEach((vehicle, v) => {
        const label = this.labels[v], top = vehicle.position.clone();
        label.style.display = player.show.labels ? "" : "none";
        if (!player.show.labels) return;
        top.z += Math.max(vehicle.track.entry.top_m, 0) + 0.25;
        top.applyMatrix4(camera.matrixWorldInverse);
        const depth = Math.max(Math.abs(top.z), 1e-3);
        let x = top.x / (depth * tangent * camera.aspect), y = top.y / (depth * tangent);
        const away = top.z >= 0 || Math.abs(x) > 1 || Math.abs(y) > 1;
        if (away) {
          const scale = 1 / Math.max(Math.abs(x), Math.abs(y), 1e-6);
          x *= scale;
          y *= scale;
        }
        label.classList.toggle("vr-away", away);
        let left = (0.5 + 0.5 * x) * width, low = (0.5 - 0.5 * y) * height - 9;
        const reach = 0.5 * label.offsetWidth + 6, tall = label.offsetHeight;
        left = Math.min(Math.max(left, reach), width - reach);
        low = Math.min(Math.max(low, 30), height - foot - 18);
        // Move the label above those that it would cover.
        for (let k = 0; k < placed.length; ++k) {
          const other = placed.find((at) => Math.abs(at.left - left) < at.reach + reach - 8 && Math.abs(at.low - low) < tall + 2);
          if (other) low = other.low - tall - 3;
        }
        placed.push({ left, low, reach });
        label.style.transform = "translate(" + left.toFixed(1) + "px," + low.toFixed(1) + "px) translate(-50%,-100%)";
      });
    }
  }
  Replay.Controls = Controls;
})(window);

VinerowReplay.start();
