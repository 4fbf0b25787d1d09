// Properties of a whole motion: lines that are rods, and parts held by the ground.
function acrossTo(normal) {
  const first = fixedAxes.find((e) => Math.abs(dot(e, normal)) < 0.8);
  return minus(first, scaled(normal, dot(first, normal)));
}

// Lines between places: rods if their length is constant, else lines of a length coordinate. A spring between the same
// ends replaces the line.
function linksOf(scene, rows) {
  const {parts} = scene, first = rows[0], near = (a, b) => Math.hypot(...minus(a, b)) < 1e-9 * (1 + Math.hypot(...a));
  const sprung = (a, b) => parts.springs.some((spring) => {
    const p = scene.position(first, spring.a), q = scene.position(first, spring.b);
    return (near(p, a) && near(q, b)) || (near(p, b) && near(q, a));
  });
  const on = (place) => parts.surfaces.some((surface) => surface.place === place && surface.touched);
  const measured = parts.places.map((place, to) => ({from: place.from, to})).filter(({from, to}) => from !== null && !sprung(scene.placeAt(first, from), scene.placeAt(first, to)));
  const lines = measured.map(({from, to}) => {
    const lengths = rows.map((y) => Math.hypot(...minus(scene.placeAt(y, to), scene.placeAt(y, from)))).filter(Number.isFinite);
    const longest = Math.max(...lengths);
    return {from, to, rigid: !on(to) && longest - Math.min(...lengths) < 1e-6 * longest};
  });
  return [...lines, ...parts.rods.map(([from, to]) => ({from, to, rigid: true}))];
}

// Fixed origins of rods, fixed ends of springs and dampers, joints with the ground: position, and the axis along which
// each holds its part.
function supportsOf(scene, rows) {
  const {parts} = scene, found = [], rest = (at) => rows.every((y) => Math.hypot(...minus(scene.position(y, at), scene.position(rows[0], at))) < 1e-9 * (1 + Math.hypot(...scene.position(rows[0], at))));
  const add = (at, others) => {
    const here = at(rows[0]);
    if (!isPoint(here) || found.some((other) => Math.hypot(...minus(other.at(rows[0]), here)) < 1e-9 * (1 + Math.hypot(...here)))) return;
    let mean = origin;
    for (const y of rows) for (const other of others(y)) if (isPoint(other)) mean = plus(mean, minus(other, here));
    const k = [0, 1, 2].reduce((best, i) => (Math.abs(mean[i]) > Math.abs(mean[best]) + 1e-9 ? i : best), 0);
    if (Math.abs(mean[k]) > 0) found.push({at, toward: scaled(fixedAxes[k], Math.sign(mean[k]))});
  };
  const held = scene.links.filter((link) => link.rigid && link.from === -1 && !parts.surfaces.some((surface) => surface.place === link.to && surface.touched));
  if (held.length > 0) add(() => origin, (y) => held.map((link) => scene.placeAt(y, link.to)));
  for (const {a, b} of [...parts.springs, ...parts.dampers]) {
    for (const [end, other] of [[a, b], [b, a]]) if (rest(end) && !rest(other)) add((y) => scene.position(y, end), (y) => [scene.position(y, other)]);
  }
  for (const joint of parts.joints) {
    const of = joint.of.filter((place) => place !== null);
    if (of.length === 1 && rest(joint.at)) add((y) => scene.position(y, joint.at), (y) => of.map((place) => scene.placeAt(y, place)));
  }
  return found;
}
