// The picture: cells as paths where few are seen, as pixels where many are; lines and marks on top.

const FEW = 2500; // cells that are drawn as paths
const NEAR = 1e6; // pixels: beyond, positions are taken relative to the eye at twice the precision
const LABELS = 160;

let colours = null;

// The colours of the page, as [red, green, blue] or as text.
function theme() {
  if (colours) return colours;
  const style = getComputedStyle(document.documentElement);
  const text = (name) => style.getPropertyValue(`--${name}`).trim();
  const rgb = (name) => [1, 3, 5].map((i) => parseInt(text(name).slice(i, i + 2), 16));
  colours = { paper: rgb("paper"), fill: rgb("fill"), overlap: rgb("overlap"), ink: rgb("ink") };
  for (const name of ["cover", "edge", "border", "segment", "wrong", "rounding", "text", "faint", "halo", "accent"]) colours[name] = text(name);
  return colours;
}

const withAlpha = (hex, alpha) => hex + Math.round(alpha * 255).toString(16).padStart(2, "0");

class Scene {
  constructor(canvas, mesh, tree, layers) {
    Object.assign(this, { canvas, mesh, tree, layers, context: canvas.getContext("2d") });
    this.eye = new Eye();
    this.marks = [];
    this.chosen = null;
    this.raster = null; // at work
    this.image = null; // done
    this.mode = "none";
    this.visible = 0;
  }

  resize(width, height) {
    this.ratio = Math.min(window.devicePixelRatio || 1, 2);
    [this.canvas.width, this.canvas.height] = [Math.round(width * this.ratio), Math.round(height * this.ratio)];
    [this.eye.width, this.eye.height] = [width, height];
  }

  // Draw; return whether there is more to do.
  draw() {
    const { context, eye } = this;
    context.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
    context.fillStyle = `rgb(${theme().paper.join(" ")})`;
    context.fillRect(0, 0, eye.width, eye.height);
    const rows = this.tree.found(eye.window(), this.mesh.boxOf, FEW);
    this.mode = rows ? "paths" : "pixels";
    if (rows) {
      this.raster = null;
      this.visible = rows.length;
      this.lattice();
      this.cells(rows);
    } else {
      this.pixels();
    }
    for (const layer of this.layers) this.lines(layer);
    if (rows) this.numbers(rows);
    this.drawMarks();
    this.bar();
    return this.raster !== null;
  }

  forget() {
    colours = null;
    [this.raster, this.image] = [null, null];
  }

  pixels() {
    const { eye } = this;
    if (!this.image || !this.image.eye.sees(eye)) {
      if (!this.raster || !this.raster.eye.sees(eye)) this.raster = new Raster(this.mesh, this.tree, eye, this.ratio);
      if (this.raster.run(BUDGET)) [this.image, this.raster] = [this.raster, null];
    } else {
      this.raster = null;
    }
    if (!this.image) return;
    const before = this.image.eye;
    const grown = eye.scale / before.scale;
    const left = (before.x - eye.x + (before.ox - eye.ox)) * eye.scale + (eye.width - before.width * grown) / 2;
    const top = -(before.y - eye.y + (before.oy - eye.oy)) * eye.scale + (eye.height - before.height * grown) / 2;
    this.context.drawImage(this.image.image, left, top, before.width * grown, before.height * grown);
  }

  // Where the doubles themselves are far apart: a line through each of them.
  lattice() {
    const { context, eye } = this;
    const [dx, dy] = [ulp(eye.x) * eye.scale, ulp(eye.y) * eye.scale];
    context.strokeStyle = withAlpha(theme().faint, 0.35);
    context.lineWidth = 1;
    context.setLineDash([1, 3]);
    context.beginPath();
    if (dx >= 8) {
      for (let x = (eye.width / 2 - eye.ox * eye.scale) % dx; x < eye.width; x += dx) {
        context.moveTo(x, 0);
        context.lineTo(x, eye.height);
      }
    }
    if (dy >= 8) {
      for (let y = (eye.height / 2 + eye.oy * eye.scale) % dy; y < eye.height; y += dy) {
        context.moveTo(0, y);
        context.lineTo(eye.width, y);
      }
    }
    context.stroke();
    context.setLineDash([]);
  }

  position(v) {
    const { points } = this.mesh;
    return [this.eye.left(points[2 * v]), this.eye.top(points[2 * v + 1])];
  }

  // Return the part of a straight line that is seen, or null.
  seen(ax, ay, bx, by) {
    const { eye } = this;
    const { width, height } = eye;
    const ends = [eye.left(ax), eye.top(ay), eye.left(bx), eye.top(by)];
    if (ends.every((z) => Math.abs(z) < NEAR)) return clipped(...ends, -60, -60, width + 60, height + 60);
    const line = lineNear(eye, ax, ay, bx, by);
    if (!line) return null;
    const reach = 2 * (width + height);
    const [x, y] = [width / 2 + line.x * eye.scale, height / 2 - line.y * eye.scale];
    if (!(Math.abs(x) < reach && Math.abs(y) < reach)) return null;
    const from = Math.max(-reach, Math.min(reach, line.from * eye.scale));
    const to = Math.max(-reach, Math.min(reach, line.to * eye.scale));
    if (from === to) return null;
    return clipped(x + from * line.ux, y - from * line.uy, x + to * line.ux, y - to * line.uy, -60, -60, width + 60, height + 60);
  }

  // Return the corners of the part of a cell that is seen, as [x, y, x, y ...].
  outline(corners) {
    const { eye } = this;
    const shape = [];
    for (const v of corners) shape.push(...this.position(v));
    if (shape.every((z) => Math.abs(z) < NEAR)) return shape;
    const { points } = this.mesh;
    const at = (i) => [points[2 * corners[i]], points[2 * corners[i] + 1]];
    const [[ax, ay], [bx, by], [cx, cy]] = [at(0), at(1), at(2)];
    const unit = unitOf(bx - ax, by - ay, cx - ax, cy - ay);
    const sides = [twoDiff(bx, ax), twoDiff(by, ay), twoDiff(cx, ax), twoDiff(cy, ay)];
    const turn = Math.sign(crossed(...sides.map((pair) => [pair[0] * unit, pair[1] * unit]))[0]);
    const [w, h] = [eye.width / 2 + 60, eye.height / 2 + 60];
    let kept = [-w, -h, w, -h, w, h, -w, h]; // from the centre, upwards
    for (let i = 0; i < corners.length && kept.length; i++) {
      const line = lineNear(eye, ...at(i), ...at((i + 1) % corners.length));
      if (!line || !turn) return [];
      kept = leftOf(kept, line.x * eye.scale, line.y * eye.scale, turn * line.ux, turn * line.uy);
    }
    return kept.map((z, i) => (i & 1 ? eye.height / 2 - z : eye.width / 2 + z));
  }

  cells(rows) {
    const { context, mesh } = this;
    const { cover, edge } = theme();
    const single = new Path2D();
    context.fillStyle = withAlpha(cover, 0.24); // once: light; where cells overlap: darker
    const dots = [];
    const edges = new Path2D();
    for (const row of rows) {
      const corners = mesh.corners(row);
      if (corners.length === 1) dots.push(corners[0]);
      else {
        context.fill(pathOf(this.outline(corners)));
        this.addEdges(edges, corners);
      }
    }
    context.strokeStyle = edge;
    context.lineWidth = rows.length < 400 ? 1.1 : 0.7;
    context.stroke(edges);
    context.fillStyle = edge;
    for (const v of dots) this.disc(single, ...this.position(v), 2.2);
    context.fill(single);
  }

  addEdges(path, corners) {
    const { points } = this.mesh;
    for (let i = 0; i < corners.length; i++) {
      const [a, b] = [2 * corners[i], 2 * corners[(i + 1) % corners.length]];
      this.addLine(path, points[a], points[a + 1], points[b], points[b + 1]);
    }
  }

  addLine(path, ax, ay, bx, by) {
    const part = this.seen(ax, ay, bx, by);
    if (!part) return;
    path.moveTo(part[0], part[1]);
    path.lineTo(part[2], part[3]);
  }

  disc(path, x, y, radius) {
    if (!(Math.abs(x) < NEAR && Math.abs(y) < NEAR)) return;
    path.moveTo(x + radius, y);
    path.arc(x, y, radius, 0, 2 * Math.PI);
  }

  lines({ lines, tree, colour, width }) {
    const rows = tree.found(this.eye.window(), lines.boxOf, 20000);
    if (!rows) return;
    const { context } = this;
    const { points, ends } = lines;
    const path = new Path2D();
    for (const row of rows) {
      const [a, b] = [2 * ends[2 * row], 2 * ends[2 * row + 1]];
      this.addLine(path, points[a], points[a + 1], points[b], points[b + 1]);
    }
    context.strokeStyle = theme()[colour];
    context.lineWidth = rows.length > 5000 ? width / 2 : width;
    context.lineCap = "round";
    context.stroke(path);
  }

  numbers(rows) {
    if (rows.length > LABELS) return;
    const { context, mesh } = this;
    context.font = "11px ui-sans-serif, system-ui, sans-serif";
    context.textAlign = "center";
    context.textBaseline = "middle";
    const vertices = new Set();
    for (const row of rows) {
      const corners = mesh.corners(row);
      for (const v of corners) vertices.add(v);
      if (corners.length === 1) continue;
      const place = middleOf(this.outline(corners), this.eye.width, this.eye.height);
      if (place && place[2] > 500) this.label(String(row), place[0], place[1], theme().faint);
    }
    const dots = new Path2D();
    for (const v of vertices) {
      const [x, y] = this.position(v);
      if (x < -20 || y < -20 || x > this.eye.width + 20 || y > this.eye.height + 20) continue;
      this.disc(dots, x, y, 2.6);
      if (rows.length <= LABELS / 2 && !this.chosen?.vertices.includes(v)) this.label(String(v), x, y - 10, theme().edge);
    }
    context.fillStyle = theme().edge;
    context.fill(dots);
  }

  label(text, x, y, colour) {
    const { context } = this;
    context.lineWidth = 3;
    context.lineJoin = "round";
    context.strokeStyle = theme().halo;
    context.strokeText(text, x, y);
    context.fillStyle = colour;
    context.fillText(text, x, y);
  }

  bar() {
    const { context, eye } = this;
    const most = Math.min(160, eye.width / 3) / eye.scale;
    const power = 10 ** Math.floor(Math.log10(most));
    const length = [5, 2, 1].map((digit) => digit * power).find((z) => z <= most) ?? power;
    const pixels = length * eye.scale;
    if (!Number.isFinite(pixels)) return;
    const [x, y] = [16.5, eye.height - 16.5];
    context.strokeStyle = theme().text;
    context.lineWidth = 1.2;
    context.beginPath();
    context.moveTo(x, y - 4);
    context.lineTo(x, y);
    context.lineTo(x + pixels, y);
    context.lineTo(x + pixels, y - 4);
    context.stroke();
    context.font = "11px ui-sans-serif, system-ui, sans-serif";
    context.textAlign = "left";
    context.textBaseline = "bottom";
    const exponent = page.exponent ? ` × 2^${page.exponent}` : "";
    this.label(`${Number(length.toPrecision(1))}${exponent}`, x + pixels + 8, y + 5, theme().text);
  }
}

function pathOf(shape) {
  const path = new Path2D();
  for (let i = 0; i < shape.length; i += 2) {
    if (i) path.lineTo(shape[i], shape[i + 1]);
    else path.moveTo(shape[i], shape[i + 1]);
  }
  path.closePath();
  return path;
}

// The part of a polygon to the left of a line through (px, py) in the direction (ux, uy), y up.
function leftOf(shape, px, py, ux, uy) {
  const kept = [];
  const side = (i) => ux * (shape[i + 1] - py) - uy * (shape[i] - px);
  for (let i = 0; i < shape.length; i += 2) {
    const j = (i + 2) % shape.length;
    const [a, b] = [side(i), side(j)];
    if (a >= 0) kept.push(shape[i], shape[i + 1]);
    if (a >= 0 !== b >= 0) {
      const t = a / (a - b);
      kept.push(shape[i] + t * (shape[j] - shape[i]), shape[i + 1] + t * (shape[j + 1] - shape[i + 1]));
    }
  }
  return kept;
}

// The middle of the part of a polygon that is on the screen, and its area in pixels.
function middleOf(shape, width, height) {
  for (const [px, py, ux, uy] of [[0, 0, 0, -1], [width, height, 0, 1], [0, 0, 1, 0], [width, height, -1, 0]]) {
    shape = leftOf(shape, px, py, ux, uy);
    if (shape.length < 6) return null;
  }
  let [area, x, y] = [0, 0, 0];
  for (let i = 0; i < shape.length; i += 2) {
    const j = (i + 2) % shape.length;
    const cross = shape[i] * shape[j + 1] - shape[j] * shape[i + 1];
    area += cross;
    x += (shape[i] + shape[j]) * cross;
    y += (shape[i + 1] + shape[j + 1]) * cross;
  }
  return area ? [x / area / 3, y / area / 3, Math.abs(area) / 2] : null;
}
