// Numbers of twice the precision, [high, low]: what is a million million pixels away must not move what is seen here.

function twoSum(a, b) {
  const sum = a + b;
  const virtual = sum - a;
  return [sum, a - (sum - virtual) + (b - virtual)];
}

const twoDiff = (a, b) => twoSum(a, -b);

function split(a) {
  const c = 134217729 * a;
  const high = c - (c - a);
  return [high, a - high];
}

function twoProduct(a, b) {
  const product = a * b;
  const [ah, al] = split(a);
  const [bh, bl] = split(b);
  return [product, al * bl - (product - ah * bh - al * bh - ah * bl)];
}

function plus(a, b) {
  const [sum, error] = twoSum(a[0], b[0]);
  return twoSum(sum, error + a[1] + b[1]);
}

function times(a, b) {
  const [product, error] = twoProduct(a[0], b[0]);
  return twoSum(product, error + a[0] * b[1] + a[1] * b[0]);
}

const negated = (a) => [-a[0], -a[1]];
const minus = (a, b) => plus(a, negated(b));
const crossed = (ux, uy, vx, vy) => minus(times(ux, vy), times(uy, vx));
const dotted = (ux, uy, vx, vy) => plus(times(ux, vx), times(uy, vy));

// Return the power of two that brings the largest of the numbers near 1.
function unitOf(...numbers) {
  const largest = Math.max(...numbers.map(Math.abs));
  if (!(largest > 0) || !Number.isFinite(largest)) return 1;
  return 2 ** -Math.min(1000, Math.max(-1000, Math.floor(Math.log2(largest))));
}

// Return the line from a to b near the eye: its point nearest to the eye, in units from there; its direction; and how
// far along it a and b are.
function lineNear(eye, ax, ay, bx, by) {
  const unit = unitOf(bx - ax, by - ay, eye.x - ax, eye.y - ay);
  const [dx, dy] = between(ax, ay, bx, by, unit);
  const [ex, ey] = toEye(eye, ax, ay, unit);
  const length = Math.hypot(dx[0], dy[0]);
  if (!(length > 0)) return null;
  const [ux, uy] = [dx[0] / length, dy[0] / length];
  const off = crossed(dx, dy, ex, ey)[0] / length / unit;
  const along = (ex[0] * ux + ey[0] * uy) / unit;
  return { x: uy * off, y: -ux * off, ux, uy, from: -along, to: length / unit - along };
}

// Return the circle through three points near the eye: its point nearest to the eye, in units from there; the direction
// from the centre to it; its radius.
function circleNear(eye, ax, ay, bx, by, cx, cy) {
  const unit = unitOf(bx - ax, by - ay, cx - ax, cy - ay);
  const [ux, uy] = between(ax, ay, bx, by, unit);
  const [vx, vy] = between(ax, ay, cx, cy, unit);
  const [ex, ey] = toEye(eye, ax, ay, unit);
  const area = crossed(ux, uy, vx, vy);
  if (area[0] === 0) return null;
  const u = dotted(ux, uy, ux, uy);
  const v = dotted(vx, vy, vx, vy);
  // Twice the area times twice the centre, from a.
  const px = minus(times(u, vy), times(v, uy));
  const py = minus(times(v, ux), times(u, vx));
  const power = minus(dotted(ex, ey, ex, ey), quotient(dotted(px, py, ex, ey), area));
  return nearest(power[0], ex[0], ey[0], px[0] / area[0] / 2, py[0] / area[0] / 2, unit);
}

// The same of the circle with the diameter ab.
function diametralNear(eye, ax, ay, bx, by) {
  const unit = unitOf(bx - ax, by - ay);
  const [ux, uy] = between(ax, ay, bx, by, unit);
  const [ex, ey] = toEye(eye, ax, ay, unit);
  const power = minus(dotted(ex, ey, ex, ey), dotted(ex, ey, ux, uy));
  return nearest(power[0], ex[0], ey[0], ux[0] / 2, uy[0] / 2, unit);
}

// The eye at (ex, ey), the centre at (zx, zy), the circle through the origin.
function nearest(power, ex, ey, zx, zy, unit) {
  const [wx, wy] = [ex - zx, ey - zy];
  const [radius, away] = [Math.hypot(zx, zy), Math.hypot(wx, wy)];
  const [nx, ny] = away > 0 ? [wx / away, wy / away] : [1, 0];
  const off = power / (away + radius) / unit;
  return { x: -nx * off, y: -ny * off, nx, ny, radius: radius / unit };
}

const scaled = (pair, unit) => [pair[0] * unit, pair[1] * unit];

function between(ax, ay, bx, by, unit) {
  return [scaled(twoDiff(bx, ax), unit), scaled(twoDiff(by, ay), unit)];
}

function toEye(eye, ax, ay, unit) {
  return [scaled(plus(twoDiff(eye.x, ax), [eye.ox, 0]), unit), scaled(plus(twoDiff(eye.y, ay), [eye.oy, 0]), unit)];
}

function quotient(a, b) {
  const first = a[0] / b[0];
  const rest = minus(a, times([first, 0], b));
  return twoSum(first, rest[0] / b[0]);
}
