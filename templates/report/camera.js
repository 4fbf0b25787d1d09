// A camera without perspective, so that lengths can be compared, and common functions of all drawing.
const palette = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#8a6d3b"];  // distinguishable with any colour vision

function styleOf(name) { return getComputedStyle(document.documentElement).getPropertyValue(name).trim(); }
function mixed(colour, other, share) {
  const parts = (text) => [1, 3, 5].map((k) => parseInt((text.length === 4 ? "#" + [...text.slice(1)].map((c) => c + c).join("") : text).slice(k, k + 2), 16));
  const a = parts(colour), b = parts(other);
  return "rgb(" + a.map((value, k) => Math.round(value * (1 - share) + b[k] * share)).join(",") + ")";
}

class Camera {
  constructor() { Object.assign(this, {zoom: 1, pan: [0, 0], azimuth: 0, elevation: 0, width: 1, height: 1}); }

  // Looks along the normal of a plane motion, else from the side and slightly from above; gravity points down.
  // Contents: balls [x, y, z, radius].
  find(balls, down) {
    const low = [0, 1, 2].map((k) => Math.min(...balls.map((r) => r[k]))), high = [0, 1, 2].map((k) => Math.max(...balls.map((r) => r[k])));
    this.centre = low.map((value, k) => (value + high[k]) / 2);
    const extent = Math.hypot(...minus(high, low)) || 1;
    let normal = [2, 1, 0].find((k) => high[k] - low[k] <= 1e-9 * extent);
    const falls = down ? unit(down) : null;
    if (normal !== undefined && falls && Math.abs(falls[normal]) > 0.99) normal = undefined;
    const axis = (k) => [0, 1, 2].map((i) => (i === k ? 1 : 0));
    this.up = falls ? scaled(falls, -1) : axis(normal === 2 ? 1 : 2);
    this.flat = normal !== undefined;
    if (this.flat) {
      this.front = axis(normal);
      const right = cross(this.up, this.front);
      if (right[0] + right[1] + right[2] < 0) this.front = scaled(this.front, -1);
    } else {
      const other = [0, 1, 2].map(axis).find((e) => Math.abs(dot(e, this.up)) < 0.5);
      this.front = unit(minus(other, scaled(this.up, dot(other, this.up))));
    }
    this.side = cross(this.up, this.front);
    this.home();
    // Centred on the contents in this view.
    const across = balls.map((r) => [dot(this.right, minus(r, this.centre)), dot(this.above, minus(r, this.centre)), r[3]]);
    const [[left, right], [bottom, top]] = [0, 1].map((k) => [Math.min(...across.map((p) => p[k] - p[2])), Math.max(...across.map((p) => p[k] + p[2]))]);
    this.centre = plus(this.centre, plus(scaled(this.right, (left + right) / 2), scaled(this.above, (bottom + top) / 2)));
    this.half = [(right - left) / 2, (top - bottom) / 2];
    if (!(Math.hypot(...this.half) > 0)) this.half = [0.5, 0.5];  // a single point
    this.size = Math.hypot(...this.half);
  }
  home() {
    this.zoom = 1;
    this.pan = [0, 0];
    this.azimuth = this.flat ? 0 : 0.6;
    this.elevation = this.flat ? 0 : 0.3;
    this.turn(0, 0);
  }
  turn(azimuth, elevation) {
    this.azimuth += azimuth;
    this.elevation = Math.min(Math.PI / 2, Math.max(-Math.PI / 2, this.elevation + elevation));
    const ca = Math.cos(this.azimuth), sa = Math.sin(this.azimuth), ce = Math.cos(this.elevation), se = Math.sin(this.elevation);
    const level = plus(scaled(this.front, ca), scaled(this.side, sa));
    this.toward = plus(scaled(level, ce), scaled(this.up, se));
    this.above = plus(scaled(this.up, ce), scaled(level, -se));
    this.right = cross(this.above, this.toward);
  }
  // With a margin for labels.
  scale() {
    const room = Math.min(44, 0.12 * Math.min(this.width, this.height)), least = 0.02 * this.size;
    return Math.min((this.width / 2 - room) / Math.max(this.half[0], least), (this.height / 2 - room) / Math.max(this.half[1], least)) * this.zoom;
  }
  // A vector, and a point, on the screen.
  flattened(v) { const s = this.scale(); return [s * dot(this.right, v), -s * dot(this.above, v)]; }
  project(r) {
    const [x, y] = this.flattened(minus(r, this.centre));
    return [this.width / 2 + this.pan[0] + x, this.height / 2 + this.pan[1] + y];
  }
  depth(r) { return dot(this.toward, minus(r, this.centre)); }
  // The vector in the screen plane for a movement of the pointer.
  lift(dx, dy) { return scaled(plus(scaled(this.right, dx), scaled(this.above, -dy)), 1 / this.scale()); }
}
