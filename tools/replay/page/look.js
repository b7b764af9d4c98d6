"use strict";
// Materials: light of the run's hour, sky, ground, leaves. Colours are linear until the tone curve.
(function (root) {
  const Replay = (root.VinerowReplay = root.VinerowReplay || {});

  /** The renderer's curve (Narkowicz 2015), then display gamma. */
  function toScreen(x) {
    const y = (x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14);
    return Math.pow(Math.min(Math.max(y, 0), 1), 1 / 2.2);
  }

  function colourOf(rgb) {
    return new THREE.Color(rgb[0], rgb[1], rgb[2]);
  }

  /** One level of a picture as RGBA. Cards have brightness, and coverage in alpha. */
  function rgbaOf(bytes, offset, size, channels) {
    const rgba = new Uint8Array(4 * size * size);
    for (let i = 0; i < size * size; ++i) {
      const at = offset + i * channels;
      for (let c = 0; c < 3; ++c) rgba[4 * i + c] = bytes[at + (channels === 2 ? 0 : c)];
      rgba[4 * i + 3] = channels === 2 ? bytes[at + 1] : channels === 4 ? bytes[at + 3] : 255;
    }
    return rgba;
  }

  /** Pictures of the index as textures. */
  Replay.makeTextures = function (index, bytes, anisotropy) {
    const textures = {};
    for (const [name, entry] of Object.entries(index)) {
      const levels = [];
      for (let level = 0, size = entry.size, offset = entry.offset; level < entry.levels; ++level, size >>= 1) {
        levels.push({ data: rgbaOf(bytes, offset, size, entry.channels), width: size, height: size });
        offset += size * size * entry.channels;
      }
      const texture = new THREE.DataTexture(levels[0].data, entry.size, entry.size, THREE.RGBAFormat);
      texture.magFilter = THREE.LinearFilter;
      texture.minFilter = name === "sky" ? THREE.LinearFilter : THREE.LinearMipMapLinearFilter;
      texture.generateMipmaps = name !== "sky" && levels.length === 1;
      // Every level keeps the leaves' share of the picture, so foliage does not thin out with distance.
      if (levels.length > 1) texture.mipmaps = levels;
      if (name !== "sky") texture.anisotropy = anisotropy;
      if (name === "ground" || name === "noise") texture.wrapS = texture.wrapT = THREE.RepeatWrapping;
      texture.needsUpdate = true;
      textures[name] = texture;
    }
    return textures;
  };

  Replay.addLight = function (scene, light) {
    const sun = new THREE.DirectionalLight(0xffffff, 1);
    sun.color = colourOf(light.sun);
    sun.castShadow = true;
    sun.shadow.mapSize.set(2048, 2048);
    sun.shadow.bias = -0.0006;
    sun.shadow.radius = 1.5;
    sun.userData.direction = new THREE.Vector3().fromArray(light.sun_W);
    const sky = new THREE.HemisphereLight(0xffffff, 0xffffff, 1);
    sky.color = colourOf(light.sky);
    sky.groundColor = colourOf(light.ground);
    sky.position.set(0, 0, 1);
    scene.add(sun, sun.target, sky);
    // Fog is added after the tone curve, so it needs a screen colour.
    const haze = [0, 1, 2].map((c) => toScreen(0.5 * (light.haze_to_sun[c] + light.haze_from_sun[c])));
    scene.fog = new THREE.FogExp2(0xffffff, 0.00042);
    scene.fog.color = colourOf(haze);
    return sun;
  };

  /** Centres the shadow's box on a place, in whole texels so that shadow edges do not crawl. */
  Replay.aimSun = function (sun, centre, reach) {
    const camera = sun.shadow.camera, direction = sun.userData.direction;
    const right = new THREE.Vector3(0, 0, 1).cross(direction).normalize();
    const up = direction.clone().cross(right);
    const texel = (2 * reach) / sun.shadow.mapSize.x;
    const x = Math.round(centre.dot(right) / texel) * texel, y = Math.round(centre.dot(up) / texel) * texel;
    const middle = right.multiplyScalar(x).addScaledVector(up, y).addScaledVector(direction, centre.dot(direction));
    sun.target.position.copy(middle);
    sun.position.copy(middle).addScaledVector(direction, 2 * reach);
    camera.up.set(0, 0, 1);
    camera.left = camera.bottom = -reach;
    camera.right = camera.top = reach;
    camera.near = 0.1 * reach;
    camera.far = 5 * reach;
    camera.updateProjectionMatrix();
  };

  Replay.makeSky = function (light, textures) {
    const material = new THREE.ShaderMaterial({
      side: THREE.BackSide, depthWrite: false, depthTest: false, fog: false,
      uniforms: {
        skyTable: { value: textures.sky }, noiseTile: { value: textures.noise },
        sunDirection: { value: new THREE.Vector3().fromArray(light.sun_W) },
        sunLight: { value: new THREE.Vector3().fromArray(light.sun) },
        skyLight: { value: new THREE.Vector3().fromArray(light.sky) },
        hazeToSun: { value: new THREE.Vector3().fromArray(light.haze_to_sun) },
        hazeFromSun: { value: new THREE.Vector3().fromArray(light.haze_from_sun) },
      },
      vertexShader: `
        varying vec3 direction;
        void main() {
          direction = position;
          gl_Position = projectionMatrix * mat4(mat3(modelViewMatrix)) * vec4(position, 1.0);
          gl_Position.z = gl_Position.w;
        }`,
      fragmentShader: `
        varying vec3 direction;
        uniform sampler2D skyTable, noiseTile;
        uniform vec3 sunDirection, sunLight, skyLight, hazeToSun, hazeFromSun;
        vec3 toScreen(vec3 x) {
          x = (x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14);
          return pow(clamp(x, 0.0, 1.0), vec3(1.0 / 2.2));
        }
        void main() {
          vec3 d = normalize(direction);
          float elevation = asin(clamp(d.z, 0.0, 1.0));
          float along = dot(normalize(d.xy + vec2(1e-5)), normalize(sunDirection.xy + vec2(1e-5)));
          vec2 uv = vec2(acos(clamp(along, -1.0, 1.0)) / 3.14159265, sqrt(elevation / 1.5707963));
          vec3 root = texture2D(skyTable, uv * (47.0 / 48.0) + 0.5 / 48.0).rgb;
          vec3 radiance = 2.0 * root * root;
          // Fair-weather clouds on a plane, brighter where they face the sun.
          vec2 p = d.xy * 0.115 / (max(d.z, 0.0) + 0.10) + vec2(0.37, 0.11);
          float cover = texture2D(noiseTile, p).b * 0.72 + texture2D(noiseTile, p * 3.1 + 0.4).b * 0.28;
          float lit = texture2D(noiseTile, p + sunDirection.xy * 0.018).b * 0.72 + 0.14;
          float cloud = smoothstep(0.53, 0.86, cover) * smoothstep(0.015, 0.20, d.z);
          vec3 sunlit = 3.14159265 * (sunLight * 0.16 + skyLight * 0.22);
          vec3 shaded = 3.14159265 * (sunLight * 0.075 + skyLight * 0.20);
          radiance = mix(radiance, mix(shaded, sunlit, clamp(0.5 + 3.0 * (cover - lit), 0.0, 1.0)), cloud * 0.85);
          float toward = max(dot(d, sunDirection), 0.0);
          radiance += sunLight * (smoothstep(0.99990, 0.99996, toward) * 60.0 + 0.7 * pow(toward, 900.0));
          float side = 0.5 + 0.5 * along;
          vec3 haze = mix(hazeFromSun, hazeToSun, side * side);
          radiance = mix(radiance, haze, d.z < 0.0 ? 1.0 : exp(-d.z * 22.0) * 0.75);
          gl_FragColor = vec4(toScreen(radiance), 1.0);
        }`,
    });
    const sky = new THREE.Mesh(new THREE.SphereBufferGeometry(10, 48, 24), material);
    sky.frustumCulled = false;
    sky.renderOrder = -10;
    return sky;
  };

  // Limit of distances, as in the renderer.
  const kReach = 2.55, kFade = 2.4;

  /** Texture around the rows: distance to rows (R), distance to alley centres (G), alley mask (B). */
  function makeRowMask(ground) {
    if (!ground.row_box) return null;
    const x0 = ground.row_box[0][0] - 6, y0 = ground.row_box[0][1] - 6;
    const width = ground.row_box[1][0] + 6 - x0, depth = ground.row_box[1][1] + 6 - y0;
    const power = (m) => Math.min(2048, Math.max(64, Math.pow(2, Math.ceil(Math.log2(m / 0.12)))));
    const columns = power(width), rows = power(depth), rgba = new Uint8Array(4 * columns * rows);
    for (let i = 0; i < columns * rows; ++i) rgba[4 * i] = rgba[4 * i + 1] = rgba[4 * i + 3] = 255;
    const cellX = width / columns, cellY = depth / rows;
    const stamp = (line, alley) => {
      const count = line.length / 3;
      for (let k = 0; k + 1 < count; ++k) {
        const ax = line[3 * k], ay = line[3 * k + 1], dx = line[3 * k + 3] - ax, dy = line[3 * k + 4] - ay;
        const square = Math.max(dx * dx + dy * dy, 1e-9), over = kFade / Math.sqrt(square);
        const low = alley && k === 0 ? -over : 0, high = alley && k + 2 === count ? 1 + over : 1;
        const fromX = Math.max(0, Math.floor((Math.min(ax, ax + dx) - kReach - x0) / cellX));
        const toX = Math.min(columns - 1, Math.ceil((Math.max(ax, ax + dx) + kReach - x0) / cellX));
        const fromY = Math.max(0, Math.floor((Math.min(ay, ay + dy) - kReach - y0) / cellY));
        const toY = Math.min(rows - 1, Math.ceil((Math.max(ay, ay + dy) + kReach - y0) / cellY));
        for (let j = fromY; j <= toY; ++j) {
          for (let i = fromX; i <= toX; ++i) {
            const px = x0 + (i + 0.5) * cellX - ax, py = y0 + (j + 0.5) * cellY - ay;
            const share = (px * dx + py * dy) / square;
            if (alley && (share < low || share > high)) continue;
            const t = Math.min(Math.max(share, low), high), at = 4 * (j * columns + i);
            const distance = Math.hypot(px - t * dx, py - t * dy);
            const value = Math.min(255, Math.round((distance * 255) / kReach)), channel = alley ? 1 : 0;
            if (value < rgba[at + channel]) rgba[at + channel] = value;
            if (alley) {
              const inside = Math.round(255 * (1 - Math.max(0, -t, t - 1) / over));
              if (inside > rgba[at + 2]) rgba[at + 2] = inside;
            }
          }
        }
      }
    };
    for (const line of ground.rows) stamp(line, false);
    for (const line of ground.alleys) stamp(line, true);
    const texture = new THREE.DataTexture(rgba, columns, rows, THREE.RGBAFormat);
    texture.magFilter = THREE.LinearFilter;
    texture.minFilter = THREE.LinearMipMapLinearFilter;
    texture.generateMipmaps = true;
    texture.needsUpdate = true;
    return { texture, rect: new THREE.Vector4(x0, y0, 1 / width, 1 / depth) };
  }

  const kGroundColours = `
    varying vec3 vPlace;
    uniform sampler2D groundTile, noiseTile, rowMask;
    uniform vec4 maskRect;
    uniform float hasMask;
    uniform vec2 home;
    vec3 grassColour(float brightness, float dryness, vec2 tone) {
      float lush = smoothstep(0.25, 0.75, tone.x);
      vec3 deep = mix(vec3(0.050, 0.062, 0.022), vec3(0.030, 0.054, 0.017), lush);
      vec3 light = mix(vec3(0.225, 0.232, 0.095), vec3(0.135, 0.192, 0.062), lush);
      vec3 straw = vec3(0.34, 0.285, 0.160);
      float dry = clamp(dryness * 0.75 + (tone.y - 0.55) * 0.75 - 0.12, 0.0, 0.8);
      return mix(mix(deep, light, brightness), straw * (0.25 + 0.95 * brightness), dry);
    }
    vec3 groundColour(vec2 q) {
      vec4 macro = texture2D(noiseTile, q * 0.0041 + 0.13), meso = texture2D(noiseTile, mat2(0.8, 0.6, -0.6, 0.8) * q * 0.033);
      vec4 detail = texture2D(groundTile, q * 0.476) * 0.5
          + texture2D(groundTile, mat2(0.54, 0.84, -0.84, 0.54) * q * 0.171 + 0.7) * 0.3
          + texture2D(groundTile, mat2(0.28, -0.96, 0.96, 0.28) * q * 0.043 + 0.3) * 0.2;
      vec2 tone = vec2(macro.r * 0.6 + meso.g * 0.4, macro.g * 0.65 + meso.r * 0.35);
      vec3 grass = grassColour(detail.r * 1.15, detail.g, tone);
      vec3 soil = mix(vec3(0.098, 0.066, 0.043), vec3(0.335, 0.255, 0.176), detail.b * 0.9 + 0.25 * (meso.r - 0.5));
      vec2 uv = (q - maskRect.xy) * maskRect.zw;
      vec3 mask = texture2D(rowMask, uv).rgb;
      float inside = hasMask * step(0.0, uv.x) * step(uv.x, 1.0) * step(0.0, uv.y) * step(uv.y, 1.0);
      mask = mix(vec3(1.0, 1.0, 0.0), mask, inside);
      vec2 d = mask.rg * 2.55;
      float ragged = (meso.a - 0.5) * 0.26 + (detail.a - 0.5) * 0.30;
      float strip = 1.0 - smoothstep(0.24, 0.44, d.x + ragged);
      strip *= 1.0 - 0.6 * smoothstep(0.50, 0.75, meso.g + 0.5 * (detail.a - 0.5));
      float track = 1.0 - smoothstep(0.05, 0.24, abs(d.y - 0.60) + 0.7 * ragged);
      track *= 0.75 * mask.b * smoothstep(0.25, 0.75, meso.r + 0.4 * detail.a);
      grass *= 0.88 + 0.18 * mask.b * smoothstep(0.9, 0.2, d.y);
      vec3 colour = mix(grass, soil, clamp(max(strip, track), 0.0, 1.0));
      colour *= 1.0 - 0.22 * (1.0 - smoothstep(0.0, 0.8, d.x));
      // Distant country: alternating fields and woods.
      float far = smoothstep(120.0, 600.0, distance(q, home));
      vec4 regions = texture2D(noiseTile, q * 0.00071 + 0.2), trees = texture2D(noiseTile, q * 0.0051 + 0.6);
      vec3 field = mix(vec3(0.090, 0.112, 0.046), vec3(0.190, 0.165, 0.092), smoothstep(0.42, 0.62, regions.r));
      field *= 0.8 + 0.4 * trees.g;
      float woods = smoothstep(0.52, 0.60, regions.a * 0.50 + trees.r * 0.30 + trees.a * 0.10 + macro.b * 0.10);
      field = mix(field, vec3(0.036, 0.052, 0.026) * (0.55 + 0.9 * trees.a), woods * 0.9);
      return mix(colour, field, far * 0.85);
    }`;

  Replay.makeGroundMaterial = function (ground, textures) {
    const mask = makeRowMask(ground);
    const box = ground.row_box || ground.terrain_box || [[0, 0, 0], [0, 0, 0]];
    const material = new THREE.MeshLambertMaterial({ color: 0xffffff, side: THREE.DoubleSide });
    material.onBeforeCompile = (shader) => {
      Object.assign(shader.uniforms, {
        groundTile: { value: textures.ground }, noiseTile: { value: textures.noise },
        rowMask: { value: mask ? mask.texture : textures.noise },
        maskRect: { value: mask ? mask.rect : new THREE.Vector4(0, 0, 1, 1) },
        hasMask: { value: mask ? 1 : 0 },
        home: { value: new THREE.Vector2(0.5 * (box[0][0] + box[1][0]), 0.5 * (box[0][1] + box[1][1])) },
      });
      shader.vertexShader = "varying vec3 vPlace;\n" + shader.vertexShader.replace(
        "#include <begin_vertex>", "#include <begin_vertex>\nvPlace = (modelMatrix * vec4(position, 1.0)).xyz;");
      shader.fragmentShader = kGroundColours + shader.fragmentShader.replace(
        "#include <map_fragment>", "diffuseColor.rgb = groundColour(vPlace.xy);").replace(/gl_FrontFacing/g, "true");
    };
    return material;
  };

  /** Foliage: cards lit on both sides like the canopy's volume, and the material of their shadows. */
  Replay.makeLeafMaterial = function (texture) {
    const material = new THREE.MeshLambertMaterial({
      color: 0xffffff, map: texture, alphaTest: 0.5, side: THREE.DoubleSide, vertexColors: THREE.VertexColors,
    });
    // Leaves are translucent: neither their far side nor their shadows on each other are black.
    const throughLeaves = THREE.ShaderChunk.lights_lambert_vertex.replace(/saturate\( dotNL \)/g, "saturate( 0.62 * dotNL + 0.38 )");
    material.onBeforeCompile = (shader) => {
      shader.vertexShader = shader.vertexShader.replace("#include <lights_lambert_vertex>", throughLeaves);
      shader.fragmentShader = shader.fragmentShader
        .replace("#include <map_fragment>",
          "vec4 card = texture2D(map, vUv);\ndiffuseColor.rgb *= 2.0 * card.r;\ndiffuseColor.a *= card.a;")
        .replace("getShadowMask()", "mix(0.28, 1.0, getShadowMask())")
        .replace(/gl_FrontFacing/g, "true");
    };
    const depth = new THREE.MeshDepthMaterial({ depthPacking: THREE.RGBADepthPacking, map: texture, alphaTest: 0.5 });
    return { material, depth };
  };
})(typeof window === "undefined" ? globalThis : window);
