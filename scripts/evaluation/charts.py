"""Charts as SVG text, identical in every run."""
import io

import matplotlib

matplotlib.use("svg")
from matplotlib import pyplot  # noqa: E402  (the backend must be set before)
from matplotlib.ticker import FuncFormatter, LogLocator  # noqa: E402

matplotlib.rcParams.update({
    "svg.hashsalt": "tessera",
    "svg.fonttype": "none",
    "font.family": "sans-serif",
    "font.size": 11,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.color": "#e4e4e0",
    "axes.edgecolor": "#77756d",
    "lines.linewidth": 2,
})
# Colours for colour-blind readers (Okabe and Ito), and different markers.
STYLES = [("#d55e00", "o"), ("#0072b2", "s"), ("#009e73", "^"), ("#cc79a7", "D"), ("#e69f00", "v"), ("#56b4e9", "P"),
          ("#000000", "X"), ("#77756d", "*"), ("#8b5a2b", "<")]


def thousands(value, _position=None):
    return f"{value:,.0f}" if value >= 10 else f"{value:.3g}"


def lines(series, x_label, y_label, log_x=False, log_y=False, emphasised=()):
    """series: {name: ([x], [y])}."""
    below = len(series) > 6
    figure, axes = pyplot.subplots(figsize=(7.2, 5.9 if below else 4.3))
    for (name, (x, y)), (colour, marker) in zip(series.items(), STYLES * 3):
        strong = not emphasised or name in emphasised
        axes.plot(x, y, marker=marker, color=colour, label=name, alpha=1 if strong else 0.75,
                  linewidth=2.4 if strong else 1.3, markersize=6 if strong else 4)
    for axis, logarithmic in ((axes.xaxis, log_x), (axes.yaxis, log_y)):
        if logarithmic:
            getattr(axes, f"set_{axis.axis_name}scale")("log")
            axis.set_major_locator(LogLocator(subs=(1, 2, 5)))
            axis.set_minor_locator(LogLocator(subs=()))
        axis.set_major_formatter(FuncFormatter(thousands))
    axes.set_xlabel(x_label)
    axes.set_ylabel(y_label)
    place = {"loc": "upper center", "bbox_to_anchor": (0.45, -0.14), "ncols": 2, "fontsize": 11} if below else {"fontsize": 10}
    axes.legend(frameon=False, **place)
    return svg_of(figure)


def bars(names, values, x_label):
    figure, axes = pyplot.subplots(figsize=(7.2, 0.6 + 0.42 * len(names)))
    axes.barh(range(len(names)), values, color=STYLES[1][0], height=0.62)
    axes.set_yticks(range(len(names)), names)
    axes.invert_yaxis()
    axes.grid(False)
    for k, value in enumerate(values):
        axes.annotate(thousands(value), (value, k), xytext=(4, 0), textcoords="offset points", va="center")
    axes.set_xlabel(x_label)
    axes.margins(x=0.12)
    return svg_of(figure)


def svg_of(figure):
    figure.tight_layout()
    out = io.StringIO()
    figure.savefig(out, format="svg", metadata={"Date": None, "Creator": None})
    pyplot.close(figure)
    text = out.getvalue()
    return text[text.index("<svg"):]
