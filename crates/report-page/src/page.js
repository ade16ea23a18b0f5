const dark = window.matchMedia("(prefers-color-scheme: dark)");
function themed(layout) {
  const ink = dark.matches ? "#d8dde3" : "#22262b";
  const grid = dark.matches ? "#3a4148" : "#d9dde2";
  const out = Object.assign({}, layout, {
    paper_bgcolor: "rgba(0,0,0,0)", plot_bgcolor: "rgba(0,0,0,0)",
    font: { color: ink, size: 12 }, autosize: true,
    modebar: { bgcolor: "rgba(0,0,0,0)", color: grid, activecolor: ink },
  });
  for (const key of Object.keys(out)) {
    if (/^[xy]axis/.test(key)) {
      out[key] = Object.assign({}, out[key], { gridcolor: grid, zerolinecolor: grid, linecolor: grid });
    }
  }
  return out;
}
function draw() {
  charts.forEach((chart, i) => Plotly.react("chart-" + i, chart.data, themed(chart.layout),
    { responsive: true, displaylogo: false, displayModeBar: "hover" }));
}
draw();
dark.addEventListener("change", draw);
