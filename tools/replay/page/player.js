"use strict";
// Player: reads the page's data, draws, and handles time, camera and views.
(function (root) {
  const Replay = (root.VinerowReplay = root.VinerowReplay || {});

  const kSpeeds = [1, 2, 4, 8, 16, 32, 64];
  const kStep_s = 5;
  const kLead_s = 1;  // time shown before the first motion
  const kLongest_s = 1;  // longest step while playing, so that a page from the background does not jump

  class Player {
    constructor(stage) {
      this.stage = stage;
      this.find = (name) => stage.querySelector(".vr-" + name);
      this.canvas = stage.querySelector("canvas");
      this.t = 0;
      this.playing = false;
      this.speed = 4;
      this.dirty = true;
      this.costs = [];
      this.quality = 2;  // 2: shadows, full resolution; 1: coarser leaves, lower resolution; 0: also no shadows
      this.show = { canopy: true, plans: true, trails: true, labels: true };
    }

    start() {
      const text = (id) => document.getElementById("vinerow-replay-" + id).textContent;
      this.index = JSON.parse(text("index"));
      if (!this.openCanvas()) return;
      const tracks = Replay.readTracks(this.index, Replay.decodeBase64(text("tracks")));
      const textures = Replay.makeTextures(
        this.index.textures, Replay.decodeBase64(text("textures")), Math.min(8, this.renderer.capabilities.getMaxAnisotropy()));
      new THREE.GLTFLoader().parse(
        Replay.decodeBase64(text("scene")).buffer, "",
        (gltf) => {
          try {
            this.begin(gltf, tracks, textures);
          } catch (error) {
            this.fail("The replay cannot be shown: " + error.message + ".");
            throw error;
          }
        },
        (error) => this.fail("The scene cannot be read: " + error.message + "."));
    }

    /** Whether a software renderer replaces the graphics card, which is tens of times slower. */
    drawsInSoftware() {
      const context = document.createElement("canvas").getContext("webgl");
      const names = context && context.getExtension("WEBGL_debug_renderer_info");
      const name = names ? context.getParameter(names.UNMASKED_RENDERER_WEBGL) : "";
      return /swiftshader|llvmpipe|software|basic render/i.test(name);
    }

    openCanvas() {
      const plain = this.drawsInSoftware();
      const options = { canvas: this.canvas, antialias: !plain, powerPreference: "high-performance" };
      const attributes = { antialias: !plain, alpha: false, depth: true };
      const context = this.canvas.getContext("webgl", attributes);
      if (!context) {
        this.fail("This browser cannot draw 3D graphics (WebGL is off or missing), so the replay cannot be shown.");
        return false;
      }
      options.context = context;
      this.renderer = new THREE.WebGLRenderer(options);
      if (plain) this.quality = 0;
      this.renderer.gammaOutput = true;
      this.renderer.gammaFactor = 2.2;
      this.renderer.toneMapping = THREE.ACESFilmicToneMapping;
      this.renderer.shadowMap.enabled = true;
      this.renderer.shadowMap.type = THREE.PCFSoftShadowMap;
      return true;
    }

    fail(sentence) {
      this.stage.dataset.state = "failed";
      this.find("message").textContent = sentence;
    }

    begin(gltf, tracks, textures) {
      this.scene = new Replay.Scene(gltf, this.index, tracks, textures);
      this.eye = new Replay.Eye(this.canvas, this.scene);
      this.controls = new Replay.Controls(this);
      this.resize();
      this.open();
      this.controls.readAddress();
      if (this.quality === 0) this.tellSimple();
      this.eye.controls.addEventListener("change", () => (this.dirty = true));
      // A resized canvas is empty until it is drawn, so draw before the page is shown.
      new ResizeObserver(() => {
        this.resize();
        this.draw();
      }).observe(this.stage);
      window.addEventListener("beforeprint", () => this.draw());
      this.stage.dataset.state = "ready";
      this.tick(0);
      let last = null;
      const frame = (now) => {
        const dt = last === null ? 0 : Math.min((now - last) / 1000, kLongest_s);
        last = now;
        this.tick(dt);
        window.requestAnimationFrame(frame);
      };
      window.requestAnimationFrame(frame);
    }

    /** Start time and view: shortly before the first motion, at the place of it. */
    open() {
      const first = this.scene.firstMove();
      this.seek(first ? Math.max(first.t - kLead_s, 0) : 0);
      this.eye.whole(this.index.ground, this.scene.sun.userData.direction, true);
      if (first && !this.eye.sees(first.vehicle.position)) this.eye.follow(first.vehicle, false, true);
    }

    tellSimple() {
      this.stage.classList.add("vr-told");
      this.find("hint").textContent = "Simple view: this browser seems to draw without a graphics card.";
    }

    resize() {
      const width = Math.max(this.stage.clientWidth, 1), height = Math.max(this.stage.clientHeight, 1);
      this.renderer.setPixelRatio(this.quality === 0 ? 0.7 : this.quality < 2 ? 1 : Math.min(window.devicePixelRatio || 1, 2));
      this.scene.sun.castShadow = this.quality > 0;
      this.renderer.setSize(width, height, false);
      this.eye.reshape(width / height);
      this.dirty = true;
    }

    seek(t) {
      this.t = Math.min(Math.max(t, 0), this.index.duration_s);
      this.scene.setTime(this.t);
      this.dirty = true;
    }

    play(on) {
      if (on && this.t >= this.index.duration_s) this.seek(0);
      this.playing = on;
      this.dirty = true;
    }

    changeSpeed(steps) {
      const at = kSpeeds.indexOf(this.speed) + steps;
      this.speed = kSpeeds[Math.min(Math.max(at, 0), kSpeeds.length - 1)];
      this.dirty = true;
    }

    tick(dt) {
      if (this.playing) {
        this.seek(this.t + dt * this.speed);
        if (this.t >= this.index.duration_s) this.playing = false;
      }
      if (this.eye.update(dt)) this.dirty = true;
      if (!this.dirty) return;
      this.dirty = false;
      this.controls.update();
      const before = performance.now();
      this.draw();
      this.watchCost(performance.now() - before, dt);
    }

    draw() {
      const size = this.renderer.getDrawingBufferSize(new THREE.Vector2()), camera = this.eye.camera;
      this.scene.canopy.visible = this.show.canopy;
      this.scene.plans.visible = this.show.plans;
      this.scene.trails.visible = this.show.trails;
      this.scene.setFocus(this.eye.followed, this.t);
      camera.updateMatrixWorld();
      this.scene.prepare(camera, size.x, size.y, [0.2, 0.4, 1][this.quality]);
      const reach = this.eye.shadowReach(), ahead = camera.getWorldDirection(new THREE.Vector3()).setZ(0);
      Replay.aimSun(this.scene.sun, this.eye.controls.target.clone().addScaledVector(ahead, 0.25 * reach), reach);
      this.renderer.render(this.scene.scene, camera);
      this.controls.placeLabels(camera);
      this.stage.dataset.frames = String(Number(this.stage.dataset.frames || 0) + 1);
    }

    /** Lowers the quality if drawing is slow, as on a machine without a graphics card. */
    watchCost(cost_ms, dt) {
      if (!this.playing || this.quality === 0) return;
      this.costs.push(Math.max(cost_ms, 1000 * dt));
      // Do not measure further: sixteen frames of a second each would take too long.
      const slow = this.costs.length >= 3 && Math.min(...this.costs.slice(-2)) > 400;
      if (this.costs.length < 16 && !slow) return;
      const mean = this.costs.slice(4).reduce((a, b) => a + b, 0) / (this.costs.length - 4);
      this.costs = [];
      if (!slow && mean < 70) return;
      this.setQuality(slow ? 0 : this.quality - 1);
      if (this.quality === 0) this.tellSimple();
    }

    setQuality(quality) {
      this.quality = quality;
      this.resize();
    }
  }
  Replay.Player = Player;
  Replay.kSpeeds = kSpeeds;
  Replay.kStep_s = kStep_s;

  /** Starts when the replay becomes visible, so that a report that is only read costs nothing. */
  Replay.start = function () {
    const stage = document.getElementById("vinerow-replay");
    const player = (Replay.player = new Player(stage));
    const begin = () => {
      stage.dataset.state = "reading";
      window.setTimeout(() => {
        try {
          player.start();
        } catch (error) {
          player.fail("The replay cannot be shown: " + error.message + ".");
          throw error;
        }
      }, 30);
    };
    // A report starts the replay when it becomes visible; a page with only the replay starts at once.
    const margin = -60, box = stage.getBoundingClientRect();
    if (box.top < window.innerHeight + margin && box.bottom > -margin) {
      begin();
      return;
    }
    const watch = new IntersectionObserver((entries) => {
      if (!entries.some((entry) => entry.isIntersecting)) return;
      watch.disconnect();
      begin();
    }, { rootMargin: margin + "px" });
    watch.observe(stage);
  };
})(window);
