#include <cmath>
#include <vector>

#include "modules/datapath/curvature.h"
#include "modules/datapath/map_entry.h"
#include "testbench/check/conformance/setup_judge.h"

namespace tessera::setup_check {

namespace {

using datapath::Format;
using datapath::Registers;
using datapath::TableLayout;

using Socket = tlm_utils::simple_initiator_socket<Host>;

/// Reads a table from its memory, row by row.
class TableReader {
  public:
    TableReader(Socket& socket, const TableLayout& layout)
        : socket_(socket), layout_(layout), bytes_(std::size_t{layout.columns} * layout.entry_bytes) {}

    bool read_row(std::uint32_t row) {
        tlm::tlm_generic_payload payload;
        payload.set_command(tlm::TLM_READ_COMMAND);
        payload.set_address(layout_.address(0, row));
        payload.set_data_ptr(bytes_.data());
        payload.set_data_length(static_cast<unsigned>(bytes_.size()));
        payload.set_streaming_width(payload.get_data_length());
        return socket_->transport_dbg(payload) == bytes_.size();
    }
    std::uint64_t entry(std::uint32_t column) const {
        std::uint64_t value = 0;
        for (std::uint32_t k = layout_.entry_bytes; k-- > 0;)
            value = value << 8 | bytes_[std::size_t{column} * layout_.entry_bytes + k];
        return value;
    }

  private:
    Socket& socket_;
    const TableLayout& layout_;
    std::vector<unsigned char> bytes_;
};

class TableCheck {
  public:
    TableCheck(const MachineSetup& setup, const GoldenJob& golden, Host& host, SetupResult& result)
        : registers_(setup.registers), golden_(golden), host_(host), result_(result) {}

    void run() {
        check_displacement_map();
        check_normal_map();
        if (golden_.map().has_ranks())
            check_rank_table();
        else if (golden_.map().has_curvatures())
            check_curvature_table();
        else if (!golden_.map().mipmap().empty())
            check_mipmap_table();
        else
            check_summed_height_table();
    }

  private:
    template <typename Check>
    void each_entry(Judge& judge, Socket& socket, const TableLayout& layout, int columns, int rows, Check check) {
        // A wrong layout has already been reported with the registers.
        if (layout.columns != number(columns) || layout.rows != number(rows) || layout.entry_bytes > 8)
            return;
        TableReader table(socket, layout);
        for (std::uint32_t y = 0; y < layout.rows; ++y) {
            const bool there = table.read_row(y);
            if (!there) {
                judge.require(false, [&] { return fmt::format("row {} is not in the memory", y); });
                return;
            }
            for (std::uint32_t x = 0; x < layout.columns; ++x)
                check(x, y, table.entry(x));
        }
    }

    std::size_t texel_of(std::uint32_t x, std::uint32_t y) const {
        return std::size_t{y} * static_cast<std::size_t>(golden_.map().width()) + x;
    }

    void check_displacement_map() {
        Judge judge(result_, "displacement map", "every code, to nearest or as fitted by the host");
        const golden::Map& map = golden_.map();
        const bool fitted = golden_.job().map.heights == MapHeights::fitted;
        each_entry(judge, host_.displacement_map, registers_.displacement_map, map.width(), map.height(),
                   [&](std::uint32_t x, std::uint32_t y, std::uint64_t code) {
                       const std::size_t texel = texel_of(x, y);
                       const double golden = fitted ? map.code(texel) : golden_.unrounded_code(texel);
                       judge.judge([&] { return fmt::format("({}, {})", x, y); }, number(code), golden, to_nearest,
                                   double_rounding * golden);
                   });
    }

    void check_normal_map() {
        Judge judge(result_, "normal map", "every component; slopes within the rounding of S, then to nearest");
        const golden::Map& map = golden_.map();
        const Format& format = registers_.formats.normal;
        const double lsb = lsb_per_unit(format);
        const double full = std::abs(golden_.parameters().scale) * (golden_.scene().highest_code + 1) *
                            lsb_per_unit(registers_.formats.position);
        const double slope_error = (full > 0 ? 0.5 / full : 0) + double_rounding;
        each_entry(judge, host_.normal_map, registers_.normal_map, map.width(), map.height(),
                   [&](std::uint32_t x, std::uint32_t y, std::uint64_t entry) {
                       const glm::dvec2 slope = map.slope(texel_of(x, y));
                       const datapath::Direction n = datapath::unpack_normal(entry, format.bits);
                       const NormalRange range(slope, slope_error);
                       const auto component = [&](const char* name, double hardware, double low, double high) {
                           const double middle = (low + high) / 2 * lsb, half = (high - low) / 2 * lsb;
                           judge.judge([&] { return fmt::format("({}, {}).{}", x, y, name); }, hardware, middle,
                                       {-0.5 - half, 0.5 + half}, double_rounding * lsb);
                       };
                       component("x", n.x, range.low.x, range.high.x);
                       component("y", n.y, range.low.y, range.high.y);
                       component("z", n.z, range.low.z, range.high.z);
                   });
    }

    /// Ranges of the components of normalise(-a, -b, 1) for relative errors of a and b up to `error`. The first falls
    /// with a and shrinks with |b|; the second likewise; the third shrinks with both.
    struct NormalRange {
        NormalRange(const glm::dvec2& slope, double error) {
            const glm::dvec2 least = glm::abs(slope) * (1 - error), most = glm::abs(slope) * (1 + error);
            const auto part = [](double along, double across) {
                return along / std::sqrt(1 + along * along + across * across);
            };
            const auto signed_range = [&](double s, double least_along, double most_along, double least_across,
                                          double most_across, double& from, double& to) {
                const double small = part(std::max(least_along, 0.0), most_across);
                const double large = part(most_along, std::max(least_across, 0.0));
                from = s > 0 ? -large : small;
                to = s > 0 ? -small : large;
            };
            signed_range(slope.x, least.x, most.x, least.y, most.y, low.x, high.x);
            signed_range(slope.y, least.y, most.y, least.x, most.x, low.y, high.y);
            low.z = 1 / std::sqrt(1 + glm::dot(most, most));
            high.z = 1 / std::sqrt(1 + glm::dot(least, least));
        }
        glm::dvec3 low{0}, high{0};
    };

    void check_summed_height_table() {
        Judge judge(result_, "summed height table", "every sum of codes, exact modulo 2^bits");
        const golden::Map& map = golden_.map();
        const auto mask = static_cast<std::uint64_t>(registers_.formats.summed_height.highest);
        each_entry(judge, host_.summed_height_table, registers_.height_table, map.width() + 1, map.height() + 1,
                   [&](std::uint32_t x, std::uint32_t y, std::uint64_t sum) {
                       judge.judge([&] { return fmt::format("({}, {})", x, y); }, number(sum),
                                   number(map.sum({0, 0, x, y}) & mask), exact);
                   });
    }

    void check_rank_table() {
        Judge judge(result_, "rank table", "every entry, as ranked by the host");
        const golden::RankTable& table = golden_.map().rank_table();
        each_entry(judge, host_.summed_height_table, registers_.height_table, static_cast<int>(table.columns),
                   static_cast<int>(table.rows), [&](std::uint32_t x, std::uint32_t y, std::uint64_t entry) {
                       const std::size_t k = std::size_t{y} * static_cast<std::size_t>(table.columns) + x;
                       const std::uint64_t rank = table.ranks.empty() ? 0 : table.ranks[k];
                       const std::uint64_t bound = table.bounds.empty() ? 0 : table.bounds[k];
                       const std::uint64_t radius = table.radii.empty() ? 0 : table.radii[k];
                       const Job::Formats& formats = golden_.job().formats;
                       judge.judge([&] { return fmt::format("({}, {})", x, y); }, number(entry),
                                   number(rank | (bound | radius << formats.bound_bits) << formats.rank_bits), exact);
                   });
    }

    void check_curvature_table() {
        Judge judge(result_, "curvature table", "every entry, as fitted by the host");
        const std::vector<golden::Curvature>& cells = golden_.map().curvature_table().cells;
        each_entry(judge, host_.summed_height_table, registers_.height_table, static_cast<int>(cells.size()), 1,
                   [&](std::uint32_t x, std::uint32_t, std::uint64_t entry) {
                       const datapath::CurvatureEntry found = datapath::unpack_curvature(entry);
                       const golden::Curvature& cell = cells[x];
                       const double unit = std::ldexp(1.0, found.exponent - datapath::curvature_fraction);
                       const auto field = [&](const char* name, double hardware, double golden) {
                           judge.judge([&] { return fmt::format("{}.{}", x, name); }, hardware, golden, exact);
                       };
                       field("unit", unit, cell.unit);
                       field("xx", found.xx * unit, cell.xx);
                       field("xy", found.xy * unit, cell.xy);
                       field("yy", found.yy * unit, cell.yy);
                       field("rest", found.rest * unit, cell.rest);
                   });
    }

    void check_mipmap_table() {
        Judge judge(result_, "mipmap table", "every block's mean, to nearest, or maximum");
        std::vector<double> blocks;
        for (const std::vector<double>& level : golden_.map().mipmap())
            blocks.insert(blocks.end(), level.begin(), level.end());
        each_entry(judge, host_.summed_height_table, registers_.height_table, static_cast<int>(blocks.size()), 1,
                   [&](std::uint32_t x, std::uint32_t, std::uint64_t entry) {
                       judge.judge([&] { return fmt::format("{}", x); }, number(entry), blocks[x], exact);
                   });
    }

    const Registers& registers_;
    const GoldenJob& golden_;
    Host& host_;
    SetupResult& result_;
};

}  // namespace

void check_tables(const MachineSetup& setup, const GoldenJob& golden, Host& host, SetupResult& result) {
    TableCheck(setup, golden, host, result).run();
}

}  // namespace tessera::setup_check
