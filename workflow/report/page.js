"use strict";
// Draws the figures of the page, and moves through the states of a run: line load, force and bodies together.
const data = JSON.parse(document.getElementById("data").textContent);
const config = { responsive: true, displaylogo: false, showSendToCloud: false };
// What all charts have in common.
const axis = { showline: true, ticks: "outside", automargin: true };
const common = {
  template: "none",
  margin: { l: 70, r: 15, t: 30, b: 65 },
  hovermode: "closest",
  legend: { orientation: "h", x: 0, y: 1.02, yanchor: "bottom" },
};
const draw = (id, traces, { xaxis, yaxis }) =>
  Plotly.newPlot(id, traces, { ...common, xaxis: { ...axis, ...xaxis }, yaxis: { ...axis, ...yaxis } }, config);
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
  const at = (values) => (Array.isArray(values[0]) ? values[Number(slider.value)] : values);
  const moved = (chart) => chart.data.map((trace) => ({ ...trace, x: at(trace.x), y: at(trace.y) }));
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

// On paper a figure is as wide as the page.
window.addEventListener("beforeprint", () =>
  document.querySelectorAll(".chart").forEach((chart) => Plotly.Plots.resize(chart)),
);
