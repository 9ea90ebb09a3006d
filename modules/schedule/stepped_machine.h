#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "modules/schedule/calls.h"
#include "modules/schedule/link.h"
#include "modules/schedule/shared_table.h"
#include "modules/schedule/stepped_stage.h"
#include "modules/schedule/timetable.h"

namespace tessera::schedule {

/// Timetable of the triangle design in which several units read the same memory: with three Tessellation Tests units,
/// or if the height test reads codes from the displacement map. The readers share a memory's ports in order of time,
/// and one may be several passes ahead of another, so that items cannot be evaluated in their own order. Instead the
/// units before Pass or Tessellate's decision are called cycle by cycle, as the scheduler calls the clocked units, but
/// without data. All that follows from the decision is computed at once (backend.h).
class SteppedMachine final : public Timetable {
  public:
    explicit SteppedMachine(const Plan& plan);

    void send(std::uint64_t triangles, Cycle cycle) override;
    const Source::Next& next() override;
    void pass(const Facts& facts) override;
    std::uint64_t corners(unsigned k) const override { return tests_[k]->corners.taken(); }
    std::uint64_t edges(unsigned k) const override { return tests_[k]->edges.taken(); }

  private:
    using Memory = SteppedStage::Memory;

    /// The order of the calls within a cycle: downstream first.
    enum Call : unsigned {
        displacement_map_call,
        displacement_map_for_tests_call,
        normal_map_call,
        height_table_call,
        join_call,
        first_tests_call
    };
    enum TestsCall : unsigned {
        collect_tests_call,
        view_test_call,
        normal_test_call,
        height_test_call,
        tex_coord_test_call,
        calculate_new_u_call,
        calls_of_tests
    };
    enum LastCall : unsigned {
        transform_call = first_tests_call + most_tests_units * calls_of_tests,
        displace_vertex_call,
        calculate_new_p_call,
        get_triangle_call
    };

    static constexpr unsigned of_tests_call(unsigned k, TestsCall call) {
        return first_tests_call + k * calls_of_tests + call;
    }

    /// Tessellation Tests unit k.
    struct Tests {
        Tests(SteppedMachine& machine, const TestsPlan& plan, unsigned k);
        void collect();

        Calls& calls;
        Link input, to_normal_test, to_tex_coord_test, to_height_test, to_view_test, corners;
        std::array<Link, 4> results;
        Link edges;  // to Pass or Tessellate
        SteppedStage calculate_new_u, tex_coord_test, height_test, normal_test, view_test;
        bool leaves = false;  // an edge is collected and on offer
        Cycle collected = 0;
        States collect_states;
        Level collect_level{1};
    };
    /// One of Get Triangle's outputs.
    struct Branch {
        Link* link = nullptr;
        unsigned takes = 0, left = 0;  ///< parts of a triangle: all that go here; those not sent yet
        Cycle next = 0;                ///< from which it may send a part
        Unit consumer = nobody;
    };

    void call(unsigned unit);
    bool get_triangle_begins();
    bool send_parts(Branch& branch);
    void set_get_triangle_state();
    void join();
    void take_parts();
    bool open(std::uint64_t pass);
    bool decide();

    Calls calls_;
    Passes passes_;

    std::uint64_t begun_ = 0;   // passes begun
    std::uint64_t opened_ = 0;  // passes that have had a place in Pass or Tessellate
    std::uint64_t joined_ = 0;  // passes decided
    bool complete_ = false;     // the first undecided pass is complete; it starts in the cycle in its Join

    bool sending_ = false;  // Get Triangle
    Cycle begin_ = 0;
    std::vector<Branch> branches_;
    State get_triangle_state_ = State::starved;  // since the last call
    Unit get_triangle_by_ = nobody;

    Memory displacement_map_, displacement_map_for_tests_, normal_map_, height_table_;
    Link to_calculate_new_p_, to_displace_vertex_, to_transform_, to_join_;
    SteppedStage calculate_new_p_, displace_vertex_, transform_;
    std::vector<std::unique_ptr<Tests>> tests_;
    std::array<SteppedStage*, Calls::most_units> stages_{};  // by call number
};

}  // namespace tessera::schedule
