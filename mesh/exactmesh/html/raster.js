// Many cells at once: how often each pixel is covered, and how much of edges is in it; then colours. No canvas is fast
// enough at drawing a million triangles, and none says where two of them overlap.

class Raster {
  constructor(mesh, tree, eye, ratio) {
    Object.assign(this, { mesh, tree, eye: eye.copy(), ratio });
    this.width = Math.max(1, Math.round(eye.width * ratio));
    this.height = Math.max(1, Math.round(eye.height * ratio));
    const pixels = this.width * this.height;
    this.covered = new Uint8Array(pixels);
    this.ink = new Float32Array(pixels);
    this.image = null;
    this.work = this.steps();
  }

  // Work for some milliseconds; return whether it is done.
  run(budget) {
    const end = performance.now() + budget;
    while (performance.now() < end) if (this.work.next().done) return true;
    return false;
  }

  *steps() {
    const { tree } = this;
    const speck = 1 / (this.eye.scale * this.ratio);
    let done = 0;
    for (const [begin, end, speckBox] of tree.leaves(this.eye.window(), speck)) {
      if (speckBox) this.dot(speckBox, end - begin);
      else for (let i = begin; i < end; i++) this.cell(tree.rows[i]);
      if ((++done & 63) === 0) yield;
    }
    yield* this.colours();
  }

  left(x) {
    return this.eye.left(x) * this.ratio;
  }

  top(y) {
    return this.eye.top(y) * this.ratio;
  }

  // Cells that are smaller than a pixel.
  dot(box, cells) {
    const x = Math.floor(this.left(box[0] / 2 + box[2] / 2));
    const y = Math.floor(this.top(box[1] / 2 + box[3] / 2));
    if (!(x >= 0 && y >= 0 && x < this.width && y < this.height)) return;
    const at = y * this.width + x;
    if (!this.covered[at]) this.covered[at] = 1;
    this.ink[at] += Math.min(cells, 16) * 0.5;
  }

  cell(cell) {
    const { points } = this.mesh;
    const corners = this.mesh.corners(cell);
    const size = corners.length;
    if (size === 1) return this.dot([points[2 * corners[0]], points[2 * corners[0] + 1], points[2 * corners[0]], points[2 * corners[0] + 1]], 8);
    const [xs, ys] = [XS, YS];
    for (let i = 0; i < size; i++) {
      xs[i] = this.left(points[2 * corners[i]]);
      ys[i] = this.top(points[2 * corners[i] + 1]);
    }
    this.fill(size);
    for (let i = 0; i < size; i++) {
      const j = i + 1 === size ? 0 : i + 1;
      this.line(xs[i], ys[i], xs[j], ys[j]);
    }
  }

  // Count the pixels whose centres are inside: neighbours share none, for they find the same point on a common edge.
  fill(size) {
    const [xs, ys, cuts] = [XS, YS, CUTS];
    let [low, high] = [Infinity, -Infinity];
    for (let i = 0; i < size; i++) {
      if (ys[i] < low) low = ys[i];
      if (ys[i] > high) high = ys[i];
    }
    const last = Math.min(this.height, Math.ceil(high - 0.5));
    for (let row = Math.max(0, Math.ceil(low - 0.5)); row < last; row++) {
      const y = row + 0.5;
      let count = 0;
      for (let i = 0; i < size; i++) {
        const j = i + 1 === size ? 0 : i + 1;
        const [a, b] = ys[i] < ys[j] ? [i, j] : [j, i];
        if (ys[a] <= y && y < ys[b]) cuts[count++] = xs[a] + ((y - ys[a]) / (ys[b] - ys[a])) * (xs[b] - xs[a]);
      }
      if (count < 2) continue;
      if (count > 2) cuts.subarray(0, count).sort();
      for (let i = 0; i + 1 < count; i += 2) {
        const [west, east] = cuts[i] < cuts[i + 1] ? [cuts[i], cuts[i + 1]] : [cuts[i + 1], cuts[i]];
        const end = row * this.width + Math.min(this.width, Math.ceil(east - 0.5));
        for (let at = row * this.width + Math.max(0, Math.ceil(west - 0.5)); at < end; at++) {
          if (this.covered[at] < 255) this.covered[at]++;
        }
      }
    }
  }

  // Ink along an edge, shared by the two pixels beside it.
  line(ax, ay, bx, by) {
    const { width, height, ink } = this;
    if (ax < -1 || ay < -1 || bx < -1 || by < -1 || ax > width || ay > height || bx > width || by > height) {
      const part = clipped(ax, ay, bx, by, -1, -1, width, height);
      if (!part) return;
      [ax, ay, bx, by] = part;
    }
    const [dx, dy] = [bx - ax, by - ay];
    const steps = Math.ceil(Math.max(Math.abs(dx), Math.abs(dy)));
    if (steps <= 1) {
      const [x, y] = [Math.floor((ax + bx) / 2), Math.floor((ay + by) / 2)];
      if (x >= 0 && y >= 0 && x < width && y < height) ink[y * width + x] += Math.max(Math.abs(dx), Math.abs(dy));
      return;
    }
    const flat = Math.abs(dx) >= Math.abs(dy);
    const [stepX, stepY] = [dx / steps, dy / steps];
    for (let i = 0; i < steps; i++) {
      const x = ax + (i + 0.5) * stepX;
      const y = ay + (i + 0.5) * stepY;
      const across = (flat ? y : x) - 0.5;
      const floor = Math.floor(across);
      const part = across - floor;
      const px = flat ? Math.floor(x) : floor;
      const py = flat ? floor : Math.floor(y);
      if (px >= 0 && py >= 0 && px < width && py < height) ink[py * width + px] += 1 - part;
      const qx = flat ? px : px + 1;
      const qy = flat ? py + 1 : py;
      if (qx >= 0 && qy >= 0 && qx < width && qy < height) ink[qy * width + qx] += part;
    }
  }

  *colours() {
    const { width, height, covered, ink } = this;
    const colours = theme();
    let [area, sum] = [1, 0];
    for (let at = 0; at < ink.length; at++) {
      if (covered[at]) {
        area++;
        sum += ink[at];
      }
      if ((at & 0xfffff) === 0) yield;
    }
    const strength = Math.min(0.6, (0.75 * area) / Math.max(sum, 1));
    const data = new ImageData(width, height);
    const rgba = data.data;
    for (let at = 0, i = 0; at < ink.length; at++, i += 4) {
      if (covered[at] || ink[at] > 0) {
        const base = covered[at] > 1 ? colours.overlap : covered[at] ? colours.fill : colours.paper;
        const share = 1 - Math.exp(-strength * ink[at]);
        for (let c = 0; c < 3; c++) rgba[i + c] = base[c] + (colours.ink[c] - base[c]) * share;
        rgba[i + 3] = 255;
      }
      if ((at & 0x3ffff) === 0) yield;
    }
    const canvas = document.createElement("canvas");
    [canvas.width, canvas.height] = [width, height];
    canvas.getContext("2d").putImageData(data, 0, 0);
    this.image = canvas;
  }
}

const [XS, YS, CUTS] = [new Float64Array(4), new Float64Array(4), new Float64Array(4)];

// The part of a line within a window, or null [Liang 1984].
function clipped(ax, ay, bx, by, west, north, east, south) {
  const [dx, dy] = [bx - ax, by - ay];
  let [from, to] = [0, 1];
  for (const [p, q] of [[-dx, ax - west], [dx, east - ax], [-dy, ay - north], [dy, south - ay]]) {
    if (p === 0) {
      if (q < 0) return null;
    } else {
      const t = q / p;
      if (p < 0) {
        if (t > to) return null;
        if (t > from) from = t;
      } else {
        if (t < from) return null;
        if (t < to) to = t;
      }
    }
  }
  return [ax + from * dx, ay + from * dy, ax + to * dx, ay + to * dy];
}
