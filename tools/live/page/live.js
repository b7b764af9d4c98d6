"use strict";
// The page: loads the scene, connects the socket with picture, plots, driving, events, and draws once per frame.
(function (root) {
  const Live = (root.VinerowLive = root.VinerowLive || {});
  const Replay = root.VinerowReplay;

  const kLongest_s = 1;  // step of the loop without picture
  const kHint_ms = 12000;  // words on mouse and keys are in view

  /** Address of a file or of the socket beside this page, with the token that the page was opened with. */
  function address(name, protocol) {
    const url = new URL(name, document.baseURI), token = new URLSearchParams(location.search).get("token");
    url.hash = url.search = "";
    if (protocol) url.protocol = location.protocol === "https:" ? "wss:" : "ws:";
    if (token !== null) url.searchParams.set("token", token);
    return url.href;
  }

  async function load(name, kind) {
    const response = await fetch(address(name), { cache: "no-cache" });
    if (!response.ok) throw new Error(name + " cannot be loaded (" + response.status + ")");
    return response[kind]();
  }

  /** Buttons and keys of the picture, and keys of the run. */
  class Controls extends Replay.ViewControls {
    constructor(view, bar) {
      super(view);
      this.listenToKeys({
        " ": () => bar.pause(!bar.isPaused()),
        ".": () => bar.step(1),
        "+": () => bar.changeSpeed(1),
        "-": () => bar.changeSpeed(-1),
      });
    }
  }

  class LiveView extends Replay.View {
    constructor(app, stage) {
      super(stage, "picture of the run");
      this.app = app;
      this.lowest = -1;  // it moves all the time, so smoothness counts more than in a replay
    }

    begin(gltf, tracks, textures) {
      this.scene = new Live.Scene(gltf, this.index, tracks, textures);
      this.eye = new Replay.Eye(this.canvas, this.scene);
      this.controls = new Controls(this, this.app.bar);
      this.resize();
      this.scene.setTime(0);
      this.eye.whole(this.index.ground, this.scene.sun.userData.direction, true);
      const { vehicles } = this.scene;
      if (vehicles.length > 0 && !vehicles.some((vehicle) => this.eye.sees(vehicle.position))) this.eye.follow(vehicles[0], false, true);
      this.controls.selectView(this.app.wanted);
      this.run();
      window.setTimeout(() => this.stage.classList.add("vr-touched"), kHint_ms);
    }

    tick(dt) {
      const t = this.app.tick(dt);
      if (t !== null) {
        this.t = t;
        this.scene.setTime(t);
        this.scene.measureGround(dt);
        this.dirty = true;
      }
      this.frame(dt, t !== null);
    }
  }

  class App {
    constructor() {
      const stage = document.getElementById("vinerow-live"), panel = (name) => document.getElementById("vinerow-" + name);
      this.stage = stage;
      this.wanted = Replay.readAddress("live") || {};
      this.socket = new Live.Socket(address("./", true));
      this.socket.parameterNames = Live.kParameters;
      this.clock = new Live.Clock();
      this.time = null;  // simulated time of the run, s
      this.tracks = [];
      this.events = new Live.Events(panel("events"));
      this.bar = new Live.RunBar(stage, this.socket, (sentence) => this.complain(sentence));
      this.plots = new Live.Plots(panel("plots"), this.socket, () => this.writeAddress());
      this.drive = new Live.Drive(panel("drive"), stage, this.socket, () => this.time || 0);
      this.view = new LiveView(this, stage);
      if (this.wanted.window) this.plots.setWindow(Number(this.wanted.window));
      if (this.wanted.plot) this.plots.fromText(this.wanted.plot);
      this.isReady = true;
    }

    complain(sentence) {
      this.events.add(2, this.time, "", sentence.charAt(0).toUpperCase() + sentence.slice(1) + ".");
    }

    async start() {
      this.stage.dataset.state = "reading";
      this.listen();
      const text = await load("index.json", "text");
      this.indexText = text;
      const index = (this.view.index = JSON.parse(text));
      document.title = index.name + " · live";
      this.tracks = index.vehicles.map((entry) => new Live.Track(entry));
      this.drive.setVehicles(index.vehicles);
      for (const track of this.tracks) this.follow(track);
      this.socket.connect();
      if (!this.view.openCanvas()) {
        this.runWithoutPicture();
        return;
      }
      const [pictures, scene] = await Promise.all([load("textures.bin", "arrayBuffer"), load("scene.glb", "arrayBuffer")]);
      const textures = Replay.makeTextures(index.textures, new Uint8Array(pictures), this.view.anisotropy());
      const gltf = await new Promise((resolve, reject) => new THREE.GLTFLoader().parse(scene, "", resolve, reject));
      this.view.begin(gltf, this.tracks, textures);
    }

    /** Feeds a vehicle's track from its channels. */
    follow(track) {
      const { socket } = this, start = "/" + track.name + "/";
      const arrive = (t) => {
        this.clock.arrive(t, performance.now() / 1000);
        this.setTime(t);
      };
      socket.want(start + "truth", (message, t) => {
        track.addOdometry(message, t);
        arrive(t);
      });
      socket.want(start + "links", (message, t) => {
        track.addLinks(message, t);
        arrive(t);
      });
      socket.want(start + "plan", (message) => {
        track.addPlan(message);
        this.isNew = true;
      });
    }

    listen() {
      const { socket } = this, on = (kind, action) => socket.addEventListener(kind, (event) => action(event.detail));
      on("state", () => this.showConnection());
      on("session", (session) => this.beginSession(session));
      on("time", (t) => this.setTime(t));
      on("status", ({ level, message, id }) => this.events.add(level, this.time, "server", message, id));
      on("parameters", () => this.showConnection());
      on("unstatus", (ids) => this.events.remove(ids));
      on("malformed", (error) => {
        if (socket.malformed === 1) this.events.add(1, this.time, "page", "A message of the run cannot be read and is ignored: " + error.message);
        this.showConnection();
      });
      socket.want("/run/events", (message, t) => this.events.addLog(message, t));
      this.showConnection();
    }

    setTime(t) {
      if (this.time === null || t > this.time) this.time = t;
    }

    /** The run was reset, or another run answers at this address. */
    async beginSession({ first, same_connection: isReset }) {
      if (first) return;
      this.clear();
      if (isReset) {
        this.events.add(0, 0, "page", "The run was reset.");
        return;
      }
      this.events.add(0, null, "page", "Connected to a new run.");
      try {
        // Another scenario has another scene.
        if ((await load("index.json", "text")) !== this.indexText) location.reload();
      } catch (error) {
        this.complain(error.message);
      }
    }

    clear() {
      this.clock.clear();
      this.time = null;
      for (const track of this.tracks) track.clear();
      for (const track of this.tracks) track.hasNewPlan = true;
      this.plots.clear();
      this.isNew = true;
    }

    showConnection() {
      const { state, malformed, parameters } = this.socket;
      const words = [{ open: "connected", connecting: "connecting …", closed: "no connection" }[state]];
      if (state === "open" && parameters.seed !== undefined) words.push("seed " + parameters.seed);
      if (malformed > 0) words.push(malformed + " unreadable");
      this.stage.dataset.link = state;
      this.stage.querySelector(".vl-link").textContent = words.join(" · ");
      if (state === "open") this.wasOpen = true;
      // Attempts alternate between two states; the sentence stays.
      this.stage.querySelector(".vl-gone").hidden = state === "open";
      this.stage.querySelector(".vl-gone").textContent = this.wasOpen
        ? "The run does not answer. This is its last picture; the page tries to connect every second."
        : "Connecting to the run …";
    }

    /** One frame without the picture. @returns time of the picture if it has changed, s; else null */
    tick(dt) {
      const moved = this.clock.advance(dt, performance.now() / 1000) || this.isNew;
      this.isNew = false;
      this.bar.showTime(this.time);
      this.plots.frame(this.time || 0, dt);
      return moved ? this.clock.t || 0 : null;
    }

    runWithoutPicture() {
      let last = null;
      const frame = (now) => {
        this.tick(last === null ? 0 : Math.min((now - last) / 1000, kLongest_s));
        last = now;
        window.requestAnimationFrame(frame);
      };
      window.requestAnimationFrame(frame);
    }

    /** Keeps the choice of plots in the address, so that it survives a reload and can be sent to others. */
    writeAddress() {
      if (!this.isReady) return;
      const parts = Object.assign({}, this.wanted, { plot: this.plots.toText(), window: String(this.plots.window_s) });
      const text = Object.entries(parts).filter(([, value]) => value !== "").map(([key, value]) => key + "=" + value).join(";");
      history.replaceState(null, "", location.pathname + location.search + "#live:" + encodeURI(text).replace(/#/g, "%23"));
    }
  }

  const app = (Live.app = new App());
  app.start().catch((error) => {
    app.view.fail("The run cannot be shown: " + error.message + ".");
    throw error;
  });
})(window);
