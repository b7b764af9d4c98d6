"use strict";
// Camera: orbits freely, follows a vehicle, or stays behind one.
(function (root) {
  const Replay = (root.VinerowReplay = root.VinerowReplay || {});

  const kFlight_s = 0.7;  // transition from one view to the next

  class Eye {
    constructor(canvas, scene) {
      this.scene = scene;
      this.camera = new THREE.PerspectiveCamera(42, 1, 0.5, 6000);
      this.camera.up.set(0, 0, 1);
      this.controls = new THREE.OrbitControls(this.camera, canvas);
      this.controls.enableKeys = false;
      this.controls.minDistance = 0.6;
      this.controls.maxDistance = 2500;
      this.controls.maxPolarAngle = 0.495 * Math.PI;
      this.controls.zoomSpeed = 1.2;
      this.followed = null;  // vehicle
      this.behind = false;
      this.flight = null;
      this.fitted = null;  // function that finds the current view again after a change of size
      this.last = { position: new THREE.Vector3(), yaw: 0 };
      const own = () => (this.flight = this.fitted = null);
      this.controls.addEventListener("start", own);
      canvas.addEventListener("wheel", own);
    }

    /** Moves to a view, at once or smoothly. */
    go(position, target, at_once) {
      if (at_once) {
        this.camera.position.copy(position);
        this.controls.target.copy(target);
        this.controls.update();
        this.flight = null;
        return;
      }
      this.flight = {
        share: 0, position, target, fromPosition: this.camera.position.clone(), fromTarget: this.controls.target.clone(),
      };
    }

    /** Fits the places into the picture, seen from a direction (towards the camera). */
    fit(places, direction, at_once) {
      const away = direction.clone().normalize();
      const right = new THREE.Vector3(0, 0, 1).cross(away).normalize(), up = away.clone().cross(right);
      const tangent = Math.tan(0.5 * this.camera.fov * Math.PI / 180), wide = tangent * this.camera.aspect;
      // Centre the view: a near edge needs more space than a far one, so iterate a few times.
      const centre = new THREE.Box3().setFromPoints(places).getCenter(new THREE.Vector3());
      const distanceFor = () => {
        let needed = 3;
        for (const place of places) {
          const p = place.clone().sub(centre), nearer = p.dot(away);
          // Panels cover some of the height and of the width.
          needed = Math.max(needed, nearer + Math.abs(p.dot(right)) / (0.92 * wide), nearer + Math.abs(p.dot(up)) / (0.66 * tangent));
        }
        return needed;
      };
      for (let round = 0; round < 8; ++round) {
        const distance = distanceFor();
        const sides = { low: Infinity, high: -Infinity, left: Infinity, right: -Infinity };
        for (const place of places) {
          const p = place.clone().sub(centre), depth = distance - p.dot(away);
          sides.low = Math.min(sides.low, p.dot(up) / depth);
          sides.high = Math.max(sides.high, p.dot(up) / depth);
          sides.left = Math.min(sides.left, p.dot(right) / depth);
          sides.right = Math.max(sides.right, p.dot(right) / depth);
        }
        centre.addScaledVector(up, 0.5 * (sides.low + sides.high) * distance);
        centre.addScaledVector(right, 0.5 * (sides.left + sides.right) * distance);
      }
      const distance = distanceFor();
      this.free();
      this.fitted = { places, direction };
      this.go(centre.clone().addScaledVector(away, distance), centre, at_once);
    }

    /** View of the whole scene: slightly oblique, its long side across the picture, light from the camera's side. */
    whole(ground, sun, at_once) {
      const places = this.scene.home(ground, 0);
      let best = null, most = -Infinity;
      for (let k = 0; k < 36; ++k) {
        const azimuth = (k * Math.PI) / 18, x = Math.cos(azimuth), y = Math.sin(azimuth);
        let low = Infinity, high = -Infinity, near = Infinity, far = -Infinity;
        for (const p of places) {
          const across = x * p.y - y * p.x, along = x * p.x + y * p.y;
          low = Math.min(low, across);
          high = Math.max(high, across);
          near = Math.min(near, along);
          far = Math.max(far, along);
        }
        const score = (high - low) / Math.hypot(high - low, far - near) + 0.3 * (x * sun.x + y * sun.y);
        if (score > most + 1e-9) {
          most = score;
          best = azimuth;
        }
      }
      best += 0.3;
      this.fit(places, new THREE.Vector3(Math.cos(best), Math.sin(best), 0.4), at_once);
    }

    above(ground, at_once) {
      this.fit(this.scene.home(ground, 0), new THREE.Vector3(0, -0.002, 1), at_once);
    }

    free() {
      this.followed = this.fitted = null;
      this.behind = false;
    }

    /** Adapts to a new aspect ratio of the picture. */
    reshape(aspect) {
      this.camera.aspect = aspect;
      this.camera.updateProjectionMatrix();
      if (this.fitted) this.fit(this.fitted.places, this.fitted.direction, true);
    }

    /** @param behind turns with the vehicle */
    follow(vehicle, behind, at_once) {
      const size = Math.max(vehicle.track.entry.size_m, 0.5), direction = new THREE.Vector3();
      const yaw = vehicle.yaw + (behind ? 0 : 0.6);
      direction.set(-Math.cos(yaw), -Math.sin(yaw), behind ? 0.36 : 0.55).normalize();
      const target = this.aimOf(vehicle);
      this.free();
      this.followed = vehicle;
      this.behind = behind;
      this.remember();
      this.go(target.clone().addScaledVector(direction, behind ? 2.6 * size + 1.6 : 4.2 * size + 2.5), target, at_once);
    }

    /** Whether a place is in the picture. */
    sees(place) {
      this.camera.updateMatrixWorld();
      const at = place.clone().project(this.camera);
      return Math.abs(at.x) < 1 && Math.abs(at.y) < 1 && Math.abs(at.z) < 1;
    }

    aimOf(vehicle) {
      const up = vehicle.track.entry.flies ? 0 : 0.35 * vehicle.track.entry.size_m;
      return vehicle.position.clone().add(new THREE.Vector3(0, 0, up));
    }

    remember() {
      this.last.position.copy(this.followed.position);
      this.last.yaw = this.followed.yaw;
    }

    /** @param dt wall time, s @returns whether the view has moved */
    update(dt) {
      let moved = false;
      if (this.followed) {
        const step = this.followed.position.clone().sub(this.last.position);
        let turn = this.followed.yaw - this.last.yaw;
        turn = Math.atan2(Math.sin(turn), Math.cos(turn));
        moved = step.lengthSq() > 0 || turn !== 0;
        const places = [[this.camera.position, this.controls.target]];
        if (this.flight) places.push([this.flight.position, this.flight.target], [this.flight.fromPosition, this.flight.fromTarget]);
        for (const [position, target] of places) {
          position.add(step);
          target.add(step);
          if (this.behind) position.sub(target).applyAxisAngle(new THREE.Vector3(0, 0, 1), turn).add(target);
        }
        this.remember();
      }
      if (this.flight) {
        const flight = this.flight;
        flight.share = Math.min(1, flight.share + dt / kFlight_s);
        const s = flight.share * flight.share * (3 - 2 * flight.share);
        this.camera.position.lerpVectors(flight.fromPosition, flight.position, s);
        this.controls.target.lerpVectors(flight.fromTarget, flight.target, s);
        if (flight.share === 1) this.flight = null;
        moved = true;
      }
      this.controls.update();
      const distance = this.camera.position.distanceTo(this.controls.target);
      const near = Math.min(Math.max(0.02 * distance, 0.05), 5);
      if (Math.abs(near - this.camera.near) > 0.1 * near) {
        this.camera.near = near;
        this.camera.updateProjectionMatrix();
      }
      return moved;
    }

    /** Half the side of the square on which shadows are drawn. */
    shadowReach() {
      const distance = this.camera.position.distanceTo(this.controls.target);
      return Math.min(Math.max(0.75 * distance, 9), 130);
    }
  }

  Replay.Eye = Eye;
})(typeof window === "undefined" ? globalThis : window);
