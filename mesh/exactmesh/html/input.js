// Mouse, fingers, keys, buttons.

Object.assign(Viewer.prototype, {
  flights: 0,

  listen() {
    const { canvas } = this;
    canvas.addEventListener("wheel", (event) => this.onWheel(event), { passive: false });
    canvas.addEventListener("pointerdown", (event) => this.onDown(event));
    canvas.addEventListener("pointermove", (event) => this.onMove(event));
    for (const name of ["pointerup", "pointercancel"]) canvas.addEventListener(name, (event) => this.onUp(event));
    canvas.addEventListener("dblclick", (event) => this.zoom(3, event.offsetX, event.offsetY));
    canvas.addEventListener("keydown", (event) => this.onKey(event));
    new ResizeObserver(() => this.resize()).observe(byId("stage"));
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
      this.scene.forget();
      this.redraw();
    });
    const actions = {
      fit: () => this.fit(),
      closer: () => this.zoom(2),
      farther: () => this.zoom(0.5),
      next: () => this.next(1),
      previous: () => this.next(-1),
      dismiss: () => this.choose(-1),
    };
    for (const [id, action] of Object.entries(actions)) byId(id).addEventListener("click", action);
    for (const row of document.querySelectorAll("[data-property]")) {
      row.addEventListener("click", () => this.panel.only(row.dataset.property));
    }
  },

  onWheel(event) {
    event.preventDefault();
    const lines = event.deltaMode === 1 ? 16 : 1;
    const pinched = event.ctrlKey ? 4 : 1;
    const delta = Math.max(-240, Math.min(240, event.deltaY * lines * pinched));
    this.zoom(2 ** (-delta / 160), event.offsetX, event.offsetY);
  },

  onDown(event) {
    this.stop();
    this.canvas.setPointerCapture(event.pointerId);
    this.pointers.set(event.pointerId, [event.offsetX, event.offsetY]);
    this.moved = this.pointers.size > 1;
    this.pressed = [event.offsetX, event.offsetY];
  },

  onMove(event) {
    const here = [event.offsetX, event.offsetY];
    const before = this.pointers.get(event.pointerId);
    if (!before) return this.tell(...here);
    if (Math.hypot(here[0] - this.pressed[0], here[1] - this.pressed[1]) > 4) this.moved = true;
    if (!this.moved) return undefined;
    const others = [...this.pointers].filter(([id]) => id !== event.pointerId);
    this.pointers.set(event.pointerId, here);
    if (others.length) {
      const [other] = others[0].slice(1);
      const apart = (p) => Math.max(8, Math.hypot(p[0] - other[0], p[1] - other[1]));
      this.drag((here[0] - before[0]) / 2, (here[1] - before[1]) / 2);
      this.eye.zoom(apart(here) / apart(before), (here[0] + other[0]) / 2, (here[1] + other[1]) / 2);
    } else {
      this.drag(here[0] - before[0], here[1] - before[1]);
    }
    this.redraw();
    return undefined;
  },

  drag(left, top) {
    this.eye.move(-left / this.eye.scale, top / this.eye.scale);
  },

  onUp(event) {
    const known = this.pointers.delete(event.pointerId);
    if (!known || this.moved || event.type === "pointercancel") return;
    const mark = this.markAt(event.offsetX, event.offsetY);
    if (mark) this.choose(mark.index);
  },

  markAt(left, top) {
    let [nearest, best] = [null, 12];
    for (const mark of this.panel.marks) {
      const place = this.scene.pin(mark);
      const far = place ? Math.hypot(place[0] - left, place[1] - top) : Infinity;
      if (far < best) [nearest, best] = [mark, far];
    }
    return nearest;
  },

  onKey(event) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const step = event.shiftKey ? 240 : 60;
    const actions = {
      ArrowLeft: () => this.drag(step, 0),
      ArrowRight: () => this.drag(-step, 0),
      ArrowUp: () => this.drag(0, step),
      ArrowDown: () => this.drag(0, -step),
      "+": () => this.eye.zoom(1.5),
      "=": () => this.eye.zoom(1.5),
      "-": () => this.eye.zoom(1 / 1.5),
      0: () => this.fit(),
      f: () => this.fit(),
      n: () => this.next(1),
      p: () => this.next(-1),
      Escape: () => this.choose(-1),
    };
    const action = actions[event.key];
    if (!action) return;
    event.preventDefault();
    this.stop();
    action();
    this.redraw();
  },

  // What is under the mouse.
  tell(left, top) {
    const [x, y] = this.eye.place(left, top);
    const { mesh, tree } = this.scene;
    const cells = tree.found([x, y, x, y], mesh.boxOf, 400) ?? [];
    const inside = cells.filter((cell) => holds(mesh, cell, x, y)).slice(0, 4);
    const names = inside.map((cell) => `${cell < mesh.m ? "triangle" : "quad"} ${cell}`);
    const exponent = page.exponent ? ` · 2^${page.exponent}` : "";
    byId("status").textContent = [`(${x}, ${y})${exponent}`, ...names].join("   ");
  },
});

// Whether a cell holds a place, to be told, not to be trusted.
function holds(mesh, cell, x, y) {
  const corners = mesh.corners(cell);
  const { points } = mesh;
  let inside = false;
  for (let i = 0, j = corners.length - 1; i < corners.length; j = i++) {
    const [ax, ay, bx, by] = [points[2 * corners[i]], points[2 * corners[i] + 1], points[2 * corners[j]], points[2 * corners[j] + 1]];
    if (ay > y !== by > y && x < ((bx - ax) * (y - ay)) / (by - ay) + ax) inside = !inside;
  }
  return inside;
}

const viewer = new Viewer();
const ready = viewer.start().catch((error) => {
  byId("status").textContent = `cannot draw: ${error.message}`;
  byId("stage").setAttribute("aria-busy", "false");
  throw error;
});

// For tests, and for whoever opens the console.
window.exactmesh = {
  ready,
  report: page,
  get view() {
    const { x, y, ox, oy, scale, width, height } = viewer.eye;
    return { x, y, ox, oy, scale, width, height };
  },
  get mode() {
    return viewer.scene.mode;
  },
  get busy() {
    return viewer.asked || viewer.flying > 0 || viewer.scene.raster !== null;
  },
  get chosen() {
    return viewer.scene.chosen?.index ?? -1;
  },
  choose: (index, animated = false) => viewer.choose(index, animated),
  fit: () => viewer.fit(false),
  zoom: (factor) => viewer.zoom(factor),
  look: (box) => viewer.go(box, false, 1),
};
