// The tables below the plots: of the run of the program, or of a run in the page. They show the run that is drawn.
class Results {
  constructor(place, panels, kept) {
    const names = panels.flatMap((panel) => panel.of);
    Object.assign(this, {place, curves: names, kept: names.filter((of) => kept.includes(of.name)), original: [...place.childNodes]});
  }

  // `motion`: null for the run of the program. `about`: pairs of words; null if the motion is a place without a run.
  show(motion, about) {
    if (motion === null) {
      this.place.replaceChildren(...this.original);
      return;
    }
    this.place.replaceChildren();
    if (about === null) {
      this.paragraph("A point is being placed. The run follows when it is let go.");
      return;
    }
    this.paragraph("Of the run in this page. \u201cAs in the model\u201d shows the run of the program again.");
    this.table(["", ""], about);
    const last = motion.t.length - 1, states = motion.live.states.map((state, k) => [state.name, motion.x[last][k]]);
    const known = new Set(states.map(([name]) => name)), drawn = motion.drawn();
    const others = this.curves.filter((of) => !known.has(of.name)).map((of) => [of.name, drawn[last][of.at]]);
    this.heading("At the end");
    this.table(["", "value"], [["t", motion.t[last]], ...states, ...others]);
    if (this.kept.length > 0) {
      this.heading("Conserved");
      this.table(["", "at the start", "largest relative drift"], this.kept.map((of) => {
        const values = motion.curve(of), size = Math.max(...values.map(Math.abs));
        return [of.name, values[0], size > 0 ? (Math.max(...values.map((v) => Math.abs(v - values[0]))) / size).toExponential(1) : 0];
      }));
    }
    if (motion.events.length > 0) {
      this.heading("Events");
      this.table(["t", "of"], motion.events.map((event) => [event.t, event.name]));
    }
  }

  paragraph(text) { this.add("p", text).className = "quiet"; }
  heading(text) { this.add("h3", text); }
  add(name, text, place = this.place) {
    const node = document.createElement(name);
    node.textContent = text;
    place.append(node);
    return node;
  }
  table(head, rows) {
    const table = this.add("table", "");
    const row = (cells, name) => {
      const line = this.add("tr", "", table);
      for (const cell of cells) {
        const node = this.add(name, typeof cell === "number" ? String(Number(cell.toPrecision(10))) : cell, line);
        if (typeof cell === "number") node.className = "n";
      }
    };
    row(head, "th");
    rows.forEach((cells) => row(cells, "td"));
  }
}
