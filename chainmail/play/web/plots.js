"use strict";
// Small plots of curves over time; the cursor follows the film, a click or a drag moves it.

/** A number with four digits at most. */
function shown(value) {
  if (!Number.isFinite(value)) return "-";
  const size = Math.abs(value);
  if (size >= 1000) return value.toFixed(0);
  return size >= 100 ? value.toFixed(1) : size >= 1 ? value.toFixed(2) : size === 0 ? "0" : value.toPrecision(2);
}

/** Round numbers between two limits, about `count` of them. */
function ticks(low, high, count) {
  const raw = (high - low) / count, power = 10 ** Math.floor(Math.log10(raw));
  const step = power * ([1, 2, 5, 10].find((k) => k * power >= raw) ?? 10);
  const found = [];
  for (let k = Math.ceil(low / step); k * step <= high + 1e-9 * step; k++) found.push(k * step);
  return { values: found, digits: Math.max(0, -Math.floor(Math.log10(step) + 1e-9)) };
}

class Plot {
  /** @param curves with times, values, lower, upper (arrays), colour, isDots, label */
  constructor(host, { title, unit, curves }, span, intervals, onSeek) {
    Object.assign(this, { title, unit, curves, span, intervals });
    this.root = document.createElement("figure");
    this.root.className = "plot";
    this.caption = this.root.appendChild(document.createElement("figcaption"));
    this.frame = this.root.appendChild(document.createElement("div"));
    this.canvas = this.frame.appendChild(document.createElement("canvas"));
    this.cursor = this.frame.appendChild(document.createElement("div"));
    this.cursor.className = "cursor";
    const all = curves.flatMap((c) => [c.values, c.lower, c.upper].filter(Boolean));
    const extremes = all.map((v) => v.reduce(([a, b], x) => [Math.min(a, x), Math.max(b, x)], [Infinity, -Infinity]));
    const low = Math.min(...extremes.map((e) => e[0])), high = Math.max(...extremes.map((e) => e[1]));
    const room = high > low ? 0.06 * (high - low) : Math.max(1e-9, 0.1 * Math.abs(high), 0.5);
    [this.low, this.high] = [low - room, high + room];
    const seek = (event) => {
      const { left, width } = this.canvas.getBoundingClientRect(), edge = this.edge ?? 0;
      onSeek(span[0] + (span[1] - span[0]) * (event.clientX - left - edge) / (width - edge - 4));
    };
    this.canvas.addEventListener("pointerdown", (e) => { this.canvas.setPointerCapture(e.pointerId); seek(e); });
    this.canvas.addEventListener("pointermove", (e) => { if (e.buttons) seek(e); });
    host.appendChild(this.root);
  }

  x(t) { return this.edge + (this.width - this.edge - 4) * (t - this.span[0]) / ((this.span[1] - this.span[0]) || 1); }

  y(v) { return this.height - 16 - (this.height - 22) * (v - this.low) / (this.high - this.low); }

  draw() {
    const ratio = window.devicePixelRatio || 1, canvas = this.canvas;
    [this.width, this.height] = [this.frame.clientWidth, this.frame.clientHeight];
    [canvas.width, canvas.height] = [this.width * ratio, this.height * ratio];
    const pen = this.pen = canvas.getContext("2d");
    pen.scale(ratio, ratio);
    pen.font = "10px system-ui, sans-serif";
    const levels = ticks(this.low, this.high, 3);
    const labels = levels.values.map((v) => v.toFixed(levels.digits));
    this.edge = Math.max(34, 8 + Math.max(...labels.map((l) => pen.measureText(l).width)));
    for (const [a, b] of this.intervals) {
      pen.fillStyle = "rgba(217, 0, 122, 0.13)";
      pen.fillRect(this.x(Math.max(a, this.span[0])), 4, Math.max(1, this.x(Math.min(b, this.span[1])) - this.x(Math.max(a, this.span[0]))), this.height - 20);
    }
    pen.strokeStyle = "#e2e8f0";
    pen.fillStyle = "#4a5568";
    pen.textBaseline = "middle";
    pen.textAlign = "right";
    levels.values.forEach((v, k) => {
      this.line([[this.edge, this.y(v)], [this.width - 4, this.y(v)]]);
      if (this.y(v) < this.height - 18) pen.fillText(labels[k], this.edge - 4, this.y(v)); // lower ones meet the times
    });
    const moments = ticks(this.span[0], this.span[1], 5);
    pen.textAlign = "center";
    moments.values.forEach((t) => pen.fillText(`${t.toFixed(moments.digits)}`, Math.min(this.width - 12, this.x(t)), this.height - 7));
    this.curves.forEach((c) => this.curve(c));
  }

  line(corners) {
    this.pen.beginPath();
    corners.forEach(([x, y], k) => (k ? this.pen.lineTo(x, y) : this.pen.moveTo(x, y)));
    this.pen.stroke();
  }

  curve({ times, values, lower, upper, colour, isDots }) {
    const pen = this.pen, at = (list) => Array.from(list, (v, k) => [this.x(times[k]), this.y(v)]);
    pen.save();
    pen.beginPath();
    pen.rect(this.edge, 0, this.width - this.edge - 3, this.height - 15);
    pen.clip();
    pen.strokeStyle = pen.fillStyle = colour;
    if (isDots) for (const [x, y] of at(values)) pen.fillRect(x - 1, y - 1, 2, 2);
    else {
      if (lower) {
        pen.globalAlpha = 0.2;
        pen.beginPath();
        [...at(lower), ...at(upper).reverse()].forEach(([x, y], k) => (k ? pen.lineTo(x, y) : pen.moveTo(x, y)));
        pen.fill();
        pen.globalAlpha = 1;
      }
      pen.lineWidth = 1.4;
      this.line(at(values));
    }
    pen.restore();
  }

  /** Moves the cursor and says the values there. */
  at(t, isTold) {
    this.cursor.style.transform = `translateX(${this.x(t)}px)`;
    if (!isTold) return;
    const now = this.curves.filter((c) => !c.isDots && t >= c.times[0] - 1e-9 && t <= c.times[c.times.length - 1] + 1e-9).slice(0, 3).map((c) => {
      const { i, j, share } = between(c.times, t), value = (list) => list[i] + share * (list[j] - list[i]);
      const label = c.label ? `${c.label} ` : "";
      return label + shown(value(c.values)) + (c.lower ? ` (${shown(value(c.lower))} to ${shown(value(c.upper))})` : "");
    });
    const text = `${this.title}: ${now.join(" | ") || "no value"} ${now.length ? this.unit : ""}`;
    if (this.caption.textContent !== text) this.caption.textContent = text;
  }
}
