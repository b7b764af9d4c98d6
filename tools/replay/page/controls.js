"use strict";
// Controls of a replay's time: buttons, keys, time line with phases.
(function (root) {
  const Replay = (root.VinerowReplay = root.VinerowReplay || {});
  const element = Replay.element;

  class Controls extends Replay.ViewControls {
    constructor(player) {
      super(player);
      const index = player.index;
      this.find("length").textContent = "/ " + Replay.clock(index.duration_s);
      const slider = this.find("slider");
      slider.max = String(index.duration_s);
      slider.addEventListener("input", () => player.seek(Number(slider.value)));
      this.makePhases();
      this.makeTimeButtons();
      this.listenToKeys({
        " ": () => player.play(!player.playing),
        ArrowLeft: () => player.seek(player.t - Replay.kStep_s),
        ArrowRight: () => player.seek(player.t + Replay.kStep_s),
        Home: () => player.seek(0),
        End: () => player.seek(player.index.duration_s),
        "+": () => player.changeSpeed(1),
        "-": () => player.changeSpeed(-1),
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

    makeTimeButtons() {
      const player = this.player;
      this.press("play", () => player.play(!player.playing));
      const speeds = this.find("speed");
      for (const speed of Replay.kSpeeds) speeds.append(new Option(speed + "×", String(speed)));
      speeds.addEventListener("change", () => {
        player.speed = Number(speeds.value);
        player.stage.focus({ preventScroll: true });
      });
    }

    /** "#replay:t=52;follow=drone;hide=canopy,plans;speed=8;play=1" opens the page at that instant; views as in selectView(). */
    readAddress() {
      const player = this.player, wanted = Replay.readAddress("replay");
      if (!wanted) return;
      if (Number.isFinite(Number(wanted.t))) player.seek(Number(wanted.t));
      this.selectView(wanted);
      if (wanted.speed && Replay.kSpeeds.includes(Number(wanted.speed))) player.speed = Number(wanted.speed);
      if (wanted.play === "1") player.play(true);
    }

    update() {
      super.update();
      const { player, find } = this;
      find("slider").value = String(player.t);
      find("time").textContent = Replay.clock(player.index.first_s + player.t);
      find("play").classList.toggle("vr-playing", player.playing);
      find("speed").value = String(player.speed);
      const running = player.index.phases.filter((phase) => phase.begin <= player.t && player.t < phase.end);
      find("now").textContent = running.map((phase) => phase.name).join(" · ");
    }
  }
  Replay.Controls = Controls;
})(window);

VinerowReplay.start();
