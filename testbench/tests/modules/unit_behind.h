#pragma once
#include <memory>

#include "modules/machine.h"

namespace tessera::testing {

/// Inserts an Inserted, which has `input` and `output`, behind the machine's Before: Displace Vertex or Lighting. One
/// factory per machine, which it must outlive.
template <class Before, class Inserted>
class UnitBehind : public UnitFactory {
  public:
    UnitBehind() {
        replace<Before>([this](Name name, const UnitContext& context) {
            inserted_ = std::make_unique<Inserted>("inserted", context);
            context.clock.attach(*inserted_);
            return std::make_unique<Before>(name, context);
        });
    }
    const Inserted& inserted() const { return *inserted_; }

  private:
    void made(sc_core::sc_module& module) override {
        if (auto* const before = dynamic_cast<Before*>(&module))
            output_of(*before).interpose([this](auto& from, auto& to) {
                from.bind(inserted_->input);
                inserted_->output.bind(to);
            });
    }
    static auto& output_of(DisplaceVertex& unit) { return unit.to_transform; }
    static auto& output_of(Lighting& unit) { return unit.to_rasteriser; }

    std::unique_ptr<Inserted> inserted_;
};

}  // namespace tessera::testing
