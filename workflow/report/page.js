"use strict";
// Draws the figures of the page, and moves through the states of a run: line load, force and bodies together.
const data = JSON.parse(document.getElementById("data").textContent);
const config = { responsive: true, displaylogo: false, showSendToCloud: false };
data.charts.forEach((chart, i) => Plotly.newPlot(`chart-${i}`, chart.data, chart.layout, config));

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
  const path = data.path;
  const slider = document.getElementById("state");
  const words = document.getElementById("words");
  path.charts.forEach((chart, i) => Plotly.newPlot(`path-${i}`, chart.data, chart.layout, config));
  const show = () => {
    const i = Number(slider.value);
    const x = [path.x[i], path.x[i]];
    Plotly.restyle("path-0", { x: [[path.along[i]]], y: [[path.against[i]]] }, [1]);
    Plotly.restyle("path-1", { x, y: path.loads.map((states) => states[i]) }, [0, 1]);
    Plotly.restyle("path-2", { x, y: path.bodies.map((states) => states[i]) }, [0, 1]);
    words.textContent = `${i + 1} of ${path.words.length}: ${path.words[i]}`;
    slider.setAttribute("aria-valuetext", path.words[i]);
  };
  slider.addEventListener("input", show);
  show();
}

// On paper a figure is as wide as the page.
window.addEventListener("beforeprint", () =>
  document.querySelectorAll(".chart").forEach((chart) => Plotly.Plots.resize(chart)),
);
