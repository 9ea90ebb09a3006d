#include "testbench/faults/flip_bit.h"

namespace tessera {

namespace {

constexpr int part_bits = 9;
constexpr int test_bit_count = 6;

template <class Vector>
void visit_vector(BitFlipper& fields, Vector& v, const datapath::Format& format) {
    fields.signed_number(v.x, format.bits);
    fields.signed_number(v.y, format.bits);
    fields.signed_number(v.z, format.bits);
}

void visit_texture(BitFlipper& fields, datapath::TexCoord& t, const datapath::Formats& formats) {
    fields.unsigned_number(t.u, formats.texture.bits);
    fields.unsigned_number(t.v, formats.texture.bits);
}

void visit_screen(BitFlipper& fields, datapath::ScreenPosition& screen, const datapath::Formats& formats) {
    fields.signed_number(screen.x, formats.screen.bits);
    fields.signed_number(screen.y, formats.screen.bits);
    fields.signed_number(screen.w, formats.view_distance.bits);
    fields.flag(screen.in_front);
}

void visit_edge(BitFlipper& fields, datapath::NewVertex& made, datapath::EdgeTests& edge,
                const datapath::Formats& formats) {
    visit_vector(fields, made.position, formats.position);
    visit_vector(fields, made.mean_normal, formats.normal);
    visit_texture(fields, made.texture, formats);
    visit_vector(fields, made.displaced, formats.position);
    visit_screen(fields, made.screen, formats);
    visit_texture(fields, edge.texture, formats);
    visit_vector(fields, edge.normal, formats.normal);
    visit_vector(fields, edge.tangent, formats.normal);
    visit_vector(fields, edge.displaced_normal, formats.normal);
    fields.unsigned_number(edge.tests, test_bit_count);
}

}  // namespace

bool flip_bit(datapath::Triangle& triangle, const datapath::Formats& formats, std::uint64_t bit) {
    BitFlipper fields(bit);
    datapath::visit_packed_triangle(fields, triangle, formats);
    return fields.flipped();
}

bool flip_bit(Work& work, const datapath::Formats& formats, std::uint64_t bit) {
    BitFlipper fields(bit);
    const Parts parts = work.parts;
    fields.unsigned_number(work.parts, part_bits);
    for (unsigned k = 0; k < 3; ++k)
        if ((unsigned{parts} >> (first_edge_part + k) & 1u) != 0) {
            visit_edge(fields, work.pass->new_vertex[k], work.pass->edges[k], formats);
            return fields.flipped();
        }
    for (unsigned k = 0; k < 3; ++k)
        if ((unsigned{parts} >> k & 1u) != 0 || (unsigned{parts} >> (first_normal_part + k) & 1u) != 0) {
            datapath::visit_packed_vertex(fields, work.pass->triangle.vertices[k], formats);
            break;
        }
    return fields.flipped();
}

bool flip_bit(LitTriangle& triangle, const datapath::Formats& formats, std::uint64_t bit) {
    BitFlipper fields(bit);
    for (LitTriangle::Corner& corner : triangle.corners) {
        visit_screen(fields, corner.screen, formats);
        visit_texture(fields, corner.texture, formats);
        fields.unsigned_number(corner.intensity, 8);
    }
    return fields.flipped();
}

}  // namespace tessera
