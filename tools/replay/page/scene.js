"use strict";
// World, vehicles and the lines over them. z is up, as in the log: glTF's y up is rotated back.
(function (root) {
  const Replay = (root.VinerowReplay = root.VinerowReplay || {});

  // Distances below which the finest and the middle leaves are drawn, m.
  const kLevels = [22, 320];
  // Height of lines above what they follow, m.
  const kHover = 0.07;
  // Displayed rotation rate of rotors.
  const kSpinTurns = 7.3;
  // Opacity of the other vehicles' trails while the camera follows one vehicle.
  const kFaint = 0.3;
  // Trails are hidden around the followed vehicle within this multiple of its size plus a margin, m.
  const kClear = 3, kClear_m = 2;
  // A vehicle farther than this from its start has departed, m.
  const kSetOut = 0.3;

  function worldMaterial(own, materials, cards) {
    if (cards) return materials.leaves[cards].material;
    if (!materials.plain.has(own)) {
      const plain = new THREE.MeshLambertMaterial({ color: own.color, side: own.side });
      plain.vertexColors = own.vertexColors;
      materials.plain.set(own, plain);
    }
    return materials.plain.get(own);
  }

  /** Gives the shader of a line its own uniform. */
  function setOpacity(material, opacity) {
    material.transparent = opacity < 1;
    material.opacity = opacity;
    if (material.uniforms.opacity) material.uniforms.opacity.value = opacity;
    else material.uniforms.opacity = { value: opacity };
    material.needsUpdate = true;
  }

  /** Hides a line within a reach of a place and fades it in up to twice the reach. @param clearing {place, reach} uniforms */
  function clearAround(material, clearing) {
    material.uniforms.clearPlace = clearing.place;
    material.uniforms.clearReach = clearing.reach;
    const own = (code, from, to) => code.replace(from, from + to);
    const fromPlace = "\nfromClear = mvPosition.xyz - (viewMatrix * vec4(clearPlace, 1.0)).xyz;\n";
    material.vertexShader = "uniform vec3 clearPlace;\nvarying vec3 fromClear;\n" +
      own(material.vertexShader, "vec4 mvPosition = ( position.y < 0.5 ) ? start : end;", fromPlace);
    const fade = "\ndiffuseColor.a *= clamp(length(fromClear) / max(clearReach, 1e-6) - 1.0, 0.0, 1.0);\nif (diffuseColor.a < 0.01) discard;\n";
    material.fragmentShader = "uniform float clearReach;\nvarying vec3 fromClear;\n" +
      own(material.fragmentShader, "vec4 diffuseColor = vec4( diffuse, opacity );", fade);
  }

  /** Moves an object from the file's tree to its pose in W. */
  function settle(object, parent) {
    object.matrix.copy(object.matrixWorld);
    object.matrixAutoUpdate = false;
    parent.add(object);
  }

  class Scene {
    /** @param gltf result of GLTFLoader @param index index of the page @param tracks tracks of data.js */
    constructor(gltf, index, tracks, textures) {
      this.scene = new THREE.Scene();
      this.sun = Replay.addLight(this.scene, index.light);
      this.sky = Replay.makeSky(index.light, textures);
      this.scene.add(this.sky);
      this.world = new THREE.Group();
      this.canopy = new THREE.Group();
      this.plans = new THREE.Group();
      this.trails = new THREE.Group();
      this.scene.add(this.world, this.canopy, this.plans, this.trails);
      this.levels = [];
      this.lineMaterials = [];
      this.arrangeWorld(gltf, index, textures);
      this.focus = null;  // vehicle that the camera follows
      this.vehicles = tracks.map((track, v) => this.addVehicle(track, v));
    }

    /** {vehicle, t} of the vehicle that moves first, s since the run's start; null if none moves. */
    firstMove() {
      let first = null;
      for (const vehicle of this.vehicles) {
        const { positions: p, times } = vehicle.track;
        for (let i = 1; i < times.length && (first === null || times[i] < first.t); ++i) {
          if (Math.hypot(p[3 * i] - p[0], p[3 * i + 1] - p[1], p[3 * i + 2] - p[2]) < kSetOut) continue;
          first = { vehicle, t: times[i] };
        }
      }
      return first;
    }

    /** Keeps lines of other vehicles clear of the followed one. */
    setFocus(vehicle, t) {
      for (const each of this.vehicles) {
        const clear = vehicle !== null && each !== vehicle;
        each.clearing.reach.value = clear ? kClear * vehicle.track.entry.size_m + kClear_m : 0;
        if (clear) each.clearing.place.value.copy(vehicle.position);
      }
      if (vehicle === this.focus) return;
      this.focus = vehicle;
      for (const each of this.vehicles) {
        const faint = vehicle !== null && each !== vehicle, material = each.trail.material;
        setOpacity(material, faint ? kFaint : 1);
        this.showPlan(each, t);
      }
    }

    showPlan(vehicle, t) {
      const current = this.focus === null || this.focus === vehicle ? vehicle.track.planAt(t) : -1;
      vehicle.plans.forEach((line, i) => (line.visible = i === current));
    }

    arrangeWorld(gltf, index, textures) {
      gltf.scene.rotation.x = Math.PI / 2;
      gltf.scene.updateMatrixWorld(true);
      const materials = { ground: Replay.makeGroundMaterial(index.ground, textures), leaves: {}, plain: new Map() };
      for (const name of ["leaf", "spray", "clump"]) materials.leaves[name] = Replay.makeLeafMaterial(textures[name]);
      const found = [], groups = new Map();
      this.links = new Map();
      gltf.scene.traverse((object) => {
        if (object.userData.part) found.push(object);
      });
      for (const object of found) {
        const data = object.userData;
        if (data.part === "link") {
          this.links.set(data.vehicle + "/" + data.link, object);
          object.traverse((mesh) => {
            if (mesh.isMesh) mesh.castShadow = mesh.receiveShadow = true;
          });
          continue;
        }
        object.receiveShadow = true;
        if (data.part === "terrain" || data.part === "surroundings" || data.surface === "terrain") {
          const isGround = data.part !== "world";
          object.material = isGround ? materials.ground : worldMaterial(object.material, materials);
          object.receiveShadow = data.part !== "surroundings";
          settle(object, this.world);
          continue;
        }
        object.material = worldMaterial(object.material, materials, data.cards);
        if (data.cards) object.customDepthMaterial = materials.leaves[data.cards].depth;
        object.castShadow = data.surface !== "wire";
        const foliage = data.surface === "canopy" || data.cards;
        settle(object, foliage ? this.canopy : this.world);
        if (data.group !== undefined) {
          if (!groups.has(data.group)) groups.set(data.group, []);
          groups.get(data.group)[data.level] = object;
        }
      }
      for (const levels of groups.values()) {
        const coarsest = levels[levels.length - 1];
        coarsest.geometry.computeBoundingSphere();
        const centre = coarsest.geometry.boundingSphere.center.clone().applyMatrix4(coarsest.matrix);
        this.levels.push({ levels, centre });
      }
    }

    addVehicle(track, v) {
      const vehicle = {
        track, name: track.name, colour: track.entry.colour,
        group: new THREE.Group(), links: [], position: new THREE.Vector3(), quaternion: new THREE.Quaternion(),
        yaw: 0, speed: 0,
      };
      this.scene.add(vehicle.group);
      track.links.forEach((link, l) => {
        const object = this.links.get(track.entry.index + "/" + l);
        if (!object) return;
        object.matrixAutoUpdate = false;
        vehicle.group.add(object);
        vehicle.links.push({ l, object, link, disc: link.axis ? addDisc(object, link.axis) : null });
      });
      vehicle.trail = this.addTrail(vehicle, v);
      vehicle.clearing = { place: { value: new THREE.Vector3() }, reach: { value: 0 } };
      clearAround(vehicle.trail.material, vehicle.clearing);
      vehicle.plans = track.plans.map((plan) => this.addPlan(vehicle, plan));
      return vehicle;
    }

    addLine(parent, pairs, colour, width, opacity) {
      const geometry = new THREE.LineSegmentsGeometry();
      geometry.setPositions(pairs);
      const material = new THREE.LineMaterial({ color: new THREE.Color(colour).getHex(), linewidth: width });
      setOpacity(material, opacity);
      material.fog = false;
      // Lines are symbols: their colours are screen colours, without tone mapping.
      material.fragmentShader = material.fragmentShader.replace("#include <tonemapping_fragment>", "").replace("#include <encodings_fragment>", "");
      this.lineMaterials.push(material);
      const line = new THREE.LineSegments2(geometry, material);
      line.frustumCulled = false;
      parent.add(line);
      return line;
    }

    /** Trail as pairs of points, of which those already passed are drawn. */
    addTrail(vehicle, v) {
      const track = vehicle.track, n = track.times.length, down = track.entry.foot_m - kHover - 0.01 * v;
      const pairs = new Float32Array(6 * Math.max(n - 1, 1));
      for (let i = 0; i + 1 < n; ++i) {
        for (let end = 0; end < 2; ++end) {
          for (let c = 0; c < 3; ++c) {
            pairs[6 * i + 3 * end + c] = track.positions[3 * (i + end) + c] - (c === 2 && !track.entry.flies ? down : 0);
          }
        }
      }
      return this.addTrailLine(vehicle, pairs);
    }

    /** @param pairs ends of segments */
    addTrailLine(vehicle, pairs) {
      const line = this.addLine(this.trails, pairs, vehicle.colour, 3.5, 1);
      // The trail covers the plan where the vehicle followed it exactly.
      line.material.polygonOffset = true;
      line.material.polygonOffsetUnits = -400;
      line.renderOrder = 2;
      return line;
    }

    addPlan(vehicle, plan) {
      const count = plan.points.length / 3, pairs = new Float32Array(6 * (count - 1));
      for (let i = 0; i + 1 < count; ++i) {
        for (let k = 0; k < 6; ++k) pairs[6 * i + k] = plan.points[3 * i + k] + (k % 3 === 2 ? 0.6 * kHover : 0);
      }
      const line = this.addLine(this.plans, pairs, "#ffffff", 1.5, 0.55);
      line.renderOrder = 1;
      line.visible = false;
      return line;
    }

    /** Moves everything to a time, s since the run's start. */
    setTime(t) {
      for (const vehicle of this.vehicles) {
        const at = vehicle.track.bracket(t), p = [0, 0, 0], q = [0, 0, 0, 1];
        vehicle.track.poseAt(at, p, q);
        vehicle.position.fromArray(p);
        vehicle.quaternion.fromArray(q);
        vehicle.yaw = Math.atan2(2 * (q[3] * q[2] + q[0] * q[1]), 1 - 2 * (q[1] * q[1] + q[2] * q[2]));
        vehicle.speed = vehicle.track.speedAt(at);
        vehicle.height = vehicle.track.heightAt(at);
        vehicle.group.position.copy(vehicle.position);
        vehicle.group.quaternion.copy(vehicle.quaternion);
        for (const part of vehicle.links) this.setLink(vehicle.track, part, at, t);
        this.showTrail(vehicle, at, t);
        this.showPlan(vehicle, t);
      }
    }

    /** Draws the points of a trail that its vehicle has passed. */
    showTrail(vehicle, at) {
      const passed = Math.min(at.index + (at.share > 0.5 ? 1 : 0), vehicle.track.times.length - 1);
      vehicle.trail.geometry.maxInstancedCount = passed;
      vehicle.trail.visible = passed > 0;
    }

    setLink(track, part, at, t) {
      const p = [0, 0, 0], q = [0, 0, 0, 1];
      const spins = track.linkPoseAt(at, part.l, p, q);
      const rotation = new THREE.Quaternion().fromArray(q);
      if (part.link.axis) {
        const axis = new THREE.Vector3().fromArray(part.link.axis);
        if (spins) rotation.multiply(new THREE.Quaternion().setFromAxisAngle(axis, 2 * Math.PI * ((kSpinTurns * t) % 1)));
        part.disc.visible = spins;
      }
      part.object.matrix.compose(new THREE.Vector3().fromArray(p), rotation, new THREE.Vector3(1, 1, 1));
    }

    /** Selects levels of detail before drawing. @param share factor on the distances, 1 or less */
    prepare(camera, width, height, share) {
      for (const { levels, centre } of this.levels) {
        const distance = camera.position.distanceTo(centre);
        let wanted = distance < kLevels[0] * share ? 0 : distance < kLevels[1] * share ? 1 : 2;
        wanted = Math.min(wanted, levels.length - 1);
        while (!levels[wanted]) ++wanted;  // the page may lack the finest level
        levels.forEach((object, i) => (object.visible = i === wanted));
      }
      for (const material of this.lineMaterials) material.resolution.set(width, height);
    }

    /** Places in a view of the whole: rows, and vehicles at a time; all trails if there are no rows. */
    home(ground, t) {
      const places = [];
      const add = (array, at, up) => places.push(new THREE.Vector3(array[at], array[at + 1], array[at + 2] + up));
      const height = ground.canopy_top_m || 0;
      for (const line of ground.rows) {
        for (const at of [0, line.length - 3]) {
          add(line, at, 0);
          add(line, at, height);
        }
      }
      const rows = new THREE.Box3().setFromPoints(places), centre = rows.getCenter(new THREE.Vector3());
      const reach = 0.75 * rows.getSize(new THREE.Vector3()).length(), alone = places.length === 0;
      for (const vehicle of this.vehicles) {
        const track = vehicle.track, p = [0, 0, 0];
        track.poseAt(track.bracket(t), p, [0, 0, 0, 1]);
        if (alone || new THREE.Vector3().fromArray(p).distanceTo(centre) < reach) add(p, 0, 1);
        for (let i = 0; alone && i < track.times.length; ++i) add(track.positions, 3 * i, 0);
      }
      if (places.length === 0) {
        const box = ground.terrain_box || [[-10, -10, 0], [10, 10, 3]];
        for (let k = 0; k < 8; ++k) places.push(new THREE.Vector3(box[k & 1][0], box[(k >> 1) & 1][1], box[k >> 2][2]));
      }
      return places;
    }
  }

  /** Blurred disc of a fast rotor. */
  function addDisc(object, axis) {
    const box = new THREE.Box3(), along = new THREE.Vector3().fromArray(axis);
    object.traverse((mesh) => {
      if (!mesh.isMesh) return;
      mesh.geometry.computeBoundingBox();
      mesh.updateMatrix();
      box.union(mesh.geometry.boundingBox.clone().applyMatrix4(mesh.matrix));
    });
    if (box.isEmpty()) box.expandByPoint(new THREE.Vector3());
    const size = box.getSize(new THREE.Vector3()), radius = 0.5 * Math.max(size.x, size.y, size.z);
    const disc = new THREE.Mesh(
      new THREE.CircleBufferGeometry(radius, 40),
      new THREE.MeshBasicMaterial({ color: 0x20262b, transparent: true, opacity: 0.16, side: THREE.DoubleSide, depthWrite: false }));
    disc.position.copy(along).multiplyScalar(box.getCenter(new THREE.Vector3()).dot(along));
    disc.quaternion.setFromUnitVectors(new THREE.Vector3(0, 0, 1), along);
    object.add(disc);
    return disc;
  }
  Replay.addDisc = addDisc;
  Replay.kHover = kHover;

  Replay.Scene = Scene;
})(typeof window === "undefined" ? globalThis : window);
