#pragma once
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "modules/memories/base_protocol_bridge.h"
#include "modules/unit_factory.h"

namespace tessera::testing {

/// Makes the memory that replaces the machine's memory of this name, and binds the bridge to it.
using BridgedMemory = std::function<std::unique_ptr<sc_core::sc_module>(BaseProtocolBridge&, const std::string&)>;

template <class Memory, class... Arguments>
std::unique_ptr<sc_core::sc_module> bound(BaseProtocolBridge& bridge, const std::string& name,
                                          const Arguments&... arguments) {
    auto memory = std::make_unique<Memory>((name + "_bus").c_str(), arguments...);
    bridge.to_memory.bind(memory->socket);
    return memory;
}

/// Joins the ports of a machine to bridges, one for each of its memories; both sides of a dual-port displacement map
/// are one.
class BridgedUnits : public UnitFactory {
  public:
    BridgedUnits(const Timing& timing, BridgedMemory make) : timing_(timing), make_(std::move(make)) {}

    void join(MemoryPort& port, TableMemory& memory) override { join_any(port, memory, 1); }
    void join(MemoryPort& port, OffChipMemory& memory) override {
        join_any(port, memory, timing_.off_chip_memory.buffer);
    }
    BaseProtocolBridge& bridge(const std::string& memory) { return *bridges_.at(memory); }

  private:
    void join_any(MemoryPort& port, const MemoryServer& memory, unsigned buffer) {
        std::string name = memory.basename();
        if (name == "displacement_map_for_tests")
            name = "displacement_map";
        if (bridges_.count(name) == 0) {
            const std::string machine = memory.get_parent_object()->name();
            auto* clock = dynamic_cast<CycleScheduler*>(sc_core::sc_find_object((machine + ".clock").c_str()));
            bridges_[name] = std::make_unique<BaseProtocolBridge>(("bridge_of_" + name).c_str(), *clock, buffer);
            memories_.push_back(make_(*bridges_[name], name));
        }
        port.bind(*bridges_[name]);
    }

    Timing timing_;
    BridgedMemory make_;
    std::map<std::string, std::unique_ptr<BaseProtocolBridge>> bridges_;
    std::vector<std::unique_ptr<sc_core::sc_module>> memories_;
};

}  // namespace tessera::testing
