"use strict";
// View: canvas, renderer, quality and drawing loop. What is shown comes from a player (a recorded run) or a live run.
(function (root) {
  const Replay = (root.VinerowReplay = root.VinerowReplay || {});

  const kRatios = { "-1": 0.45, 0: 0.7, 1: 1, 2: 2 };  // pixels drawn per pixel of the page, at most, by quality
  const kShares = { "-1": 0.2, 0: 0.2, 1: 0.4, 2: 1 };  // of the distances of detailed leaves
  const kLongest_s = 1;  // longest step of the loop, so that a page from the background does not jump

  class View {
    /** @param what name of the picture in messages, "replay" */
    constructor(stage, what) {
      this.stage = stage;
      this.what = what;
      this.find = (name) => stage.querySelector(".vr-" + name);
      this.canvas = stage.querySelector("canvas");
      this.t = 0;
      this.dirty = true;
      this.costs = [];
      this.quality = 2;  // 2: shadows, full resolution; 1: coarser leaves, lower resolution; 0: also no shadows; -1: also blurred
      this.lowest = 0;  // quality to which a slow picture may fall
      this.show = { canopy: true, plans: true, trails: true, labels: true };
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
        this.fail("This browser cannot draw 3D graphics (WebGL is off or missing), so the " + this.what + " cannot be shown.");
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

    /** Samples of a texture seen at a flat angle. Software takes each of them at full price. */
    anisotropy() {
      return this.quality > 0 ? Math.min(8, this.renderer.capabilities.getMaxAnisotropy()) : 1;
    }

    fail(sentence) {
      this.stage.dataset.state = "failed";
      this.find("message").textContent = sentence;
    }

    /** Draws whenever something has changed, from now on. @pre scene, eye and controls exist */
    run() {
      if (this.quality <= 0) this.tellSimple();
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

    tellSimple() {
      this.stage.classList.add("vr-told");
      this.find("hint").textContent = "Simple view: this browser seems to draw without a graphics card.";
    }

    resize() {
      const width = Math.max(this.stage.clientWidth, 1), height = Math.max(this.stage.clientHeight, 1);
      const ratio = kRatios[this.quality];
      this.renderer.setPixelRatio(ratio > 1 ? Math.min(window.devicePixelRatio || 1, ratio) : ratio);
      this.scene.sun.castShadow = this.quality > 0;
      this.renderer.setSize(width, height, false);
      this.eye.reshape(width / height);
      this.dirty = true;
    }

    /** One frame. @param dt wall time, s @param moving whether the picture changes by itself */
    frame(dt, moving) {
      if (this.eye.update(dt)) this.dirty = true;
      if (!this.dirty) return;
      this.dirty = false;
      this.controls.update();
      const before = performance.now();
      this.draw();
      if (moving) this.watchCost(performance.now() - before, dt);
    }

    draw() {
      const size = this.renderer.getDrawingBufferSize(new THREE.Vector2()), camera = this.eye.camera;
      this.scene.canopy.visible = this.show.canopy;
      this.scene.plans.visible = this.show.plans;
      this.scene.trails.visible = this.show.trails;
      this.scene.setFocus(this.eye.followed, this.t);
      camera.updateMatrixWorld();
      this.scene.prepare(camera, size.x, size.y, kShares[this.quality]);
      const reach = this.eye.shadowReach(), ahead = camera.getWorldDirection(new THREE.Vector3()).setZ(0);
      Replay.aimSun(this.scene.sun, this.eye.controls.target.clone().addScaledVector(ahead, 0.25 * reach), reach);
      this.renderer.render(this.scene.scene, camera);
      this.controls.placeLabels(camera);
      this.stage.dataset.frames = String(Number(this.stage.dataset.frames || 0) + 1);
    }

    /** Lowers the quality if drawing is slow, as on a machine without a graphics card. */
    watchCost(cost_ms, dt) {
      if (this.quality === this.lowest) return;
      this.costs.push(Math.max(cost_ms, 1000 * dt));
      // Do not measure further: sixteen frames of a second each would take too long.
      const slow = this.costs.length >= 3 && Math.min(...this.costs.slice(-2)) > 400;
      if (this.costs.length < 16 && !slow) return;
      const mean = this.costs.slice(4).reduce((a, b) => a + b, 0) / (this.costs.length - 4);
      this.costs = [];
      if (!slow && mean < 70) return;
      this.setQuality(slow && this.quality > 0 ? 0 : this.quality - 1);
      if (this.quality <= 0) this.tellSimple();
    }

    setQuality(quality) {
      this.quality = quality;
      this.resize();
    }
  }
  Replay.View = View;
})(window);
