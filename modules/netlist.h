#pragma once
#include <algorithm>
#include <functional>
#include <memory>
#include <string>
#include <typeindex>
#include <utility>
#include <vector>

#include "modules/sockets/stream_input.h"
#include "modules/sockets/stream_output.h"
#include "modules/stage/unit.h"
#include "modules/unit_factory.h"

namespace tessera {

/// The units of a machine, or of a block of it, and the wires between them. netlists.cpp lists them for each design, in
/// the order of the data's flow; all else that concerns every unit follows from that list. Owns the units.
class Netlist {
  public:
    /// context.design: used only while the machine is built.
    Netlist(const UnitContext& context, UnitFactory& factory) : context_(context), factory_(factory) {}

    /// Adds a unit, made by the factory.
    template <class AnyUnit>
    AnyUnit& make(const std::string& name) {
        std::unique_ptr<AnyUnit> unit = factory_.make<AnyUnit>(name.c_str(), context_);
        AnyUnit& made = *unit;
        owned_.push_back(std::move(unit));
        units_.push_back(&made);
        row(typeid(AnyUnit)).push_back(&made);
        return made;
    }
    /// Adds the units and wires of a block, which must outlive this.
    template <class Block>
    void add(const Block& block) {
        const Netlist& its = block.netlist();
        units_.insert(units_.end(), its.units_.begin(), its.units_.end());
        const std::vector<Unit*> ordered = its.downstream_first();
        std::vector<Unit*>& blocks = row(typeid(Block));
        blocks.insert(blocks.end(), ordered.begin(), ordered.end());
        wires_.insert(wires_.end(), its.wires_.begin(), its.wires_.end());
    }
    template <class Item>
    void wire(StreamOutput<Item>& from, StreamInput<Item>& to) {
        wires_.emplace_back([&from, &to] { from.bind(to); });
    }
    /// A wire of another kind. join: binds it.
    void wire(std::function<void()> join) { wires_.push_back(std::move(join)); }

    /// Binds all wires. Call once, when all units have been made.
    void bind() const {
        for (const std::function<void()>& wire : wires_)
            wire();
    }

    const std::vector<Unit*>& units() const { return units_; }
    /// For the clock (cycle_scheduler.h): the last class in the list first; units of one class in the order of the list.
    std::vector<Unit*> downstream_first() const {
        std::vector<Unit*> ordered;
        for (auto its = rows_.rbegin(); its != rows_.rend(); ++its)
            ordered.insert(ordered.end(), its->second.begin(), its->second.end());
        return ordered;
    }
    /// All units that are an AnyUnit, which may be a common base.
    template <class AnyUnit>
    std::vector<AnyUnit*> all() const {
        std::vector<AnyUnit*> found;
        for (Unit* const unit : units_)
            if (auto* const its = dynamic_cast<AnyUnit*>(unit))
                found.push_back(its);
        return found;
    }
    /// The first of these. The design must have one.
    template <class AnyUnit>
    AnyUnit& the() const {
        return *all<AnyUnit>().at(0);
    }

    const UnitContext& context() const { return context_; }
    UnitFactory& factory() const { return factory_; }

  private:
    /// The units of one class, or of the blocks of one class, at the place of the first.
    std::vector<Unit*>& row(std::type_index kind) {
        const auto its = std::find_if(rows_.begin(), rows_.end(), [&](const auto& row) { return row.first == kind; });
        return its != rows_.end() ? its->second : rows_.emplace_back(kind, std::vector<Unit*>{}).second;
    }

    UnitContext context_;
    UnitFactory& factory_;
    std::vector<std::unique_ptr<Unit>> owned_;
    std::vector<Unit*> units_;
    std::vector<std::pair<std::type_index, std::vector<Unit*>>> rows_;
    std::vector<std::function<void()>> wires_;
};

}  // namespace tessera
