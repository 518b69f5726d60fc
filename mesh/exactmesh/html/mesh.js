// The mesh: its cells are triangles, then quadrilaterals, then points that are no corner of any.

class Mesh {
  constructor(points, triangles, quads, loose) {
    Object.assign(this, { points, triangles, quads, loose });
    this.n = points.length / 2;
    this.m = triangles.length / 3;
    this.k = quads.length / 4;
    this.count = this.m + this.k + loose.length;
    this.boxOf = this.boxOf.bind(this);
  }

  corners(cell) {
    if (cell < this.m) return this.triangles.subarray(3 * cell, 3 * cell + 3);
    const quad = cell - this.m;
    if (quad < this.k) return this.quads.subarray(4 * quad, 4 * quad + 4);
    return this.loose.subarray(quad - this.k, quad - this.k + 1);
  }

  boxOf(cell, box) {
    const { points, triangles, quads, loose, m, k } = this;
    const [array, first, size] =
      cell < m ? [triangles, 3 * cell, 3] : cell < m + k ? [quads, 4 * (cell - m), 4] : [loose, cell - m - k, 1];
    let [west, south, east, north] = [Infinity, Infinity, -Infinity, -Infinity];
    for (let i = first; i < first + size; i++) {
      const v = 2 * array[i];
      const [x, y] = [points[v], points[v + 1]];
      if (!(Number.isFinite(x) && Number.isFinite(y))) return false; // no such point, or not finite
      if (x < west) west = x;
      if (x > east) east = x;
      if (y < south) south = y;
      if (y > north) north = y;
    }
    box[0] = west;
    box[1] = south;
    box[2] = east;
    box[3] = north;
    return true;
  }
}

// Straight lines between points: the mesh's boundary, its segments, those of the domain.
class Lines {
  constructor(points, ends) {
    Object.assign(this, { points, ends, count: ends.length / 2 });
    this.boxOf = this.boxOf.bind(this);
  }

  boxOf(i, box) {
    const [a, b] = [2 * this.ends[2 * i], 2 * this.ends[2 * i + 1]];
    const [ax, ay, bx, by] = [this.points[a], this.points[a + 1], this.points[b], this.points[b + 1]];
    box[0] = Math.min(ax, bx);
    box[1] = Math.min(ay, by);
    box[2] = Math.max(ax, bx);
    box[3] = Math.max(ay, by);
    return Number.isFinite(ax + ay) && Number.isFinite(bx + by);
  }
}

// The box of all finite points, made a little larger where it has no area.
function extentOf(points) {
  let [west, south, east, north] = [Infinity, Infinity, -Infinity, -Infinity];
  for (let i = 0; i < points.length; i += 2) {
    const [x, y] = [points[i], points[i + 1]];
    if (!(Number.isFinite(x) && Number.isFinite(y))) continue;
    if (x < west) west = x;
    if (x > east) east = x;
    if (y < south) south = y;
    if (y > north) north = y;
  }
  return west <= east ? [west, south, east, north] : [-1, -1, 1, 1];
}
