// A drawn solid of the model with the current sizes; null if it has no volume. Polygons are in the axes of its place and
// have the outside to the left of their edges.
function solidOf({at, ball, tip, polyhedron, edges, points, faces = [], open}, polyhedra, sizes) {
  const vector = (v) => v.map((i) => sizes[i]), middle = at ? vector(at) : origin;
  if (ball !== undefined) return sizes[ball] > 0 ? {at: middle, ball: sizes[ball], faces, radius: Math.hypot(...middle) + sizes[ball]} : null;
  let vertices = [], shape = {faces};
  if (polyhedron) {
    const [a, b, c] = edges.map(vector);
    if (!(dot(cross(a, b), c) > 0)) return null;
    shape = polyhedra[polyhedron];
    vertices = shape.vertices.map(([x, y, z]) => plus(plus(scaled(a, x), scaled(b, y)), scaled(c, z)));
  } else {
    vertices = (points || [tip]).map(vector);
  }
  vertices = vertices.map((r) => plus(middle, r));
  if (!vertices.every(isPoint)) return null;
  return {at: middle, tip: tip ? vertices[0] : null, radius: Math.max(...[middle, ...vertices].map((r) => Math.hypot(...r))),
          faces: shape.faces.map((face, k) => Object.assign(face.map((i) => vertices[i]), {smooth: k >= shape.smooth, open}))};
}
