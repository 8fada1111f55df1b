"use strict";
// Reads the blocks that chainmail/play/codec.py writes: deflate, LEB128, zigzag, differences in time.

/** Bytes of base64 text of deflated data (zlib format). */
async function inflate(text) {
  const binary = atob(text);
  const packed = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; i++) packed[i] = binary.charCodeAt(i);
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** Blocks by name: {series, frames, data}, data series by series. */
function readBlocks(bytes, table) {
  const found = {};
  let place = 0;
  for (const { name, series, frames, order, scale, offset } of table) {
    const data = new Float64Array(series * frames);
    for (let s = 0; s < series; s++) {
      let code = 0, step = 0; // the present code and, for order 2, its present difference
      for (let f = 0; f < frames; f++) {
        let value = 0, shift = 0, byte;
        do {
          byte = bytes[place++];
          value |= (byte & 127) << shift;
          shift += 7;
        } while (byte > 127);
        const miss = (value >>> 1) ^ -(value & 1);
        if (order === 2) { step += miss; code += step; } else code += miss;
        data[s * frames + f] = offset[s] + scale * code;
      }
    }
    found[name] = { series, frames, data };
  }
  return found;
}

/** Place of a time among rising times: {i, j, share}, at the ends the first or the last. */
function between(times, t) {
  const last = times.length - 1;
  if (t <= times[0]) return { i: 0, j: 0, share: 0 };
  if (t >= times[last]) return { i: last, j: last, share: 0 };
  let low = 0, high = last;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (times[middle] <= t) low = middle; else high = middle;
  }
  return { i: low, j: high, share: (t - times[low]) / (times[high] - times[low]) };
}

/** Value of one series of a block at a place in time. */
function valueAt(block, series, { i, j, share }) {
  const first = series * block.frames;
  const a = block.data[first + i];
  return share ? a + share * (block.data[first + j] - a) : a;
}

/** Poses of all links of a fabric at a time; `out` has 8 numbers a link: middle, quaternion, distance of the bars. */
function posesAt(fabric, place, out) {
  const { position, orientation, distance } = fabric;
  for (let n = 0; n < fabric.links; n++) {
    const at = 8 * n;
    for (let a = 0; a < 3; a++) out[at + a] = valueAt(position, 3 * n + a, place);
    let square = 0;
    for (let a = 0; a < 4; a++) {
      const part = valueAt(orientation, 4 * n + a, place);
      out[at + 3 + a] = part;
      square += part * part;
    }
    const size = Math.sqrt(square) || 1;
    for (let a = 3; a < 7; a++) out[at + a] /= size;
    out[at + 7] = valueAt(distance, n, place);
  }
  return out;
}

/** A vector turned by the quaternion of a link in `poses`. */
function turned(poses, n, [vx, vy, vz]) {
  const [x, y, z, w] = poses.slice(8 * n + 3, 8 * n + 7);
  const cx = y * vz - z * vy + w * vx, cy = z * vx - x * vz + w * vy, cz = x * vy - y * vx + w * vz;
  return [vx + 2 * (y * cz - z * cy), vy + 2 * (z * cx - x * cz), vz + 2 * (x * cy - y * cx)];
}

/** Markers as the simulation has them: on both bars of the last link of every row, at its outer side (+x). */
function markersOf(fabric, poses) {
  const markers = [];
  const last = Math.max(...fabric.place);
  for (let n = 0; n < fabric.links; n++) {
    if (fabric.place[n] !== last) continue;
    for (const end of [-1, 1]) {
      const to = turned(poses, n, [fabric.width / 2, end * poses[8 * n + 7] / 2, 0]);
      markers.push([0, 1, 2].map((a) => poses[8 * n + a] + to[a]));
    }
  }
  return markers;
}
