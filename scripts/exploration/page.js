"use strict";
// One scene is shown at a time. `selection` is a set of runs, or null: all.
const data = JSON.parse(document.getElementById("data").textContent);
const get = (id) => document.getElementById(id);
const columns = data.columns.map((column, index) => ({...column, index}));
const choices = columns.filter((column) => column.kind !== "note");
const figures = choices.filter((column) => column.kind === "figure");
const frontColumn = columns.find((column) => column.name === "front").index;
const statusColumn = columns.find((column) => column.name === "status").index;
const BLUE = "#0072b2", ORANGE = "#d55e00", GREY = "#d6d5cf";
const MOST_ROWS = 300;  // of the list of designs
let rows = [], selection = null, chosen = [];

const title = (column) => column.unit ? `${column.name} [${column.unit}]` : column.name;
const text = (value) => value === null || value === undefined ? "" :
    typeof value === "number" && !Number.isInteger(value) ? value.toPrecision(5) :
    typeof value === "number" ? value.toLocaleString("en") : String(value);
const escaped = (words) => words.replace(/[&<>"]/g, (c) => `&#${c.charCodeAt(0)};`);
const isNumber = (column, of) => of.every((row) => row.cells[column.index] === null || typeof row.cells[column.index] === "number");

function option(select, value, words) {
    select.add(new Option(words, value));
}

function visible() {
    return rows.filter((row) => !get("front_only").checked || row.cells[frontColumn]);
}

function isSelected(row) {
    return selection === null || selection.has(row.run);
}

function drawScatter() {
    const x = columns[get("x").value], y = columns[get("y").value];
    const shown = visible().filter((row) => row.cells[statusColumn] === "ok");
    const trace = (of, name, marker) => ({
        type: of.length > 5000 ? "scattergl" : "scatter", mode: "markers", name, marker,
        x: of.map((row) => row.cells[x.index]), y: of.map((row) => row.cells[y.index]), customdata: of.map((row) => row.run),
        text: of.map((row) => columns.filter((c) => c.kind === "axis").map((c) => `${c.name} ${text(row.cells[c.index])}`).join("<br>")),
        hovertemplate: `%{text}<br>${x.name} %{x}<br>${y.name} %{y}<extra>run %{customdata}</extra>`,
        selectedpoints: selection === null ? null : of.flatMap((row, k) => selection.has(row.run) ? [k] : []),
        unselected: {marker: {color: GREY, opacity: 0.5}},
    });
    const front = shown.filter((row) => row.cells[frontColumn]);
    const others = shown.filter((row) => !row.cells[frontColumn]);
    const traces = [trace(others, "dominated", {color: BLUE, size: 7, opacity: 0.7}),
                    trace(front, "Pareto front", {color: ORANGE, size: 10, symbol: "diamond"})];
    const signs = data.objectives, names = Object.keys(signs);
    if (names.length === 2 && names.includes(x.name) && names.includes(y.name)) {
        const path = front.map((row) => [row.cells[x.index], row.cells[y.index]]).sort((a, b) => signs[x.name] * (a[0] - b[0]) || signs[y.name] * (b[1] - a[1]));
        traces.push({type: "scatter", mode: "lines", name: "front", x: path.map((p) => p[0]), y: path.map((p) => p[1]),
                     line: {shape: "hv", color: ORANGE, width: 1}, hoverinfo: "skip", showlegend: false});
    }
    const type = (column) => get("log").checked && isNumber(column, shown) && shown.every((row) => row.cells[column.index] > 0) ? "log" : undefined;
    return Plotly.react("scatter", traces, {
        dragmode: "select", hovermode: "closest", margin: {l: 70, r: 10, t: 10, b: 55}, legend: {orientation: "h", y: 1.08},
        xaxis: {title: title(x), type: type(x)}, yaxis: {title: title(y), type: type(y)}, uirevision: `${x.index} ${y.index} ${get("log").checked}`,
    }, {responsive: true, displaylogo: false});
}

/** The columns that differ between the rows: axes, then objectives or, without any, the figures. */
function dimensions() {
    const wanted = Object.keys(data.objectives).length ? figures.filter((c) => c.name in data.objectives) : figures.slice(0, 4);
    return [...columns.filter((c) => c.kind === "axis"), ...wanted].filter((column) =>
        new Set(rows.map((row) => JSON.stringify(row.cells[column.index]))).size > 1);
}

function drawParallel() {
    const shown = visible().filter((row) => row.cells[statusColumn] === "ok");
    const described = dimensions().map((column) => {
        const values = shown.map((row) => row.cells[column.index]);
        const label = column.name.split(".").pop();
        const distinct = [...new Set(values.map((value) => JSON.stringify(value)))];
        if (isNumber(column, shown) && (column.kind !== "axis" || distinct.length > 12))
            return {label, values, column};
        // Values of an axis are equally spaced, in order.
        const order = isNumber(column, shown) ? distinct.map(Number).sort((a, b) => a - b).map(String) : distinct;
        return {label, column, values: values.map((value) => order.indexOf(JSON.stringify(value))),
                tickvals: order.map((_, k) => k), ticktext: order.map((value) => text(JSON.parse(value))), range: [0, Math.max(1, order.length - 1)]};
    });
    const trace = {
        type: "parcoords", customdata: shown.map((row) => row.run), labelangle: -20, labelside: "top",
        dimensions: described.map(({column, ...rest}) => rest),
        line: {color: shown.map((row) => !isSelected(row) ? 0 : row.cells[frontColumn] ? 2 : 1), cmin: 0, cmax: 2,
               colorscale: [[0, GREY], [0.5, BLUE], [1, ORANGE]]},
    };
    const longest = Math.min(40, Math.max(0, ...(described[0]?.ticktext ?? []).map((words) => words.length)));
    get("parallel").runs = shown.map((row) => row.run);
    return Plotly.newPlot("parallel", [trace], {margin: {l: 30 + 6 * longest, r: 50, t: 90, b: 30}}, {responsive: true, displaylogo: false})
        .then((plot) => plot.on("plotly_restyle", brushed));
}

/** The runs within all ranges marked on the parallel axes. */
function brushed() {
    const trace = get("parallel").data[0], runs = get("parallel").runs;
    const marked = trace.dimensions.filter((dimension) => dimension.constraintrange);
    const within = (value, range) => Array.isArray(range[0]) ? range.some((each) => within(value, each)) : range[0] <= value && value <= range[1];
    selection = marked.length === 0 ? null :
        new Set(runs.filter((_, k) => marked.every((dimension) => within(dimension.values[k], dimension.constraintrange))));
    drawScatter();
    drawList();
}

function select(runs) {
    selection = runs && new Set(runs);
    drawScatter();
    drawParallel();
    drawList();
}

function drawList() {
    const listed = visible().filter(isSelected);
    const first = Object.keys(data.objectives)[0];
    const by = columns.find((column) => column.name === first);
    if (by)
        listed.sort((a, b) => (a.cells[by.index] ?? Infinity) * data.objectives[first] - (b.cells[by.index] ?? Infinity) * data.objectives[first]);
    get("selected").textContent = selection === null ? "" : `${listed.length} selected`;
    get("shown").textContent = `${Math.min(listed.length, MOST_ROWS)} of ${listed.length} designs${by ? `, by ${by.name}` : ""}`;
    const of = columns.filter((column) => !["scene", "front", "result"].includes(column.name));
    get("designs").tHead.innerHTML = `<tr>${of.map((column) => `<th>${escaped(title(column))}</th>`).join("")}</tr>`;
    get("designs").tBodies[0].innerHTML = listed.slice(0, MOST_ROWS).map((row) =>
        `<tr data-run="${row.run}" class="${row.cells[frontColumn] ? "front" : ""} ${chosen.includes(row.run) ? "shown" : ""}">` +
        of.map((column) => {
            const value = row.cells[column.index];
            return `<td class="${typeof value === "number" ? "number" : ""} ${value === "failed" || value === "refused" ? "bad" : ""}">${escaped(text(value))}</td>`;
        }).join("") + "</tr>").join("");
}

/** Rows of a table with one column per design; those that differ are marked. */
function compared(name, entries, designs) {
    return `<tr class="group"><th>${name}</th></tr>` + entries.map(([label, values]) => {
        const differs = designs.length > 1 && new Set(values.map(text)).size > 1;
        return `<tr class="${differs ? "differs" : ""}"><td>${escaped(label)}</td>` +
            values.map((value) => `<td class="${typeof value === "number" ? "number" : ""}">${escaped(text(value))}</td>`).join("") + "</tr>";
    }).join("");
}

function drawDetails() {
    const designs = chosen.map((run) => data.rows[data.rows.findIndex((row) => row.run === run)]);
    get("details").hidden = designs.length === 0;
    location.replace(`#${chosen.length ? `runs=${chosen.join(",")}` : ""}`);
    if (designs.length === 0)
        return;
    const keys = [...new Set(designs.flatMap((design) => Object.keys(design.settings)))].sort();
    const measured = figures.map((column) => [title(column), designs.map((design) => design.cells[column.index])]);
    get("details").innerHTML =
        `<h2>${designs.map((design) => `Run ${design.run}`).join(" and ")}</h2>` +
        `<table id="comparison"><tr><th></th>${designs.map((design) => `<th>run ${design.run}, ${escaped(design.cells[1])}</th>`).join("")}</tr>` +
        compared("Keys", keys.map((key) => [key, designs.map((design) => design.settings[key])]), designs) +
        compared("Figures", measured, designs) +
        compared("Result", [["status", designs.map((design) => design.cells[statusColumn])],
                            ...(designs.some((design) => design.bottleneck) ? [["bottleneck", designs.map((design) => design.bottleneck)]] : [])],
                 designs) + "</table>" +
        designs.map((design) =>
            `<h2>Run ${design.run}</h2><pre class="command">${escaped(design.command)}</pre>` +
            (design.reason ? `<pre class="bad">${escaped(design.reason)}</pre>` : "") +
            (design.timing ? `<pre class="timing">${escaped(design.timing)}</pre>` : "")).join("");
}

function choose(run, add) {
    chosen = add && chosen.length ? [...chosen.filter((other) => other !== run).slice(-1), run] : [run];
    drawDetails();
    drawList();
}

function chooseScene() {
    rows = data.rows.filter((row) => row.cells[1] === get("scene").value);
    selection = null;
    drawScatter();
    drawList();
    // After the first picture, since creating a WebGL context takes time.
    requestAnimationFrame(() => setTimeout(() => drawParallel().then(() => {
        document.body.dataset.complete = performance.now();
    })));
}

function begin() {
    get("summary").textContent = data.summary;
    for (const scene of data.scenes)
        option(get("scene"), scene, scene);
    for (const column of choices) {
        option(get("x"), column.index, title(column));
        option(get("y"), column.index, title(column));
    }
    const [first, second] = Object.keys(data.objectives).map((name) => columns.find((column) => column.name === name));
    get("x").value = (second ?? choices[0]).index;
    get("y").value = (first ?? figures[0] ?? choices[1]).index;
    const linked = /runs=([\d,]+)/.exec(location.hash);
    if (linked) {
        chosen = linked[1].split(",").map(Number).filter((run) => data.rows.some((row) => row.run === run)).slice(0, 2);
        if (chosen.length)
            get("scene").value = data.rows.find((row) => row.run === chosen[0]).cells[1];
    }
    chooseScene();
    if (chosen.length)
        drawDetails();
    get("scene").onchange = chooseScene;
    for (const id of ["x", "y", "log"])
        get(id).onchange = drawScatter;
    get("front_only").onchange = () => select(selection);
    get("clear").onclick = () => select(null);
    get("scatter").on("plotly_selected", (event) => event && select(event.points.map((point) => point.customdata)));
    get("scatter").on("plotly_deselect", () => select(null));
    get("scatter").on("plotly_click", (event) => choose(event.points[0].customdata, event.event.shiftKey));
    get("designs").onclick = (event) => {
        const row = event.target.closest("tr[data-run]");
        if (row)
            choose(Number(row.dataset.run), event.shiftKey);
    };
    document.body.dataset.ready = performance.now();
}

begin();
