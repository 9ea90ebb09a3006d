#pragma once
#include <initializer_list>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "modules/stage/unit.h"
#include "modules/unit_factory.h"

namespace tessera {

/// Makes units of a machine with its factory, and owns them.
class MadeUnits {
  public:
    /// list: the machine's units; each that is made is added. context.design: used only while the machine is built.
    MadeUnits(const UnitContext& context, UnitFactory& factory, std::vector<Unit*>& list)
        : context_(context), factory_(factory), list_(list) {}

    template <class AnyUnit>
    AnyUnit& make(const std::string& name) {
        std::unique_ptr<AnyUnit> unit = factory_.make<AnyUnit>(name.c_str(), context_);
        AnyUnit& made = *unit;
        units_.push_back(std::move(unit));
        list_.push_back(&made);
        return made;
    }
    /// Null in the other design.
    template <class AnyUnit>
    AnyUnit* make_for(Work work, const std::string& name) {
        return context_.design.work == work ? &make<AnyUnit>(name) : nullptr;
    }

    const UnitContext& context() const { return context_; }
    UnitFactory& factory() const { return factory_; }

  private:
    UnitContext context_;
    UnitFactory& factory_;
    std::vector<Unit*>& list_;
    std::vector<std::unique_ptr<Unit>> units_;
};

/// The only one of these that is made; the others are null.
template <class AnyUnit>
AnyUnit& the_one(std::initializer_list<AnyUnit*> units) {
    AnyUnit* made = nullptr;
    for (AnyUnit* const unit : units)
        made = unit != nullptr ? unit : made;
    return *made;
}

}  // namespace tessera
