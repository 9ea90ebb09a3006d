"""Section 3.1: one Tessellation Tests unit or three, and latencies hidden by Transform."""
from section import Chart, Claim, Experiment, Section, Table, MEASURED, PARTLY, REPRODUCED, NOT_REPRODUCED
import charts

QUIET = {"mode": "timed", "check.golden": False, "check.invariants": False, "output.ply": False}
DEFAULT_LATENCY = 20  # of Transform, modules/timing/timing.h
LATENCIES = (1, 10, 20, 40, 80, 120, 160, 320)


def timed(study, units, ports, latency=None):
    settings = {**QUIET, "hardware.tests_units": units, "timing.summed_height_table_ports": ports}
    name = f"units_{units}_ports_{ports}"
    if latency is not None:
        settings["timing.transform_latency"] = latency
        name += f"_transform_{latency}"
    return study.run(name, settings=settings, keep=False)


def waited_for_tests(figures):
    """Cycles in which Pass or Tessellate had all of a triangle's parts from Transform but not all from the tests."""
    of = {name: value for name, value in figures.items() if name.startswith("timing.pass_or_tessellate.starved_of_")}
    if "timing.pass_or_tessellate.starved" not in figures:
        raise KeyError("timing.pass_or_tessellate.starved")
    return sum(value for name, value in of.items() if "tessellation_tests_" in name)


def measure(study):
    section, rows, passes = Section(), [], {}
    runs = {(units, ports): timed(study, units, ports) for units in (1, 3) for ports in (1, 2, 4, 12)}
    with_latency = {(units, ports, latency): timed(study, units, ports, latency)
                    for units, ports in ((1, 1), (1, 4), (3, 12)) for latency in LATENCIES}
    yield
    for (units, ports), run in runs.items():
        figures = run.figures
        passes[units, ports] = figures["timing.cycles_per_pass"]
        rows.append([units, ports, figures["timing.cycles"], figures["timing.cycles_per_pass"],
                     figures["timing.cycles_per_triangle"], 100 * figures["timing.summed_height_table.utilisation"],
                     figures["timing.bottleneck"]])
    waits, by_latency = {}, []
    for units, ports in ((1, 1), (1, 4), (3, 12)):
        name = f"{units} tests unit{'s' if units > 1 else ''}, {ports} port{'s' if ports > 1 else ''}"
        waits[name] = []
        for latency in LATENCIES:
            figures = with_latency[units, ports, latency].figures
            waits[name].append(100 * waited_for_tests(figures) / figures["timing.cycles"])
            for_transform = figures.get("timing.pass_or_tessellate.starved_of_transform", 0)
            by_latency.append([units, ports, latency, figures["timing.cycles"], waits[name][-1],
                               100 * for_transform / figures["timing.cycles"]])
    hidden = {name: next((latency for latency, share in zip(LATENCIES, shares) if share < 1), None)
              for name, shares in waits.items()}
    default = {name: shares[LATENCIES.index(DEFAULT_LATENCY)] for name, shares in waits.items()}
    hiding = [name for name, share in default.items() if share < 1]
    section.claims = [
        Claim("Transform's latency hides that of the Tessellation Tests, which run in parallel.", "section 3.1",
              f"at the default latency of Transform, {DEFAULT_LATENCY} cycles, the join waits for the tests for "
              + "; ".join(f"{share:.2g} % of all cycles with {name}" for name, share in default.items())
              + ". Below 1 % from this latency on: "
              + "; ".join(f"{name}: " + (f"{latency} cycles" if latency else f"more than {LATENCIES[-1]}")
                          for name, latency in hidden.items())
              + ".",
              REPRODUCED if len(hiding) == len(default) else PARTLY if hiding else NOT_REPRODUCED),
        Claim("If several Transform pipelines require more performance, the Tessellation Tests unit can be replicated three "
              "times, one for each edge.", "section 3.1",
              f"cycles per pass with one unit and three: {passes[1, 1]:.1f} and {passes[3, 1]:.1f} with one port to the "
              f"Summed Height Table, {passes[1, 12]:.2f} and {passes[3, 12]:.2f} with twelve. The bottleneck is "
              + "; ".join(f"{bottleneck} with {ports} port{'s' if ports > 1 else ''}"
                          for units, ports, *_, bottleneck in rows if units == 3)
              + ": the three rectangles of four reads per edge are the limit, not the unit. One Transform pipeline was enough in all runs.",
              MEASURED),
    ]
    section.charts.append(Chart(
        charts.lines({name: (LATENCIES, shares) for name, shares in waits.items()}, "latency of Transform, cycles",
                     "cycles in which the join waits for the tests, %", log_x=True),
        "Tests' latency that is not hidden, half donut, 264 x 264"))
    section.tables = [
        Table("tests_units", "Units and ports, half donut, 264 x 264",
              [("tests units", ""), ("table ports", ""), ("cycles", ""), ("a pass", "cycles"), ("a triangle", "cycles"),
               ("table ports taken", "%"), ("bottleneck", "")], rows),
        Table("transform_latency", "Latency of Transform",
              [("tests units", ""), ("table ports", ""), ("latency", "cycles"), ("cycles", ""),
               ("join waits for the tests", "%"), ("join waits for Transform", "%")], by_latency)]
    return section


EXPERIMENT = Experiment("tests_units", "One Tessellation Tests unit or three", "Section 3.1",
                        "Latency, throughput and the bottleneck in a cycle-accurate run.", measure)
