#pragma once
#include <memory>
#include <vector>

#include "modules/unit_factory.h"
#include "testbench/check/transport/read_check.h"

namespace tessera {

/// A machine with a read check before each table or its cache. Must be declared before the machine: the checks are
/// modules within it, and are destroyed after it.
class ReadCheckedUnits : public UnitFactory {
  public:
    using UnitFactory::join;
    void join(MemoryPort& port, TableMemory& memory) override;
    void join(MemoryPort& port, TableCache& cache) override;

    /// Over all tables. Call before the machine is destroyed.
    ReadResult result() const;

  protected:
    /// Binds the port to a read check, whose to_memory is still to be bound.
    ReadCheck& check(MemoryPort& port, const sc_core::sc_object& memory);

  private:
    struct Checked {
        const MemoryPort* port;
        std::unique_ptr<ReadCheck> check;
    };
    std::vector<Checked> checks_;
};

}  // namespace tessera
