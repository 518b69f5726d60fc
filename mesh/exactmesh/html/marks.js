// The marks of the failing places: a pin each, and all about the chosen one.

Object.assign(Scene.prototype, {
  colourOf(mark) {
    return theme()[mark.tone === "not_claimed" ? "faint" : mark.tone];
  },

  // Where the pin of a violation is on the screen, or null.
  pin(mark) {
    if (!mark.box) return null;
    const [west, south, east, north] = mark.box;
    const x = this.eye.left(west) / 2 + this.eye.left(east) / 2;
    const y = this.eye.top(south) / 2 + this.eye.top(north) / 2;
    const seen = x > -20 && y > -20 && x < this.eye.width + 20 && y < this.eye.height + 20;
    return seen ? [x, y] : null;
  },

  drawMarks() {
    const { context } = this;
    for (const mark of [...this.marks].reverse()) {
      const place = mark === this.chosen ? null : this.pin(mark);
      if (!place) continue;
      const path = new Path2D();
      this.disc(path, ...place, 5);
      context.fillStyle = this.colourOf(mark);
      context.strokeStyle = theme().halo;
      context.lineWidth = 2;
      context.stroke(path);
      context.fill(path);
    }
    if (this.chosen) this.drawChosen(this.chosen);
  },

  drawChosen(mark) {
    const { context, mesh } = this;
    const colour = this.colourOf(mark);
    const edges = new Path2D();
    context.fillStyle = withAlpha(colour, 0.16);
    for (const cell of mark.triangles) {
      const corners = mesh.corners(cell);
      if (![...corners].every((v) => v < mesh.n)) continue;
      context.fill(pathOf(this.outline(corners)));
      this.addEdges(edges, corners);
    }
    context.lineCap = context.lineJoin = "round";
    context.strokeStyle = withAlpha(colour, 0.75);
    context.lineWidth = 1.6;
    context.stroke(edges);
    this.emphasise(mark, colour);
    this.drawPlaces(mark, colour);
    const pin = this.pin(mark);
    if (pin && this.sizeOf(mark) < 30) {
      const ring = new Path2D();
      this.disc(ring, ...pin, 13);
      context.strokeStyle = colour;
      context.lineWidth = 2.5;
      context.stroke(ring);
    }
  },

  sizeOf(mark) {
    const [west, south, east, north] = mark.box;
    return Math.max(east - west, north - south) * this.eye.scale;
  },

  // Lines and circles that the violation is about.
  emphasise(mark, colour) {
    const { context, mesh } = this;
    const { points } = mesh;
    const xy = (v) => [points[2 * v], points[2 * v + 1]];
    const lines = new Path2D();
    for (const [a, b] of mark.lines) this.addLine(lines, ...xy(a), ...xy(b));
    if (mark.places.length === 2) this.addLine(lines, ...mark.places.flat()); // a segment of the domain
    context.strokeStyle = colour;
    context.lineWidth = 3;
    context.stroke(lines);
    const circles = new Path2D();
    for (const corners of mark.circles) {
      if (corners.length === 3) this.addCircle(circles, circleNear(this.eye, ...corners.flatMap(xy)));
      else this.addCircle(circles, diametralNear(this.eye, ...corners.flatMap(xy)));
    }
    context.lineWidth = 1.6;
    context.setLineDash([7, 5]);
    context.stroke(circles);
    context.setLineDash([]);
  },

  addCircle(path, circle) {
    if (!circle) return;
    const { scale, width, height } = this.eye;
    const [x, y] = [width / 2 + circle.x * scale, height / 2 - circle.y * scale];
    const radius = circle.radius * scale;
    if (radius < 1e5) {
      const [left, top] = [x - circle.nx * radius, y + circle.ny * radius];
      path.moveTo(left + radius, top);
      path.arc(left, top, radius, 0, 2 * Math.PI);
      return;
    }
    const reach = 2 * (width + height);
    if (!(Math.abs(x) < reach && Math.abs(y) < reach)) return;
    for (let i = -64; i <= 64; i++) {
      const t = (i / 64) * Math.min(reach, radius);
      const back = Number.isFinite(radius) ? (t * t) / (radius + Math.sqrt(Math.max(0, (radius - t) * (radius + t)))) : 0;
      const left = x - circle.ny * t - circle.nx * back;
      const top = y - circle.nx * t + circle.ny * back;
      if (i === -64) path.moveTo(left, top);
      else path.lineTo(left, top);
    }
  },

  // The vertices, with their numbers; and positions that are no vertices.
  drawPlaces(mark, colour) {
    const { context, mesh } = this;
    context.font = "600 12px ui-sans-serif, system-ui, sans-serif";
    context.textAlign = "center";
    context.textBaseline = "middle";
    const close = this.sizeOf(mark) >= 30;
    const places = mark.vertices.filter((v) => v >= 0 && v < mesh.n).map((v) => [String(v), ...this.position(v)]);
    for (const [x, y] of mark.places) places.push(["", this.eye.left(x), this.eye.top(y)]);
    const taken = [];
    for (const [name, x, y] of places) {
      if (!(Math.abs(x) < NEAR && Math.abs(y) < NEAR)) continue;
      const path = new Path2D();
      this.disc(path, x, y, close ? 4.5 : 3);
      context.lineWidth = 2;
      context.strokeStyle = theme().halo;
      context.stroke(path);
      context.fillStyle = colour;
      context.fill(path);
      if (!close || !name) continue;
      let top = y - 14;
      while (taken.some(([left, other]) => Math.abs(left - x) < 24 && Math.abs(other - top) < 13)) top -= 14;
      taken.push([x, top]);
      this.label(name, x, top, colour);
    }
  },
});
