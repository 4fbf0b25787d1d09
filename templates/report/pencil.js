// Strokes on the canvas in the colours of the page. Points with three numbers are in space, with two on the screen;
// names are drawn last, on top.
class Pencil {
  constructor(canvas, camera) { Object.assign(this, {canvas, camera, draw: canvas.getContext("2d"), names: [], taken: []}); }

  // Starts an empty picture with the current size of the canvas.
  begin() {
    const ratio = window.devicePixelRatio || 1, {canvas, camera} = this;
    camera.width = canvas.clientWidth || 640;
    camera.height = canvas.clientHeight || 480;
    const width = Math.round(camera.width * ratio), height = Math.round(camera.height * ratio);
    if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, {width, height});
    this.draw.setTransform(ratio, 0, 0, ratio, 0, 0);
    [this.paper, this.ink, this.quiet, this.rule] = ["--paper", "--ink", "--quiet", "--line"].map(styleOf);
    this.names = [];
    this.taken = [];
    this.draw.clearRect(0, 0, camera.width, camera.height);
  }
  at(r) { return r.length === 3 ? this.camera.project(r) : r; }

  trace(points, closed) {
    const {draw} = this;
    draw.beginPath();
    points.forEach((r, k) => { const p = this.at(r); if (k === 0) draw.moveTo(p[0], p[1]); else draw.lineTo(p[0], p[1]); });
    if (closed) draw.closePath();
  }
  stroke(colour, width, alpha) {
    const {draw} = this;
    draw.globalAlpha = alpha === undefined ? 1 : alpha;
    draw.strokeStyle = colour;
    draw.lineWidth = width;
    draw.lineJoin = draw.lineCap = "round";
    draw.stroke();
    draw.globalAlpha = 1;
  }
  line(points, colour, width, alpha) {
    this.trace(points);
    this.stroke(colour, width, alpha);
  }
  dashed(points, colour, width) {
    this.draw.setLineDash([5, 5]);
    this.line(points, colour, width);
    this.draw.setLineDash([]);
  }
  // Many short lines at once.
  segments(list, colour, width, alpha) {
    const {draw} = this;
    draw.beginPath();
    for (const [a, b] of list) { const p = this.at(a), q = this.at(b); draw.moveTo(p[0], p[1]); draw.lineTo(q[0], q[1]); }
    this.stroke(colour, width, alpha);
  }
  dot(r, radius, fill, edge) {
    const [x, y] = this.at(r), {draw} = this;
    draw.beginPath();
    draw.arc(x, y, radius, 0, 2 * Math.PI);
    draw.fillStyle = fill;
    draw.fill();
    if (edge) this.stroke(edge, 2);
  }
  head([x, y], [ux, uy], size, colour, width) {
    this.line([[x - size * (ux + 0.45 * uy), y - size * (uy - 0.45 * ux)], [x, y], [x - size * (ux - 0.45 * uy), y - size * (uy + 0.45 * ux)]], colour, width);
  }
  // Tip and direction on the screen; null if the arrow is seen end-on.
  arrow(from, to, colour, width) {
    const a = this.at(from), b = this.at(to), length = Math.hypot(b[0] - a[0], b[1] - a[1]);
    if (!(length >= 3)) return null;
    const u = [(b[0] - a[0]) / length, (b[1] - a[1]) / length];
    this.line([a, b], colour, width);
    this.head(b, u, Math.min(4 + 2.2 * width, length / 2), colour, width);
    return {tip: b, along: u};
  }
  // A moment by the right-hand rule: an arrow with two heads, or, seen end-on, an arc as wide as the arrow is long.
  moment(from, to, colour, width) {
    const {camera} = this, axis = minus(to, from), length = Math.hypot(...axis) * camera.scale(), [x, y] = this.at(from), b = this.at(to), seen = Math.hypot(b[0] - x, b[1] - y);
    if (!(length >= 3)) return null;
    const size = Math.min(4 + 2.2 * width, length / 2);
    if (seen > 0.5 * length && seen >= 3) {
      const drawn = this.arrow(from, to, colour, width);
      this.head([b[0] - 0.8 * size * drawn.along[0], b[1] - 0.8 * size * drawn.along[1]], drawn.along, size, colour, width);
      return drawn;
    }
    const sense = Math.sign(dot(axis, camera.toward)), radius = length / 2, points = [];
    const on = (share) => { const angle = Math.PI * (0.25 + 1.5 * share) * sense; return [x + radius * Math.cos(angle), y - radius * Math.sin(angle)]; };
    for (let k = 0; k <= 36; ++k) points.push(on(k / 36));
    this.line(points, colour, width);
    const tip = on(1), before = on(0.9), d = Math.hypot(tip[0] - before[0], tip[1] - before[1]);
    this.head(tip, [(tip[0] - before[0]) / d, (tip[1] - before[1]) / d], size, colour, width);
    return {tip: [x + 0.7 * radius, y - 0.7 * radius], along: [0.7, -0.7]};
  }
  // Beyond the tip of an arrow.
  name(text, arrow, colour) { if (arrow) this.names.push({text, at: [arrow.tip[0] + 11 * arrow.along[0], arrow.tip[1] + 11 * arrow.along[1] + 5], colour, middle: true}); }
  label(text, at, colour) { this.names.push({text, at, colour, middle: false}); }

  // Labels with a halo in the background colour. Overlapping labels move down, and labels stay on the canvas if
  // possible.
  finish() {
    const {draw, camera} = this;
    draw.font = "14px system-ui, sans-serif";
    draw.lineJoin = "round";
    for (const {text, at, colour, middle} of this.names) {
      const width = draw.measureText(text).width, inside = at[0] > 0 && at[0] < camera.width && at[1] > 0 && at[1] < camera.height;
      let x = at[0] - (middle ? width / 2 : 0), y = at[1];
      if (inside) { x = Math.min(Math.max(x, 3), camera.width - width - 3); y = Math.min(Math.max(y, 14), camera.height - 5); }
      for (let tries = 0; tries < 6 && this.taken.some((l) => Math.abs(l[1] - y) < 15 && x < l[0] + l[2] + 3 && l[0] < x + width + 3); ++tries) y += 15;
      this.taken.push([x, y, width]);
      draw.lineWidth = 4;
      draw.strokeStyle = this.paper;
      draw.strokeText(text, x, y);
      draw.fillStyle = colour;
      draw.fillText(text, x, y);
    }
  }

  // Points on a line on the screen at a fraction of its length and at a distance in pixels; null if the line is too
  // short.
  beside(a, b) {
    const p = this.at(a), q = this.at(b), d = [q[0] - p[0], q[1] - p[1]], length = Math.hypot(...d);
    return length < 1 ? null : {length, at: (s, off) => [p[0] + s * d[0] - off * d[1] / length, p[1] + s * d[1] + off * d[0] / length]};
  }
  coil(a, b, wide) {
    const line = this.beside(a, b), turns = 9;
    if (!line) return;
    const points = [line.at(0, 0)];
    for (let k = 0; k <= 2 * turns; ++k) points.push(line.at(0.12 + 0.76 * k / (2 * turns), k === 0 || k === 2 * turns ? 0 : k % 2 ? wide : -wide));
    this.line([...points, line.at(1, 0)], this.quiet, 1.8);
  }
  damper(a, b) {
    const line = this.beside(a, b), wide = 7;
    if (!line) return;
    this.line([line.at(0, 0), line.at(0.4, 0)], this.quiet, 2);
    this.line([line.at(0.65, wide), line.at(0.4, wide), line.at(0.4, -wide), line.at(0.65, -wide)], this.quiet, 2);
    this.line([line.at(0.55, wide - 2), line.at(0.55, 2 - wide)], this.quiet, 2);
    this.line([line.at(0.55, 0), line.at(1, 0)], this.quiet, 2);
  }
  // The ground: a line with hatches on the side opposite to the held part, which is along `toward`.
  support(r, toward) {
    const [x, y] = this.at(r), d = this.camera.flattened(toward), length = Math.hypot(...d);
    if (!(length > 1e-9)) return;
    const [ux, uy] = [d[0] / length, d[1] / length], at = (along, off) => [x - along * uy + off * ux, y + along * ux + off * uy], lines = [[at(-14, 0), at(14, 0)]];
    for (let k = -12; k <= 12; k += 6) lines.push([at(k, 0), at(k - 5, -7)]);
    this.segments(lines, this.quiet, 1.6);
  }

  face(points, fill, edge) {
    const {draw} = this;
    this.trace(points, true);
    draw.fillStyle = fill;
    draw.fill();
    this.stroke(edge, 0.8);  // an edge in the face colour closes the seams between smooth faces
  }
  ball(centre, axes, radius, colour) {
    const {draw, camera} = this, [x, y] = this.at(centre), size = radius * camera.scale(), light = draw.createRadialGradient(x - 0.35 * size, y - 0.4 * size, 0.1 * size, x, y, size);
    light.addColorStop(0, mixed(colour, this.paper, 0.75));
    light.addColorStop(1, mixed(colour, this.paper, 0.4));
    draw.globalAlpha = 0.88;
    this.dot(centre, size, light);
    this.stroke(colour, 1);
    for (let k = 0; k < 3; ++k) {  // near halves of great circles show the rotation
      const a = axes[(k + 1) % 3], b = axes[(k + 2) % 3];
      let part = [];
      for (let s = 0; s <= 48; ++s) {
        const angle = 2 * Math.PI * s / 48, r = plus(centre, plus(scaled(a, radius * Math.cos(angle)), scaled(b, radius * Math.sin(angle))));
        if (camera.depth(r) >= camera.depth(centre)) part.push(r);
        if (part.length > 1 && (camera.depth(r) < camera.depth(centre) || s === 48)) this.line(part, colour, 1.2);
        if (camera.depth(r) < camera.depth(centre)) part = [];
      }
    }
  }
}
