"use strict";
// Draws the figures of the page; a slider moves line load, force and bodies through the states of a run.
const data = JSON.parse(document.getElementById("data").textContent);
const config = { responsive: true, displaylogo: false, showSendToCloud: false };
// What all charts have in common.
const axis = { showline: true, ticks: "outside", automargin: true, exponentformat: "power" };
const common = {
  template: "none",
  // The tool bar is above the plot; the legend is below it, as text that wraps.
  margin: { l: 70, r: 15, t: 36, b: 60 },
  hovermode: "closest",
  hoverlabel: { namelength: -1 },
  showlegend: false,
};
const dashes = { dash: "6 4", dot: "2 3", dashdot: "6 3 2 3" };
const swatch = ({ mode, fill, marker, line: { color, width, dash }, opacity }) => {
  const area = fill ? '<rect width="28" height="12"/>' : "";
  const along = `<path d="M0 6H28" stroke="${color}" stroke-width="${width}" stroke-dasharray="${dashes[dash] ?? ""}"/>`;
  const point = marker ? `<circle cx="14" cy="6" r="${marker.size / 2}"/>` : "";
  const drawn = area + (mode.includes("lines") ? along : "") + (mode.includes("markers") ? point : "");
  return `<svg viewBox="0 0 28 12" fill="${color}" opacity="${opacity}" aria-hidden="true">${drawn}</svg>`;
};
// A name in the legend shows and hides the series of that name.
const legend = (id, traces) => {
  const list = document.createElement("ul");
  list.className = "legend";
  traces.filter((trace) => trace.showlegend).forEach((trace) => {
    const button = document.createElement("button");
    button.innerHTML = `${swatch(trace)}<span>${trace.name}</span>`;
    button.ariaPressed = "true";
    button.addEventListener("click", () => {
      button.ariaPressed = String(button.ariaPressed !== "true");
      const named = traces.flatMap(({ legendgroup }, i) => (legendgroup === trace.legendgroup ? [i] : []));
      Plotly.restyle(id, { visible: button.ariaPressed === "true" }, named);
    });
    list.appendChild(document.createElement("li")).append(button);
  });
  if (list.hasChildNodes()) document.getElementById(id).after(list);
};
const draw = (id, traces, { xaxis, yaxis }) => {
  Plotly.newPlot(id, traces, { ...common, xaxis: { ...axis, ...xaxis }, yaxis: { ...axis, ...yaxis } }, config);
  legend(id, traces);
};
data.charts.forEach((chart, i) => draw(`chart-${i}`, chart.data, chart.layout));

// Logarithmic or linear axes, for a figure whose numbers allow it; the ranges are then those of the data.
document.querySelectorAll("input[data-axis]").forEach((box) => {
  const chart = data.charts[Number(box.dataset.chart)];
  const axis = `${box.dataset.axis}axis`;
  const values = chart.data.flatMap((trace) => trace[box.dataset.axis]).filter((value) => value !== null);
  box.checked = chart.layout[axis].type === "log";
  box.disabled = !box.checked && values.every((value) => value <= 0);
  box.addEventListener("change", () =>
    Plotly.relayout(`chart-${box.dataset.chart}`, {
      [`${axis}.type`]: box.checked ? "log" : "linear",
      [`${axis}.autorange`]: true,
    }),
  );
});

if (data.path) {
  const { charts, words } = data.path;
  const slider = document.getElementById("state");
  const output = document.getElementById("words");
  // A series that moves has a list for each state.
  const stateOf = (values) => (Array.isArray(values[0]) ? values[Number(slider.value)] : values);
  const moved = (chart) => chart.data.map((trace) => ({ ...trace, x: stateOf(trace.x), y: stateOf(trace.y) }));
  charts.forEach((chart, i) => draw(`path-${i}`, moved(chart), chart.layout));
  const show = () => {
    charts.forEach((chart, i) => {
      const traces = moved(chart);
      Plotly.restyle(`path-${i}`, { x: traces.map((trace) => trace.x), y: traces.map((trace) => trace.y) });
    });
    const text = words[Number(slider.value)];
    output.textContent = `${Number(slider.value) + 1} of ${words.length}: ${text}`;
    slider.setAttribute("aria-valuetext", text);
  };
  slider.addEventListener("input", show);
  show();
}
