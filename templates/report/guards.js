// The bounds of the current mode during a run. A side is 1 inside, -1 if the bound does not matter until it is inside
// again, 0 unknown: a bound that is at its zero, up to rounding, shows its side later.
const smallPart = 1e-13, crossedPart = 1e-10;  // of the largest value: rounding; the error of a zero that was crossed

class Guards {
  constructor(contacts) {
    this.contacts = contacts;
    this.sizes = new Float64Array(contactValues * contacts.contacts.length);
    this.progress = -Infinity;
    this.repeated = 0;
  }
  // Begins at (t, x), where these bounds were crossed at about these values.
  begin(t, x, crossed = []) {
    this.bounds = this.contacts.bounds();
    const values = this.contacts.values(t, x, this.bounds);
    this.grow(values);
    this.near = this.bounds.map(({j, k}, i) => Math.max(smallPart * this.size(i), ...crossed.filter((of) => of.j === j && of.k === k).map((of) => Math.max(4 * Math.abs(of.value), crossedPart * this.size(i)))));
    const began = this.bounds.map(({j, k}) => this.contacts.nearOf(j, k));
    began.forEach((near, i) => { this.near[i] = Math.max(this.near[i], near); });
    this.sides = values.map((value, i) => (Math.abs(value) > this.near[i] ? 1 : 0));
    began.forEach((near, i) => { if (near === 0) this.near[i] = Math.max(smallPart * this.size(i), this.sides[i] === 0 ? 4 * Math.abs(values[i]) || 0 : 0); });
  }
  // The largest value of a bound in the run, from which its rounding errors follow.
  size(i) { return this.sizes[contactValues * this.bounds[i].j + this.bounds[i].k]; }
  grow(values) {
    this.bounds.forEach(({j, k}, i) => { if (Number.isFinite(values[i])) this.sizes[contactValues * j + k] = Math.max(this.size(i), Math.abs(values[i])); });
  }
  get isUnknown() { return this.sides.includes(0); }
  // Bounds that are crossed between the sides and this state: {i, j, k, value}. Those of `known` are crossed at 0, others of
  // unknown side beyond their rounding errors.
  crossing(t, x, known = []) {
    return this.contacts.values(t, x, this.bounds).flatMap((value, i) => {
      const {j, k} = this.bounds[i], limit = this.sides[i] === 0 && !known.some((of) => of.i === i) ? -this.near[i] : 0;
      return this.sides[i] >= 0 && value < limit ? [{i, j, k, value}] : [];
    });
  }
  // Takes the sides of a state that crosses none.
  observe(t, x) {
    const values = this.contacts.values(t, x, this.bounds);
    this.grow(values);
    values.forEach((value, i) => { if (this.sides[i] !== 1 && value > this.near[i]) this.sides[i] = 1; });
    this.contacts.observe(this.contacts.mode);
  }
  // Transitions at (t, x), until all bounds hold. Returns {t, names}; `contacts.failure` if there is no next mode.
  happen(crossed, t, x, latest, h) {
    const {contacts} = this, names = [];
    this.repeated = t - this.progress > Math.max(1e-14 * Math.abs(t), 1e-11 * h) ? 0 : this.repeated + 1;
    for (let at = crossed; at.length > 0 && contacts.failure === "";) {
      const found = contacts.cross(t, x, at[0], latest);
      t = found.t;
      names.push(...found.names);
      if (found.resumes) this.sides[at[0].i] = -1;
      else this.begin(t, x, at);
      at = contacts.failure === "" ? this.crossing(t, x) : [];
      if (++this.repeated > contacts.mostRepeated) contacts.failure = "contacts change without progress in time";
    }
    this.progress = t;
    return {t, names};
  }
}
