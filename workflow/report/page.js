"use strict";
// Draws the figures of the page, and moves through the states of a run: profile, force and bodies together.
const data = JSON.parse(document.getElementById("data").textContent);
const config = { responsive: true, displaylogo: false, showSendToCloud: false };
data.charts.forEach((chart, i) => Plotly.newPlot(`chart-${i}`, chart.data, chart.layout, config));

if (data.way) {
  const way = data.way;
  const slider = document.getElementById("state");
  const told = document.getElementById("told");
  way.charts.forEach((chart, i) => Plotly.newPlot(`way-${i}`, chart.data, chart.layout, config));
  const show = () => {
    const i = Number(slider.value);
    Plotly.restyle("way-0", { x: [[way.along[i]]], y: [[way.against[i]]] }, [1]);
    Plotly.restyle("way-1", { x: [way.x[i], way.x[i]], y: [way.pressure[i], way.shear[i]] }, [0, 1]);
    Plotly.restyle("way-2", { x: [way.x[i], way.x[i]], y: [way.z_upper[i], way.z_lower[i]] }, [0, 1]);
    told.textContent = `${i + 1} of ${way.words.length}: ${way.words[i]}`;
    slider.setAttribute("aria-valuetext", way.words[i]);
  };
  slider.addEventListener("input", show);
  show();
}
