// The page "Try it": a deck of contact1d runs in a worker, and sliders scale what it wrote, or change the deck and run it again.
import { chart, prefix } from "./chart.js";
import { closedForm, lineLoad, pressure, readCurve, readStates, scales, tensileRadius } from "./contact.js";

const root = document.getElementById("try");
const opened = performance.now();
const NAMES = { ball: "Ball", cone: "Cone", punch: "Flat punch", pressed: "Without adhesion", jkr: "JKR", chains: "Two chains of the paper" };
const FORMS = {
  ball: { pressed: "Hertz", jkr: "Johnson, Kendall, Roberts" },
  cone: { pressed: "Sneddon", jkr: "Maugis, Barquins" },
  punch: { pressed: "Sneddon", jkr: "Kendall" },
};
const decimal = (power) => Number((10 ** power).toPrecision(2));
const exact = (value) => Number(value);
/** Sliders by name: [label, lowest, highest, step, start, unit, value of a position]. */
const SLIDERS = {
  radius: ["Radius R", -6, -1, 0.05, -2.7, "m", decimal],
  halfAngle: ["Half-angle of the cone", 60, 89.5, 0.5, 85, "°", exact],
  modulus: ["Young’s modulus E", 3, 12, 0.05, 6, "Pa", decimal],
  poisson: ["Poisson’s ratio ν", 0, 0.49, 0.01, 0.49, "", exact],
  work: ["Work of adhesion W", -3, 0, 0.05, -1.3, "J/m²", decimal],
  force: ["Force F", -9, 3, 0.05, -3, "N", decimal],
  load: ["Force F", 0, 1, 1, 0, "N", exact], // the load step of the deck
  bulk: ["Bulk stiffness of a particle", 0.5, 2, 0.05, 1, "FU/LU", exact],
  neighbours: ["Stiffness between neighbours", 0.05, 1, 0.05, 0.3, "FU/LU", exact],
  deepest: ["Largest displacement", 0.1, 0.8, 0.05, 0.4, "LU", exact],
  state: ["State shown", 0, 1, 1, 0, "", exact],
};

function sliderHtml([name, [label, low, high, step, start]]) {
  return `<div class="slider" id="row-${name}"><label for="${name}">${label}</label><output for="${name}"></output>
    <input type="range" id="${name}" min="${low}" max="${high}" step="${step}" value="${start}"></div>`;
}

function choiceHtml(name, values) {
  const one = (value, i) => `<label><input type="radio" name="${name}" value="${value}" ${i ? "" : "checked"}> ${NAMES[value]}</label>`;
  return `<div class="choices">${values.map(one).join("")}</div>`;
}

root.innerHTML = `
  <p class="warning" id="trouble" role="alert" hidden></p>
  <fieldset><legend>Body</legend>${choiceHtml("body", ["ball", "cone", "punch"])}</fieldset>
  <fieldset><legend>Contact law</legend>${choiceHtml("law", ["jkr", "pressed", "chains"])}</fieldset>
  <fieldset><legend>Values</legend><div class="sliders">${Object.entries(SLIDERS).map(sliderHtml).join("")}</div></fieldset>
  <p><label for="progress" id="status" role="status">Loading LAMMPS …</label><progress id="progress" max="1"></progress></p>
  <div id="results" hidden>
    <table id="numbers"></table>
    <p class="warning" id="validity" role="status" hidden></p>
    <div class="charts">
      <figure><svg id="curve" role="img"></svg><figcaption id="curve-caption"></figcaption></figure>
      <figure><svg id="profile" role="img"></svg><figcaption id="profile-caption"></figcaption></figure>
    </div>
    <p id="native"></p>
    <p>Download the deck (<code>lmp -in in.lammps</code> repeats this run), and the scene with the values of the sliders:</p>
    <p class="downloads" id="downloads"></p>
    <pre><code id="python"></code></pre>
  </div>`;

const element = (id) => document.getElementById(id);
const chosen = (name) => root.querySelector(`input[name=${name}]:checked`).value;
const value = (name) => SLIDERS[name][6](Number(element(name).value));
const text = (id, words) => { element(id).textContent = words; };
const cut = (number, digits = 4) => String(Number(number.toPrecision(digits))).replace("-", "−");

/** A number with an SI prefix: "1.2 mN". */
function si(number, unit, digits = 4) {
  const [factor, letter] = prefix(Math.abs(number));
  return `${cut(number * factor, digits)}\u00a0${letter}${unit}`;
}

/** A number with its uncertainty to two digits, both with the same prefix: "402.7 ± 1.3 MPa"; plain without a unit in SI. */
function stated(number, error, unit, isSi = true) {
  if (!(error > 1e-8 * Math.abs(number))) return [isSi ? si(number, unit, 6) : `${cut(number, 6)} ${unit}`, ""];
  const [factor, letter] = isSi ? prefix(Math.max(Math.abs(number), error)) : [1, ""];
  const places = Math.min(12, Math.max(0, 1 - Math.floor(Math.log10(error * factor))));
  return [`${(number * factor).toFixed(places).replace("-", "−")}\u00a0${letter}${unit}`, `± ${(error * factor).toFixed(places)}`];
}

function trouble(words) {
  text("trouble", words);
  element("trouble").hidden = !words;
}

function stopped(words) {
  trouble(words);
  text("status", "No result.");
  element("progress").value = 0;
}

function unusable(words) {
  worker = null;
  stopped(words);
}

// --- Decks and runs -------------------------------------------------------------------------------------------------

const decks = fetch("decks/decks.json").then((answer) => answer.json());
const finished = new Map(); // the result of each deck that never changes
let worker = null, current = null, waiting = null, count = 0;

function startWorker() {
  if (typeof WebAssembly === "undefined" || typeof Worker === "undefined") {
    throw Error("This browser has WebAssembly or workers switched off, and LAMMPS needs both to run here. Switch them on, or run the same scene with contact1d run.");
  }
  worker = new Worker("worker.js", { type: "module" });
  worker.onerror = () => unusable("LAMMPS could not be loaded in a worker of this browser. Use a current browser, with the site on a web server, or run the same scene with contact1d run.");
  worker.onmessage = ({ data }) => {
    if (data.failed) (data.id === undefined ? unusable : stopped)(data.failed);
    if (data.ready && !current) text("status", "LAMMPS is ready.");
    if (data.id === undefined || data.id !== current?.id) return;
    if (data.relaxed) { element("progress").value = ++current.relaxed / current.rows; return; }
    const run = current;
    current = null;
    if (!data.failed) arrived(run, data);
    if (waiting) send(waiting);
  };
}

/** Start a run, after the one that is active; one that still waits is dropped. */
function send(run) {
  if (!worker) return;
  if (current) { waiting = run; return; }
  waiting = null;
  current = { ...run, id: ++count, relaxed: 0 };
  text("status", `LAMMPS runs: ${run.title} …`);
  element("progress").removeAttribute("value");
  worker.postMessage({ id: current.id, files: run.files });
}

function arrived(run, { curve, states, seconds }) {
  const all = readStates(states); // one for each load step, of which the scene asked for some
  const result = { ...run, text: curve, curve: readCurve(curve), states: run.deck.kept.map((row) => all[row]), seconds };
  if (run.key) finished.set(run.key, result);
  trouble("");
  root.dataset.first ??= (performance.now() - opened) / 1000;
  rest();
  if (run.name === deckName() && !waiting) show(result);
}

/** Note on the page whether a result is awaited. */
function rest() {
  root.dataset.busy = current || waiting ? "yes" : "";
}

const deckName = () => (chosen("law") === "chains" ? "chains" : `${chosen("body")}_${chosen("law")}`);

/** The deck's files as text, with the values of the sliders for two chains; the key is null where these are not its own. */
async function deckFiles(name) {
  const deck = (await decks)[name];
  deck.texts ??= Promise.all([...deck.files, "native.txt", "scene.toml"].map(async (file) => [file, await (await fetch(`decks/${name}/${file}`)).text()]));
  const files = Object.fromEntries(await deck.texts);
  const { "native.txt": native, "scene.toml": scene, ...given } = files;
  if (name !== "chains") return { files: given, native, scene, key: name, deck };
  const [bulk, neighbours, deepest] = ["bulk", "neighbours", "deepest"].map(value);
  const depth = (numbers) => numbers.replace(/[-+.\de]+/g, (number) => (Number(number) > 0 ? Number(number) * (deepest / SLIDERS.deepest[4]) : number));
  given["in.lammps"] = given["in.lammps"]
    .replace(/(variable +bulk_bond_coefficient index ).*/, `$1${bulk / 2}`)
    .replace(/(variable +neighbours_bond_coefficient index ).*/, `$1${neighbours / 2}`)
    .replace(/(variable +row_displacement index )((?:.*&\n)*.*)/g, (_, head, numbers) => head + depth(numbers));
  const changed = scene
    .replace(/(bulk_stiffness = ).*/, `$1${bulk}`)
    .replace(/(\[neighbours\]\nstiffness = ).*/, `$1${neighbours}`)
    .replace(/(displacements = )(.*)/, (_, head, numbers) => head + depth(numbers));
  const same = given["in.lammps"] === files["in.lammps"] || [bulk, neighbours, deepest].every((one, i) => one === SLIDERS[["bulk", "neighbours", "deepest"][i]][4]);
  if (same) given["in.lammps"] = files["in.lammps"];
  return { files: given, native: same ? native : null, scene: changed, key: same ? name : null, deck };
}

/** Show the chosen contact: what LAMMPS wrote of its deck already, or after a run. */
async function update() {
  const name = deckName();
  const visible = visibleSliders();
  for (const slider of Object.keys(SLIDERS)) element(`row-${slider}`).hidden = !visible.includes(slider);
  for (const radio of root.querySelectorAll("input[name=body]")) radio.disabled = name === "chains";
  const prepared = await deckFiles(name);
  if (name !== deckName()) return;
  const done = prepared.key && finished.get(prepared.key);
  if (done) return show(done);
  const { files, native, scene, key, deck } = prepared;
  const rows = native ? readCurve(native).length : deck.kept.at(-1) + 1;
  send({ name, key, files, native, scene, deck, rows, title: name === "chains" ? NAMES.chains : `${NAMES[chosen("body")]}, ${NAMES[chosen("law")]}` });
}

function visibleSliders() {
  const law = chosen("law"), body = chosen("body");
  if (law === "chains") return ["bulk", "neighbours", "deepest", "state"];
  return [body === "cone" ? "halfAngle" : "radius", "modulus", "poisson", ...(law === "jkr" ? ["work", "load"] : ["force"])];
}

// --- What is shown --------------------------------------------------------------------------------------------------

/** The states of a deck of one body as numbers in its units, read off the particles once. */
function readings(result, body, law) {
  const { deck } = result;
  result.readings ??= result.states.map((state, k) => {
    const { displacement, force } = result.curve[deck.kept[k]];
    const load = lineLoad(state, { ...deck, body, law });
    const mean = force / (Math.PI * load.radius ** 2);
    return { displacement, force, radius: load.radius, load, mean, central: body === "cone" ? mean : pressure(load, body, 0) };
  });
  return result.readings;
}

/** A state's uncertainties under its force: those of F move d, a and p along the curve. */
function errors(all, k, { forceErrors, radiusErrors, pressureError }, body) {
  const [before, after] = [all[Math.max(k - 1, 0)], all[Math.min(k + 1, all.length - 1)]];
  const slope = (name, one, other) => (one === other ? 0 : Math.abs((one[name] - other[name]) / (one.force - other.force)));
  const along = (name) => forceErrors[k] * Math.max(slope(name, before, all[k]), slope(name, all[k], after));
  const radius = Math.max(radiusErrors[k], all[k].load.doubt) + along("radius");
  const central = body === "cone" ? (2 * Math.abs(all[k].mean) * radius) / all[k].radius : pressureError + along("central");
  return { displacement: along("displacement"), radius, central };
}

function show(result) {
  element("results").hidden = false;
  const start = performance.now();
  if (result.name === "chains") showChains(result); else showBody(result);
  showNative(result);
  root.curve = result.text;
  root.dataset.drawn = (performance.now() - start) / 1000;
  text("status", `LAMMPS: ${result.rows} load steps in ${result.seconds.toFixed(2)} s.`);
  element("progress").value = 1;
  root.dataset.result = result.name;
  rest();
}

function showBody(result) {
  const { deck } = result;
  const [body, law] = result.name.split("_");
  const all = readings(result, body, law);
  const slider = element("load");
  if (slider.dataset.deck !== result.name) { // 0 is the largest tension that is offered; the start is as large a compression
    const start = all.findIndex(({ force }) => force < -all.at(-1).force);
    Object.assign(slider, { max: all.length - 2, value: all.length - 2 - start });
    slider.dataset.deck = result.name;
  }
  const k = law === "jkr" ? all.length - 2 - Number(slider.value) : all.length - 1;
  const size = body === "cone" ? 1 / Math.tan((value("halfAngle") * Math.PI) / 180) : value("radius");
  const contact = { body, size, modulus: value("modulus") / (1 - value("poisson") ** 2), work: law === "jkr" ? value("work") : 0 };
  const scale = scales(body, deck, contact, value("force") / all[k].force);
  const form = closedForm(contact);
  const state = all[k], error = errors(all, k, deck, body);
  const force = state.force * scale.force;
  const exactly = form.state(force);
  const centre = body === "cone" ? force / (Math.PI * exactly.radius ** 2) : form.pressure(0, exactly);
  const rows = [
    ["Force F", force, 0, "N"],
    ["Displacement d", state.displacement * scale.displacement, error.displacement * scale.displacement, "m", exactly.displacement],
    ["Contact radius a", state.radius * scale.radius, error.radius * scale.radius, "m", exactly.radius],
    [body === "cone" ? "Mean pressure F/πa²" : "Central pressure p(0)", state.central * scale.pressure, error.central * scale.pressure, "Pa", centre],
  ];
  if (law === "jkr") rows.push(["Pull-off force F<sub>A</sub>", null, 0, "N", form.pullOff]);
  table(rows, FORMS[body][law]);
  labels(law === "jkr" ? `${si(force, "N")} = ${cut(force / form.pullOff, 2)} × pull-off force` : null);
  const slope = body === "punch" ? 0 : body === "cone" ? size : exactly.radius / size;
  const tabor = body === "ball" && contact.work ? Math.cbrt((size * contact.work ** 2) / (contact.modulus ** 2 * 0.3e-9 ** 3)) : Infinity;
  const doubts = [];
  if (slope > 0.1) doubts.push(`The slope of the profile at the contact edge is ${cut(slope, 2)}: the theory of the elastic half-space is for slopes below 0.1.`);
  if (tabor < 5) doubts.push(`With a range of attraction of 0.3 nm the Tabor parameter is ${cut(tabor, 2)}: JKR holds above 5.`);
  text("validity", doubts.join(" "));
  element("validity").hidden = !doubts.length;
  const point = ({ displacement, force: load }) => [displacement * scale.displacement, load * scale.force];
  const points = all.map(point);
  const lowest = points.at(-1)[1], highest = points[0][1];
  const theory = Array.from({ length: 81 }, (_, i) => {
    const one = form.state(law === "jkr" ? lowest + (i / 80) * (highest - lowest) : (i / 80) ** 2 * force);
    return [one.displacement, one.force];
  });
  chart(element("curve"), { x: { label: "displacement d", unit: "m" }, y: { label: "force F", unit: "N" } }, [
    { points: theory, className: "theory" }, { points, className: "lammps" }, { points: [point(state)], className: "chosen", dots: 5 },
  ]);
  const radii = Array.from({ length: 121 }, (_, i) => state.load.radius * Math.min(Math.max(i / 120, body === "cone" ? 0.01 : 0), 0.9995));
  const own = radii.map((r) => [r * scale.radius, pressure(state.load, body, r) * scale.pressure]);
  const analytic = radii.map((r) => { const q = (r / state.load.radius) * exactly.radius; return [q, form.pressure(q, exactly)]; });
  const [low, high] = range(own.map(([, p]) => p));
  chart(element("profile"), { x: { label: "radius r", unit: "m" }, y: { label: "pressure p", unit: "Pa", low, high } }, [
    { points: analytic, className: "theory" }, { points: own, className: "lammps" },
  ]);
  const infinite = [body === "cone" && "the tip", (law === "jkr" || body === "punch") && "the edge"].filter(Boolean).join(" and ");
  text("curve-caption", `Force over displacement: LAMMPS (thin) and ${FORMS[body][law]} (wide); the dot is the state shown.`);
  text("profile-caption", `Pressure over the distance from the axis${infinite && `, infinite at ${infinite}`}.`);
  describe(`LAMMPS: ${points.length} load steps. Beside them: ${FORMS[body][law]}.`);
  downloads(result, siScene(body, law, force), python(body, law, force));
}

/** The interval that a chart shows of pressures that are infinite at one end: without the outermost twentieth. */
function range(pressures) {
  const inner = pressures.slice(6, -6);
  const [low, high] = [Math.min(0, ...inner), Math.max(0, ...inner)];
  return [low, high];
}

function showChains(result) {
  const { deck, key, curve, states } = result;
  const slider = element("state");
  if (Number(slider.max) !== states.length - 1) Object.assign(slider, { max: states.length - 1, value: 0 });
  const k = Number(slider.value), state = states[k], { displacement, force } = curve[deck.kept[k]];
  const kept = deck.kept.map((row) => curve[row].force);
  const peak = kept.indexOf(Math.min(...kept));
  const { radius, error } = tensileRadius(state);
  const rows = [
    ["Displacement d", displacement, 0, "LU"],
    ["Force F", force, key ? deck.forceErrors[k] : 0, "FU"],
    ["Radius of the largest tension", radius, error + (key ? deck.radiusErrors[k] : 0), "LU"],
    ["Largest tension of the states", -kept[peak], key ? deck.forceErrors[peak] : 0, "FU"],
  ];
  table(rows.map((row) => [...row.slice(0, 4), null, false]), null);
  labels(`${k + 1} of ${states.length}`);
  text("validity", key ? "" : "The springs or the path are not those of the run whose uncertainty is known: contact1d run scene.toml states that of this one.");
  element("validity").hidden = Boolean(key);
  const points = curve.map((row) => [row.displacement, row.force]);
  chart(element("curve"), { x: { label: "displacement d", model: "LU" }, y: { label: "force F", model: "FU" } }, [
    { points, className: "lammps" }, { points: [[displacement, force]], className: "chosen", dots: 5 },
  ]);
  const loads = state.x.map((x, i) => [x, state.force[i] / deck.spacing]);
  chart(element("profile"), { x: { label: "x", model: "LU" }, y: { label: "line load q", model: "FU/LU" } }, [
    { points: loads, className: "lammps" }, { points: loads, className: "lammps", dots: 1.8 },
  ]);
  text("curve-caption", "Force over displacement; the dot is the state shown.");
  text("profile-caption", "Force on the particles of the upper chain over the spacing.");
  describe(`LAMMPS: ${curve.length} load steps; the interaction has no closed form.`);
  downloads(result, result.scene, 'import contact1d\nrun = contact1d.run("scene.toml", "runs/chains")\nprint(run)');
}

function table(rows, form) {
  const cells = rows.map(([name, number, error, unit, exactly, isSi = true]) => {
    const [own, spread] = number === null ? ["", ""] : stated(number, error, unit, isSi);
    const analytic = exactly === undefined || exactly === null ? "" : stated(exactly, error, unit, isSi)[0];
    return `<tr><th scope="row">${name}</th><td data-value="${number ?? ""}" data-error="${error}" data-exact="${exactly ?? ""}">${own}<br>${spread}</td>${form ? `<td>${analytic}</td>` : ""}</tr>`;
  });
  element("numbers").innerHTML = `<thead><tr><th scope="col">Result</th><th scope="col">LAMMPS in this browser</th>${form ? `<th scope="col">${form}</th>` : ""}</tr></thead><tbody>${cells.join("")}</tbody>`;
}

/** Write the value of each slider beside it; `last`: that of the load, or of the state shown. */
function labels(last) {
  for (const [name, [, , , , , unit]] of Object.entries(SLIDERS)) {
    const words = name === "load" || name === "state" ? last ?? "" : ["m", "Pa", "N", "J/m²"].includes(unit) ? si(value(name), unit) : `${value(name)} ${unit}`.trim();
    root.querySelector(`output[for=${name}]`).textContent = words;
    element(name).setAttribute("aria-valuetext", words);
  }
}

function describe(words) {
  const rows = [...element("numbers").querySelectorAll("tbody tr")].map((row) => row.innerText.replaceAll(/\s+/g, " "));
  for (const id of ["curve", "profile"]) element(id).setAttribute("aria-label", `${words} ${rows.join("; ")}`);
}

function showNative({ text: curve, native, curve: rows }) {
  if (!native) { text("native", ""); return; }
  const others = readCurve(native);
  const largest = Math.max(...others.map(({ force }) => Math.abs(force)));
  const difference = Math.max(...rows.map(({ force }, i) => Math.abs(force - others[i].force))) / largest;
  text("native", curve === native ? "curve.txt equals that of native LAMMPS byte by byte." : `Largest difference from native LAMMPS: ${difference.toExponential(1)} of the largest force.`);
}

/** A quantity as scenes have it: "1.2 mN", with 12 digits at most. */
const written = (number, unit) => si(number, unit, 12).replace("−", "-").replace("\u00a0", " ");

/** Body, material and load as a scene and Python have them. */
function given(body, law, force) {
  const profile = body === "cone" ? { half_angle: `${value("halfAngle")}°` } : { radius: written(value("radius"), "m") };
  const modulus = written(value("modulus"), "Pa");
  return { profile, modulus, poisson: value("poisson"), work: law === "jkr" ? written(value("work"), "J/m²") : null, load: written(force, "N") };
}

function siScene(body, law, force) {
  const { profile, modulus, poisson, work, load } = given(body, law, force);
  const kind = { ball: "parabola", cone: "cone", punch: "flat_punch" }[body];
  const [[key, size]] = Object.entries(profile);
  return `title = "${NAMES[body]}, ${NAMES[law]}"

[bodies]
particles = "auto"
spacing = "auto"
profile = { kind = "${kind}", ${key} = "${size}" }
bulk_stiffness = "auto"
lower = "rigid_plane"

[material]
upper = { youngs_modulus = "${modulus}", poisson_ratio = ${poisson} }
lower = "rigid"
${work ? `\n[adhesion]\nwork_of_adhesion = "${work}"\n` : ""}
[experiment]
kind = "load"
force = "${load}"
`;
}

function python(body, law, force) {
  const { profile, modulus, poisson, work, load } = given(body, law, force);
  const [[key, size]] = Object.entries(profile);
  const shape = { ball: "sphere", cone: "cone", punch: "punch" }[body];
  const material = `upper={"youngs_modulus": "${modulus}", "poisson_ratio": ${poisson}}, lower="rigid"`;
  return `import contact1d\nrun = contact1d.${shape}(${key}="${size}", ${material}${work ? `, work_of_adhesion="${work}"` : ""}).load("${load}")\nprint(run)`;
}

function downloads(result, scene, script) {
  for (const link of element("downloads").querySelectorAll("a")) URL.revokeObjectURL(link.href);
  const files = { ...result.files, "scene.toml": scene, "contact.py": `${script}\n` };
  element("downloads").replaceChildren(...Object.entries(files).map(([name, words]) => {
    const link = document.createElement("a");
    Object.assign(link, { download: name, textContent: name, href: URL.createObjectURL(new Blob([words], { type: "text/plain" })) });
    return link;
  }));
  text("python", script);
}

// --- Start ----------------------------------------------------------------------------------------------------------

root.addEventListener("input", () => {
  root.dataset.busy = "yes";
  update().catch((error) => trouble(error.message));
});
try {
  startWorker();
  labels(null);
  decks.catch(() => trouble("The decks of this page could not be loaded. Open it from a web server, as with: python -m http.server --directory site"));
  update().catch(() => {});
} catch (error) {
  trouble(error.message);
  text("status", "LAMMPS does not run in this browser.");
  element("progress").hidden = true;
}
