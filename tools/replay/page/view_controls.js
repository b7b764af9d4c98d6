"use strict";
// Controls of the picture: camera, visible layers, vehicles and their names. The same for replays and live runs.
(function (root) {
  const Replay = (root.VinerowReplay = root.VinerowReplay || {});

  Replay.element = function (tag, className, text) {
    const made = document.createElement(tag);
    if (className) made.className = className;
    if (text !== undefined) made.textContent = text;
    return made;
  };
  const element = Replay.element;

  /** "1,2,3" as a point, or null. */
  function pointOf(text) {
    const numbers = (text || "").split(",").map(Number);
    return numbers.length === 3 && numbers.every(Number.isFinite) ? new THREE.Vector3().fromArray(numbers) : null;
  }

  /** Key-value pairs of an address "#<word>:key=value;key=value", or null if it has another word. */
  Replay.readAddress = function (word) {
    const address = decodeURIComponent(window.location.hash), start = "#" + word + ":";
    if (!address.startsWith(start)) return null;
    const wanted = {};
    for (const part of address.slice(start.length).split(";")) {
      const [key, value] = part.split("=");
      wanted[key] = value === undefined ? "" : value;
    }
    return wanted;
  };

  /** Whether an element uses most keys itself: lists and text fields. */
  Replay.usesKeys = function (target) {
    if (target.tagName === "INPUT") return !["checkbox", "range"].includes(target.type);
    return target.tagName === "SELECT" || target.tagName === "TEXTAREA";
  };

  class ViewControls {
    /** @param view a Replay.View with index, scene and eye */
    constructor(view) {
      this.player = view;
      this.find = view.find;
      const index = view.index, words = index.name.replace(/_/g, " ");
      this.find("title").textContent = words.charAt(0).toUpperCase() + words.slice(1);
      this.find("notes").hidden = index.notes.length === 0;
      this.find("notes").querySelector("p").textContent = index.notes.join("; ") + ".";
      this.makeVehicles();
      this.makeCameraList();
      this.makeViewButtons();
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

    /** Calls an action when a button is pressed, and returns the focus to the picture with its keys. */
    press(name, action) {
      this.find(name).addEventListener("click", () => {
        action();
        this.player.dirty = true;
        this.player.stage.focus({ preventScroll: true });
      });
    }

    makeViewButtons() {
      const player = this.player;
      this.press("whole", () => this.whole());
      this.press("above", () => this.above());
      this.press("full", () => this.fullScreen());
      this.find("menu").addEventListener("click", () => {
        const open = player.stage.classList.toggle("vr-open");
        this.find("menu").setAttribute("aria-expanded", String(open));
      });
      this.find("simple").addEventListener("change", () => player.setQuality(this.find("simple").checked ? 0 : 2));
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

    /** Keys of the view and further ones. @param actions functions by key */
    listenToKeys(actions) {
      const player = this.player;
      const all = Object.assign({ h: () => this.whole(), t: () => this.above(), f: () => this.fullScreen() }, actions);
      player.stage.addEventListener("keydown", (event) => {
        if (event.ctrlKey || event.altKey || event.metaKey || Replay.usesKeys(event.target)) return;
        const number = Number(event.key);
        const vehicle = event.key !== " " && number >= 1 ? player.scene.vehicles[number - 1] : undefined;
        const action = vehicle ? () => this.follow(vehicle, event.shiftKey) : all[event.key];
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

    /** View that an address selects: "follow" or "behind" a vehicle, "view=above", "eye=x,y,z;look=x,y,z" (m in W). */
    selectView(wanted) {
      const player = this.player;
      const vehicle = player.scene.vehicles.find((v) => v.name === (wanted.follow || wanted.behind));
      if (vehicle) this.follow(vehicle, wanted.behind !== undefined, true);
      else if (wanted.view === "above") this.above(true);
      const eye = pointOf(wanted.eye), look = pointOf(wanted.look);
      if (eye && look) {
        player.eye.free();
        player.eye.go(eye, look, true);
      }
      if (["0", "1", "2"].includes(wanted.quality)) player.setQuality(Number(wanted.quality));
      for (const name of (wanted.hide || "").split(",")) {
        const box = player.stage.querySelector("[data-show='" + name.replace(/[^a-z]/g, "") + "']");
        if (box) player.show[box.dataset.show] = box.checked = false;
      }
    }

    update() {
      const { player, find } = this;
      find("simple").checked = player.quality <= 0;
      player.scene.vehicles.forEach((vehicle, v) => {
        const cells = this.rows[v].cells;
        cells[1].textContent = vehicle.speed.toFixed(1) + " m/s";
        cells[2].textContent = vehicle.height === null ? "" : vehicle.height.toFixed(1).replace("-0.0", "0.0") + " m up";
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
  Replay.ViewControls = ViewControls;
})(window);
