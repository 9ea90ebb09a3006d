#include "testbench/commands/frame_table.h"

#include <fmt/core.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "testbench/common/grouped_digits.h"

namespace tessera {

namespace {

std::string traffic_text(const HostTraffic& sent) {
    std::string text = grouped_digits(sent.total()) + " bytes: base mesh " + grouped_digits(sent.base_mesh);
    const auto add = [&](const char* name, std::uint64_t bytes) {
        if (bytes > 0)
            text += fmt::format(", {} {}", name, grouped_digits(bytes));
    };
    add("displacement map", sent.displacement_map);
    add("normal map", sent.normal_map);
    add("height test's table", sent.summed_height_table);
    add("registers", sent.registers);
    return text;
}

}  // namespace

void read_counts(const std::filesystem::path& folder, FrameRow& row) {
    std::ifstream file(folder / "statistics.json");
    const nlohmann::json statistics = nlohmann::json::parse(file);
    const auto count = [&](const char* group, const char* name) {
        return statistics.at(group).at(name).at("value").get<std::uint64_t>();
    };
    row.triangles = count("run", "triangles_finished");
    row.edges_tested = count("run", "edges_tested");
    row.edges_split = count("run", "edges_split");
    if (statistics.at("run").at("mode").at("value") == "timed")
        row.cycles = count("timing", "cycles");
    row.tessellated_bytes = count("host", "tessellated_mesh_bytes");
}

std::string frames_csv(const std::vector<FrameRow>& rows) {
    std::string text =
        "frame,displacement_scale,triangles,edges_tested,edges_split,cycles,base_mesh_bytes,"
        "displacement_map_bytes,normal_map_bytes,summed_height_table_bytes,register_bytes,sent_bytes,"
        "tessellated_mesh_bytes\n";
    for (const FrameRow& row : rows)
        text += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{}\n", row.name, row.scale, row.triangles,
                            row.edges_tested, row.edges_split, row.cycles ? std::to_string(*row.cycles) : "",
                            row.sent.base_mesh, row.sent.displacement_map, row.sent.normal_map,
                            row.sent.summed_height_table, row.sent.registers, row.sent.total(), row.tessellated_bytes);
    return text;
}

std::string frames_heading() {
    return fmt::format("  {:<10} {:>18} {:>12} {:>14} {:>14} {:>14} {:>23}\n", "frame", "scale, model units",
                       "triangles", "edges tested", "cycles", "sent, bytes", "tessellated mesh, bytes");
}

std::string frames_line(const FrameRow& row) {
    return fmt::format("  {:<10} {:>18.6g} {:>12} {:>14} {:>14} {:>14} {:>23}\n", row.name, row.scale,
                       grouped_digits(row.triangles), grouped_digits(row.edges_tested),
                       row.cycles ? grouped_digits(*row.cycles) : "-", grouped_digits(row.sent.total()),
                       grouped_digits(row.tessellated_bytes));
}

std::string frames_traffic(const std::vector<FrameRow>& rows) {
    std::uint64_t all = 0, tessellated = 0;
    for (const FrameRow& row : rows) {
        all += row.sent.total();
        tessellated += row.tessellated_bytes;
    }
    const auto most = std::max_element(rows.begin() + 1, rows.end(), [](const FrameRow& a, const FrameRow& b) {
        return a.sent.total() < b.sent.total();
    });
    std::string text = fmt::format("  {:<26}{}\n", "sent for the first frame", traffic_text(rows[0].sent));
    text +=
        fmt::format("  {:<26}{} (the largest, {})\n", "sent for a later frame", traffic_text(most->sent), most->name);
    text += fmt::format(
        "  {:<26}{} bytes; the tessellated meshes, indexed, would be {}: the host sends {:.2f} times that "
        "size\n",
        "for all frames", grouped_digits(all), grouped_digits(tessellated),
        tessellated == 0 ? 0.0 : static_cast<double>(all) / static_cast<double>(tessellated));
    return text;
}

}  // namespace tessera
