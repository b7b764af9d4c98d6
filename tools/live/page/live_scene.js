"use strict";
// Scene of a live run: the replay's, with trails that grow, plans that are replaced, and rotors found while they turn.
(function (root) {
  const Live = (root.VinerowLive = root.VinerowLive || {});
  const Replay = root.VinerowReplay;

  const kGround_s = 0.7;  // wall time between two measurements of the ground below flying vehicles

  class Scene extends Replay.Scene {
    addTrail(vehicle) {
      const line = this.addTrailLine(vehicle, new Float32Array(6 * Live.Track.kPoints));
      line.geometry.attributes.instanceStart.data.setUsage(THREE.DynamicDrawUsage);
      return line;
    }

    showTrail(vehicle, at, t) {
      const { track, trail } = vehicle, { times } = track.trail;
      if (track.trail.isNew) this.writeTrail(vehicle);
      let passed = times.length;
      while (passed > 0 && times[passed - 1] > t) --passed;
      trail.geometry.maxInstancedCount = Math.max(passed - 1, 0);
      trail.visible = passed > 1;
    }

    /** Copies the trail's points as ends of segments, on the ground for vehicles that drive. */
    writeTrail({ track, trail }) {
      const { points } = track.trail, data = trail.geometry.attributes.instanceStart.data, segments = points.length / 3 - 1;
      const down = track.entry.flies ? 0 : track.entry.foot_m - Replay.kHover - 0.01 * track.entry.index;
      for (let i = 0; i < segments; ++i) {
        for (let k = 0; k < 6; ++k) data.array[6 * i + k] = points[3 * i + k] - (k % 3 === 2 ? down : 0);
      }
      data.updateRange.offset = 0;
      data.updateRange.count = 6 * Math.max(segments, 0);
      data.needsUpdate = true;
      track.trail.isNew = false;
    }

    showPlan(vehicle, t) {
      const { track } = vehicle;
      if (track.hasNewPlan) {
        for (const line of vehicle.plans) {
          this.plans.remove(line);
          this.lineMaterials.splice(this.lineMaterials.indexOf(line.material), 1);
          line.geometry.dispose();
          line.material.dispose();
        }
        vehicle.plans = track.plans.map((plan) => this.addPlan(vehicle, plan));
        track.hasNewPlan = false;
      }
      super.showPlan(vehicle, t);
    }

    setLink(track, part, at, t) {
      if (part.link.axis && !part.disc) part.disc = Replay.addDisc(part.object, part.link.axis);
      super.setLink(track, part, at, t);
      if (!track.areLinksInWorld(at)) return;
      const { parent } = part.object;
      parent.updateMatrix();
      part.object.matrix.premultiply(new THREE.Matrix4().getInverse(parent.matrix));
    }

    /** Ground below flying vehicles, by rays; seldom, as each meets thousands of triangles: a plane serves between. @param dt s */
    measureGround(dt) {
      this.unmeasured_s = (this.unmeasured_s === undefined ? kGround_s : this.unmeasured_s) + dt;
      const flying = this.vehicles.filter((vehicle) => vehicle.track.entry.flies);
      if (flying.length === 0 || this.unmeasured_s < kGround_s) return;
      this.unmeasured_s = 0;
      const terrain = this.world.children.filter((object) => object.userData.part === "terrain");
      for (const { track, position } of flying) {
        const from = position.clone().setZ(position.z + 500);
        const hits = new THREE.Raycaster(from, new THREE.Vector3(0, 0, -1)).intersectObjects(terrain, true);
        const normal = hits.length > 0 && hits[0].face.normal.clone().transformDirection(hits[0].object.matrixWorld);
        track.ground = normal && normal.z > 0.1 ? { point: hits[0].point, normal } : null;
      }
    }
  }
  Live.Scene = Scene;
})(window);
