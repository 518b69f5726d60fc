// The eye: which part of the plane is seen. Its centre is a double and a remainder, so that it moves smoothly even where
// neighbouring doubles are a hand's breadth apart.

class Eye {
  constructor(x = 0, y = 0, scale = 1) {
    Object.assign(this, { x, y, ox: 0, oy: 0, scale, width: 1, height: 1 });
  }

  copy() {
    return Object.assign(new Eye(), this);
  }

  sees(other) {
    return ["x", "y", "ox", "oy", "scale", "width", "height"].every((name) => this[name] === other[name]);
  }

  // Positions on the screen, in CSS pixels.
  left(x) {
    return (x - this.x - this.ox) * this.scale + this.width / 2;
  }

  top(y) {
    return this.height / 2 - (y - this.y - this.oy) * this.scale;
  }

  // The offset from the centre of a position on the screen.
  offset(left, top) {
    return [(left - this.width / 2) / this.scale, (this.height / 2 - top) / this.scale];
  }

  place(left, top) {
    const [dx, dy] = this.offset(left, top);
    return [this.x + (this.ox + dx), this.y + (this.oy + dy)];
  }

  move(dx, dy) {
    const [x, y] = [twoSum(this.x, this.ox + dx), twoSum(this.y, this.oy + dy)];
    if (!Number.isFinite(x[0] + y[0])) return;
    [this.x, this.ox] = x;
    [this.y, this.oy] = y;
  }

  // Zoom by a factor, keeping what is at a position on the screen.
  zoom(factor, left = this.width / 2, top = this.height / 2) {
    const scale = Math.min(Math.max(this.scale * factor, 1e-300), 1e300);
    const [dx, dy] = this.offset(left, top);
    const kept = this.scale / scale;
    this.move(dx * (1 - kept), dy * (1 - kept));
    this.scale = scale;
  }

  // The window in the plane, a little too large.
  window(margin = 2) {
    const [dx, dy] = [(this.width / 2 + margin) / this.scale, (this.height / 2 + margin) / this.scale];
    const [ex, ey] = [ulp(this.x), ulp(this.y)];
    return [
      this.x + (this.ox - dx) - ex,
      this.y + (this.oy - dy) - ey,
      this.x + (this.ox + dx) + ex,
      this.y + (this.oy + dy) + ey,
    ];
  }

  // Look at a box [west, south, east, north].
  look(box, share = 0.9) {
    const [west, south, east, north] = box;
    const scale = Math.min((share * this.width) / (east - west), (share * this.height) / (north - south));
    this.scale = Number.isFinite(scale) && scale > 0 ? Math.min(scale, 1e300) : 0.25 / ulp(Math.max(Math.abs(west), Math.abs(south)));
    [this.x, this.y, this.ox, this.oy] = [west, south, 0, 0];
    this.move((east - west) / 2, (north - south) / 2);
  }
}

// The distance to the next double, for numbers that are not tiny.
function ulp(x) {
  const size = Math.abs(x);
  return size < 2 ** -1000 ? 2 ** -1052 : 2 ** (Math.floor(Math.log2(size)) - 52);
}

// Return the way from one eye to another, as a function of 0 .. 1 and how long it should take [van Wijk 2003]. It is
// counted from the end, where the eye may have to see very small things.
function flight(from, to) {
  const [dx, dy] = [from.x - to.x + (from.ox - to.ox), from.y - to.y + (from.oy - to.oy)];
  const far = Math.hypot(dx, dy);
  const [wide, narrow] = [from.width / from.scale, to.width / to.scale];
  const at = (share, width) => {
    const eye = to.copy();
    eye.move(dx * share, dy * share);
    eye.scale = to.width / width;
    return eye;
  };
  const rho = Math.SQRT2;
  if (!(far > 1e-9 * Math.max(wide, narrow))) {
    const way = Math.log(wide / narrow) / rho;
    return { at: (t) => at(1 - t, narrow * Math.exp(rho * way * (1 - t))), length: Math.abs(way) };
  }
  const start = -Math.asinh((wide * wide - narrow * narrow + 4 * far * far) / (4 * narrow * far));
  const end = -Math.asinh((wide * wide - narrow * narrow - 4 * far * far) / (4 * wide * far));
  const way = (end - start) / rho;
  const step = (t) => {
    const s = rho * way * (1 - t);
    const share = ((narrow / (2 * far)) * Math.sinh(s)) / Math.cosh(s + start);
    return at(share, (narrow * Math.cosh(start)) / Math.cosh(s + start));
  };
  return { at: (t) => (t >= 1 ? to.copy() : step(t)), length: Math.abs(way) };
}
