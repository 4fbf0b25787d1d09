// Bodies as polygons in body axes, with the outside to the left of the edges. The shape is that of the model, or
// follows from the inertia: the homogeneous body with the same mass and moments that is a sphere, a cylinder about the
// axis of two equal moments, or a box.
function boxFaces(a, b, c) {
  const corner = (k) => [(k & 1 ? a : -a) / 2, (k & 2 ? b : -b) / 2, (k & 4 ? c : -c) / 2];
  return [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]].map((face) => face.map(corner));
}

// A solid about the third axis; the sides are one smooth surface.
function cylinderFaces(radius, length) {
  const sides = 28, ring = (z) => Array.from({length: sides}, (_, k) => [radius * Math.cos(2 * Math.PI * k / sides), radius * Math.sin(2 * Math.PI * k / sides), z]);
  const top = ring(length / 2), bottom = ring(-length / 2), faces = [top, bottom.slice().reverse()];
  for (let k = 0; k < sides; ++k) faces.push(Object.assign([bottom[k], bottom[(k + 1) % sides], top[(k + 1) % sides], top[k]], {smooth: true}));
  return faces;
}

// Axes as rows (right-handed) with the k-th axis of `axes` third.
function aboutAxis(axes, k) { return [axes[(k + 1) % 3], axes[(k + 2) % 3], axes[k]]; }

// Moved faces with the same smoothness.
function moved(faces, to) { return faces.map((face) => Object.assign(face.map(to), {smooth: face.smooth})); }
function placed(faces, axes) { return moved(faces, (r) => plus(plus(scaled(axes[0], r[0]), scaled(axes[1], r[1])), scaled(axes[2], r[2]))); }

function shapeOfInertia(mass, inertia) {
  if (!(mass > 0) || inertia.length !== 9) return null;
  const matrix = [inertia.slice(0, 3), inertia.slice(3, 6), inertia.slice(6, 9)].map((row) => Array.from(row));
  const {values, axes} = principalAxes(matrix), largest = Math.max(...values);
  if (!(largest > 0) || Math.min(...values) < -1e-9 * largest) return null;
  // A single moment, for rotation about one direction: no homogeneous body has it; see barOfInertia.
  if (2 * largest > (1 + 1e-6) * (values[0] + values[1] + values[2])) return null;
  if (dot(cross(axes[0], axes[1]), axes[2]) < 0) axes[2] = scaled(axes[2], -1);
  const same = (i, j) => Math.abs(values[i] - values[j]) < 1e-6 * largest;
  if (same(0, 1) && same(1, 2)) return {kind: "sphere", radius: Math.sqrt(2.5 * values[0] / mass), faces: []};
  for (let k = 0; k < 3; ++k) {
    const i = (k + 1) % 3, j = (k + 2) % 3;
    if (!same(i, j)) continue;
    let radius = Math.sqrt(Math.max(0, 2 * values[k] / mass));
    let length = Math.sqrt(Math.max(0, 12 * values[i] / mass - 3 * radius * radius));
    radius = Math.max(radius, 0.02 * length);
    length = Math.max(length, 0.03 * radius);
    return {kind: "cylinder", faces: placed(cylinderFaces(radius, length), aboutAxis(axes, k)), radius: Math.hypot(radius, length / 2)};
  }
  const sides = values.map((_, k) => Math.sqrt(Math.max(0, 6 * (values[(k + 1) % 3] + values[(k + 2) % 3] - values[k]) / mass)));
  const longest = Math.max(...sides), [a, b, c] = sides.map((side) => Math.max(side, 0.03 * longest));
  return {kind: "box", faces: placed(boxFaces(a, b, c), axes), radius: Math.hypot(a, b, c) / 2};
}

// A bar towards `spot` (in body axes), where something is attached. Its length is that of a uniform bar with the same
// largest moment.
function barOfInertia(mass, inertia, spot) {
  const largest = Math.max(inertia[0], inertia[4], inertia[8]), length = Math.sqrt(12 * largest / mass), reach = Math.hypot(...spot);
  if (!(mass > 0) || !(largest > 0) || !(reach > 1e-9 * length)) return null;
  const along = unit(spot), other = [[1, 0, 0], [0, 1, 0], [0, 0, 1]].find((e) => Math.abs(dot(e, along)) < 0.8), side = unit(cross(along, other));
  return {kind: "bar", faces: placed(cylinderFaces(0.025 * length, length), [side, cross(along, side), along]), radius: length / 2};
}

// The axis of a body nearest to `spot`, among the two with the smaller moments of inertia.
function nearestAxis(inertia, spot) {
  const moments = [inertia[0], inertia[4], inertia[8]], normal = moments.indexOf(Math.max(...moments));
  const sizes = spot.map((x, k) => k === normal ? 0 : Math.abs(x)), nearest = sizes.indexOf(Math.max(...sizes));
  return sizes.map((size, k) => k === nearest && size > 0 ? Math.sign(spot[k]) : 0);
}

// The faces of the convex hull of points; for points in a plane the hull polygon.
function hullFaces(points) {
  const size = Math.max(...points.map((p) => Math.hypot(...minus(p, points[0])))), least = 1e-9 * size, found = new Set(), faces = [];
  for (let i = 0; i < points.length; ++i) for (let j = i + 1; j < points.length; ++j) for (let k = j + 1; k < points.length; ++k) {
    let normal = cross(minus(points[j], points[i]), minus(points[k], points[i]));
    if (!(Math.hypot(...normal) > least * size)) continue;
    normal = unit(normal);
    const heights = points.map((p) => dot(normal, minus(p, points[i]))), high = Math.max(...heights), plane = points.map((_, l) => l).filter((l) => Math.abs(heights[l]) <= least);
    if ((Math.min(...heights) < -least && high > least) || found.has(plane.join())) continue;
    found.add(plane.join());
    faces.push(polygonAround(plane.map((l) => points[l]), high > least ? scaled(normal, -1) : normal));
  }
  return faces;
}
// Convex hull in a plane (gift wrapping): from an outermost point to the next one that has all others on its left.
function polygonAround(points, normal) {
  const along = acrossTo(normal), first = points.reduce((best, p) => (dot(along, p) < dot(along, best) ? p : best)), ring = [];
  for (let at = first; ring.length <= points.length;) {
    ring.push(at);
    let next = at;
    for (const p of points) {
      const step = minus(p, at), best = minus(next, at), turn = dot(normal, cross(best, step)), none = 1e-6 * Math.hypot(...best) * Math.hypot(...step);
      if (p !== at && (next === at || turn < -none || (turn <= none && Math.hypot(...step) > Math.hypot(...best)))) next = p;
    }
    at = next;
    if (at === first || Math.hypot(...minus(at, first)) === 0) break;
  }
  return ring;
}

// A [draw] entry: kind, index of its lengths among the sizes, axis, centre.
function shapeOfModel(drawn, sizes) {
  const lengths = drawn.lengths.map((i) => sizes[i]), at = drawn.at.length === 3 ? drawn.at.map((i) => sizes[i]) : [0, 0, 0];
  if (lengths.some((length) => !Number.isFinite(length))) return null;
  const axes = aboutAxis([[1, 0, 0], [0, 1, 0], [0, 0, 1]], drawn.axis), reach = Math.hypot(...at);
  const made = (faces, radius) => ({kind: drawn.kind, faces: moved(placed(faces, axes), (r) => plus(r, at)), radius: radius + reach, at});
  switch (drawn.kind) {
    case "sphere": return {kind: "sphere", faces: [], radius: lengths[0], at};
    case "box": return {kind: "box", faces: moved(boxFaces(...lengths), (r) => plus(r, at)), radius: Math.hypot(...lengths) / 2 + reach, at};
    case "cylinder": return made(cylinderFaces(lengths[0], lengths[1]), Math.hypot(lengths[0], lengths[1] / 2));
    case "disk": return made(cylinderFaces(lengths[0], 0.03 * lengths[0]), lengths[0]);
    case "rod": return made(cylinderFaces(0.02 * lengths[0], lengths[0]), lengths[0] / 2);
    case "mesh": {
      const points = Array.from({length: lengths.length / 3}, (_, k) => plus(at, lengths.slice(3 * k, 3 * k + 3)));
      // Faces from the model have no outside: both sides are visible.
      const faces = drawn.faces.length > 0 ? drawn.faces.map((face) => Object.assign(face.map((k) => points[k]), {open: true})) : hullFaces(points);
      if (faces.length === 1) faces[0].open = true;
      return {kind: "mesh", faces, radius: Math.max(...points.map((p) => Math.hypot(...p)))};
    }
    case "arrow": return {kind: "arrow", faces: [], radius: Math.hypot(...lengths) + reach, at, tip: plus(at, lengths)};
  }
  return null;
}

// Radii of two coupled wheels with parallel axes at this distance; `ratio` is the speed of the first divided by that of
// the second. External gears rotate in opposite directions and touch between the centres; a gear inside a ring touches
// beyond them. Pulleys of a belt may have any size: that of disks drawn on the two bodies (radii `drawn`), else one at
// which the belt is visible.
function wheelsOf(ratio, carried, distance, drawn) {
  const size = Math.abs(ratio);
  if (!(distance > 0) || !(size > 0) || !Number.isFinite(size)) return null;
  if (ratio < 0) return {kind: "mesh", radii: [distance / (1 + size), distance * size / (1 + size)]};
  if (carried) return size === 1 ? null : {kind: "ring", radii: [distance / Math.abs(size - 1), distance * size / Math.abs(size - 1)]};
  for (const a of drawn[0]) for (const b of drawn[1]) if (Math.abs(b - size * a) < 1e-6 * b) return {kind: "belt", radii: [a, b]};
  const larger = 0.3 * distance;
  return {kind: "belt", radii: size > 1 ? [larger / size, larger] : [larger, larger * size]};
}

// The two straight parts of a belt in the plane of `u` (from centre to centre) and `v`: ends on the first and on the
// second wheel.
function beltLines([r1, r2], distance, u, v) {
  const c = (r1 - r2) / distance;
  if (Math.abs(c) >= 1) return [];
  return [1, -1].map((side) => { const e = plus(scaled(u, c), scaled(v, side * Math.sqrt(1 - c * c))); return [scaled(e, r1), scaled(e, r2)]; });
}
