"use strict";
// The page: reads the film, joins picture, plots and controls.

class Player {
  constructor(film, blocks) {
    this.film = film;
    this.fabrics = film.fabrics.map((f) => ({
      ...f, times: blocks[f.times].data, position: blocks[f.position], orientation: blocks[f.orientation],
      distance: blocks[f.distance], fields: f.fields.map((q) => ({ ...q, block: blocks[q.block] })),
      poses: new Float64Array(8 * f.links), look: "ghost",
    }));
    this.fabrics[0].look = "colour";
    this.marks = film.marks.map((m, k) => ({
      ...m, colour: this.ghost(film.fabrics.length + k),
      points: m.points.map((p) => ({ ...p, axes: p.axes.map((a) => a && { times: blocks[a.times].data, block: blocks[a.values], gap: a.gap }) })),
    }));
    const times = this.fabrics.map((f) => f.times);
    this.span = [Math.min(...times.map((t) => t[0])), Math.max(...times.map((t) => t[t.length - 1]))];
    this.time = this.span[0];
    this.isPlaying = false;
    this.row = this.place = 0;
    this.quantity = this.fabrics[0].fields[0].name;
    this.speed = SPEEDS.find((s) => (this.span[1] - this.span[0]) / s <= 20) ?? 100;
    this.camera = new Camera(film.corners, film.margin);
    this.frames = 0;
    this.isConcernShown = true;
    this.addPlots(blocks);
    addControls(this);
    this.addScene();
    one("picture").addEventListener("webglcontextlost", (e) => { e.preventDefault(); this.scene = null; });
    one("picture").addEventListener("webglcontextrestored", () => { this.addScene(); this.changed(); });
    new ResizeObserver(() => this.fit()).observe(one("stage"));
    new ResizeObserver(() => this.fit()).observe(one("side"));
    this.fit();
  }

  get main() { return this.fabrics.find((f) => f.look === "colour") ?? this.fabrics[0]; }

  /** Colour of a further run or of a recording; the first run has one too, for when it is a ghost. */
  ghost(n) { return this.film.ghosts[(n + this.film.ghosts.length - 1) % this.film.ghosts.length]; }

  addScene() {
    try {
      one("failure").hidden = true;
      const palette = new Uint8Array(this.film.palette);
      this.scene = new Scene(one("picture"), palette);
      this.fabrics.forEach((f) => { f.drawn = this.scene.fabric(f, f.links); });
    } catch (error) {
      one("failure").textContent = `The fabric cannot be drawn: ${error.message}. The plots are shown all the same.`;
      one("failure").hidden = false;
    }
  }

  addPlots(blocks) {
    const list = (name) => (name === null ? null : blocks[name].data);
    const intervals = this.film.findings.flatMap((f) => f.intervals);
    const colourOf = ({ fabric, mark }) => (mark !== null ? css(this.marks[mark].colour) : fabric ? css(this.ghost(fabric)) : "#1f4fd8");
    this.plots = this.film.plots.map((p) => new Plot(one("plots"), {
      ...p, curves: p.curves.map((c) => ({
        label: c.label, isDots: c.mark !== null, colour: colourOf(c),
        times: list(c.times), values: list(c.values), lower: list(c.lower), upper: list(c.upper),
      })),
    }, this.span, intervals, (t) => this.seek(t)));
  }

  zoom(factor) {
    this.camera.zoom = Math.max(0.2, Math.min(40, this.camera.zoom * factor));
    this.changed();
  }

  key(event) {
    if (["INPUT", "SELECT", "BUTTON"].includes(event.target.tagName) && event.key === " ") return;
    if (event.target.tagName === "SELECT" || event.target.id === "slider") return;
    const times = this.main.times, { i } = between(times, this.time + 1e-9);
    if (event.key === " ") { event.preventDefault(); this.play(!this.isPlaying); }
    if (event.key === "ArrowRight") this.seek(times[Math.min(times.length - 1, i + 1)]);
    if (event.key === "ArrowLeft") this.seek(times[Math.max(0, this.time > times[i] + 1e-9 ? i : i - 1)]);
  }

  play(isPlaying) {
    if (isPlaying && this.time >= this.span[1]) this.time = this.span[0];
    this.isPlaying = isPlaying;
    this.slow = 0;
    if (this.scene && !isPlaying) this.scene.sharpness = 1;
    one("play").textContent = isPlaying ? "Pause" : "Play";
    this.last = null;
    this.changed();
  }

  seek(time) {
    this.time = Math.max(this.span[0], Math.min(this.span[1], time));
    this.changed();
  }

  fit() {
    this.plots.forEach((p) => p.draw());
    this.changed();
  }

  /** Asks for one new picture; a page that stands still computes nothing. */
  changed() {
    if (this.isAsked) return;
    this.isAsked = true;
    requestAnimationFrame((now) => {
      this.isAsked = false;
      if (this.isPlaying) {
        const passed = this.last === null ? 0 : Math.min(now - this.last, 250); // a hidden page stands still
        this.time += this.speed * passed / 1000;
        this.last = now;
        this.soften(passed);
        if (this.time >= this.span[1]) { this.time = this.span[1]; this.play(false); }
      }
      this.draw();
      if (this.isPlaying) this.changed();
    });
  }

  /** Takes fewer pixels while it plays where the machine does not manage 30 pictures a second. */
  soften(passed) {
    this.slow = passed > 36 ? this.slow + 1 : Math.max(0, this.slow - 0.5);
    if (this.slow < 6 || !this.scene) return;
    this.scene.sharpness = Math.max(0.5, 0.8 * this.scene.sharpness);
    this.slow = 0;
  }

  draw() {
    this.fabrics.forEach((f) => {
      const isThere = this.time >= f.times[0] - 1e-9 && this.time <= f.times[f.times.length - 1] + 1e-9;
      f.now = isThere ? between(f.times, this.time) : null;
      if (f.now) posesAt(f, f.now, f.poses);
    });
    if (this.scene) this.drawScene();
    const now = performance.now(), isTold = !this.isPlaying || !(now - this.told < 120); // text, eight times a second
    if (isTold) {
      this.told = now;
      this.marks.forEach((m) => this.tellDistance(m));
    }
    this.plots.forEach((p) => p.at(this.time, isTold));
    one("slider").value = this.time;
    one("clock").textContent = `${this.time.toFixed(2)} s`;
    this.drawBar();
    this.drawAxes();
    this.frames += 1;
  }

  drawScene() {
    this.scene.begin(this.camera);
    const ordered = [...this.fabrics].sort((a, b) => (a.look === "colour" ? 0 : 1) - (b.look === "colour" ? 0 : 1));
    for (const fabric of ordered) {
      if (!fabric.now || fabric.look === "hidden") continue;
      const count = this.instances(fabric);
      const isGhost = fabric.look === "ghost";
      this.scene.links(fabric.drawn, count, isGhost ? [...this.ghost(this.fabrics.indexOf(fabric)), 0.38] : null);
      fabric.count = count;
    }
    for (const mark of this.marks) {
      const pairs = this.pairs(mark).filter((p) => this.isShown(p.row, p.place)); // others would float in the air
      this.scene.dots(pairs.map((p) => p.simulated), [0.1, 0.12, 0.16], 13, 0.62);
      this.scene.dots(pairs.map((p) => p.recorded), mark.colour, 9, 0);
    }
  }

  /** Fills in the links that are not cut away; returns how many. */
  instances(fabric) {
    const field = fabric.fields.find((f) => f.name === this.quantity) ?? fabric.fields[fabric.fields.length - 1];
    const { low, high } = this.film.ranges[field.name], scale = 1 / ((high - low) || 1);
    const concerned = this.isConcernShown && fabric === this.main ? this.concerned() : { links: new Set(), coils: new Set() };
    const out = fabric.drawn.instances;
    let count = 0;
    for (let n = 0; n < fabric.links; n++) {
      if (!this.isShown(fabric.row[n], fabric.place[n])) continue;
      const to = 11 * count++;
      for (let k = 0; k < 8; k++) out[to + k] = fabric.poses[8 * n + k];
      for (let arm = 0; arm < 2; arm++) out[to + 8 + arm] = (valueAt(field.block, 2 * n + arm, fabric.now) - low) * scale;
      out[to + 10] = (fabric.held[n] ? 1 : 0) + (concerned.links.has(n) ? 2 : 0)
        + (concerned.coils.has(2 * n) ? 4 : 0) + (concerned.coils.has(2 * n + 1) ? 8 : 0);
    }
    return count;
  }

  isShown(row, place) { return (!this.row || row === this.row) && (!this.place || place === this.place); }

  concerned() {
    const all = (key) => new Set(this.film.findings.flatMap((f) => f[key]));
    return { links: all("links"), coils: all("coils") };
  }

  /** Recorded points at this time, each with the simulated one; a coordinate that was not recorded is the simulated one. */
  pairs(mark) {
    const fabric = this.main;
    if (!fabric.now) return [];
    const markers = markersOf(fabric, fabric.poses), pairs = [];
    for (const { kind, number, axes } of mark.points) {
      const simulated = kind === "marker" ? markers[number - 1] : number <= fabric.links ? Array.from(fabric.poses.slice(8 * number - 8, 8 * number - 5)) : undefined;
      if (!simulated) continue;
      const read = axes.map((axis) => (axis ? this.reading(axis) : null));
      if (axes.some((axis, a) => axis && read[a] === null)) continue; // a gap of the recording
      const square = read.reduce((sum, v, a) => sum + (v === null ? 0 : (v - simulated[a]) ** 2), 0);
      const link = kind === "marker" ? Math.ceil(number / 2) * Math.max(...fabric.place) - 1 : number - 1;
      pairs.push({ row: fabric.row[link], place: fabric.place[link], simulated, recorded: read.map((v, a) => v ?? simulated[a]), apart: Math.sqrt(square) });
    }
    return pairs;
  }

  reading({ times, block, gap }) {
    if (this.time < times[0] - 1e-9 || this.time > times[times.length - 1] + 1e-9) return null;
    const place = between(times, this.time);
    return times[place.j] - times[place.i] > gap ? null : valueAt(block, 0, place);
  }

  tellDistance(mark) {
    if (!mark.points.length) return;
    const pairs = this.pairs(mark);
    const rms = Math.sqrt(pairs.reduce((sum, p) => sum + p.apart ** 2, 0) / pairs.length);
    mark.told.textContent = pairs.length ? ` ${pairs.length} points, ${shown(1000 * rms)} mm apart (rms)` : " no reading at this time";
  }

  drawBar() {
    const key = `${this.quantity}`;
    if (this.barKey === key) return;
    this.barKey = key;
    const { low, high, unit } = this.film.ranges[this.quantity], pen = one("bar").getContext("2d");
    for (let k = 0; k < 256; k++) {
      pen.fillStyle = `rgb(${this.film.palette.slice(3 * k, 3 * k + 3).join(",")})`;
      pen.fillRect(k, 0, 1, 12);
    }
    one("low").textContent = `${shown(low)} ${unit}`;
    one("high").textContent = `${shown(high)} ${unit}`;
  }

  /** Directions of the fabric's axes in the corner of the picture. */
  drawAxes() {
    const { right, up } = this.camera.axes();
    const lines = ["x", "y", "z"].map((name, a) => {
      const [dx, dy] = [26 * right[a], -26 * up[a]];
      return `<line x1="40" y1="40" x2="${40 + dx}" y2="${40 + dy}"/><text x="${40 + 1.35 * dx}" y="${44 + 1.35 * dy}">${name}</text>`;
    });
    one("axes").innerHTML = lines.join("");
  }
}

async function begin() {
  const film = JSON.parse(one("film").textContent);
  if (typeof DecompressionStream === "undefined") throw new Error("this browser cannot inflate data (DecompressionStream)");
  const blocks = readBlocks(await inflate(one("data").textContent), film.blocks);
  window.player = new Player(film, blocks);
  requestAnimationFrame(() => { document.documentElement.dataset.ready = Math.round(performance.now()); });
}

begin().catch((error) => {
  one("failure").textContent = `This page cannot be shown: ${error.message}`;
  one("failure").hidden = false;
  document.documentElement.dataset.failed = error.message;
});
