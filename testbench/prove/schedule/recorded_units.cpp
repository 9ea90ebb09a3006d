#include "testbench/prove/schedule/recorded_units.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include "modules/datapath/cull.h"
#include "modules/datapath/tessellate.h"
#include "testbench/common/hash.h"

namespace tessera::schedule {

namespace {

/// Of its base triangle and its corners, in order.
std::uint64_t hash_of(const datapath::Triangle& triangle) {
    std::uint64_t hash = triangle.base;
    for (const datapath::Vertex& v : triangle.vertices) {
        for (const auto value : {v.position.x, v.position.y, v.position.z})
            hash = mix_hash(hash, static_cast<std::uint64_t>(value));
        hash = mix_hash(hash, std::uint64_t{v.texture.u} << 32 | v.texture.v);
    }
    return hash;
}

/// A unit that records the reads of its items.
template <class Its, class Item>
class Recorded : public Its {
  public:
    Recorded(const sc_core::sc_module_name& name, const UnitContext& context, PassRecord& record,
             PassRecord::Reader reader, std::vector<BankOfEntry> memories)
        : Its(name, context), record_(record), reader_(reader), memories_(std::move(memories)) {}

  protected:
    void reads(const Item& item, Reads& reads) const override {
        Its::reads(item, reads);
        record_.read(reader_, item.tag, reads, memories_);
    }

  private:
    PassRecord& record_;
    const PassRecord::Reader reader_;
    const std::vector<BankOfEntry> memories_;
};

}  // namespace

RecordedPass& PassRecord::pass(std::uint32_t number) {
    if (number >= passes_.size())
        passes_.resize(std::size_t{number} + 1);
    return passes_[number];
}

void PassRecord::read(Reader reader, const PartTag& tag, const Reads& reads, const std::vector<BankOfEntry>& memories) {
    RecordedPass& pass = this->pass(tag.origin.pass);
    pass.facts.parts = static_cast<std::uint16_t>(pass.facts.parts | 1u << tag.part);
    PartReads& part = (reader == Reader::displace_vertex ? pass.facts.displace_vertex
                       : reader == Reader::height_test   ? pass.facts.height_test
                                                         : pass.facts.normal_test)[tag.part];
    part.requests = static_cast<std::uint8_t>(reads.requests());
    if (reads.requests() == 0)
        return;
    part.memory = static_cast<std::uint8_t>(reads.port(0));
    for (unsigned k = 0; k < reads.requests(); ++k)
        part.first[k] = static_cast<std::uint8_t>(reads.first(k));
    part.first[reads.requests()] = static_cast<std::uint8_t>(reads.entries());
    for (unsigned k = 0; k < reads.entries(); ++k)
        part.banks[k] = static_cast<std::uint8_t>(memories.at(part.memory)(reads.addresses()[k]));
}

void PassRecord::observe(HostedMachine& hosted) {
    registers_ = &hosted.machine.registers();
    hosted.machine.pass_or_tessellate.decided.bind(decisions_);
    hosted.machine.pass_or_tessellate.finished.bind(finishes_);
}

void PassRecord::Decisions::write(const datapath::TrianglePass& decided) {
    RecordedPass& pass = record.pass(decided.number);
    pass.triangle = hash_of(decided.triangle);
    pass.facts.tested = true;
    if (decided.split == 0 && decided.new_vertices == 0)
        return;  // it is finished
    pass.facts.way = Way::tessellation;
    const datapath::Registers& registers = *record.registers_;
    datapath::Saturations ignored;
    tessellate(decided, registers.triangulation, registers.formats, ignored,
               [&](const datapath::Triangle& child) { pass.children[pass.facts.children++] = hash_of(child); });
}

void PassRecord::Finished::write(const datapath::Triangle& triangle) {
    const auto& v = triangle.vertices;
    const bool dropped =
        record.registers_->back_face_culling && datapath::faces_away(v[0].screen, v[1].screen, v[2].screen);
    record.finished_.push_back({dropped ? Way::dropped : Way::lighting, hash_of(triangle)});
}

std::vector<RecordedPass> PassRecord::take_passes() {
    const auto ends = [](const RecordedPass& pass) { return pass.facts.children == 0; };
    if (std::count_if(passes_.begin(), passes_.end(), ends) != static_cast<std::ptrdiff_t>(finished_.size()))
        throw std::logic_error(std::to_string(finished_.size()) + " triangles finished, in another number of passes");
    auto finished = finished_.begin();
    for (RecordedPass& pass : passes_) {
        if (!ends(pass))
            continue;
        pass.facts.way = finished->way;
        pass.triangle = finished++->triangle;
    }
    finished_.clear();
    return std::exchange(passes_, {});
}

RecordedUnits::RecordedUnits() {
    replace<DisplaceVertex>([this](Name name, const UnitContext& context) {
        return std::make_unique<Recorded<DisplaceVertex, BasePoint>>(
            name, context, of(context.clock), PassRecord::Reader::displace_vertex,
            std::vector{BankOfEntry(context.timing().displacement_map, context.registers.displacement_map)});
    });
    replace<HeightTestUnit>([this](Name name, const UnitContext& context) {
        const std::vector<BankOfEntry> memories{
            BankOfEntry(height_table_timing(context.timing(), context.registers.formats),
                        context.registers.height_table),
            BankOfEntry(context.timing().displacement_map, context.registers.displacement_map)};
        return std::make_unique<Recorded<HeightTestUnit, HeightOperands>>(name, context, of(context.clock),
                                                                          PassRecord::Reader::height_test, memories);
    });
    replace<NormalTest>([this](Name name, const UnitContext& context) {
        return std::make_unique<Recorded<NormalTest, NormalOperands>>(
            name, context, of(context.clock), PassRecord::Reader::normal_test,
            std::vector{BankOfEntry(context.timing().normal_map, context.registers.normal_map)});
    });
}

}  // namespace tessera::schedule
