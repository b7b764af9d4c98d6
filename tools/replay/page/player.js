"use strict";
// Player: reads the page's data, and handles time and the first view.
(function (root) {
  const Replay = (root.VinerowReplay = root.VinerowReplay || {});

  const kSpeeds = [1, 2, 4, 8, 16, 32, 64];
  const kStep_s = 5;
  const kLead_s = 1;  // time shown before the first motion

  class Player extends Replay.View {
    constructor(stage) {
      super(stage, "replay");
      this.playing = false;
      this.speed = 4;
    }

    start() {
      const text = (id) => document.getElementById("vinerow-replay-" + id).textContent;
      this.index = JSON.parse(text("index"));
      if (!this.openCanvas()) return;
      const tracks = Replay.readTracks(this.index, Replay.decodeBase64(text("tracks")));
      const textures = Replay.makeTextures(this.index.textures, Replay.decodeBase64(text("textures")), this.anisotropy());
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

    begin(gltf, tracks, textures) {
      this.scene = new Replay.Scene(gltf, this.index, tracks, textures);
      this.eye = new Replay.Eye(this.canvas, this.scene);
      this.controls = new Replay.Controls(this);
      this.resize();
      this.open();
      this.controls.readAddress();
      this.run();
    }

    /** Start time and view: shortly before the first motion, at the place of it. */
    open() {
      const first = this.scene.firstMove();
      this.seek(first ? Math.max(first.t - kLead_s, 0) : 0);
      this.eye.whole(this.index.ground, this.scene.sun.userData.direction, true);
      if (first && !this.eye.sees(first.vehicle.position)) this.eye.follow(first.vehicle, false, true);
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
      this.frame(dt, this.playing);
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
