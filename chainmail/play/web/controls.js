"use strict";
// Buttons, lists and the pointer: what a user does to a player.

const SPEEDS = [0.05, 0.1, 0.25, 0.5, 1, 2, 4, 10, 30, 100];
const one = (id) => document.getElementById(id);
const css = (rgb) => `rgb(${rgb.map((v) => Math.round(255 * v)).join(",")})`;

function addControls(player) {
  const fill = (id, entries, chosen) => one(id).replaceChildren(...entries.map(([value, text]) => new Option(text, value, false, value === chosen)));
  fill("quantity", player.fabrics[0].fields.map((f) => [f.name, f.name]), player.quantity);
  fill("speed", SPEEDS.map((s) => [s, `${s} x`]), player.speed);
  const count = (key) => Math.max(...player.fabrics.map((f) => Math.max(...f[key])));
  const choice = (all, word, n) => [[0, all], ...Array.from({ length: n }, (_, k) => [k + 1, `${word} ${k + 1}`])];
  fill("row", choice("all rows", "row", count("row")), 0);
  fill("place", choice("all columns", "column", count("place")), 0);
  [one("slider").min, one("slider").max] = player.span;
  one("slider").step = "any";
  one("play").onclick = () => player.play(!player.isPlaying);
  one("slider").oninput = () => player.seek(Number(one("slider").value));
  one("quantity").onchange = () => { player.quantity = one("quantity").value; player.changed(); };
  one("speed").onchange = () => { player.speed = Number(one("speed").value); };
  for (const id of ["row", "place"]) one(id).onchange = () => { player[id] = Number(one(id).value); player.changed(); };
  for (const button of document.querySelectorAll("[data-view]")) {
    button.onclick = () => { player.camera.view(button.dataset.view); player.changed(); };
  }
  addLegend(player);
  addFindings(player);
  one("notes").replaceChildren(...player.film.notes.map((note) => {
    const item = document.createElement("li");
    item.textContent = note;
    return item;
  }));
  addPointer(player);
  window.addEventListener("keydown", (e) => player.key(e));
}

function addLegend(player) {
  const entry = (colour, text) => {
    const line = one("legend").appendChild(document.createElement("div"));
    const spot = line.appendChild(document.createElement("span"));
    spot.className = "spot";
    spot.style.background = colour;
    line.append(text);
    return line;
  };
  if (player.fabrics.length > 1) {
    player.fabrics.forEach((fabric, k) => {
      const line = entry(k ? css(player.ghost(k)) : "#1f4fd8", `${fabric.title} (${fabric.size})`);
      const select = line.appendChild(document.createElement("select"));
      select.setAttribute("aria-label", `how ${fabric.title} is drawn`);
      select.append(...["colour", "ghost", "hidden"].map((look) => new Option(look, look, false, look === fabric.look)));
      select.onchange = () => { fabric.look = select.value; player.changed(); };
    });
  }
  player.marks.forEach((m) => {
    m.line = entry(css(m.colour), `${m.title}: ${m.points.length ? "discs are recorded, rings simulated" : "in the plots"}`);
    m.told = m.line.appendChild(document.createElement("small"));
  });
  one("legend").hidden = !one("legend").children.length;
}

function addFindings(player) {
  const { findings } = player.film;
  one("findings").hidden = !findings.length;
  findings.forEach((finding) => {
    const item = one("findings").appendChild(document.createElement("div"));
    item.className = "finding";
    const when = finding.intervals.map(([a, b]) => `${shown(a)} s to ${shown(b)} s`).join(", ");
    item.append(`${finding.isAccepted ? "" : "(suggestion) "}${finding.text} `);
    const where = item.appendChild(document.createElement("small"));
    where.textContent = `at ${finding.place}${finding.links.length ? "" : " (no link of this fabric)"}${when ? `, shows from ${when}` : ""} `;
    if (finding.intervals.length) {
      const button = item.appendChild(document.createElement("button"));
      button.textContent = "go there";
      button.onclick = () => player.seek(finding.intervals[0][0]);
    }
  });
  if (!findings.length) return;
  const label = one("findings").appendChild(document.createElement("label"));
  const box = label.appendChild(document.createElement("input"));
  box.type = "checkbox";
  box.checked = true;
  box.onchange = () => { player.isConcernShown = box.checked; player.changed(); };
  label.append(" bars of links concerned in magenta, arms of coils concerned striped");
}

function addPointer(player) {
  const stage = one("picture"), held = new Map();
  stage.addEventListener("pointerdown", (e) => { stage.setPointerCapture(e.pointerId); held.set(e.pointerId, e); });
  for (const end of ["pointerup", "pointercancel"]) stage.addEventListener(end, (e) => held.delete(e.pointerId));
  stage.addEventListener("pointermove", (e) => {
    const before = held.get(e.pointerId);
    if (!before) return;
    const [dx, dy] = [e.clientX - before.clientX, e.clientY - before.clientY].map((v) => v / stage.clientHeight);
    if (held.size > 1) {
      const other = [...held.values()].find((p) => p.pointerId !== e.pointerId);
      const apart = (p) => Math.hypot(p.clientX - other.clientX, p.clientY - other.clientY) || 1;
      player.zoom(apart(e) / apart(before));
    } else if (e.shiftKey || e.buttons > 1) player.camera.pan(dx, dy, stage.clientWidth / stage.clientHeight);
    else player.camera.orbit(3 * dx, 3 * dy);
    held.set(e.pointerId, e);
    player.changed();
  });
  stage.addEventListener("wheel", (e) => { e.preventDefault(); player.zoom(Math.exp(-0.0015 * e.deltaY)); }, { passive: false });
  stage.addEventListener("contextmenu", (e) => e.preventDefault());
}
