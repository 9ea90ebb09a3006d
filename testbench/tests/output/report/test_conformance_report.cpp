#include "testbench/output/report/conformance_report.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

// conformance.json and conformance.txt: every figure is under its name. All values are distinct.

using namespace tessera;
using Catch::Contains;
using Json = nlohmann::json;

namespace {

Checks distinct_checks() {
    Checks checks;
    checks.allowed_flips = 50;
    SetupResult& setup = checks.setup.emplace();
    setup.parts = {{"registers", "every register", 201, 2, 0.25}, {"base vertices", "every field", 302, 3, 0.75}};
    setup.first_wrong = "a register";
    ConformanceResult& conformance = checks.conformance.emplace();
    conformance.passes = 11;
    conformance.edges = 40;
    conformance.flipped_edges = 10;
    conformance.mismatches = 7;
    conformance.first_mismatch = "an edge";
    conformance.tests = {{"NT", "Normal Test", 21, 22, 23, 24}};
    conformance.quantities = {{"P_ij", "LSB", "midpoint", 31, 32, 33, 34, 35, 36}};
    EndToEndResult& e = checks.end_to_end.emplace();
    e.hardware_triangles = 50;
    e.golden_triangles = 60;
    e.allowed = {30, 0.125, 8};
    e.hardware_to_golden = {61, 62, 0.01, 25, 64, 65, 66, 67, 68, 69};
    e.golden_to_hardware = {71, 72, 0.02, 16, 74, 75, 76, 77, 78, 79};
    InvariantResult& i = checks.invariants.emplace();
    i.triangles = 81;
    i.edges = 82;
    i.base_triangles = 83;
    i.base_edges = 84;
    i.border_base_edges = 85;
    i.non_manifold_base_edges = 86;
    i.texture_seams = 87;
    i.creases = 88;
    i.t_vertices = 89;
    i.cracks = 90;
    i.inconsistent_vertices = 91;
    i.missing_triangles = 92;
    i.extra_triangles = 93;
    i.differing_triangles = 94;
    i.generation_violations = 95;
    i.unfinished = 1;
    i.collapsed = 96;
    i.turned_over = 97;
    i.displaced_collapsed = 98;
    i.open_texture_seam_edges = 99;
    i.open_crease_edges = 100;
    i.first_violation = "a crack";
    checks.work = WorkResult{111, 112, 113, "a triangle"};
    checks.reads = ReadResult{114, 115, "an entry"};
    checks.remarks = {"a remark"};
    return checks;
}

Json distance(double points, double measured, double unseen, double farther, double model, double rms, double lsb,
              double rms_lsb) {
    return {{"points", points},           {"measured", measured},       {"unseen_percent", unseen},
            {"farther_percent", farther}, {"confidence_percent", 99.9}, {"max_model", model},
            {"rms_model", rms},           {"max_position_lsb", lsb},    {"rms_position_lsb", rms_lsb}};
}

}  // namespace

TEST_CASE("conformance.json: every figure is under its name") {
    const Json json = Json::parse(conformance_json(distinct_checks()));
    CHECK(json.at("passed") == false);
    CHECK(json.at("remarks") == Json{"a remark"});
    CHECK(json.at("setup") ==
          Json{{"passed", false},
               {"compared", 503},
               {"wrong", 5},
               {"first_wrong", "a register"},
               {"parts",
                {{"registers",
                  {{"compared", 201}, {"wrong", 2}, {"worst_ratio", 0.25}, {"description", "every register"}}},
                 {"base vertices",
                  {{"compared", 302}, {"wrong", 3}, {"worst_ratio", 0.75}, {"description", "every field"}}}}}});
    CHECK(json.at("conformance") == Json{{"passed", false},
                                         {"passes", 11},
                                         {"edges", 40},
                                         {"flipped_edges", 10},
                                         {"flips_percent", 25.0},
                                         {"allowed_flips_percent", 50.0},
                                         {"mismatches", 7},
                                         {"first_mismatch", "an edge"},
                                         {"decisions",
                                          {{"NT",
                                            {{"compared", 21},
                                             {"agreed", 22},
                                             {"allowed_flips", 23},
                                             {"mismatches", 24},
                                             {"description", "Normal Test"}}}}},
                                         {"values",
                                          {{"P_ij",
                                            {{"compared", 31},
                                             {"outside", 32},
                                             {"max_error", 33.0},
                                             {"rms_error", 34.0},
                                             {"largest_bound", 35.0},
                                             {"worst_ratio", 36.0},
                                             {"unit", "LSB"},
                                             {"description", "midpoint"}}}}}});
    // 20 % more; a quarter of the points farther away: 0.125 + sqrt(0.25) * 8
    CHECK(json.at("end_to_end") == Json{{"passed", false},
                                        {"hardware_triangles", 50},
                                        {"golden_triangles", 60},
                                        {"more_triangles_percent", 20.0},
                                        {"allowed_triangles_percent", 30.0},
                                        {"rounding_model", 0.125},
                                        {"allowed_rms_model", 4.125},
                                        {"golden_bound_hit", false},
                                        {"hardware_to_golden", distance(61, 62, 1, 25, 68, 69, 66, 67)},
                                        {"golden_to_hardware", distance(71, 72, 2, 16, 78, 79, 76, 77)}});
    CHECK(json.at("work") == Json{{"passed", false},
                                  {"triangles", 111},
                                  {"equations", 112},
                                  {"violations", 113},
                                  {"first_violation", "a triangle"}});
    CHECK(json.at("reads") == Json{{"passed", false}, {"entries", 114}, {"wrong", 115}, {"first_wrong", "an entry"}});
    const Json& invariants = json.at("invariants");
    CHECK(invariants.at("passed") == false);
    CHECK(invariants.at("first_violation") == "a crack");
    // name, value, kind
    for (const auto& [name, value] : std::initializer_list<std::pair<const char*, int>>{{"triangles", 81},
                                                                                        {"edges", 82},
                                                                                        {"base_triangles", 83},
                                                                                        {"base_edges", 84},
                                                                                        {"border_base_edges", 85},
                                                                                        {"non_manifold_base_edges", 86},
                                                                                        {"texture_seams", 87},
                                                                                        {"creases", 88},
                                                                                        {"t_vertices", 89},
                                                                                        {"cracks", 90},
                                                                                        {"inconsistent_vertices", 91},
                                                                                        {"missing_triangles", 92},
                                                                                        {"extra_triangles", 93},
                                                                                        {"differing_triangles", 94},
                                                                                        {"generation_violations", 95},
                                                                                        {"unfinished", 1},
                                                                                        {"collapsed", 96},
                                                                                        {"turned_over", 97},
                                                                                        {"displaced_collapsed", 98},
                                                                                        {"open_texture_seam_edges", 99},
                                                                                        {"open_crease_edges", 100}}) {
        INFO(name);
        CHECK(invariants.at(name).at("value") == value);
    }
    CHECK(invariants.size() == 21 + 2);
}
