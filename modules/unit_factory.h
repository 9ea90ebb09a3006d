#pragma once
#include <any>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <systemc>
#include <type_traits>
#include <typeindex>
#include <utility>

#include "modules/memories/off_chip_memory.h"
#include "modules/memories/table_cache.h"
#include "modules/memories/table_memory.h"
#include "modules/sockets/memory_port.h"
#include "modules/stage/unit.h"
#include "modules/timing/design.h"

namespace tessera {

/// Makes a machine's units. A derived class calls replace() in its constructor to replace a unit by a variant: a class
/// derived from the unit, with its sockets (modules/README.md, "How to replace a unit"). A variant may also be the same
/// unit with another context, for example with stalls for that unit only. Called during elaboration only.
class UnitFactory {
  public:
    using Name = const sc_core::sc_module_name&;
    template <class AnyUnit>
    using Maker = std::function<std::unique_ptr<AnyUnit>(Name, const UnitContext&)>;

    UnitFactory() = default;
    virtual ~UnitFactory() = default;
    UnitFactory(const UnitFactory&) = delete;
    UnitFactory& operator=(const UnitFactory&) = delete;

    /// `maker` makes each AnyUnit, a class that the machine makes (netlists.cpp).
    template <class AnyUnit>
    void replace(Maker<AnyUnit> maker) {
        static_assert(std::is_base_of_v<Unit, AnyUnit>);
        makers_[typeid(AnyUnit)] = std::move(maker);
        unused_.insert(typeid(AnyUnit));
    }
    template <class AnyUnit, class Variant>
    void replace() {
        replace<AnyUnit>(
            [](Name name, const UnitContext& context) { return std::make_unique<Variant>(name, context); });
    }

    template <class AnyUnit>
    std::unique_ptr<AnyUnit> make(Name name, const UnitContext& context) {
        unused_.erase(typeid(AnyUnit));
        const auto maker = makers_.find(typeid(AnyUnit));
        return maker == makers_.end() ? std::make_unique<AnyUnit>(name, context)
                                      : std::any_cast<const Maker<AnyUnit>&>(maker->second)(name, context);
    }

    /// The replaced classes of which no machine has made a unit yet.
    const std::set<std::type_index>& unused() const { return unused_; }

    /// Called with each module that has outputs, before they are bound. Override to interpose on its streams
    /// (StreamOutput).
    virtual void made(sc_core::sc_module& /*module*/) {}

    /// Joins a unit's port to its memory. The two sides of a dual-port displacement map count as two memories.
    virtual void join(MemoryPort& port, TableMemory& memory) { port.bind(memory); }
    virtual void join(MemoryPort& port, TableCache& cache) { port.bind(cache); }
    virtual void join(MemoryPort& port, OffChipMemory& memory) { port.bind(memory); }

  private:
    std::map<std::type_index, std::any> makers_;
    std::set<std::type_index> unused_;
};

}  // namespace tessera
