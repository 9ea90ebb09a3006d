"""Section 3: the required size of the Triangle Queue, and the cost of the design's latencies."""
from section import Claim, Experiment, Section, Table, MEASURED
from .tests_units import QUIET

CAPACITIES = (0, 4, 16, 64, 256, 1024)  # triangles on chip; 0: no limit
ONE_PASS = {"mesh.columns": 1, "mesh.rows": 1, "tests.generation_limit": 1, "hardware.queue_order": "lifo"}
TRANSFORM_LATENCIES = (1, 10, 20, 30, 40, 50, 60, 80)
DISPLACE_LATENCIES = (1, 3, 6, 12, 24)
STAYS = ("get_triangle", "calculate_new_p", "displace_vertex", "pass_or_tessellate", "tessellation")


def measure(study):
    section = Section()

    def timed(name, **settings):
        return study.run(name, settings={**QUIET, **settings}, keep=False)

    def queue_row(order, capacity, figures):
        return [order, capacity or "unbounded", figures["triangle_queue.high_water_mark"],
                figures["timing.triangle_queue.on_chip_high_water_mark"], figures["timing.triangle_queue.spill_bytes"],
                figures["timing.cycles"]]

    of_queue = {(order, capacity): timed(f"{order}_{capacity}", **{"hardware.queue_order": order,
                                                                   "hardware.queue_capacity": capacity})
                for order in ("fifo", "lifo") for capacity in CAPACITIES}
    one_pass = {(latency, ports): timed(f"one_pass_ports_{ports}_transform_{latency}", **ONE_PASS, **{
        "timing.summed_height_table_ports": ports, "timing.transform_latency": latency})
                for latency in TRANSFORM_LATENCIES for ports in (1, 4)}
    displace = {latency: timed(f"displace_{latency}", **{"timing.displace_vertex_latency": latency})
                for latency in DISPLACE_LATENCIES}
    usual_run = timed("usual")
    yield
    queues = {key: queue_row(*key, run.figures) for key, run in of_queue.items()}
    usual = usual_run.figures
    host_and_queue = usual["get_triangle.host_triangles"] + usual["get_triangle.queue_triangles"]
    section.claims.append(Claim(
        "On chip or off, the memory of the Triangle Queue is a significant requirement.", "section 3",
        "; ".join(f"{order}: at most {queues[order, 0][2]:,} triangles wait; with an on-chip capacity of 64, "
                  f"{queues[order, 64][4]:,} bytes are spilled, and the run takes {queues[order, 64][5]:,} cycles instead of "
                  f"{queues[order, 0][5]:,}" for order in ("fifo", "lifo")),
        MEASURED))
    section.tables = [
        Table("queue", "Order and capacity of the Triangle Queue, half donut, 264 x 264",
              [("order", ""), ("capacity", "triangles"), ("most waiting", "triangles"), ("most on chip", "triangles"),
               ("spilled", "byte"), ("cycles", "")], list(queues.values())),
        Table("one_pass", "Two base triangles and their children: cycles by latency of Transform",
              [("latency of Transform", "cycles"), ("1 table port", "cycles"), ("4 table ports", "cycles")],
              [[latency, *(one_pass[latency, ports].figures["timing.cycles"] for ports in (1, 4))]
               for latency in TRANSFORM_LATENCIES]),
        Table("displace_latency", "Latency of Displace Vertex", [("latency", "cycles"), ("cycles", "")],
              [[latency, run.figures["timing.cycles"]] for latency, run in displace.items()]),
        Table("stays", "The paper's design: mean stay of an item, including waiting", [("unit", ""), ("stay", "cycles")],
              [[unit, usual[f"timing.{unit}.latency"]] for unit in STAYS])]
    section.notes.append(f"{usual['get_triangle.host_triangles']} of {host_and_queue:,} triangles taken are from the host.")
    return section


EXPERIMENT = Experiment("designs", "Other queues and latencies", "Section 3",
                        "Cost in cycles of the queue's order and capacity, and of the units' latencies.", measure)
