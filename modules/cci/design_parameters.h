#pragma once
#include <cci_configuration>
#include <memory>
#include <string>
#include <vector>

#include "modules/timing/design.h"

namespace tessera {

/// A Design whose members are parameters of CCI, immutable, with description and unit (metadata). They are named as
/// keys of a job file: PREFIX.mode, PREFIX.hardware.queue_order, PREFIX.timing.normal_test_latency. Choices are
/// strings.
class DesignParameters {
  public:
    /// prefix: relative to the module being constructed, if any; must not be used by other parameters. defaults: the
    /// values of parameters without a preset. SC_ERROR, naming the parameter, for an invalid preset value and for a
    /// preset below the prefix without a parameter.
    explicit DesignParameters(const std::string& prefix, const Design& defaults = {});

    const Design& design() const { return design_; }

  private:
    template <typename Group>
    class Keys;

    std::string prefix_;  // absolute, with a trailing dot
    cci::cci_originator originator_;
    cci::cci_broker_handle broker_;
    Design design_;
    std::vector<std::unique_ptr<cci::cci_param_untyped>> parameters_;
};

}  // namespace tessera
