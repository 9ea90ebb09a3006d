"""The page: one self-contained HTML file, and the tables as CSV files."""
import base64
import csv
import shutil

import jinja2

import section as vocabulary
from study import ROOT
from table import heading

HERE = ROOT / "scripts/evaluation"


def cell_text(value):
    """A figure as shown on the page: four digits; integers in full."""
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, int):
        return f"{value:,}"
    if isinstance(value, float):
        return f"{value:,.4g}" if abs(value) < 10000 else f"{value:,.0f}"
    return str(value)


def write_tables(folder, sections):
    for section in sections:
        for table in section.tables:
            with open(folder / "tables" / f"{table.name}.csv", "w", newline="", encoding="utf-8") as file:
                writer = csv.writer(file, lineterminator="\n")
                writer.writerow([heading(column) for column in table.columns])
                writer.writerows(table.rows)


def data_uri(content, kind):
    return f"data:{kind};base64,{base64.b64encode(content).decode()}"


def write_page(folder, parts):
    """parts: [(Experiment, Section, commands)]. Writes index.html, pictures/ and tables/ to the folder."""
    for name in ("pictures", "tables"):
        shutil.rmtree(folder / name, ignore_errors=True)
        (folder / name).mkdir(parents=True)
    write_tables(folder, [section for _, section, _ in parts])
    for experiment, section, _ in parts:
        for number, picture in enumerate(section.pictures, 1):
            shutil.copyfile(picture.path, folder / "pictures" / f"{experiment.name}_{number}_{picture.path.name}")
        for number, chart in enumerate(section.charts, 1):
            (folder / "pictures" / f"{experiment.name}_chart_{number}.svg").write_text(chart.svg, encoding="utf-8")
    environment = jinja2.Environment(loader=jinja2.FileSystemLoader(HERE), autoescape=True,
                                     undefined=jinja2.StrictUndefined, trim_blocks=True, lstrip_blocks=True)
    environment.filters["cell"] = cell_text
    environment.filters["heading"] = heading
    environment.filters["png"] = lambda path: data_uri(path.read_bytes(), "image/png")
    environment.filters["svg"] = lambda svg: data_uri(svg.encode(), "image/svg+xml")
    text = environment.get_template("page.html").render(
        parts=parts, vocabulary=vocabulary, style=(HERE / "page.css").read_text(encoding="utf-8"))
    partial = folder / "index.html.part"
    partial.unlink(missing_ok=True)  # a link is replaced, not followed
    partial.write_text(text, encoding="utf-8")
    partial.rename(folder / "index.html")
