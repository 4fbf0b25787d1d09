// The drawing of a motion: parts sorted from back to front, then overlays.
const fixedAxes = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
const forceColours = {applied: "#009e73", constraint: "#d55e00", friction: "#cc79a7"};

class Scene {
  constructor(canvas, parts, down) {
    Object.assign(this, {canvas, parts, down, camera: new Camera(), shown: {traces: true, axes: true, names: true, surfaces: true, forces: false}});
    this.pencil = new Pencil(canvas, this.camera);
  }

  position(y, at) { return [y[at], y[at + 1], y[at + 2]]; }
  placeAt(y, place) { return place < 0 ? origin : this.position(y, this.parts.places[place].at); }

  // Sets a new motion: shapes, paths, and on request the view. `source` has the equations of surfaces, and parameters.
  take(motion, sizes, find, source) {
    const rows = motion.drawn(), {parts} = this;
    this.motion = motion;
    this.sizes = sizes;
    this.shapes = parts.solids.map(({list}) => list.map((drawn) => solidOf(drawn, parts.polyhedra, sizes)).filter((shape) => shape !== null));
    const sample = rows.filter((_, k) => k % Math.max(1, Math.floor(rows.length / 100)) === 0);
    this.longest = null;
    if (find) this.find(sample, []);
    if (!find && rows.length < 3) return;  // a dragged point: there is no motion
    this.surfaces = parts.surfaces.map((bound) => new Surface(bound, this, sample, source));
    // Includes the supporting surfaces, unless the motion would become small.
    const before = this.camera.size, ends = this.surfaces.flatMap((surface) => surface.find(motion.t[0], rows[0])).map(([r]) => r);
    if (find && ends.length > 0) this.find(sample, ends);
    if (find && this.camera.size > 2.2 * before) this.find(sample, []);
  }
  find(rows, ends) {
    const {parts} = this, balls = [], spots = [...parts.places, ...parts.joints, ...parts.contacts].map((part) => part.at);
    for (const line of [...parts.springs, ...parts.dampers]) spots.push(line.a, line.b);
    for (const contact of parts.contacts) spots.push(contact.foot);
    const see = (r, radius) => { if (isPoint(r)) balls.push([...r, radius]); };
    for (const y of rows) {
      for (const at of spots) see(this.position(y, at), 0);
      parts.solids.forEach((body, index) => see(this.placeAt(y, body.place), Math.max(0, ...this.shapes[index].map((shape) => shape.radius))));
    }
    if (parts.links.some(({from}) => from === -1) || balls.length === 0) see(origin, 0);
    this.camera.find([...balls, ...ends.map((r) => [...r, 0])], this.down);
  }

  axesOf(body, y) {
    if (body.axes === null) return fixedAxes;
    const e1 = this.position(y, body.axes[0]), e2 = this.position(y, body.axes[1]);
    return [e1, e2, cross(e1, e2)];
  }
  // From body axes to space.
  worldOf(body, y) {
    const centre = this.placeAt(y, body.place), axes = this.axesOf(body, y);
    return (r) => plus(centre, plus(plus(scaled(axes[0], r[0]), scaled(axes[1], r[1])), scaled(axes[2], r[2])));
  }
  colour(place) { return palette[place % palette.length]; }

  bodyItems(body, index, y, items) {
    const world = this.worldOf(body, y), {pencil, camera} = this, colour = this.colour(body.place), lit = unit(plus(plus(camera.toward, scaled(camera.above, 0.7)), scaled(camera.right, -0.3)));
    for (const shape of this.shapes[index]) {
      if (shape.ball) items.push({depth: camera.depth(world(shape.at)), paint: () => pencil.ball(world(shape.at), this.axesOf(body, y), shape.ball, colour)});
      if (shape.tip) items.push({depth: camera.depth(world(origin)), paint: () => pencil.arrow(world(shape.at), world(shape.tip), colour, 3)});
      for (const face of shape.faces) {
        const points = face.map(world), outwards = unit(cross(minus(points[1], points[0]), minus(points[2], points[0]))), facing = dot(outwards, camera.toward);
        if (facing < -1e-9 && !face.open) continue;  // hidden by the same solid
        const normal = facing < 0 ? scaled(outwards, -1) : outwards;
        const middle = scaled(points.reduce(plus, origin), 1 / points.length), fill = mixed(colour, pencil.paper, 0.62 - 0.5 * Math.max(0, dot(normal, lit)));
        items.push({depth: camera.depth(middle), paint: () => pencil.face(points, fill, face.smooth ? fill : colour)});
      }
    }
    if (this.shown.axes && body.axes !== null) items.push({depth: Infinity, paint: () => this.ownAxes(body, index, y)});
  }
  ownAxes(body, index, y) {
    const {pencil, camera} = this, centre = this.placeAt(y, body.place), reach = Math.max(30 / camera.scale(), ...this.shapes[index].map((shape) => 1.1 * shape.radius));
    const named = this.shown.names && this.parts.solids.length < 4 && reach * camera.scale() > 45;
    this.axesOf(body, y).forEach((e, k) => {
      const drawn = pencil.arrow(centre, plus(centre, scaled(e, reach)), this.colour(body.place), 1.3);
      if (named) pencil.name("e" + (k + 1), drawn, pencil.quiet);
    });
  }

  // Pitch circles, each with a spoke that rotates with its body, and the belt.
  wheels({of, axis, radii, belt}, y) {
    const {parts, sizes, pencil} = this, centres = of.map((place) => this.placeAt(y, place)), n = unit(this.position(y, axis)), between = minus(centres[1], centres[0]);
    const along = unit(minus(between, scaled(n, dot(n, between)))), side = cross(n, along), rim = (k, cosine, sine) => plus(centres[k], scaled(plus(scaled(along, cosine), scaled(side, sine)), sizes[radii[k]]));
    if (!isPoint(rim(0, 1, 0)) || !isPoint(rim(1, 1, 0))) return;
    of.forEach((place, k) => {
      pencil.line(Array.from({length: 65}, (_, s) => rim(k, Math.cos(Math.PI * s / 32), Math.sin(Math.PI * s / 32))), pencil.quiet, 1.6);
      const spoke = this.axesOf(parts.solids.find((body) => body.place === place), y).map((e) => minus(e, scaled(n, dot(n, e)))).find((e) => Math.hypot(...e) > 0.5);
      pencil.line([centres[k], plus(centres[k], scaled(unit(spoke), sizes[radii[k]]))], pencil.quiet, 1.2);
    });
    if (belt === null) return;
    const cosine = sizes[belt], sine = Math.sqrt(1 - cosine ** 2);  // not a number: one pulley is inside the other
    for (const s of [sine, -sine]) if (isPoint(rim(0, cosine, s))) pencil.line([rim(0, cosine, s), rim(1, cosine, s)], pencil.quiet, 2);
  }

  // The contact plane, under the path of the contact.
  ground(contact) {
    if (!contact.tangents) return;
    const rows = this.motion.drawn(), y = rows[0], foot = this.position(y, contact.foot);
    const normal = unit(cross(this.position(y, contact.tangents[0]), this.position(y, contact.tangents[1])));
    if (!isPoint(normal) || Math.hypot(...normal) < 0.5) return;
    const t1 = unit(acrossTo(normal)), t2 = cross(normal, t1);
    const along = rows.map((row) => minus(this.position(row, contact.foot), foot)), extent = (t) => [Math.min(...along.map((d) => dot(d, t))), Math.max(...along.map((d) => dot(d, t)))];
    const [a0, a1] = extent(t1), [b0, b1] = extent(t2), margin = 0.2 * this.camera.size;
    if (![a0, a1, b0, b1].every(Number.isFinite)) return;
    const corner = (a, b) => plus(foot, plus(scaled(t1, a), scaled(t2, b))), cell = Math.max(a1 - a0, b1 - b0, margin) / 8, lines = [];
    const count = (low, high) => Math.ceil((high - low + 2 * margin) / cell), n = count(a0, a1), m = count(b0, b1), A = a0 - margin, B = b0 - margin;
    for (let k = 0; k <= n; ++k) lines.push([corner(A + k * cell, B), corner(A + k * cell, B + m * cell)]);
    for (let k = 0; k <= m; ++k) lines.push([corner(A, B + k * cell), corner(A + n * cell, B + k * cell)]);
    this.pencil.segments(lines, this.pencil.rule, 1);
  }

  // Axes at the origin if there is room, else in the corner (the origin may be off the canvas or inside a body).
  showAxes() {
    const {pencil, camera} = this, [x, y] = camera.project(origin), length = 40;
    const along = fixedAxes.map((e) => [length * dot(camera.right, e), -length * dot(camera.above, e)]);
    const isInside = ([dx, dy]) => x + 1.5 * dx > 12 && y + 1.5 * dy > 12 && x + 1.5 * dx < camera.width - 12 && y + 1.5 * dy < camera.height - 12;
    const covered = this.parts.solids.some((body, index) => this.shapes[index].some((shape) => this.covers(body, shape, [x, y])));
    const foot = !covered && along.every(isInside) ? [x, y] : [62, camera.height - 66];
    along.forEach(([dx, dy], k) => {
      const drawn = pencil.arrow(foot, [foot[0] + dx, foot[1] + dy], pencil.quiet, 1.3);
      if (this.shown.names) pencil.name("E" + (k + 1), drawn, pencil.quiet);
    });
  }

  covers(body, shape, [x, y]) {
    const [cx, cy] = this.camera.project(this.placeAt(this.now, body.place));
    return Math.hypot(cx - x, cy - y) < 0.5 * shape.radius * this.camera.scale();
  }

  // Forces and moments as arrows from their points of action. Each of the two has one scale: the greatest arrows span a
  // quarter of the picture. Rare peaks (impacts) do not shrink the others.
  showForces(y) {
    const {parts, pencil, camera} = this, size = (row, arrow) => Math.hypot(...this.position(row, arrow.value));
    if (this.longest === null) {
      this.longest = [false, true].map((turns) => {
        const all = this.motion.drawn().flatMap((row) => parts.arrows.filter((arrow) => arrow.turns === turns).map((arrow) => size(row, arrow))).filter((value) => Number.isFinite(value) && value > 0).sort((a, b) => a - b);
        return all.length > 0 ? all[Math.floor(0.98 * (all.length - 1))] : 1;
      });
    }
    for (const arrow of parts.arrows) {
      const at = this.position(y, arrow.at), value = this.position(y, arrow.value), length = Math.hypot(...value), longest = this.longest[arrow.turns ? 1 : 0];
      if (!isPoint([...at, length]) || length < 1e-6 * longest) continue;
      const to = plus(at, scaled(value, 0.3 * camera.size * Math.min(1 / longest, 1.3 / length))), colour = forceColours[arrow.kind];
      const drawn = arrow.turns ? pencil.moment(at, to, colour, 2.6) : pencil.arrow(at, to, colour, 2.6);
      if (this.shown.names && parts.arrows.length < 9) pencil.name(arrow.name, drawn, colour);
    }
  }

  show(t) {
    const {parts, camera, pencil} = this;
    pencil.begin();
    const y = this.motion.at(t), rows = this.motion.drawn(), last = this.motion.row(t), items = [];
    this.now = y;
    if (this.shown.surfaces) {
      for (const contact of parts.contacts) this.ground(contact);
      for (const surface of this.surfaces) surface.show(t, y);
    }
    if (this.shown.traces) {
      parts.places.forEach((place, i) => {
        if (place.kind === "point") return;
        const path = rows.slice(0, last + 1).map((row) => this.position(row, place.at)).filter(isPoint);
        path.push(this.position(y, place.at));
        pencil.line(path, this.colour(i), 1.4, 0.4);
      });
    }
    for (const {at, toward} of parts.supports) pencil.support(at === null ? origin : this.position(y, at), toward);
    for (const {from, to, is_rod} of parts.links) {
      const a = this.placeAt(y, from), b = this.placeAt(y, to);
      items.push({depth: Math.min(camera.depth(a), camera.depth(b)) - 1e-9, paint: () => (is_rod ? pencil.line([a, b], pencil.ink, 2.5, 0.75) : pencil.dashed([a, b], pencil.quiet, 1))});
    }
    parts.places.forEach((place, i) => {
      const here = this.position(y, place.at), index = parts.solids.findIndex((body) => body.place === i), solid = index >= 0 && this.shapes[index].length > 0;
      items.push({depth: solid ? Infinity : camera.depth(here), paint: () => {
        if (place.kind === "point") pencil.dot(here, 3, pencil.quiet);
        else pencil.dot(here, solid ? 3 : 8, this.colour(i), solid ? null : pencil.paper);
      }});
    });
    parts.solids.forEach((body, index) => this.bodyItems(body, index, y, items));
    for (const joint of parts.joints) {
      const at = this.position(y, joint.at);
      for (const of of joint.of) if (of !== null) items.push({depth: camera.depth(at), paint: () => pencil.line([this.placeAt(y, of), at], pencil.ink, 1.5, 0.5)});
      items.push({depth: Infinity, paint: () => pencil.dot(at, 4, pencil.paper, pencil.ink)});
    }
    const wide = Math.min(9, 0.1 * camera.scale() * camera.size);
    for (const {a, b} of parts.springs) items.push({depth: camera.depth(this.position(y, a)), paint: () => pencil.coil(this.position(y, a), this.position(y, b), wide)});
    for (const {a, b} of parts.dampers) items.push({depth: camera.depth(this.position(y, a)), paint: () => pencil.damper(this.position(y, a), this.position(y, b))});
    for (const pair of parts.wheels) items.push({depth: Infinity, paint: () => this.wheels(pair, y)});
    for (const contact of parts.contacts) items.push({depth: Infinity, paint: () => pencil.dot(this.position(y, contact.at), 3, pencil.ink)});
    items.sort((a, b) => (a.depth < b.depth ? -1 : a.depth > b.depth ? 1 : 0));
    for (const item of items) item.paint();
    this.showAxes();
    if (this.shown.forces) this.showForces(y);
    if (this.shown.names) {
      parts.places.forEach((place, i) => {
        const [px, py] = camera.project(this.position(y, place.at));
        pencil.label(place.name, [px + 10, py - 9], mixed(this.colour(i), pencil.ink, 0.4));
      });
    }
    pencil.finish();
  }
}
