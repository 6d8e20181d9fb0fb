// What a deck of the page says of a body of other size, stiffness and adhesion, and the closed forms beside it.
// A contact radius a, displacement d, force F (compression positive), profile z = c rⁿ, line load q(x) = E* (d − g(x)):
//   d = κ c aⁿ − √(2πWa/E*),   F = 2n/(n+1) κ c E* aⁿ⁺¹ − √(8πE*Wa³),   κ = 2 of a paraboloid, π/2 of a cone.
// Hertz; Johnson, Kendall, Roberts 1971; Sneddon 1965; Maugis, Barquins 1981; Kendall 1971 (see docs/physics.md).

/** The contact without adhesion of a body: exponent n and κ; the size is the radius, or the slope of a cone. */
export const BODIES = {
  ball: { exponent: 2, factor: 2, coefficient: (size) => 0.5 / size },
  cone: { exponent: 1, factor: Math.PI / 2, coefficient: (size) => size },
  punch: {},
};

/** The closed form of a contact {body, size, modulus, work}: limits, and the state under a force. */
export function closedForm({ body, size, modulus, work }) {
  const tension = (a) => Math.sqrt(8 * Math.PI * modulus * work * a ** 3);
  const edge = (r, a) => tension(a) / (2 * Math.PI * a * Math.sqrt(a * a - r * r));
  if (body === "punch") {
    const state = (force) => ({ force, radius: size, displacement: force / (2 * modulus * size) });
    return { pullOff: tension(size), state, pressure: (r, { force }) => force / (2 * Math.PI * size * Math.sqrt(size * size - r * r)) };
  }
  const { exponent: n, factor, coefficient } = BODIES[body];
  const slope = factor * coefficient(size);
  const force = (a) => ((2 * n) / (n + 1)) * slope * modulus * a ** (n + 1) - tension(a);
  const displacement = (a) => slope * a ** n - Math.sqrt((2 * Math.PI * work * a) / modulus);
  // dF/da = 0
  const critical = ((9 * Math.PI * work) / (2 * n * n * slope * slope * modulus)) ** (1 / (2 * n - 1));
  const state = (wanted) => {
    let low = critical, high = 2 * critical || size;
    while (force(high) < wanted) high *= 2;
    for (let step = 0; step < 200; step++) {
      const middle = (low + high) / 2;
      if (force(middle) < wanted) low = middle; else high = middle;
    }
    return { force: wanted, radius: high, displacement: displacement(high) };
  };
  const pressed = {
    ball: (r, a) => ((2 * modulus) / (Math.PI * size)) * Math.sqrt(a * a - r * r),
    cone: (r, a) => ((modulus * size) / 2) * Math.acosh(a / r),
  }[body];
  return { pullOff: -force(critical), state, pressure: (r, { radius }) => pressed(r, radius) - edge(r, radius) };
}

/** The frames of a LAMMPS dump: of each the positions x and forces fz of the upper particles, x > 0, and all forces' sum. */
export function readStates(text) {
  return text.split("ITEM: TIMESTEP\n").slice(1).map((frame) => {
    const [head, ...lines] = frame.slice(frame.indexOf("ITEM: ATOMS")).trim().split("\n");
    const names = head.split(" ").slice(2);
    const [type, x, force] = ["type", "x", names.find((name) => name.endsWith("fz"))].map((name) => names.indexOf(name));
    const upper = lines.map((line) => line.split(" ").map(Number)).filter((atom) => atom[type] === 2);
    upper.sort((one, other) => one[x] - other[x]);
    return { x: upper.map((atom) => atom[x]), force: upper.map((atom) => atom[force]) };
  });
}

/** The lines of curve.txt: phase, displacement, force. */
export function readCurve(text) {
  return text.trim().split("\n").slice(1).map((line) => {
    const [phase, displacement, force] = line.split(" ");
    return { phase, displacement: Number(displacement), force: Number(force) };
  });
}

/** Contact radius a, its error of reading (doubt), and line load up to a, as knots x, q on one side, under elastic springs. */
export function lineLoad({ x, force }, { body, law, size, modulus, work, spacing }) {
  const side = x.map((position, i) => [position, force[i] / spacing])
    .filter(([position, q]) => position > 0 && (body === "punch" ? position < size : q !== 0));
  const knots = { x: side.map(([position]) => position), q: side.map(([, q]) => q) };
  if (body === "punch") return extended(knots, size, knots.q.at(-1));
  const [first, second, third] = knots.q.slice(law === "jkr" ? -4 : -3);
  const [bend, rise] = [third - 2 * second + first, third - second + 0.5 * (third - 2 * second + first)];
  const inside = (t) => third + rise * t + 0.5 * bend * t * t; // t: spacings from the third particle
  if (law === "jkr") { // the last particle carries the part of its cell that is in contact
    const carried = knots.q.pop(), last = knots.x.pop();
    let share = 1;
    for (let step = 0; step < 20; step++) share = carried / inside(0.5 * (1 + share));
    const [radius, load] = [last + (share - 0.5) * spacing, inside(0.5 + share)];
    // The distance to where the same line load is the adhesive edge's, −√(2πE*Wa).
    const tension = Math.sqrt(2 * Math.PI * modulus * work * radius);
    const doubt = Math.abs((load + tension) / ((rise + bend * (0.5 + share)) / spacing + tension / (2 * radius)));
    return { ...extended(knots, radius, load), doubt };
  }
  const root = Math.sqrt(rise * rise - 2 * bend * third); // where the parabola falls to 0
  return extended(knots, knots.x.at(-1) + (spacing * 2 * third) / (root - rise), 0);
}

function extended({ x, q }, radius, load) {
  return { radius, doubt: 0, x: [...x, radius], q: [...q, load] };
}

/** p(r), r < a, the Abel transform of a line load that is linear in x² between its knots, or in x under a cone's tip. */
export function pressure({ x, q, radius }, body, r) {
  const cone = body === "cone";
  const unit = (position) => (cone ? position : position * position);
  const integral = (position) => {
    const root = Math.sqrt(Math.max(position * position - r * r, 0));
    return cone ? Math.log(position + root) : 2 * root;
  };
  let sum = q.at(-1) / Math.sqrt(radius * radius - r * r);
  for (let k = 0; k + 1 < x.length; k++) {
    const start = k === 0 ? r : Math.max(x[k], r); // from the axis to the first particle the slope is that behind it
    if (x[k + 1] <= start) continue;
    sum -= ((q[k + 1] - q[k]) / (unit(x[k + 1]) - unit(x[k]))) * (integral(x[k + 1]) - integral(start));
  }
  return sum / Math.PI;
}

/** Factors from the deck's units to those of a contact {size, modulus, work} of the same body; `force`: that of a state. */
export function scales(body, deck, contact, forceRatio) {
  const [size, modulus, work] = ["size", "modulus", "work"].map((name) => contact[name] / deck[name]);
  let radius, displacement;
  if (body === "punch") {
    radius = size;
    displacement = deck.work ? Math.sqrt((work * size) / modulus) : forceRatio / (modulus * size);
  } else if (body === "ball") {
    radius = Math.cbrt(deck.work ? (work * size * size) / modulus : (forceRatio * size) / modulus);
    displacement = (radius * radius) / size;
  } else {
    radius = deck.work ? work / (modulus * size * size) : Math.sqrt(forceRatio / (modulus * size));
    displacement = size * radius;
  }
  return { radius, displacement, force: modulus * radius * displacement, pressure: (modulus * displacement) / radius };
}

/** Position x > 0 of the largest tension, the contact radius of two chains, and its change with two samples less. */
export function tensileRadius({ x, force }) {
  const lowest = force.reduce((best, value, k) => (x[k] > 0 && value < force[best] ? k : best), x.findIndex((one) => one > 0));
  const minimum = (half) => { // of the polynomial through the samples around, by golden sections
    const around = (list) => list.slice(Math.max(lowest - half, 0), lowest + half + 1);
    const [xs, ys] = [around(x), around(force)];
    const value = (at) => ys.reduce((sum, y, i) => sum + xs.reduce((product, one, j) => (j === i ? product : (product * (at - one)) / (xs[i] - one)), y), 0);
    let low = x[lowest - 1], high = x[lowest + 1];
    const golden = (Math.sqrt(5) - 1) / 2;
    for (let step = 0; step < 60; step++) {
      const [left, right] = [high - golden * (high - low), low + golden * (high - low)];
      if (value(left) < value(right)) high = right; else low = left;
    }
    return (low + high) / 2;
  };
  const radius = minimum(5);
  return { radius, error: Math.abs(radius - minimum(4)) };
}
