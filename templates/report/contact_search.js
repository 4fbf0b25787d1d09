// The search of a mode in which all contacts without slip obey their laws, by the rules of lib/eom/modes/contact_search.hpp:
// friction of several contacts decides together which of them stick, slide or open. In: a state, the contacts that touch.
// Out: the mode. ContactModes (contacts.js) evaluates the contacts.
class ContactSearch {
  // Whether the closed contacts of `touching`, in the entries of `mode`, obey their laws.
  isAdmissible(t, x, touching, mode) {
    if (!this.evaluate(t, x, mode)) return false;
    const h = 1e-6, g = this.g.map((values) => values.slice()), speeds = this.contacts.map((_, j) => this.speedOf(j));
    let next = null, known = 0;  // differences below this value are rounding
    for (let j = 0; j < this.contacts.length; ++j) {
      const {unilateral, surface, sticks} = this.contacts[j], entry = mode[j], open = this.isOpen(mode, j);
      if (this.isOpen(touching, j)) continue;
      if (!open && (unilateral || surface) && !(g[j][3] >= -1e-12 * this.forceSizes[j])) return false;
      if (!open && entry % 3 === 0 && sticks && !(g[j][1] >= 0 && (this.isTwo(j) || g[j][2] >= 0))) return false;
      const begins = !open && sticks && entry % 3 !== 0 && touching[j] % 3 === 0;
      if (!open && !begins) continue;
      if (next === null) {
        const dx = this.rhs(t, x, mode);
        next = dx === null ? null : x.map((value, i) => value + h * dx[i]);
        if (next === null || !this.evaluate(t + h, next, mode)) return false;
        known = 1e-8 * h * Math.max(0, ...dx.map(Math.abs));
      }
      if (open) {
        if (this.gapRate(t + h, next, j) - this.gapRate(t, x, j) < -known) return false;
        continue;
      }
      const change = this.isTwo(j) ? this.speedOf(j) - speeds[j] : this.g[j][0] - g[j][0];
      if ((entry % 3 === 1 ? change : -change) < -known) return false;
    }
    return true;
  }
  // The first admissible mode among all entries of the contacts that `touching` leaves open, or null. x may begin to slide.
  searched(t, x, touching) {
    const before = Float64Array.from(x);
    let modes = [touching];
    this.contacts.forEach(({unilateral, surface, directions, sticks}, j) => {
      const entry = touching[j], high = entry - entry % 3, entries = [entry];
      if (!this.isOpen(touching, j)) {
        if (sticks && entry % 3 === 0) entries.push(...(directions === 1 ? [high + 1, high + 2] : [high + 1]));
        if (unilateral) entries.push(3);
        else if (surface) entries.push(...entries.map((value) => (value + 3) % 6));
      }
      modes = entries.flatMap((value) => modes.map((mode) => this.withEntry(mode, j, value)));
    });
    for (const mode of modes) {
      this.contacts.forEach(({sticks}, j) => {
        if (this.isTwo(j) && sticks && mode[j] % 3 === 1 && touching[j] % 3 === 0 && !this.isOpen(mode, j)) this.slide(t, x, this.withEntry(mode, j, mode[j] - 1), j);
      });
      if (this.isAdmissible(t, x, touching, mode)) return mode;
      x.set(before);
    }
    return null;
  }
}
