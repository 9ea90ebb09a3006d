#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

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

class MapCheck {
  public:
    MapCheck(const MachineSetup& setup, const GoldenJob& golden, Host& host, SetupResult& result)
        : registers_(setup.registers), golden_(golden), host_(host), result_(result) {}

    void run() {
        check_displacement_map();
        check_normal_map();
    }

  private:
    std::size_t texel_of(std::uint32_t x, std::uint32_t y) const {
        return std::size_t{y} * static_cast<std::size_t>(golden_.map().width()) + x;
    }

    void check_displacement_map() {
        Judge judge(result_, "displacement map", "every code, to nearest or as fitted by the host");
        const golden::Map& map = golden_.map();
        const bool fitted = golden_.job().map.heights == MapHeights::fitted;
        if (fitted)
            check_fitted_heights();
        each_entry(judge, host_.displacement_map, registers_.displacement_map, map.width(), map.height(),
                   [&](std::uint32_t x, std::uint32_t y, std::uint64_t code) {
                       const std::size_t texel = texel_of(x, y);
                       const double golden = fitted ? map.code(texel) : golden_.unrounded_code(texel);
                       judge.judge([&] { return fmt::format("({}, {})", x, y); }, number(code), golden, to_nearest,
                                   double_rounding * golden);
                   });
    }

    /// A fitted height is none that does not occur around its texel.
    void check_fitted_heights() {
        constexpr int reach = 2;  // texels
        Judge judge(result_, "fitted heights", "every code, within those of the texels up to two away");
        const golden::Map& map = golden_.map();
        const auto addressed = [](int index, int size, golden::AddressMode mode) {
            return mode == golden::AddressMode::repeat ? (index + reach * size) % size : std::clamp(index, 0, size - 1);
        };
        for (int y = 0; y < map.height(); ++y)
            for (int x = 0; x < map.width(); ++x) {
                double low = golden_.scene().highest_code, high = 0;
                for (int row = y - reach; row <= y + reach; ++row)
                    for (int column = x - reach; column <= x + reach; ++column) {
                        const double code = golden_.unrounded_code(
                            texel_of(static_cast<std::uint32_t>(addressed(column, map.width(), map.address_u())),
                                     static_cast<std::uint32_t>(addressed(row, map.height(), map.address_v()))));
                        low = std::min(low, code);
                        high = std::max(high, code);
                    }
                const std::size_t texel = texel_of(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y));
                judge.judge([&] { return fmt::format("({}, {})", x, y); }, map.code(texel), low,
                            {to_nearest.low, high - low + to_nearest.high}, double_rounding * high);
            }
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

    const Registers& registers_;
    const GoldenJob& golden_;
    Host& host_;
    SetupResult& result_;
};

}  // namespace

void judge_layout(Judge& judge, const char* name, const TableLayout& table, double columns, double rows,
                  int entry_bits) {
    judge.judge([&] { return fmt::format("{}.columns", name); }, table.columns, columns, exact);
    judge.judge([&] { return fmt::format("{}.rows", name); }, table.rows, rows, exact);
    judge.judge([&] { return fmt::format("{}.entry_bytes", name); }, table.entry_bytes, number((entry_bits + 7) / 8),
                exact);
}

std::vector<std::array<glm::dvec2, 3>> base_texels(const MachineSetup& setup, const GoldenJob& golden,
                                                   const SetupResult& result) {
    const double step = std::ldexp(1.0, -setup.registers.formats.texture.fraction);
    std::vector<std::array<glm::dvec2, 3>> base;
    for (const std::uint32_t triangle : result.base_triangles) {
        auto& corners = base.emplace_back();
        for (std::size_t k = 0; k < 3; ++k)
            corners[k] = golden::on_grid(golden.vertex(triangle, k).texture, step);
    }
    return base;
}

void judge_extent(Judge& judge, const std::vector<std::array<glm::dvec2, 3>>& base, const golden::Map& map,
                  std::int64_t columns, std::int64_t rows) {
    glm::dvec2 covered(map.width(), map.height());
    for (const auto& corners : base)
        for (const glm::dvec2& corner : corners) {
            const glm::dvec2 reached = glm::floor(corner) + 1.0;
            if (map.address_u() == golden::AddressMode::clamp)
                covered.x = std::max(covered.x, reached.x);
            if (map.address_v() == golden::AddressMode::clamp)
                covered.y = std::max(covered.y, reached.y);
        }
    judge.judge("columns", number(columns), covered.x, exact);
    judge.judge("rows", number(rows), covered.y, exact);
}

void each_entry(Judge& judge, tlm_utils::simple_initiator_socket<Host>& socket, const TableLayout& layout,
                double columns, double rows,
                const std::function<void(std::uint32_t x, std::uint32_t y, std::uint64_t entry)>& check) {
    // A wrong layout has already been reported with the registers.
    if (layout.columns != columns || layout.rows != rows || layout.entry_bytes > 8)
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

void check_maps(const MachineSetup& setup, const GoldenJob& golden, Host& host, SetupResult& result) {
    MapCheck(setup, golden, host, result).run();
}

}  // namespace tessera::setup_check
