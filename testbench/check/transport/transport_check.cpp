#include "testbench/check/transport/transport_check.h"

#include <fmt/core.h>

#include "modules/datapath/cull.h"
#include "modules/datapath/fields.h"
#include "modules/datapath/light.h"
#include "modules/datapath/tessellate.h"
#include "modules/datapath/transform.h"
#include "modules/sockets/items.h"
#include "testbench/common/hash.h"

namespace tessera {

namespace {

/// Hashes the fields of an item, two to a word: a codec of fields.h.
class Hash {
  public:
    void add(std::uint64_t word) { state_ = mix_hash(state_, word); }
    std::int64_t field(const datapath::Field&, std::int64_t value) {
        pair_ = pair_ << 32 | static_cast<std::uint32_t>(value);
        odd_ = !odd_;
        if (!odd_)
            add(pair_);
        return value;
    }
    static std::uint32_t annotation(const char*, std::uint32_t value) { return value; }
    std::uint64_t value() const { return odd_ ? mix_hash(state_, pair_) : state_; }

  private:
    std::uint64_t state_ = 1;  // not 0, so that items of zeros change the hash
    std::uint64_t pair_ = 0;
    bool odd_ = false;
};

/// `known`: includes P', N', P's. N's is checked when the triangle is finished.
void add_vertex(Hash& hash, datapath::Fields<Hash>& fields, const datapath::Vertex& v, bool known) {
    describe_base_vertex(fields, v);
    hash.add(std::uint64_t{v.generation} << 1 | (known ? 1 : 0));
    if (known)
        describe_displaced(fields, v);
}

/// Hash of a triangle before its decision, without `stopped_by`.
std::uint64_t hash_to_decide(const datapath::Formats& formats, const datapath::Triangle& triangle,
                             unsigned unknown_vertices) {
    Hash hash;
    datapath::Fields<Hash> fields(hash, formats);
    for (unsigned k = 0; k < 3; ++k)
        add_vertex(hash, fields, triangle.vertices[k], (unknown_vertices >> k & 1u) == 0);
    hash.add(triangle.base);
    hash.add(std::uint64_t{triangle.split_by} << 8 | triangle.final_edges);
    return hash.value();
}

std::uint64_t hash_to_finish(const datapath::Formats& formats, const datapath::Triangle& triangle) {
    Hash hash;
    datapath::Fields<Hash> fields(hash, formats);
    for (const datapath::Vertex& vertex : triangle.vertices)
        add_vertex(hash, fields, vertex, true);
    hash.add(triangle.base);
    hash.add(std::uint64_t{triangle.split_by} << 8 | triangle.stopped_by);
    return hash.value();
}

/// Hash of a triangle that will be split, and of the test results of its split edges.
std::uint64_t hash_to_split(const datapath::Formats& formats, const datapath::TrianglePass& pass) {
    Hash hash;
    datapath::Fields<Hash> fields(hash, formats);
    for (const datapath::Vertex& vertex : pass.triangle.vertices)
        add_vertex(hash, fields, vertex, true);
    unsigned split_by = 0;
    for (unsigned k = 0; k < 3; ++k) {
        if ((pass.split >> k & 1u) == 0)
            continue;
        const datapath::EdgeTests& edge = pass.edges[k];
        split_by |= edge.tests & datapath::requesting_tests;
        for (const datapath::Direction& n : {edge.normal, edge.tangent, edge.displaced_normal})
            fields.direction("", n, "");
    }
    hash.add(std::uint64_t{pass.number} << 32 | split_by << 8 | pass.split);
    hash.add(pass.triangle.base);
    return hash.value();
}

std::uint64_t hash_lit(const datapath::Formats& formats, const LitTriangle& triangle) {
    Hash hash;
    describe_item(hash, triangle, formats, 0);
    return hash.value();
}

unsigned unknown_vertices(const datapath::Triangle& triangle) {
    unsigned unknown = 0;
    for (unsigned k = 0; k < 3; ++k)
        unknown |= triangle.vertices[k].displaced_known ? 0u : 1u << k;
    return unknown;
}

}  // namespace

TransportCheck::TransportCheck(const datapath::Registers& registers,
                               const std::vector<datapath::Triangle>& base_triangles)
    : registers_(registers), passes_(base_triangles.size() + 1), finished_(base_triangles.size() + 1) {
    for (const datapath::Triangle& triangle : base_triangles)
        passes_[place_of(triangle.base)].decided.expect(
            hash_to_decide(registers_.formats, triangle, unknown_vertices(triangle)));
}

void TransportCheck::finding(const std::string& what) {
    if (result_.violations++ == 0)
        result_.first_violation = what;
}

void TransportCheck::write(const datapath::TrianglePass& pass) {
    Passes& base = passes_[place_of(pass.triangle.base)];
    if (pass.told == datapath::Told::midpoints) {
        base.split.come(hash_to_split(registers_.formats, pass));
    } else {
        ++triangles_;
        base.decided.come(hash_to_decide(registers_.formats, pass.triangle, pass.new_vertices));
    }
    if (pass.split == 0) {
        base.finished.expect(hash_to_finish(registers_.formats, pass.triangle));
    } else if (pass.told == datapath::Told::tests) {
        base.split.expect(hash_to_split(registers_.formats, pass));
    } else {
        datapath::Saturations counted_by_the_unit;
        datapath::tessellate(
            pass, registers_.triangulation, registers_.formats, counted_by_the_unit,
            [&](const datapath::Triangle& child) {
                base.decided.expect(hash_to_decide(registers_.formats, child, unknown_vertices(child)));
            });
    }
}

void TransportCheck::write(const datapath::Triangle& finished) {
    finished_[place_of(finished.base)].come(hash_to_finish(registers_.formats, finished));
    datapath::Saturations counted_by_the_unit;
    LitTriangle lit;
    for (unsigned k = 0; k < 3; ++k) {
        const datapath::Vertex& vertex = finished.vertices[k];
        const datapath::Direction normal = datapath::transform_normal(vertex.displaced_normal, registers_.transform,
                                                                      registers_.formats, counted_by_the_unit);
        if (!(normal == vertex.screen_normal))
            finding(
                fmt::format("base triangle {}: a finished triangle's vertex {} has N's ({}, {}, {}); its N' "
                            "transforms to ({}, {}, {})",
                            finished.base, k, vertex.screen_normal.x, vertex.screen_normal.y, vertex.screen_normal.z,
                            normal.x, normal.y, normal.z));
        lit.corners[k] = {vertex.screen, vertex.texture,
                          datapath::light(normal, registers_.light, registers_.formats, counted_by_the_unit)};
    }
    const auto& v = finished.vertices;
    if (!registers_.back_face_culling || !datapath::faces_away(v[0].screen, v[1].screen, v[2].screen))
        lit_.expect(hash_lit(registers_.formats, lit));
}

void TransportCheck::write(const LitTriangle& lit) {
    lit_.come(hash_lit(registers_.formats, lit));
}

WorkResult TransportCheck::result() const {
    WorkResult result = result_;
    result.triangles = triangles_;
    const auto judge = [&](const Balance& balance, const std::string& whose, const char* what) {
        if (balance.even())
            return;
        std::string text = whose + ": ";
        if (balance.count > 0)
            text += fmt::format("{} triangles expected to be {} were not", balance.count, what);
        else if (balance.count < 0)
            text += fmt::format("{} more triangles were {} than expected", -balance.count, what);
        else
            text += fmt::format("as many triangles were {} as expected, but not the same ones", what);
        if (result.violations++ == 0)
            result.first_violation = text;
    };
    for (std::size_t k = 0; k < passes_.size(); ++k) {
        const std::string whose = k == foreign() ? "no base triangle" : fmt::format("base triangle {}", k);
        Balance finished = passes_[k].finished;
        finished += finished_[k];
        judge(passes_[k].decided, whose, "decided");
        judge(passes_[k].split, whose, "split");
        judge(finished, whose, "finished");
    }
    judge(lit_, "all base triangles", "lit");
    return result;
}

}  // namespace tessera
