// The drawing: a camera without perspective, so that lengths can be compared, and parts sorted from back to front.
const palette = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#8a6d3b"];  // told apart with any colour vision

function styleOf(name) { return getComputedStyle(document.documentElement).getPropertyValue(name).trim(); }
function mixed(colour, other, share) {
  const parts = (text) => [1, 3, 5].map((k) => parseInt((text.length === 4 ? "#" + [...text.slice(1)].map((c) => c + c).join("") : text).slice(k, k + 2), 16));
  const a = parts(colour), b = parts(other);
  return "rgb(" + a.map((value, k) => Math.round(value * (1 - share) + b[k] * share)).join(",") + ")";
}

class Camera {
  constructor() { Object.assign(this, {zoom: 1, pan: [0, 0], azimuth: 0, elevation: 0, width: 1, height: 1}); }

  // Looks along the normal where all is in one plane, else from the side and a little from above; things fall downwards.
  find(points, reach, down) {
    const low = [0, 1, 2].map((k) => Math.min(...points.map((r) => r[k]))), high = [0, 1, 2].map((k) => Math.max(...points.map((r) => r[k])));
    this.centre = low.map((value, k) => (value + high[k]) / 2);
    this.size = Math.max(...points.map((r) => Math.hypot(...minus(r, this.centre)))) + reach || 1;
    let normal = [2, 1, 0].find((k) => high[k] - low[k] <= 1e-9 * this.size);
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
  scale() { return 0.46 * Math.min(this.width, this.height) / this.size * this.zoom; }
  project(r) {
    const d = minus(r, this.centre), s = this.scale();
    return [this.width / 2 + this.pan[0] + s * dot(this.right, d), this.height / 2 + this.pan[1] - s * dot(this.above, d)];
  }
  depth(r) { return dot(this.toward, minus(r, this.centre)); }
  // The vector in the plane of the screen that a movement of the pointer is.
  lift(dx, dy) { return scaled(plus(scaled(this.right, dx), scaled(this.above, -dy)), 1 / this.scale()); }
}

class Scene {
  constructor(canvas, parts, down) {
    Object.assign(this, {canvas, parts, down, camera: new Camera(), shown: {traces: true, axes: true, names: true}});
    this.draw = canvas.getContext("2d");
  }

  position(y, at) { return [y[at], y[at + 1], y[at + 2]]; }

  // Of a new motion: shapes, paths; the view only where it is asked for.
  take(motion, sizes, find) {
    const rows = motion.drawn(), {parts} = this;
    this.motion = motion;
    // Bodies, and particles that the model gives a shape: these keep the fixed axes.
    this.solids = [...parts.bodies, ...parts.places.map((_, place) => ({place, axes: null})).filter(({place}) => parts.shapes.some((shape) => shape.place === place) && !parts.bodies.some((body) => body.place === place))];
    this.shapes = this.solids.map((body) => {
      const drawn = parts.shapes.filter((shape) => shape.place === body.place);
      if (drawn.length > 0) return drawn.map((shape) => shapeOfModel(shape, sizes)).filter((shape) => shape !== null);
      const inertia = body.inertia.map((i) => sizes[i]), shape = shapeOfInertia(sizes[body.mass], inertia) || barOfInertia(sizes[body.mass], inertia, this.attached(body, rows[0]));
      return shape ? [shape] : [];
    });
    this.sizes = sizes;
    // A spring between the same ends stands for the line of what is measured from one of them.
    const near = (a, b) => Math.hypot(...minus(a, b)) < 1e-9 * (1 + Math.hypot(...a)), first = rows[0];
    this.sprung = parts.places.map((place) => place.from !== null && parts.springs.some((spring) => {
      const from = place.from < 0 ? [0, 0, 0] : this.position(first, parts.places[place.from].at), here = this.position(first, place.at);
      const a = this.position(first, spring.a), b = this.position(first, spring.b);
      return (near(a, from) && near(b, here)) || (near(b, from) && near(a, here));
    }));
    if (!find) return;
    const spots = [...parts.places, ...parts.joints, ...parts.contacts].map((part) => part.at);
    for (const spring of [...parts.springs, ...parts.dampers]) spots.push(spring.a, spring.b);
    const points = [];
    for (let k = 0; k < rows.length; k += Math.max(1, Math.floor(rows.length / 100))) for (const at of spots) points.push(this.position(rows[k], at));
    if (parts.places.some((place) => place.from === -1) || points.length === 0) points.push([0, 0, 0]);
    const far = points.filter((r) => r.every(Number.isFinite));
    this.camera.find(far.length > 0 ? far : [[0, 0, 0]], Math.max(0, ...this.shapes.flat().map((shape) => shape.radius)), this.down);
  }

  // Where a joint or a point is on a body, or else the origin, in its own axes.
  attached(body, y) {
    const {parts} = this, centre = this.position(y, parts.places[body.place].at), axes = this.axesOf(body, y);
    const joint = parts.joints.find((j) => j.of.includes(body.place)), point = parts.places.find((place) => place.from === body.place);
    const spot = joint ? this.position(y, joint.at) : point ? this.position(y, point.at) : [0, 0, 0];
    return axes.map((e) => dot(e, minus(spot, centre)));
  }

  axesOf(body, y) {
    if (body.axes === null) return [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
    const e1 = this.position(y, body.axes[0]), e2 = this.position(y, body.axes[1]);
    return [e1, e2, cross(e1, e2)];
  }

  resize() {
    const ratio = window.devicePixelRatio || 1, {canvas, camera} = this;
    camera.width = canvas.clientWidth || 640;
    camera.height = canvas.clientHeight || 480;
    const width = Math.round(camera.width * ratio), height = Math.round(camera.height * ratio);
    if (canvas.width !== width || canvas.height !== height) {
      canvas.width = width;
      canvas.height = height;
    }
    this.draw.setTransform(ratio, 0, 0, ratio, 0, 0);
  }

  line(points, colour, width, alpha) {
    const {draw, camera} = this;
    draw.globalAlpha = alpha === undefined ? 1 : alpha;
    draw.strokeStyle = colour;
    draw.lineWidth = width;
    draw.lineJoin = draw.lineCap = "round";
    draw.beginPath();
    points.forEach((r, k) => { const p = r.length === 3 ? camera.project(r) : r; if (k === 0) draw.moveTo(p[0], p[1]); else draw.lineTo(p[0], p[1]); });
    draw.stroke();
    draw.globalAlpha = 1;
  }
  dot(r, radius, fill, stroke) {
    const [x, y] = this.camera.project(r), {draw} = this;
    draw.beginPath();
    draw.arc(x, y, radius, 0, 2 * Math.PI);
    draw.fillStyle = fill;
    draw.fill();
    if (stroke) { draw.strokeStyle = stroke; draw.lineWidth = 2; draw.stroke(); }
  }
  arrow(from, to, colour, width) {
    const a = this.camera.project(from), b = this.camera.project(to), length = Math.hypot(b[0] - a[0], b[1] - a[1]);
    if (length < 3) return null;
    const u = [(b[0] - a[0]) / length, (b[1] - a[1]) / length], head = Math.min(9, length / 2);
    this.line([a, b], colour, width);
    this.line([[b[0] - head * (u[0] + 0.5 * u[1]), b[1] - head * (u[1] - 0.5 * u[0])], b, [b[0] - head * (u[0] - 0.5 * u[1]), b[1] - head * (u[1] + 0.5 * u[0])]], colour, width);
    return b;
  }
  // Names with the colour of the paper around them; one that would lie on another moves down.
  label(text, at, colour) {
    const {draw} = this, width = 8 * text.length;
    let y = at[1];
    for (let tries = 0; tries < 5 && this.labels.some((l) => Math.abs(l[1] - y) < 14 && at[0] < l[0] + l[2] && l[0] < at[0] + width); ++tries) y += 15;
    this.labels.push([at[0], y, width]);
    draw.font = "14px system-ui, sans-serif";
    draw.lineWidth = 4;
    draw.lineJoin = "round";
    draw.strokeStyle = this.paper;
    draw.strokeText(text, at[0], y);
    draw.fillStyle = colour;
    draw.fillText(text, at[0], y);
  }

  coil(a, b) {
    const p = this.camera.project(a), q = this.camera.project(b), length = Math.hypot(q[0] - p[0], q[1] - p[1]);
    if (length < 1) return;
    const u = [(q[0] - p[0]) / length, (q[1] - p[1]) / length], turns = 9, wide = Math.min(9, 0.2 * this.camera.scale() * this.camera.size), points = [p];
    for (let k = 0; k <= 2 * turns; ++k) {
      const s = 0.12 + 0.76 * k / (2 * turns), off = k === 0 || k === 2 * turns ? 0 : k % 2 ? wide : -wide;
      points.push([p[0] + s * length * u[0] - off * u[1], p[1] + s * length * u[1] + off * u[0]]);
    }
    points.push(q);
    this.line(points, this.quiet, 1.8);
  }
  damper(a, b) {
    const p = this.camera.project(a), q = this.camera.project(b), length = Math.hypot(q[0] - p[0], q[1] - p[1]);
    if (length < 1) return;
    const u = [(q[0] - p[0]) / length, (q[1] - p[1]) / length], wide = 7;
    const at = (s, off) => [p[0] + s * length * u[0] - off * u[1], p[1] + s * length * u[1] + off * u[0]];
    this.line([p, at(0.4, 0)], this.quiet, 2);
    this.line([at(0.65, wide), at(0.4, wide), at(0.4, -wide), at(0.65, -wide)], this.quiet, 2);
    this.line([at(0.55, wide - 2), at(0.55, 2 - wide)], this.quiet, 2);
    this.line([at(0.55, 0), q], this.quiet, 2);
  }

  // Two wheels that turn together: kind, centres, radii, the common axis, the direction from one to the other across it; null where the axes are not parallel.
  wheels(coupling, y) {
    const {parts, sizes} = this, [a, b] = coupling.of.map((place) => this.position(y, parts.places[place].at)), [n, m] = coupling.axes.map((axis) => unit(this.position(y, axis)));
    if (![...a, ...b, ...n, ...m].every(Number.isFinite) || Math.hypot(...cross(n, m)) > 1e-6) return null;
    const across = minus(minus(b, a), scaled(n, dot(n, minus(b, a)))), distance = Math.hypot(...across), round = (shape) => shape.kind === "disk" || shape.kind === "cylinder";
    const drawn = coupling.of.map((place) => parts.shapes.filter((shape) => shape.place === place && round(shape)).map((shape) => sizes[shape.lengths[0]]));
    const found = wheelsOf(sizes[coupling.ratio] * Math.sign(dot(n, m)), coupling.carried, distance, drawn);
    return found ? {...found, centres: [a, b], axis: n, along: scaled(across, 1 / distance), distance} : null;
  }
  // Pitch circles, each with a spoke that turns with its body, and the belt.
  coupled(coupling, y) {
    const found = this.wheels(coupling, y);
    if (!found) return;
    const {kind, centres, radii, axis, along, distance} = found, side = cross(axis, along);
    centres.forEach((centre, k) => {
      const ring = [], body = this.parts.bodies.find((other) => other.place === coupling.of[k]);
      for (let s = 0; s <= 64; ++s) ring.push(plus(centre, plus(scaled(along, radii[k] * Math.cos(Math.PI * s / 32)), scaled(side, radii[k] * Math.sin(Math.PI * s / 32)))));
      this.line(ring, this.quiet, 1.6);
      if (!body) return;
      const e = this.axesOf(body, y).map((r) => minus(r, scaled(axis, dot(axis, r)))).find((r) => Math.hypot(...r) > 0.5);
      this.line([centre, plus(centre, scaled(unit(e), radii[k]))], this.quiet, 1.2);
    });
    if (kind !== "belt") return;
    for (const [p, q] of beltLines(radii, distance, along, side)) this.line([plus(centres[0], p), plus(centres[1], q)], this.quiet, 2);
  }

  // The plane that something touches, under the path of the contact.
  ground(contact) {
    if (!contact.tangents) return;
    const rows = this.motion.drawn(), y = rows[0], origin = this.position(y, contact.at);
    const normal = unit(cross(this.position(y, contact.tangents[0]), this.position(y, contact.tangents[1])));
    if (!normal.every(Number.isFinite) || Math.hypot(...normal) < 0.5) return;
    const first = [[1, 0, 0], [0, 1, 0], [0, 0, 1]].find((e) => Math.abs(dot(e, normal)) < 0.8), t1 = unit(minus(first, scaled(normal, dot(first, normal)))), t2 = cross(normal, t1);
    const along = rows.map((row) => minus(this.position(row, contact.at), origin)), extent = (t) => [Math.min(...along.map((d) => dot(d, t))), Math.max(...along.map((d) => dot(d, t)))];
    const [a0, a1] = extent(t1), [b0, b1] = extent(t2), margin = 0.25 * this.camera.size;
    if (![a0, a1, b0, b1].every(Number.isFinite)) return;
    const corner = (a, b) => plus(origin, plus(scaled(t1, a), scaled(t2, b))), cells = 8;
    const A = (k) => a0 - margin + (a1 - a0 + 2 * margin) * k / cells, B = (k) => b0 - margin + (b1 - b0 + 2 * margin) * k / cells;
    for (let k = 0; k <= cells; ++k) {
      this.line([corner(A(k), B(0)), corner(A(k), B(cells))], this.rule, 1);
      this.line([corner(A(0), B(k)), corner(A(cells), B(k))], this.rule, 1);
    }
  }

  // From own axes to space.
  worldOf(body, y) {
    const centre = this.position(y, this.parts.places[body.place].at), axes = this.axesOf(body, y);
    return (r) => plus(centre, plus(plus(scaled(axes[0], r[0]), scaled(axes[1], r[1])), scaled(axes[2], r[2])));
  }
  bodyItems(body, index, y, items) {
    const world = this.worldOf(body, y), centre = world([0, 0, 0]), axes = this.axesOf(body, y), colour = palette[body.place % palette.length];
    for (const shape of this.shapes[index]) {
      if (shape.kind === "sphere") items.push({depth: this.camera.depth(world(shape.at || [0, 0, 0])), paint: () => this.ball(world(shape.at || [0, 0, 0]), axes, shape.radius, colour)});
      if (shape.kind === "arrow") items.push({depth: this.camera.depth(centre), paint: () => this.arrow(world(shape.at), world(shape.tip), colour, 3)});
      for (const face of shape.faces) {
        const points = face.map(world), normal = unit(cross(minus(points[1], points[0]), minus(points[2], points[0])));
        const middle = scaled(points.reduce(plus, [0, 0, 0]), 1 / points.length), light = Math.abs(dot(normal, unit(plus(this.camera.toward, scaled(this.camera.above, 0.6)))));
        items.push({depth: this.camera.depth(middle), paint: () => this.face(points, mixed(colour, this.paper, 0.75 - 0.45 * light), colour)});
      }
    }
    if (!this.shown.axes || body.axes === null) return;
    const reach = Math.max(0.12 * this.camera.size, ...this.shapes[index].map((shape) => 1.15 * shape.radius));
    axes.forEach((e, k) => items.push({depth: Infinity, paint: () => {
      const tip = this.arrow(centre, plus(centre, scaled(e, reach)), colour, 1.5);
      if (tip && this.shown.names && this.parts.bodies.length < 4) this.label("e" + (k + 1), [tip[0] + 4, tip[1] + 4], this.quiet);
    }}));
  }
  face(points, fill, edge) {
    const {draw, camera} = this;
    draw.beginPath();
    points.forEach((r, k) => { const p = camera.project(r); if (k === 0) draw.moveTo(p[0], p[1]); else draw.lineTo(p[0], p[1]); });
    draw.closePath();
    draw.globalAlpha = 0.92;
    draw.fillStyle = fill;
    draw.fill();
    draw.globalAlpha = 0.55;
    draw.strokeStyle = edge;
    draw.lineWidth = 0.8;
    draw.stroke();
    draw.globalAlpha = 1;
  }
  ball(centre, axes, radius, colour) {
    const {draw, camera} = this, [x, y] = camera.project(centre), size = radius * camera.scale();
    draw.beginPath();
    draw.arc(x, y, size, 0, 2 * Math.PI);
    draw.globalAlpha = 0.85;
    draw.fillStyle = mixed(colour, this.paper, 0.55);
    draw.fill();
    draw.globalAlpha = 1;
    draw.strokeStyle = colour;
    draw.lineWidth = 1;
    draw.stroke();
    for (let k = 0; k < 3; ++k) {  // great circles, of which the near halves show how it turns
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

  show(t) {
    const {draw, parts, camera} = this;
    this.resize();
    this.paper = styleOf("--paper");
    this.ink = styleOf("--ink");
    this.quiet = styleOf("--quiet");
    this.rule = styleOf("--line");
    this.labels = [];
    draw.clearRect(0, 0, camera.width, camera.height);
    const y = this.motion.at(t), rows = this.motion.drawn(), last = this.motion.row(t);
    this.now = y;
    for (const contact of parts.contacts) this.ground(contact);
    const origin = [0, 0, 0];
    ["E1", "E2", "E3"].forEach((name, k) => {
      const tip = this.arrow(origin, scaled([0, 1, 2].map((i) => (i === k ? 1 : 0)), 0.22 * camera.size), this.quiet, 1.3);
      if (tip && this.shown.names) this.label(name, [tip[0] + 4, tip[1] - 2], this.quiet);
    });
    if (this.shown.traces) {
      parts.places.forEach((place, i) => {
        if (place.kind === "point") return;
        const path = rows.slice(0, last + 1).map((row) => this.position(row, place.at)).filter((r) => r.every(Number.isFinite));
        path.push(this.position(y, place.at));
        this.line(path, palette[i % palette.length], 1.4, 0.4);
      });
    }
    const items = [];
    parts.places.forEach((place, i) => {
      const here = this.position(y, place.at), colour = palette[i % palette.length];
      if (place.from !== null && !this.sprung[i]) {
        const from = place.from < 0 ? origin : this.position(y, parts.places[place.from].at);
        items.push({depth: Math.min(camera.depth(from), camera.depth(here)) - 1e-9, paint: () => this.line([from, here], this.ink, 2.5, 0.75)});
      }
      const bodyIndex = this.solids.findIndex((body) => body.place === i), solid = bodyIndex >= 0 && this.shapes[bodyIndex].length > 0;
      items.push({depth: solid ? Infinity : camera.depth(here), paint: () => {
        if (place.kind === "point") this.dot(here, 3, this.quiet);
        else this.dot(here, solid ? 3 : 8, colour, solid ? null : this.paper);
      }});
    });
    this.solids.forEach((body, index) => this.bodyItems(body, index, y, items));
    for (const joint of parts.joints) {
      const at = this.position(y, joint.at);
      for (const of of joint.of) if (of !== null) items.push({depth: camera.depth(at), paint: () => this.line([this.position(y, parts.places[of].at), at], this.ink, 1.5, 0.5)});
      items.push({depth: Infinity, paint: () => this.dot(at, 4, this.paper, this.ink)});
    }
    for (const spring of parts.springs) items.push({depth: camera.depth(this.position(y, spring.a)), paint: () => this.coil(this.position(y, spring.a), this.position(y, spring.b))});
    for (const damper of parts.dampers) items.push({depth: camera.depth(this.position(y, damper.a)), paint: () => this.damper(this.position(y, damper.a), this.position(y, damper.b))});
    for (const coupling of parts.couplings) items.push({depth: Infinity, paint: () => this.coupled(coupling, y)});
    for (const contact of parts.contacts) items.push({depth: Infinity, paint: () => this.dot(this.position(y, contact.at), 3, this.ink)});
    items.sort((a, b) => (a.depth < b.depth ? -1 : a.depth > b.depth ? 1 : 0));
    for (const item of items) item.paint();
    if (this.shown.names) {
      parts.places.forEach((place, i) => {
        const [px, py] = camera.project(this.position(y, place.at));
        this.label(place.name, [px + 10, py - 9], mixed(palette[i % palette.length], this.ink, 0.4));
      });
    }
  }
}

