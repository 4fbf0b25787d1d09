// Changes of the state by the model itself: resets at events, samples at given times, by the rules of `eomgen run`. All
// values of one reset are those before it. Events at the same time occur in declared order, and a reset that moves
// another event function across zero makes that event occur too.
const longestChain = 100, mostSamples = 1e7, mostPeriods = 1e14;

// Times that differ by less are equal.
const nearTo = (t) => 8 * 2 ** -52 * Math.abs(t);

// A random integer from a counter (the finalizer of SplitMix64; Steele, Lea, Flood 2014).
function randomBits(counter) {
  const whole = (z) => BigInt.asUintN(64, z);
  let z = whole((counter + 1n) * 0x9e3779b97f4a7c15n);
  z = whole((z ^ (z >> 30n)) * 0xbf58476d1ce4e5b9n);
  z = whole((z ^ (z >> 27n)) * 0x94d049bb133111ebn);
  return z ^ (z >> 31n);
}
// The random number of sample k: normal (Box and Muller 1958), or uniform from -1 to 1.
function randomNumber(normal, seed, k) {
  const stream = randomBits(BigInt(seed));
  const uniform = (i) => (Number(randomBits(BigInt.asUintN(64, stream ^ BigInt.asUintN(64, 2n * BigInt(k) + i))) >> 11n) + 0.5) * 2 ** -53;
  return normal ? Math.sqrt(-2 * Math.log(uniform(0n))) * Math.cos(2 * Math.PI * uniform(1n)) : 2 * uniform(0n) - 1;
}

class Resets {
  // problem: eventKinds [{name, stop, direction, set, condition}], samples [{name, every, offset, noise, set, condition}],
  // events(t, x, g) -> code, resets(t, x, r) -> code, meet(t, x, before) -> whether the new motion x can follow `before`,
  // resetCount, moving (how many components are coordinates and rates)
  constructor(problem, t0, t1) {
    Object.assign(this, {problem, t1, failure: "", found: []});
    this.sides = problem.eventKinds.map(() => 0);
    this.g = problem.eventKinds.map(() => 0);
    this.r = new Float64Array(problem.resetCount);
    this.taken = problem.samples.map(() => -Infinity);
    const farthest = (offset) => Math.max(Math.abs(t0), Math.abs(t1), Math.abs(offset));
    const bad = problem.samples.find(({every, offset}) => !(t1 - t0 < mostSamples * every && farthest(offset) < mostPeriods * every));
    if (bad) this.failure = "the period of the sample \u201c" + bad.name + "\u201d is " + bad.every.toPrecision(4) + " s";
  }

  // Values of the event functions of the model.
  values(t, x) {
    if (this.g.length > 0 && this.problem.events(t, x, this.g) !== 0) this.g.fill(NaN);
    return Array.from(this.g);
  }

  isCrossing(i, side) {
    const {direction} = this.problem.eventKinds[i];
    return side !== 0 && this.sides[i] === -side && (direction === "any" || (direction === "up") === (side > 0));
  }
  // Events that lie between the sides and this state.
  crossing(t, x) { return this.values(t, x).map(Math.sign).flatMap((side, i) => (this.isCrossing(i, side) ? [i] : [])); }
  // The same; takes the sides of this state.
  crossed(t, x) {
    const found = this.crossing(t, x);
    this.g.forEach((value, i) => { if (value > 0 || value < 0) this.sides[i] = Math.sign(value); });
    return found;
  }

  fail(text, t) { this.failure = text + " at t = " + t.toPrecision(6) + " s"; }

  holds(of, t, x) {
    if (of.condition === null) return true;
    return this.problem.resets(t, x, this.r) === 0 && this.r[of.condition] > 0.5;
  }

  // Sets the new values; returns whether it did.
  set(of, t, x) {
    if (of.set.length === 0) return false;
    const code = this.problem.resets(t, x, this.r), before = Float64Array.from(x);
    if (code === 0 && of.condition !== null && !(this.r[of.condition] > 0.5)) return false;
    if (code !== 0 || of.set.some(([, value]) => !Number.isFinite(this.r[value]))) {
      this.fail("a new value that \u201c" + of.name + "\u201d sets is not finite", t);
      return false;
    }
    for (const [place, value] of of.set) x[place] = this.r[value];
    const moves = of.set.some(([place]) => place < this.problem.moving && x[place] !== before[place]);
    if (moves && !this.problem.meet(t, x, of.set)) this.fail("the new values that \u201c" + of.name + "\u201d sets break a constraint", t);
    return true;
  }

  // Handles events that occurred, and those that their resets cause. Returns {changed, stopped}.
  occur(occurred, t, x) {
    const result = {changed: false, stopped: false};
    for (let count = 0; occurred.length > 0 && this.failure === "";) {
      const i = Math.min(...occurred), of = this.problem.eventKinds[i];
      occurred = occurred.filter((j) => j !== i);
      if (!this.holds(of, t, x)) continue;
      if (++count > longestChain) {
        this.fail("a chain of events without end, with \u201c" + of.name + "\u201d", t);
        break;
      }
      this.found.push({t, name: of.name});
      result.stopped = result.stopped || of.stop;
      if (!this.set(of, t, x)) continue;
      result.changed = true;
      for (const j of this.crossed(t, x)) if (j !== i && !occurred.includes(j)) occurred.push(j);
    }
    return result;
  }

  // Events located at (t, x). begin: values of the event functions where the motion to here began.
  happen(occurred, begin, t, x) {
    const located = this.values(t, x);
    this.crossed(t, x);
    for (const i of occurred) this.sides[i] = 0;
    const result = this.occur(occurred, t, x), after = this.values(t, x);
    // The side on which an event function is at its zero is decided by rounding.
    for (const i of occurred) if (Math.abs(after[i]) <= 4 * Math.abs(located[i]) + 1e-12 * Math.abs(begin[i])) this.sides[i] = 0;
    return result;
  }

  // Number and time of the first sample i at or after t.
  sampleAfter(i, t) {
    const {every, offset} = this.problem.samples[i];
    let k = Math.ceil((t - offset) / every);
    while (offset + k * every < t) ++k;
    while (offset + (k - 1) * every >= t) --k;
    return [k, offset + k * every];
  }

  // Takes the samples that are due at t, and handles the events that these cause.
  sample(t, x) {
    let changed = false;
    this.problem.samples.forEach((of, i) => {
      if (this.failure !== "") return;
      const [k, at] = this.sampleAfter(i, t - nearTo(t));
      if (at > t + nearTo(t) || k <= this.taken[i]) return;
      this.taken[i] = k;
      for (const [place, normal, seed] of of.noise) x[place] = randomNumber(normal, seed, k);
      changed = this.set(of, t, x) || of.noise.length > 0 || changed;
    });
    const result = changed ? this.occur(this.crossed(t, x), t, x) : {changed: false, stopped: false};
    return {changed: changed || result.changed, stopped: result.stopped};
  }

  // The next sample, or the end of the run: a sample there belongs to what follows.
  until(t) {
    const after = t + 2 * nearTo(t);
    let end = this.t1;
    if (this.failure !== "") return end;
    this.problem.samples.forEach(({every, offset}, i) => {
      const [k, next] = this.sampleAfter(i, after), at = next > after ? next : offset + (k + 1) * every;
      if (at < this.t1 - 2 * nearTo(this.t1)) end = Math.min(end, at);
    });
    return end;
  }
}

