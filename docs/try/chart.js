// A chart of curves as SVG: axes with round numbers, a line or points for each series, in the colours of try.css.
const [WIDTH, HEIGHT, LEFT, RIGHT, TOP, BOTTOM] = [440, 300, 62, 12, 12, 44];
const PREFIXES = { "-15": "f", "-12": "p", "-9": "n", "-6": "µ", "-3": "m", 0: "", 3: "k", 6: "M", 9: "G", 12: "T" };

/** [factor, prefix] with which a number of this size is between 1 and 1000. */
export function prefix(size) {
  const power = size > 0 ? Math.min(12, Math.max(-15, 3 * Math.floor(Math.log10(size * (1 + 1e-9)) / 3))) : 0;
  return [10 ** -power, PREFIXES[power]];
}

/** Some five round numbers within an interval. */
function ticks(low, high) {
  const rough = (high - low) / 5;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = power * [1, 2, 5, 10].find((one) => one * power >= rough);
  const first = Math.ceil(low / step - 1e-9);
  return Array.from({ length: Math.floor(high / step + 1e-9) - first + 1 }, (_, i) => (first + i) * step);
}

/**
 * Draw series of points [x, y] in base units.
 * axes: {x, y}, each {label, unit, low?, high?}; series: [{points, className, dots}], in the order of drawing.
 */
export function chart(element, axes, series) {
  const all = series.flatMap(({ points }) => points).filter((point) => point.every(Number.isFinite));
  const [x, y] = ["x", "y"].map((name, i) => {
    const values = all.map((point) => point[i]);
    let low = axes[name].low ?? Math.min(...values), high = axes[name].high ?? Math.max(...values);
    if (!(high > low)) [low, high] = [low - 1, high + 1];
    const [factor, unit] = axes[name].unit ? prefix(Math.max(Math.abs(low), Math.abs(high))) : [1, ""];
    const margin = 0.04 * (high - low);
    [low, high] = [(low - margin) * factor, (high + margin) * factor];
    const [start, length] = i ? [HEIGHT - BOTTOM, TOP + BOTTOM - HEIGHT] : [LEFT, WIDTH - LEFT - RIGHT];
    const label = `${axes[name].label} (${axes[name].unit ? unit + axes[name].unit : axes[name].model})`;
    return { label, ticks: ticks(low, high), at: (value) => start + ((value - low) / (high - low)) * length, factor };
  });
  const place = ([one, other]) => `${x.at(one * x.factor).toFixed(2)},${y.at(other * y.factor).toFixed(2)}`;
  const number = (value) => String(Number(value.toPrecision(6))).replace("-", "−");
  const [bottom, right] = [HEIGHT - BOTTOM, WIDTH - RIGHT];
  const axis = [
    ...x.ticks.map((t) => `<path class="grid" d="M${x.at(t)} ${TOP}V${bottom}"/><text x="${x.at(t)}" y="${bottom + 16}" text-anchor="middle">${number(t)}</text>`),
    ...y.ticks.map((t) => `<path class="grid" d="M${LEFT} ${y.at(t)}H${right}"/><text x="${LEFT - 6}" y="${y.at(t) + 4}" text-anchor="end">${number(t)}</text>`),
    `<text x="${(LEFT + right) / 2}" y="${HEIGHT - 6}" text-anchor="middle">${x.label}</text>`,
    `<text transform="translate(14 ${(TOP + bottom) / 2}) rotate(-90)" text-anchor="middle">${y.label}</text>`,
  ];
  const drawn = series.map(({ points, className, dots }) => {
    const shown = points.filter((point) => point.every(Number.isFinite)).map(place);
    if (!dots) return `<polyline class="${className}" points="${shown.join(" ")}"/>`;
    return shown.map((one) => `<circle class="${className}" cx="${one.split(",")[0]}" cy="${one.split(",")[1]}" r="${dots}"/>`).join("");
  });
  element.setAttribute("viewBox", `0 0 ${WIDTH} ${HEIGHT}`);
  const clip = `clip-${element.id}`;
  element.innerHTML = `<clipPath id="${clip}"><rect x="${LEFT}" y="${TOP}" width="${right - LEFT}" height="${bottom - TOP}"/></clipPath>
    ${axis.join("")}<path class="frame" d="M${LEFT} ${TOP}V${bottom}H${right}"/><g clip-path="url(#${clip})">${drawn.join("")}</g>`;
}
