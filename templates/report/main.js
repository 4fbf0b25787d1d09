// The page: the drawing with its controls, the live model or the recorded run, the plots.
const data = JSON.parse(document.getElementById("motion").textContent);
const stage = document.getElementById("stage"), view = document.createElement("div"), canvas = document.createElement("canvas");
const bar = document.createElement("div"), tools = document.createElement("div"), message = document.createElement("p");
const live = data.live ? new Live(model, data.live, data) : null;
const recorded = new Motion(data.t, data.x ? data.x.map((x) => Float64Array.from(x)) : null, data.y, live, data.events, []);
let motion = recorded, pending = 0;

canvas.id = "scene";
canvas.setAttribute("role", "img");
canvas.setAttribute("aria-label", "the mechanism, moving");
view.className = "view";
bar.className = tools.className = "bar";
message.className = "status quiet";
message.id = "status";
message.setAttribute("role", "status");
view.append(canvas, bar, tools, message);
stage.append(view);

const scene = new Scene(canvas, data.parts, data.down), plots = new Plots(document.getElementById("plots"), data.panels, (t) => { player.play(false); player.jump(t); });
const plotted = data.panels.flatMap((panel) => panel.of).filter((of) => live && of.state && of.at < live.n);
const phase = plotted.length > 0 ? new Phase(document.getElementById("plots"), plotted, live.layout.rates, plots.element) : null;
const results = new Results(document.getElementById("results"), data.panels, data.kept);
let showStart = () => {}, showParameters = () => {};  // put the sliders on the values of the current model
let notice = "";  // of the address of the page
const link = document.createElement("a");  // to the page with the values of the current model
link.textContent = "Link to these values";
link.id = "link";
const updateLink = () => { link.href = "#" + fragmentOf(live); };
const player = new Player(bar, (t) => { scene.show(t); plots.show(t); });
const redraw = () => scene.show(player.at);
if (data.parts.places.length === 0) canvas.hidden = true;

// Takes a motion for the drawing, the plots and the tables; `about` of the tables: see Results.
function take(next, find, about) {
  motion = next;
  scene.take(motion, live ? live.sizes : data.sizes, find, {code: surfaceCode, p: live ? live.p : Float64Array.from(data.p)});
  player.take(motion, data.speed);
  plots.take(motion);
  if (phase) phase.take(motion);
  results.show(motion === recorded ? null : motion, about);
  player.jump(Math.min(player.at, player.t1));
}

// Runs the current model; cancels a run in progress.
function run(play) {
  const mine = ++pending;
  player.play(false);
  live.prepare();
  updateLink();
  if (live.refusal !== "") {
    message.textContent = notice + "no run with these values: " + live.refusal + ". The run before is shown.";
    return;
  }
  showStart();
  const integration = live.integration(500);
  const work = () => {
    if (mine !== pending) return;
    if (!integration.advance(25)) { message.textContent = "running: t = " + integration.t.toPrecision(3) + " s"; setTimeout(work, 0); return; }
    const steps = integration.steps + " steps in this page";
    message.textContent = notice + (integration.outcome === "done" ? steps : steps + "; " + integration.outcome);
    if (integration.times.length > 1) {
      player.at = live.t0;
      take(new Motion(integration.times, integration.states, null, live, integration.found, integration.modes), false, [["outcome", integration.outcome], ["steps", String(integration.steps)]]);
      player.play(play);
    }
  };
  work();
}

function grab(at) {
  if (!live || canvas.hidden) return null;
  let best = null, nearest = 24;
  data.parts.places.forEach((place) => {
    const p = scene.camera.project(scene.position(scene.now, place.at)), distance = Math.hypot(p[0] - at[0], p[1] - at[1]);
    if (distance < nearest) { nearest = distance; best = place; }
  });
  if (best === null) return null;
  player.play(false);
  const x = motion.state(player.at), drag = new Drag(live, best.at, scene.camera);
  let pulled = false;
  return {
    move: (now) => {
      pulled = true;
      const here = drag.place(x), p = scene.camera.project(here);
      drag.move(x, plus(here, scene.camera.lift(now[0] - p[0], now[1] - p[1])));
      take(new Motion([live.t0, live.t1], [x, x].map((state) => Float64Array.from(state)), null, live, [], []), false, null);
      player.jump(live.t0);
    },
    release: () => {
      if (!pulled) return;
      live.placed = Float64Array.from(x);
      run(true);
    }};
}

function checkbox(text, key) {
  const label = document.createElement("label"), box = document.createElement("input");
  Object.assign(box, {type: "checkbox", checked: scene.shown[key]});
  box.addEventListener("change", () => { scene.shown[key] = box.checked; redraw(); });
  label.append(box, document.createTextNode(" " + text));
  return label;
}

// Legend of the colours and heads of forces, and of missing forces; shown with them.
function legend() {
  const place = document.createElement("span"), kinds = {applied: "applied", constraint: "of constraints", friction: "of friction"}, {arrows, beyond, without_vector} = data.parts;
  const add = (text, colour) => {
    const entry = document.createElement("span");
    entry.textContent = text;
    if (colour) entry.style.color = colour;
    place.append(entry);
  };
  place.className = "legend";
  place.hidden = true;
  for (const kind in kinds) if (arrows.some((arrow) => arrow.kind === kind)) add("\u2192 " + kinds[kind], forceColours[kind]);
  if (arrows.some((arrow) => arrow.turns)) add(arrows.some((arrow) => !arrow.turns) ? "\u21a0 moments, in a scale of their own" : "\u21a0 moments");
  if (beyond > 0) add(arrows.length + " arrows are drawn, " + beyond + " more are not");
  if (without_vector.length > 0) add("not drawn, since no vector is known of all that they do: " + without_vector.slice(0, 6).join(", ") + (without_vector.length > 6 ? " and " + (without_vector.length - 6) + " more" : ""));
  tools.addEventListener("change", () => { place.hidden = !scene.shown.forces; });
  return place;
}

function panel() {
  const place = document.createElement("div"), sliders = [], places = [];
  place.className = "panel";
  const group = (title, open) => {
    const field = document.createElement("fieldset"), details = document.createElement("details"), summary = document.createElement("summary");
    summary.textContent = title;
    details.open = open;
    details.append(summary);
    field.append(details);
    place.append(field);
    return details;
  };
  const parameters = group("Parameters", true), starts = group("Initial values", false);
  live.parameters.forEach((p, i) => {
    if (!p.moved) return;
    const [low, high] = rangeOf(p.value, p.positive);
    const made = slider(p.name, p.unit, p.note, p.value, low, high, (v) => { live.chosen[i] = v; run(true); });
    sliders.push(() => made.set(live.chosen[i]));
    parameters.append(made.row);
  });
  live.states.forEach((state, k) => {
    if (!state.moved) return;
    const value = live.x[k], reach = state.unit === "rad" ? Math.PI : Math.max(1, 2 * Math.abs(value));
    const made = slider(state.name, state.unit, "", value, Math.min(-reach, value), Math.max(reach, value), (v) => { live.placed = null; live.starts_chosen.set(k, v); run(true); });
    places.push(() => made.set(live.x[k]));
    starts.append(made.row);
  });
  showParameters = () => sliders.forEach((show) => show());
  showStart = () => places.forEach((show) => show());
  place.append(button("As in the model", "All values as the model has them", () => {
    ++pending;
    live.reset();
    showParameters();
    showStart();
    notice = "";
    updateLink();
    message.textContent = "";
    player.at = recorded.t[0];
    take(recorded, true);
    player.play(true);
  }), link);
  updateLink();
  stage.append(place);
  stage.classList.add("live");
}

tools.append(button("+", "Zoom in (+)", () => { scene.camera.zoom *= 1.25; redraw(); }), button("\u2212", "Zoom out (-)", () => { scene.camera.zoom /= 1.25; redraw(); }),
             button("View", "The first view (0)", () => { scene.camera.home(); redraw(); }), checkbox("traces", "traces"), checkbox("axes", "axes"), checkbox("names", "names"));
const recorder = new Recorder({canvas, scene, player, name: data.model, say: (text) => { message.textContent = text; }});
if (data.parts.places.length > 0) tools.append(button("Save GIF", "Save the motion as an animated GIF for slides; again: stop", () => recorder.save()));
if (data.parts.surfaces.length + data.parts.contacts.length > 0) tools.append(checkbox("surfaces", "surfaces"));
if (data.parts.arrows.length + data.parts.without_vector.length > 0) tools.append(checkbox("forces", "forces"), legend());
const help = document.createElement("p");
help.className = "quiet";
help.textContent = live ? "Drag a point to place it and let go; drag beside it to turn the view, with shift to move it." : "Drag to turn the view, with shift to move it. This page replays the run and does not compute: " + data.reason + ".";
if (data.parts.untried) help.textContent += " Rods are not looked for among so many places.";
view.append(help);
pointers(canvas, scene.camera, redraw, grab);
keys(canvas, player, scene.camera, redraw);
take(recorded, true);
if (live) panel();
fitFormulas();
for (const folded of document.querySelectorAll("details")) folded.addEventListener("toggle", fitFormulas);
window.addEventListener("resize", () => { redraw(); fitFormulas(); });
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw);
player.jump(player.t0);
if (!matchMedia("(prefers-reduced-motion: reduce)").matches) player.play(true);
// The values in the address of the page.
function followAddress() {
  if (!live || location.hash.length < 2 || location.hash.slice(1) === fragmentOf(live)) return;
  const unknown = takeFragment(live, location.hash.slice(1));
  notice = unknown.length > 0 ? "not taken from the address: " + unknown.slice(0, 6).join(", ") + ". " : "";
  showParameters();
  run(true);
}
window.addEventListener("hashchange", followAddress);
followAddress();
// For inspection from the console of the browser.
window.report = {data, live, recorder, scene, player, phase, run, motion: () => motion};
