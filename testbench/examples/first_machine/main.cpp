#include <tlm_utils/simple_initiator_socket.h>
#include <cstdio>
#include <systemc>
#include <vector>

#include "modules/datapath/map_entry.h"
#include "modules/pipeline.h"

// A machine, a host that fills its tables and sends a square, and a sink; in functional and in timed mode.

using namespace tessera;

namespace {

constexpr std::uint32_t side = 8;  // of the map, in texels
constexpr std::int32_t one = 1 << 16;

std::uint64_t code(std::uint32_t x, std::uint32_t y) {
    return x == 3 && y == 4 ? 40'000 : 0;
}

datapath::Registers registers() {
    datapath::Registers r;
    r.map = {side, side, datapath::AddressMode::clamp, datapath::AddressMode::clamp};
    r.displacement_map = {0x1000, side, side, datapath::entry_bytes(r.formats.displacement.bits)};
    r.normal_map = {0x2000, side, side, datapath::entry_bytes(3 * r.formats.normal.bits)};
    r.summed_height_table = {0x3000, side + 1, side + 1, datapath::entry_bytes(r.formats.summed_height.bits)};
    r.tests.normal_test = r.tests.view_test = false;
    r.displacement.scale = one / 4;
    // From (0.5, 0.5, 4) straight down, 256 x 256 pixels.
    const std::int64_t unit = std::int64_t{1} << datapath::TransformParameters::matrix_fraction;
    r.transform.row_x = r.transform.row_y = {unit, 0, -unit / 2, unit * one * 3 / 2};
    std::swap(r.transform.row_y[0], r.transform.row_y[1]);
    r.transform.row_w = {0, 0, -unit, 4 * unit * one};
    r.transform.exponent = 8;
    r.transform.normal_rows = {{{1 << 14, 0, 0}, {0, 1 << 14, 0}, {0, 0, 1 << 14}}};
    r.light.direction = {0, 0, 1 << 14};
    return r;
}

datapath::Triangle triangle(std::uint32_t base) {
    datapath::Triangle result;
    result.base = base;
    const std::array<std::array<std::int32_t, 2>, 3> corners{{{0, 0}, {1, base == 0 ? 0 : 1}, {base == 0 ? 1 : 0, 1}}};
    for (std::size_t k = 0; k < 3; ++k) {
        datapath::Vertex& v = result.vertices[k];
        v.position = {corners[k][0] * one, corners[k][1] * one, 0};
        v.normal = {0, 0, 1 << 14};
        v.tangent = {1 << 14, 0, 0};
        v.texture = {static_cast<std::uint32_t>(corners[k][0]) * side << 12,
                     static_cast<std::uint32_t>(corners[k][1]) * side << 12};
    }
    return result;
}

class Machine : public sc_core::sc_module, public CycleProcess {
  public:
    StreamOutput<datapath::Triangle> output{"output"};
    StreamInput<LitTriangle> input{"input"};
    tlm_utils::simple_initiator_socket<Machine> displacement{"displacement"}, normals{"normals"}, heights{"heights"};
    unsigned triangles = 0;

    Machine(const sc_core::sc_module_name& name, const datapath::Registers& r, const Design& design)
        : sc_module(name),
          registers_(r),
          blocking_(design.transport == Transport::blocking),
          pipeline("pipeline", r, design) {
        pipeline.clock.attach(*this);
        output.clocked_by(pipeline.clock, *this);
        input.clocked_by(pipeline.clock, *this, 1, {});
        input.register_b_transport<&Machine::take>(*this);
        output.bind(pipeline.get_triangle.from_host);
        pipeline.lighting.to_rasteriser.bind(input);
        displacement.bind(pipeline.displacement_map.host);
        normals.bind(pipeline.normal_map.host);
        heights.bind(pipeline.summed_height_table.host);
        SC_HAS_PROCESS(Machine);
        SC_THREAD(send);
    }

  private:
    template <class Socket, class Entry>
    void fill(Socket& socket, const datapath::TableLayout& layout, const Entry& entry) {
        for (std::uint32_t y = 0; y < layout.rows; ++y) {
            for (std::uint32_t x = 0; x < layout.columns; ++x) {
                std::array<unsigned char, 8> bytes{};
                for (std::size_t k = 0; k < 8; ++k)
                    bytes[k] = static_cast<unsigned char>(entry(x, y) >> 8 * k);
                tlm::tlm_generic_payload write;
                write.set_command(tlm::TLM_WRITE_COMMAND);
                write.set_address(layout.address(x, y));
                write.set_data_ptr(bytes.data());
                write.set_data_length(layout.entry_bytes);
                write.set_streaming_width(layout.entry_bytes);
                socket->transport_dbg(write);
            }
        }
    }
    void start_of_simulation() override {
        fill(displacement, registers_.displacement_map, code);
        fill(normals, registers_.normal_map, [](auto, auto) { return datapath::pack_normal({0, 0, 1 << 14}, 16); });
        fill(heights, registers_.summed_height_table, [](std::uint32_t columns, std::uint32_t rows) {
            std::uint64_t sum = 0;
            for (std::uint32_t y = 0; y < rows; ++y) {
                for (std::uint32_t x = 0; x < columns; ++x)
                    sum += code(x, y);
            }
            return sum;
        });
    }
    void send() {
        if (!blocking_) {
            pipeline.clock.wake(*this);
            return;
        }
        sc_core::sc_time delay;
        for (datapath::Triangle& t : base_)
            output.transport(t, delay);
    }
    void take(LitTriangle&, sc_core::sc_time&) { ++triangles; }
    void step() override {
        while (sent_ < base_.size() && output.free())
            output.send(base_[sent_++]);
        for (; !input.empty(); input.pop())
            ++triangles;
    }

    const datapath::Registers& registers_;
    bool blocking_;
    std::array<datapath::Triangle, 2> base_{triangle(0), triangle(1)};
    std::size_t sent_ = 0;

  public:
    Pipeline pipeline;
};

}  // namespace

int sc_main(int, char**) {
    const datapath::Registers r = registers();
    Design timed_design;
    timed_design.transport = Transport::non_blocking;
    Machine functional("functional", r, Design{});
    Machine timed("timed", r, timed_design);
    sc_core::sc_start();
    const auto cycles = static_cast<unsigned>(timed.pipeline.clock.last_cycle() + 1);
    std::printf("functional: %u triangles\n", functional.triangles);
    std::printf("timed: %u triangles in %u cycles\n", timed.triangles, cycles);
    return functional.triangles > 2 && functional.triangles == timed.triangles ? 0 : 1;
}
