#pragma once
#include <functional>
#include <memory>

#include "golden/height_tests/height_test.h"
#include "modules/datapath/height_tests.h"
#include "testbench/check/conformance/golden_job.h"
#include "testbench/check/conformance/setup_judge.h"
#include "testbench/machine/machine_setup.h"

namespace tessera {

/// The check's part of a height test: golden's counterpart, made in two ways, and their comparison.
class HeightTestCheck {
  public:
    using Golden = std::shared_ptr<const golden::HeightTest>;
    /// Compares the table in one machine's memory with golden's.
    using TableCheck = std::function<void(Host&)>;

    HeightTestCheck() = default;
    virtual ~HeightTestCheck() = default;
    HeightTestCheck(const HeightTestCheck&) = delete;
    HeightTestCheck& operator=(const HeightTestCheck&) = delete;

    /// From the registers and the host's table, dequantised.
    virtual Golden of_machine(const MachineSetup& setup, const golden::Map& map) const = 0;
    /// From the job, without the registers.
    virtual Golden of_job(const GoldenJob& golden, const TakenFromHost& taken) const = 0;

    virtual void check_thresholds(const datapath::Registers& registers, const GoldenJob& golden,
                                  setup_check::Judge& judge) const = 0;
    /// The table's size.
    virtual void check_layout(const datapath::Registers& registers, const GoldenJob& golden,
                              setup_check::Judge& judge) const = 0;
    /// Checks what the table is made from. The result refers to the arguments.
    virtual TableCheck table_check(const MachineSetup& setup, const GoldenJob& golden, SetupResult& result) const = 0;
};

/// That of a test of the datapath.
template <class Test>
const HeightTestCheck& check_part();
#define TESSERA_CHECK_PART(Test) \
    template <>                  \
    const HeightTestCheck& check_part<datapath::Test>();
TESSERA_FOR_EACH_HEIGHT_TEST(TESSERA_CHECK_PART)
#undef TESSERA_CHECK_PART

/// Adds that of the test added last to datapath::height_tests().
void add_height_test_check(const HeightTestCheck& check);
const HeightTestCheck& check_of(datapath::HeightTest test);

}  // namespace tessera
