"use strict";
// Bar below the picture: pause, steps, speed, reset, and simulated time. The run decides; this shows its parameters.
(function (root) {
  const Live = (root.VinerowLive = root.VinerowLive || {});
  const { clock } = root.VinerowReplay;

  // Of simulation_interfaces: SimulationState, Result, ResetSimulation.
  const kPlaying = 1, kPaused = 2, kDone = 1, kResetDefault = 0;
  const kSpeeds = [0.25, 0.5, 1, 2, 5, 0];  // 0: as fast as possible

  Live.kParameters = [
    "speed", "paused", "scenario", "seed", "duration_s", "step_s", "over", "real_time_factor", "command_topics",
  ];

  const words = (speed) => (speed === 0 ? "max" : speed + "×");

  class RunBar {
    /** @param complain is called with a sentence */
    constructor(stage, socket, complain) {
      Object.assign(this, { socket, complain });
      this.find = (name) => stage.querySelector(name);
      this.shown = {};
      const press = (name, action) => this.find(name).addEventListener("click", action);
      press(".vr-play", () => this.pause(!this.isPaused()));
      press(".vl-step", () => this.step(1));
      press(".vl-steps", () => this.step(Number(this.find(".vl-count").value)));
      press(".vl-reset", () => this.reset());
      this.find(".vl-count").addEventListener("keydown", (event) => {
        if (event.key === "Enter") this.step(Number(event.target.value));
      });
      for (const speed of kSpeeds) this.find(".vr-speed").append(new Option(words(speed), String(speed)));
      this.find(".vr-speed").addEventListener("change", () => socket.setParameter("speed", Number(this.find(".vr-speed").value)));
      for (const kind of ["state", "parameters", "services"]) socket.addEventListener(kind, () => this.update());
      this.update();
    }

    isPaused() {
      return this.socket.parameters.paused === true;
    }

    isOver() {
      return this.socket.parameters.over === true;
    }

    canAct() {
      return this.socket.state === "open";
    }

    async ask(name, request) {
      try {
        const { result } = await this.socket.call(name, request);
        if (result && result.result !== kDone) throw new Error(result.error_message || "the run refused " + name);
      } catch (error) {
        this.complain(error.message);
      }
    }

    pause(on) {
      if (!this.canAct() || this.isOver()) return;
      this.ask("/run/set_simulation_state", { state: { state: on ? kPaused : kPlaying } });
    }

    step(steps) {
      if (!this.canAct() || this.isOver() || !this.isPaused() || !(steps >= 1)) return;
      this.ask("/run/step_simulation", { steps: Math.floor(steps) });
    }

    reset() {
      if (this.canAct() && !this.isOver()) this.ask("/run/reset_simulation", { scope: kResetDefault });
    }

    changeSpeed(by) {
      const at = kSpeeds.indexOf(this.socket.parameters.speed), next = kSpeeds[Math.min(Math.max(at + by, 0), kSpeeds.length - 1)];
      if (at >= 0 && this.canAct()) this.socket.setParameter("speed", next);
    }

    update() {
      const { paused, over, speed, duration_s: duration, step_s: step, real_time_factor: factor } = this.socket.parameters;
      const isOpen = this.canAct(), canRun = isOpen && !over, canStep = canRun && paused === true;
      const play = this.find(".vr-play"), steps = [".vl-step", ".vl-steps", ".vl-count"];
      play.disabled = !canRun;
      play.classList.toggle("vr-playing", !paused && !over);
      play.title = (paused ? "continue" : "pause") + " (space)";
      play.setAttribute("aria-label", paused ? "continue" : "pause");
      for (const name of steps) this.find(name).disabled = !canStep;
      const length = step > 0 ? " of " + Number((1000 * step).toPrecision(6)) + " ms" : "";
      this.find(".vl-step").title = canStep ? "one step" + length + " (.)" : "one step; pause the run first";
      this.find(".vl-reset").disabled = !canRun;
      const list = this.find(".vr-speed");
      list.disabled = !isOpen;
      if (typeof speed === "number" && document.activeElement !== list) {
        // Another client may have set a speed that the list lacks.
        if (![...list.options].some((option) => option.value === String(speed))) list.append(new Option(words(speed), String(speed)));
        list.value = String(speed);
      }
      this.find(".vr-length").textContent = duration > 0 ? "/ " + clock(duration) : "";
      const hasFactor = isOpen && typeof factor === "number" && !paused && !over;
      this.find(".vl-factor").textContent = hasFactor ? factor.toFixed(factor < 9.95 ? 2 : 0) + " ×" : "";
      const state = !isOpen ? "" : over ? "The run is over." : paused ? "Paused" : "";
      this.find(".vr-now").textContent = state;
    }

    /** @param t simulated time, s; null: unknown */
    showTime(t) {
      const text = t === null ? "--:--.-" : this.isPaused() ? clock(t - (t % 1)).replace(/\.0$/, (t % 1).toFixed(3).slice(1)) : clock(t);
      if (text !== this.shown.text) this.find(".vr-time").textContent = this.shown.text = text;
      const { duration_s: duration } = this.socket.parameters, share = duration > 0 && t !== null ? Math.min(t / duration, 1) : 0;
      const width = (100 * share).toFixed(1) + "%";
      if (width !== this.shown.width) this.find(".vl-progress").style.width = this.shown.width = width;
    }
  }
  Live.RunBar = RunBar;
})(window);
