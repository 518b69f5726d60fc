// The page: reads its data, draws, and answers to mouse, fingers, keys and buttons.

const page = JSON.parse(byId("report").textContent);

class Viewer {
  constructor() {
    this.canvas = byId("picture");
    this.scene = null;
    this.asked = false;
    this.flying = 0;
    this.pointers = new Map();
    this.panel = new Panel(this);
  }

  async start() {
    if (typeof DecompressionStream === "undefined") throw new Error("this browser is too old: it has no DecompressionStream");
    const { arrays } = page;
    const say = (text) => (byId("status").textContent = text);
    say("reading points");
    const points = await unpacked("points", arrays.points, Float64Array);
    say("reading cells");
    const triangles = await unpacked("triangles", arrays.triangles, Uint32Array);
    const quads = await unpacked("quads", arrays.quads, Uint32Array);
    const loose = await unpacked("loose", arrays.loose, Uint32Array);
    const mesh = new Mesh(points, triangles, quads, loose);
    this.extent = extentOf(points);
    say("sorting");
    const tree = await Tree.over(mesh.count, mesh.boxOf, this.extent);
    const layers = await this.layers(points);
    this.scene = new Scene(this.canvas, mesh, tree, layers);
    this.listen();
    this.resize();
    this.fit(false);
    say("");
    byId("stage").setAttribute("aria-busy", "false");
    await new Promise((resolve) => (this.settle = resolve));
  }

  // Boundary, segments, and the domain's segments on points of their own.
  async layers(points) {
    const { arrays } = page;
    const made = [];
    for (const [name, colour, width, own] of [["boundary", "border", 1.6, ""], ["segments", "segment", 2.4, ""], ["outline", "segment", 2.4, "corners"]]) {
      if (!arrays[name]) continue;
      const ends = await unpacked(name, arrays[name], Uint32Array);
      const lines = new Lines(own ? await unpacked(own, arrays[own], Float64Array) : points, ends);
      made.push({ lines, colour, width, tree: await Tree.over(lines.count, lines.boxOf, this.extent) });
    }
    return made;
  }

  get eye() {
    return this.scene.eye;
  }

  resize() {
    const { clientWidth, clientHeight } = byId("stage");
    this.scene.resize(Math.max(clientWidth, 1), Math.max(clientHeight, 1));
    this.redraw();
  }

  redraw() {
    if (this.asked || !this.scene) return;
    this.asked = true;
    requestAnimationFrame(() => {
      this.asked = false;
      this.scene.marks = this.panel.marks;
      const more = this.scene.draw();
      byId("working").hidden = !more;
      if (more) this.redraw();
      else if (!this.flying) this.settle?.();
    });
  }

  // Look at a box.
  go(box, animated = true, share = 0.9) {
    const target = this.eye.copy();
    const [left, top] = this.covered;
    target.width -= left;
    target.height -= top;
    target.look(box, share);
    target.width += left;
    target.height += top;
    target.move(-left / 2 / target.scale, top / 2 / target.scale);
    this.fly(target, animated);
  }

  // How much of the left or of the top of the picture is under what is said of a chosen place.
  get covered() {
    const details = byId("details");
    if (details.hidden) return [0, 0];
    const right = details.offsetLeft + details.offsetWidth;
    const bottom = details.offsetTop + details.offsetHeight;
    const { width, height } = this.eye;
    if (right < width / 2 + 60) return [right, 0];
    return bottom < height / 2 + 60 ? [0, bottom] : [0, 0];
  }

  fit(animated = true) {
    this.go(this.extent, animated, 0.92);
  }

  fly(target, animated) {
    const own = ++this.flights;
    const still = matchMedia("(prefers-reduced-motion: reduce)").matches;
    if (!animated || still) {
      this.flying = 0;
      Object.assign(this.eye, target);
      return this.redraw();
    }
    const way = flight(this.eye.copy(), target);
    const time = Math.min(1600, 350 + 90 * way.length);
    const begin = performance.now();
    this.flying = own;
    const step = () => {
      if (this.flying !== own) return;
      const t = Math.min(1, (performance.now() - begin) / time);
      const eased = t * t * (3 - 2 * t);
      const { width, height } = this.eye;
      Object.assign(this.eye, t < 1 ? way.at(eased) : target, { width, height });
      if (t >= 1) this.flying = 0;
      this.redraw();
      if (t < 1) requestAnimationFrame(step);
    };
    step();
  }

  stop() {
    this.flying = 0;
  }

  // Choose a violation by its number in the list, and fly there.
  choose(index, animated = true) {
    const mark = page.violations[index] ?? null;
    if (this.scene) this.scene.chosen = mark;
    this.panel.show(mark);
    byId("told").textContent = mark ? mark.message : "";
    if (this.scene && mark?.box) this.go(this.around(mark.box), animated, 0.5);
    else this.redraw();
  }

  // A box to look at; one without extent gets that of what is around it.
  around(box) {
    const [west, south, east, north] = box;
    if (east > west || north > south) return box;
    const { mesh, tree } = this.scene;
    const near = tree.found([west, south, east, north], mesh.boxOf, 200) ?? [];
    const other = new Float64Array(4);
    let reach = Math.max(this.extent[2] - this.extent[0], this.extent[3] - this.extent[1]) / (4 * Math.sqrt(mesh.count + 1));
    near.forEach((cell, i) => {
      mesh.boxOf(cell, other);
      const size = Math.max(other[2] - other[0], other[3] - other[1]);
      if (size > 0) reach = i ? Math.min(reach, size) : size;
    });
    return [west - reach, south - reach, east + reach, north + reach];
  }

  // Centre on a vertex, nearer with every call.
  approach(vertex) {
    const { points } = this.scene.mesh;
    const [x, y] = [points[2 * vertex], points[2 * vertex + 1]];
    if (!Number.isFinite(x + y)) return;
    const target = this.eye.copy();
    Object.assign(target, { x, y, ox: 0, oy: 0 });
    target.scale = Math.min(target.scale * 16, 40 / Math.min(ulp(x), ulp(y)), 1e300);
    const [left, top] = this.covered;
    target.move(-left / 2 / target.scale, top / 2 / target.scale);
    this.fly(target, true);
  }

  next(step) {
    const marks = this.panel.marks;
    if (!marks.length) return;
    const at = marks.indexOf(this.scene.chosen);
    this.choose(marks[at < 0 ? 0 : (at + step + marks.length) % marks.length].index);
  }

  zoom(factor, left, top) {
    this.stop();
    this.eye.zoom(factor, left, top);
    this.redraw();
  }
}
