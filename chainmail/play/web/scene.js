"use strict";
// Draws links as instances of one mesh (two bars, two arms) with WebGL 2, and markers as round points.

const SHADERS = {
  link: [`#version 300 es
in vec3 shape; in vec3 normal; in vec2 part;
in vec3 middle; in vec4 turn; in vec4 state;
uniform mat4 camera; uniform sampler2D palette; uniform vec4 plain;
out vec3 facing; out vec3 colour; out float along; flat out float isStriped;
vec3 rotated(vec3 v) { return v + 2.0 * cross(turn.xyz, cross(turn.xyz, v) + turn.w * v); }
void main() {
  // part.x: which end of the link (-1, 1), which the distance of the bars moves; part.y: arm 0, arm 1, or bar 2
  vec3 here = middle + rotated(shape + vec3(0.0, 0.5 * part.x * state.x, 0.0));
  gl_Position = camera * vec4(here, 1.0);
  facing = rotated(normal);
  float value = part.y < 0.5 ? state.y : part.y < 1.5 ? state.z : 0.5 * (state.y + state.z);
  colour = texture(palette, vec2((255.0 * clamp(value, 0.0, 1.0) + 0.5) / 256.0, 0.5)).rgb;
  int flags = int(state.w + 0.5); // 1: held, 2: a finding is about it, 4 and 8: about the coil of its first, second arm
  if (part.y > 1.5 && (flags & 2) > 0) colour = vec3(0.85, 0.0, 0.48);
  else if (part.y > 1.5 && (flags & 1) > 0) colour = vec3(0.36);
  isStriped = part.y < 1.5 && (flags & (part.y < 0.5 ? 4 : 8)) > 0 ? 1.0 : 0.0;
  along = 0.5 * part.x * state.x; // from the middle [m]
  if (plain.a > 0.0) colour = plain.rgb;
}`, `#version 300 es
precision highp float;
in vec3 facing; in vec3 colour; in float along; flat in float isStriped;
uniform vec3 light; uniform vec4 plain;
out vec4 pixel;
void main() {
  vec3 n = normalize(facing);
  float lit = 0.60 + 0.38 * max(dot(n, light), 0.0) + 0.12 * n.z;
  vec3 own = isStriped > 0.5 && fract(along / 0.006) < 0.4 ? vec3(0.85, 0.0, 0.48) : colour;
  pixel = vec4((plain.a > 0.0 ? plain.rgb : own) * lit, plain.a > 0.0 ? plain.a : 1.0);
}`],
  point: [`#version 300 es
in vec3 here; uniform mat4 camera; uniform float size;
void main() { gl_Position = camera * vec4(here, 1.0); gl_PointSize = size; }`, `#version 300 es
precision highp float;
uniform vec4 plain; uniform float hollow; out vec4 pixel;
void main() {
  float r = 2.0 * length(gl_PointCoord - 0.5);
  if (r > 1.0 || r < hollow) discard;
  pixel = plain;
}`],
};

/** A link's mesh: corners of shape (3), normal (3), end, kind, each once, and triangles; its bars have `sides` sides. */
function linkMesh({ diameter, width }, sides) {
  const corners = [], triangles = [], known = new Map(), radius = diameter / 2, arm = (width - diameter) / 2;
  const half = 0.5005 * width; // a bar ends flush with an arm: 0.1 % more decides which of the two is seen
  const triangle = (normal, end, kind, ...points) => {
    points.forEach((p, k) => {
      const corner = [...p, ...(Array.isArray(normal[0]) ? normal[k] : normal), end[k] ?? end[0], kind], key = corner.join();
      if (!known.has(key)) { known.set(key, known.size); corners.push(...corner); }
      triangles.push(known.get(key));
    });
  };
  for (const end of [-1, 1]) {
    for (let k = 0; k < sides; k++) {
      const [a, b] = [k, (k + 1) % sides].map((i) => 2 * Math.PI * i / sides);
      const [na, nb] = [a, b].map((t) => [0, Math.cos(t), Math.sin(t)]);
      const at = (x, n) => [x, radius * n[1], radius * n[2]];
      triangle([na, nb, nb], [end], 2, at(-half, na), at(-half, nb), at(half, nb));
      triangle([na, nb, na], [end], 2, at(-half, na), at(half, nb), at(half, na));
      for (const x of [-1, 1]) triangle([x, 0, 0], [end], 2, [x * half, 0, 0], at(x * half, na), at(x * half, nb));
    }
  }
  for (const [kind, x] of [[0, -arm], [1, arm]]) { // from bar axis to bar axis; the ends lie inside the bars
    for (const [nx, nz] of [[1, 0], [-1, 0], [0, 1], [0, -1]]) {
      const at = (s) => [x + radius * (nx + s * nz), 0, radius * (nz - s * nx)];
      triangle([nx, 0, nz], [-1, 1, 1], kind, at(-1), at(-1), at(1));
      triangle([nx, 0, nz], [-1, 1, -1], kind, at(-1), at(1), at(1));
    }
  }
  return { corners: new Float32Array(corners), triangles: new Uint16Array(triangles) };
}

/** Whether a processor draws instead of a graphics card: smoothed edges would halve its pictures a second. */
function isSoftware() {
  const gl = document.createElement("canvas").getContext("webgl2"), info = gl?.getExtension("WEBGL_debug_renderer_info");
  const name = gl ? gl.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : gl.RENDERER) : "";
  gl?.getExtension("WEBGL_lose_context")?.loseContext();
  return /swiftshader|llvmpipe|software|basic render/i.test(name);
}

class Camera {
  /** @param corners outermost middles of links @param margin how far a link reaches from its middle */
  constructor(corners, margin) {
    this.corners = corners;
    this.margin = margin;
    this.angle = 0.5;
    this.view("oblique");
  }

  /** Looks from a named side, so that everything just fits into the picture (chainmail/play/camera.py). */
  view(name) {
    const angles = { oblique: [-0.55, 0.42], side: [0, 0], top: [0, Math.PI / 2 - 1e-3], front: [-Math.PI / 2, 0.0] };
    [this.azimuth, this.elevation] = angles[name];
    this.zoom = 1;
    const { right, up, back } = this.axes(), axes = [right, up, back];
    this.seen = this.corners.map((p) => axes.map((d) => d[0] * p[0] + d[1] * p[1] + d[2] * p[2]));
    this.middle = axes.map((_, k) => (Math.min(...this.seen.map((s) => s[k])) + Math.max(...this.seen.map((s) => s[k]))) / 2);
    this.target = [0, 1, 2].map((a) => axes.reduce((sum, d, k) => sum + d[a] * this.middle[k], 0));
    this.depth = Math.max(...this.seen.map((s) => Math.abs(s[2] - this.middle[2]))) + this.margin;
  }

  /** Directions of the picture: right, up, towards the viewer. Seen from +x at azimuth 0: y to the right, z up. */
  axes() {
    const [sa, ca, se, ce] = [Math.sin(this.azimuth), Math.cos(this.azimuth), Math.sin(this.elevation), Math.cos(this.elevation)];
    return { right: [-sa, ca, 0], up: [-ca * se, -sa * se, ce], back: [ca * ce, sa * ce, se] };
  }

  distance(aspect) {
    const tangent = Math.tan(this.angle / 2), [x, y, z] = this.middle;
    const needed = this.seen.map((s) => Math.max((Math.abs(s[0] - x) + this.margin) / aspect, Math.abs(s[1] - y) + this.margin) / tangent + s[2] - z);
    return (Math.max(...needed) + this.margin) / this.zoom;
  }

  orbit(dx, dy) {
    this.azimuth -= dx;
    this.elevation = Math.max(-1.57, Math.min(1.57, this.elevation + dy));
  }

  pan(dx, dy, aspect) { // as shares of the height of the picture
    const { right, up } = this.axes(), reach = 2 * this.distance(aspect) * Math.tan(this.angle / 2);
    this.target = this.target.map((v, a) => v - reach * (dx * right[a] - dy * up[a]));
  }

  /** Column-major matrix from metres to clip space. */
  matrix(aspect) {
    const { right, up, back } = this.axes(), distance = this.distance(aspect);
    const eye = this.target.map((v, a) => v + distance * back[a]);
    const dot = (v) => v[0] * eye[0] + v[1] * eye[1] + v[2] * eye[2];
    const f = 1 / Math.tan(this.angle / 2), near = distance / 50, far = distance + 20 * this.depth;
    const c = (far + near) / (near - far), d = 2 * far * near / (near - far);
    const m = [];
    for (let a = 0; a < 3; a++) m.push(f / aspect * right[a], f * up[a], c * back[a], -back[a]);
    m.push(-f / aspect * dot(right), -f * dot(up), -c * dot(back) + d, dot(back));
    return new Float32Array(m);
  }
}

class Scene {
  /** Throws an Error where there is no WebGL 2. */
  constructor(canvas, palette) {
    const gl = canvas.getContext("webgl2", { antialias: !isSoftware(), alpha: false });
    if (!gl) throw new Error("this browser has no WebGL 2");
    this.canvas = canvas;
    this.gl = gl;
    this.sharpness = 1; // share of the full resolution
    this.link = this.program(SHADERS.link, ["shape", "normal", "part", "middle", "turn", "state"]);
    this.point = this.program(SHADERS.point, ["here"]);
    this.points = { array: gl.createVertexArray(), buffer: gl.createBuffer() };
    gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGB, 256, 1, 0, gl.RGB, gl.UNSIGNED_BYTE, palette);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
    gl.enable(gl.DEPTH_TEST);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
  }

  program(sources, attributes) {
    const gl = this.gl, program = gl.createProgram();
    [gl.VERTEX_SHADER, gl.FRAGMENT_SHADER].forEach((kind, k) => {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, sources[k]);
      gl.compileShader(shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
      gl.attachShader(program, shader);
    });
    attributes.forEach((name, k) => gl.bindAttribLocation(program, k, name));
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
    const at = (name) => gl.getUniformLocation(program, name);
    return { program, camera: at("camera"), plain: at("plain"), light: at("light"), size: at("size"), hollow: at("hollow") };
  }

  /** What the links of one fabric need on the graphics side. */
  fabric(shape, links) {
    const gl = this.gl, array = gl.createVertexArray(), buffer = gl.createBuffer();
    const mesh = linkMesh(shape, links > 100 ? 10 : 20);
    gl.bindVertexArray(array);
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ARRAY_BUFFER, mesh.corners, gl.STATIC_DRAW);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, mesh.triangles, gl.STATIC_DRAW);
    [[3, 0], [3, 12], [2, 24]].forEach(([size, offset], k) => this.attribute(k, size, 32, offset, 0));
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.bufferData(gl.ARRAY_BUFFER, 44 * links, gl.DYNAMIC_DRAW);
    [[3, 0], [4, 12], [4, 28]].forEach(([size, offset], k) => this.attribute(3 + k, size, 44, offset, 1));
    return { array, buffer, corners: mesh.triangles.length, instances: new Float32Array(11 * links) };
  }

  attribute(k, size, stride, offset, divisor) {
    this.gl.enableVertexAttribArray(k);
    this.gl.vertexAttribPointer(k, size, this.gl.FLOAT, false, stride, offset);
    this.gl.vertexAttribDivisor(k, divisor);
  }

  /** Empties the picture and fits it to its place on the page. */
  begin(camera) {
    const gl = this.gl, canvas = this.canvas, ratio = this.sharpness * Math.min(window.devicePixelRatio || 1, 2);
    const [width, height] = [canvas.clientWidth, canvas.clientHeight].map((v) => Math.max(1, Math.round(v * ratio)));
    if (canvas.width !== width || canvas.height !== height) [canvas.width, canvas.height] = [width, height];
    gl.viewport(0, 0, width, height);
    gl.clearColor(0.965, 0.972, 0.98, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    this.ratio = ratio;
    this.matrix = camera.matrix(width / height);
    const { right, up, back } = camera.axes(), light = [0, 1, 2].map((a) => -0.35 * right[a] + 0.55 * up[a] + back[a]);
    this.light = light.map((v) => v / Math.hypot(...light));
  }

  /** Draws `count` links whose numbers stand in `fabric.instances`; `plain` (r, g, b, opacity) makes them a ghost. */
  links(fabric, count, plain) {
    const gl = this.gl;
    gl.useProgram(this.link.program);
    gl.uniformMatrix4fv(this.link.camera, false, this.matrix);
    gl.uniform3fv(this.link.light, this.light);
    gl.uniform4fv(this.link.plain, plain ?? [0, 0, 0, 0]);
    gl.bindVertexArray(fabric.array);
    gl.bindBuffer(gl.ARRAY_BUFFER, fabric.buffer);
    gl.bufferSubData(gl.ARRAY_BUFFER, 0, fabric.instances, 0, 11 * count);
    if (!plain) return gl.drawElementsInstanced(gl.TRIANGLES, fabric.corners, gl.UNSIGNED_SHORT, 0, count);
    // Depth first, so that a ghost does not show its own inside; a little farther away, so that it does not tint
    // what lies in the same place.
    gl.enable(gl.POLYGON_OFFSET_FILL);
    gl.polygonOffset(1, 200);
    gl.colorMask(false, false, false, false);
    gl.drawElementsInstanced(gl.TRIANGLES, fabric.corners, gl.UNSIGNED_SHORT, 0, count);
    gl.colorMask(true, true, true, true);
    gl.depthFunc(gl.LEQUAL);
    gl.enable(gl.BLEND);
    gl.drawElementsInstanced(gl.TRIANGLES, fabric.corners, gl.UNSIGNED_SHORT, 0, count);
    gl.disable(gl.BLEND);
    gl.disable(gl.POLYGON_OFFSET_FILL);
    gl.depthFunc(gl.LESS);
  }

  /** Draws points over everything; `hollow` is the inner radius of a ring, 0 for a disc. */
  dots(places, colour, size, hollow) {
    if (!places.length) return;
    const gl = this.gl;
    gl.useProgram(this.point.program);
    gl.uniformMatrix4fv(this.point.camera, false, this.matrix);
    gl.uniform4fv(this.point.plain, [...colour, 1]);
    gl.uniform1f(this.point.size, size * this.ratio);
    gl.uniform1f(this.point.hollow, hollow);
    gl.bindVertexArray(this.points.array);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.points.buffer);
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(places.flat()), gl.DYNAMIC_DRAW);
    this.attribute(0, 3, 12, 0, 0);
    gl.disable(gl.DEPTH_TEST);
    gl.drawArrays(gl.POINTS, 0, places.length);
    gl.enable(gl.DEPTH_TEST);
  }
}
