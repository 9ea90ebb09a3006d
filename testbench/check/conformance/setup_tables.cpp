#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "golden/height_tests/curvature_test.h"
#include "golden/height_tests/mipmap_test.h"
#include "golden/height_tests/rank_test.h"
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
    TableCheck(const MachineSetup& setup, const GoldenJob& golden, const golden::DerivedRanks& ranks, Host& host,
               SetupResult& result)
        : registers_(setup.registers), golden_(golden), ranks_(ranks), host_(host), result_(result) {}

    void run() {
        check_displacement_map();
        check_normal_map();
        if (golden::has<golden::RankTest>(golden_.map()))
            check_rank_table();
        else if (golden::has<golden::CurvatureTest>(golden_.map()))
            check_curvature_table();
        else if (golden::has<golden::MipmapTest>(golden_.map()))
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
        const double slope_error = (full > 0 ? 0.5 / full : 0) + double_rounding + golden_.texel_rounding();
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
            const glm::dvec2 least = glm::abs(slope) * std::max(1 - error, 0.0), most = glm::abs(slope) * (1 + error);
            const auto part = [](double along, double across) {
                return along / std::sqrt(1 + along * along + across * across);
            };
            const auto signed_range = [&](double s, double least_along, double most_along, double least_across,
                                          double most_across, double& from, double& to) {
                const double small = part(least_along, most_across);
                const double large = part(most_along, least_across);
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
        const golden::RankTable& table = golden::rank_table(golden_.map());
        const bool derived = !ranks_.ranks.empty() || !ranks_.bounds.empty();
        Judge judge(result_, "rank table",
                    derived ? "every rank, bound and radius; of a double's error, both sides"
                            : "every entry, as ranked by the host, since midpoints share entries");
        each_entry(judge, host_.summed_height_table, registers_.height_table, static_cast<int>(table.columns),
                   static_cast<int>(table.rows), [&](std::uint32_t x, std::uint32_t y, std::uint64_t entry) {
                       const std::size_t k = std::size_t{y} * static_cast<std::size_t>(table.columns) + x;
                       const auto field = [&](const char* name, int bits, const auto& given,
                                              const std::vector<golden::EntryRange>& ranges) {
                           if (bits == 0)
                               return;
                           const std::uint64_t value = entry & ((std::uint64_t{1} << bits) - 1);
                           entry >>= bits;
                           const golden::EntryRange range =
                               derived ? ranges[k] : golden::EntryRange{number(given[k]), number(given[k])};
                           judge.judge([&] { return fmt::format("({}, {}).{}", x, y, name); }, number(value), range.low,
                                       {0, range.high - range.low});
                       };
                       const Job::Formats& formats = golden_.job().formats;
                       field("rank", static_cast<int>(formats.rank_bits), table.ranks, ranks_.ranks);
                       field("bound", static_cast<int>(formats.bound_bits), table.bounds, ranks_.bounds);
                       field("radius", table.radii.empty() ? 0 : datapath::radius_bits, table.radii, ranks_.radii);
                       judge.require(entry == 0, [&] { return fmt::format("({}, {}) has other bits", x, y); });
                   });
    }

    void check_curvature_table() {
        Judge judge(result_, "curvature table",
                    "every quadratic and its rest, to nearest, in the smallest unit that fits");
        const golden::CurvatureTable& table = golden::curvature_table(golden_.map());
        std::vector<std::array<std::int64_t, 3>> cells;  // column, row, reach
        for (std::int64_t reach = 2;; reach *= 2) {
            const auto nearest = [&](std::int64_t texel) { return (texel + reach / 2) / reach; };
            for (std::int64_t row = 0; row <= nearest(table.rows - 1); ++row)
                for (std::int64_t column = 0; column <= nearest(table.columns - 1); ++column)
                    cells.push_back({column * reach, row * reach, reach});
            if (2 * reach >= std::max(table.columns, table.rows))
                break;
        }
        each_entry(judge, host_.summed_height_table, registers_.height_table, static_cast<int>(cells.size()), 1,
                   [&](std::uint32_t x, std::uint32_t, std::uint64_t entry) {
                       const auto [column, row, reach] = cells[x];
                       const golden::Curvature cell = golden::fit_curvature(golden_.map(), column, row, reach);
                       const datapath::CurvatureEntry found = datapath::unpack_curvature(entry);
                       const double unit = std::ldexp(1.0, found.exponent - datapath::curvature_fraction);
                       constexpr double leeway = 0.02;  // of a unit, for sums of squares in doubles
                       const auto field = [&](const char* name, double hardware, double golden) {
                           judge.judge([&] { return fmt::format("{}.{}", x, name); }, hardware, golden / unit,
                                       to_nearest, leeway);
                       };
                       field("xx", found.xx, cell.xx);
                       field("xy", found.xy, cell.xy);
                       field("yy", found.yy, cell.yy);
                       field("rest", found.rest, cell.rest);
                       const double largest = std::max({std::abs(cell.xx), std::abs(cell.xy), std::abs(cell.yy)});
                       const double smaller = unit / 2;
                       const bool fits = largest / smaller < 127.5 - leeway && cell.rest / smaller < 255.5 - leeway;
                       judge.require(found.exponent == 0 || !fits,
                                     [&] { return fmt::format("{}.unit = {}, and a smaller one fits", x, unit); });
                   });
    }

    void check_mipmap_table() {
        Judge judge(result_, "mipmap table", "every block's mean, to nearest, or maximum");
        std::vector<double> blocks;
        for (const std::vector<double>& level : golden::mipmap_levels(golden_.map()))
            blocks.insert(blocks.end(), level.begin(), level.end());
        each_entry(judge, host_.summed_height_table, registers_.height_table, static_cast<int>(blocks.size()), 1,
                   [&](std::uint32_t x, std::uint32_t, std::uint64_t entry) {
                       judge.judge([&] { return fmt::format("{}", x); }, number(entry), blocks[x], exact);
                   });
    }

    const Registers& registers_;
    const GoldenJob& golden_;
    const golden::DerivedRanks& ranks_;
    Host& host_;
    SetupResult& result_;
};

}  // namespace

golden::DerivedRanks derived_ranks(const MachineSetup& setup, const GoldenJob& golden, SetupResult& result) {
    const golden::Map& map = golden.map();
    if (!golden::has<golden::RankTest>(map) && !golden::has<golden::CurvatureTest>(map))
        return {};
    golden::RankSource source;
    const datapath::Formats& formats = setup.registers.formats;
    const double step = std::ldexp(1.0, -formats.texture.fraction);
    glm::dvec2 covered(map.width(), map.height());
    for (const std::uint32_t number : result.base_triangles) {
        auto& corners = source.base.emplace_back();
        for (std::size_t k = 0; k < 3; ++k) {
            corners[k] = golden::on_grid(golden.vertex(number, k).texture, step);
            const glm::dvec2 reached = glm::floor(corners[k]) + 1.0;
            if (map.address_u() == golden::AddressMode::clamp)
                covered.x = std::max(covered.x, reached.x);
            if (map.address_v() == golden::AddressMode::clamp)
                covered.y = std::max(covered.y, reached.y);
        }
    }
    Judge judge(result, "table's extent", "texels that the base mesh covers; the order of bisections");
    const golden::RankTable& table = golden::rank_table(map);
    judge.judge("columns",
                number(golden::has<golden::RankTest>(map) ? table.columns : golden::curvature_table(map).columns),
                covered.x, exact);
    judge.judge("rows", number(golden::has<golden::RankTest>(map) ? table.rows : golden::curvature_table(map).rows),
                covered.y, exact);
    source.columns = table.columns;
    source.rows = table.rows;
    source.midpoints = table.midpoints;
    std::vector<std::size_t> sorted;
    for (const glm::dvec2& midpoint : source.midpoints)
        sorted.push_back(source.entry(midpoint));
    std::sort(sorted.begin(), sorted.end());
    if (!golden::has<golden::RankTest>(map) || std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end())
        return {};
    source.rank_bits = golden.scene().rank_bits;
    source.bound_bits = golden.scene().bound_bits;
    const auto entries = static_cast<std::size_t>(source.columns * source.rows);
    judge.require(sorted.empty() || sorted.back() < entries,
                  [] { return std::string("a bisection beyond the table"); });
    if (!sorted.empty() && sorted.back() >= entries)
        return {};
    if (golden.scene().rank_view != golden::RankView::none && source.bound_bits > 0) {
        const double last_place = std::ldexp(1.0, -formats.view_distance.fraction);
        source.radii = true;
        source.steps = glm::dvec3(golden.texel_size(), std::abs(golden.parameters().scale)) / last_place;
        source.rounding = 4 + 32 * std::sqrt(3.0) * std::ldexp(1.0, -formats.position.fraction) / last_place;
    }
    golden::DerivedRanks ranks = golden::derive_ranks(map, source);
    judge.require(ranks.fault.empty(), [&] { return ranks.fault; });
    if (source.bound_bits > 0 && ranks.fault.empty())
        judge.judge("highest_bound_threshold", table.highest_bound_threshold, ranks.highest_bound_threshold.low,
                    {0, ranks.highest_bound_threshold.high - ranks.highest_bound_threshold.low});
    return ranks;
}

void check_tables(const MachineSetup& setup, const GoldenJob& golden, const golden::DerivedRanks& ranks, Host& host,
                  SetupResult& result) {
    TableCheck(setup, golden, ranks, host, result).run();
}

}  // namespace tessera::setup_check
