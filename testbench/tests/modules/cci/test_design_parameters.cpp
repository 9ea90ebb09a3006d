#include <catch2/catch.hpp>
#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "modules/cci/design_parameters.h"
#include "modules/device/device.h"
#include "testbench/job/job_keys.h"
#include "testbench/job/toml_text.h"
#include "testbench/tests/modules/named_machine.h"
#include "testbench/tests/support/timed_checks.h"

// Presets of a platform become a Design. Names, units and ranges are compared with the keys of a job file.

using namespace tessera;
using namespace tessera::testing;
using Catch::Contains;

namespace {

cci::cci_broker_handle global_broker() {
    static cci_utils::broker broker("global");
    static const bool registered = (cci::cci_register_broker(broker), true);
    static_cast<void>(registered);
    return cci::cci_get_global_broker(cci::cci_originator("test"));
}

void preset(const std::string& name, const std::string& json) {
    global_broker().set_preset_cci_value(name, cci::cci_value::from_json(json));
}

/// The design for these presets, with a prefix that is unique to this call.
Design design_of(const std::map<std::string, std::string>& presets, const Design& defaults = {}) {
    static int calls = 0;
    const std::string prefix = "call_" + std::to_string(calls++);
    global_broker();
    for (const auto& [name, json] : presets)
        preset(prefix + '.' + name, json);
    return DesignParameters(prefix, defaults).design();
}

std::string json_string(std::string_view name) {
    return '"' + std::string(name) + '"';
}

/// Every parameter's value, as JSON.
std::map<std::string, std::string> values_of(const Design& design) {
    std::map<std::string, std::string> values{
        {"mode", json_string(name_of(design.transport))},
        {"hardware.queue_order", json_string(name_of(design.queue.order))},
        {"hardware.queue_watermark", std::to_string(design.queue.watermark)},
        {"hardware.queue_capacity", std::to_string(design.queue.capacity)},
        {"hardware.queue_overflow", json_string(name_of(design.queue.overflow))},
        {"hardware.off_chip_triangles", std::to_string(design.queue.off_chip_triangles)},
        {"hardware.work", json_string(name_of(design.work))},
        {"hardware.test_order", json_string(name_of(design.test_order))},
        {"hardware.tests_units", std::to_string(design.tests_units)},
        {"hardware.edge_lanes", std::to_string(design.edge_lanes)},
        {"hardware.normal_tests", std::to_string(design.normal_tests)},
        {"hardware.transform_pipelines", std::to_string(design.transform_pipelines)},
    };
    Job job;
    job.timing = design.timing;
    for (const tessera::Key& key : find_table("timing")->keys)
        values[key.name] = toml_value(key.get(job));
    return values;
}

std::string integer(double value) {
    return std::to_string(static_cast<std::int64_t>(value));
}

/// Extreme values of a key: the lowest and highest integer, the first and last choice.
std::pair<std::string, std::string> ends_of(const tessera::Key& key) {
    if (key.kind == KeyKind::choice)
        return {json_string(key.choices.front()), json_string(key.choices.back())};
    return {integer(key.range.low), integer(key.range.high)};
}

std::string error_of(const std::string& name, const std::string& json) {
    try {
        design_of({{name, json}});
    } catch (const sc_core::sc_report& report) {
        CHECK(report.get_severity() == sc_core::SC_ERROR);
        CHECK(report.get_msg_type() == std::string("tessera/cci"));
        return report.get_msg();
    }
    return "";
}

/// A module with its own broker, and the parameters below its name.
struct Platform : sc_core::sc_module {
    cci_utils::broker broker{"broker"};
    cci::cci_broker_handle handle = cci::cci_register_broker(broker);
    std::unique_ptr<DesignParameters> parameters;

    explicit Platform(const sc_core::sc_module_name& name) : sc_module(name) {
        handle.set_preset_cci_value("platform.device.timing.lighting_latency", cci::cci_value(7));
        parameters = std::make_unique<DesignParameters>("device");
    }
};

}  // namespace

TEST_CASE("without presets the parameters return the initial design") {
    CHECK(values_of(design_of({})) == values_of({}));
    std::map<std::string, std::string> others;
    for (const auto& [name, value] : values_of({})) {
        const auto [first, last] = ends_of(*find_key(name));
        others[name] = value == last ? first : last;
    }
    const Design other = design_of(others);
    CHECK(values_of(other) == others);
    CHECK(values_of(design_of({}, other)) == others);
}

TEST_CASE("each preset, at both ends of its range, sets its own member and no other") {
    const std::map<std::string, std::string> defaults = values_of({});
    CHECK(defaults.size() > 80);
    for (const auto& [name, value] : defaults) {
        INFO(name);
        const tessera::Key& key = *find_key(name);
        for (const std::string& end : {ends_of(key).first, ends_of(key).second}) {
            std::map<std::string, std::string> expected = defaults;
            expected[name] = end;
            CHECK(values_of(design_of({{name, end}})) == expected);
        }
    }
}

TEST_CASE("parameters have the names and descriptions of job keys, and cannot be changed") {
    global_broker();
    const DesignParameters parameters("described");
    std::map<std::string, std::string> expected = values_of({});
    for (cci::cci_param_untyped_handle& parameter : global_broker().get_param_handles()) {
        const std::string name = std::string(parameter.name()).substr(std::string("described.").size());
        INFO(name);
        REQUIRE(expected.erase(name) == 1);
        const tessera::Key& key = *find_key(name);
        CHECK(parameter.get_metadata().at("unit").get_list()[0].get<std::string>() == key.unit);
        if (name.rfind("timing.", 0) == 0)
            CHECK(parameter.get_description() == key.description);
        CHECK(parameter.get_description().size() > 10);
        const cci::cci_value before = parameter.get_cci_value();
        CHECK_THROWS_AS(parameter.set_cci_value(before), sc_core::sc_report);
    }
    CHECK(expected.empty());
}

TEST_CASE("an invalid preset is refused with its name, and the valid values") {
    for (const auto& [name, value] : values_of({})) {
        const tessera::Key& key = *find_key(name);
        const auto [first, last] = ends_of(key);
        std::set<std::string> refused{"\"\"", "\"5\"", "-1", "true", "1.5", "null", "[1]"};
        if (key.kind == KeyKind::choice)
            refused.insert({"0", "\"x" + first.substr(1)});
        else
            refused.insert(
                {integer(key.range.low - 1), integer(key.range.high + 1), "18446744073709551615", last + "0"});
        for (const std::string& json : refused) {
            INFO(name << " = " << json);
            CHECK_THAT(error_of(name, json),
                       Catch::StartsWith("call_") &&
                           Catch::EndsWith("." + name + " = " + json + " is invalid: must be " + wanted_text(key)));
        }
    }
    CHECK_THAT(error_of("hardware.tests_units", "2"), Contains(".hardware.tests_units = 2 is invalid: must be 1 or 3"));
}

TEST_CASE("a mistyped preset is refused with the nearest name, and one with another prefix is ignored") {
    const auto refused = [](const std::string& mistyped, const std::string& nearest) {
        INFO(mistyped);
        const std::string error = error_of(mistyped, "9");
        CHECK_THAT(error, Contains("." + mistyped + " = 9 is preset, but no such parameter exists") &&
                              Catch::EndsWith("." + nearest + "?"));
    };
    refused("timing.normal_test_latancy", "timing.normal_test_latency");
    refused("timing.nromal_test_latency", "timing.normal_test_latency");
    refused("normal_test_latency", "timing.normal_test_latency");
    refused("hardware.queue_watermarks", "hardware.queue_watermark");
    refused("modes", "mode");
    preset("device_2.timing.normal_test_latancy", "9");
    preset("a.device.timing.normal_test_latancy", "9");
    preset("device.timing.normal_test_latency", "19");
    CHECK(DesignParameters("device").design().timing.normal_test.latency == 19);
}

TEST_CASE("parameters within a module use its name and its broker") {
    global_broker();
    const Platform platform("platform");
    CHECK(platform.parameters->design().timing.lighting.latency == 7);
    CHECK(cci::cci_broker_handle(platform.handle).get_param_handle("platform.device.mode").is_valid());
    CHECK_FALSE(global_broker().get_param_handle("platform.device.mode").is_valid());
}

TEST_CASE("a device and its parameters may have the same name") {
    global_broker();
    const DesignParameters parameters("beside");
    DeviceDesign design;
    design.machine = parameters.design();
    const Device device("beside", one_triangle().registers, design);
    CHECK(device.name() == std::string("beside"));
}

TEST_CASE("a timed machine configured by presets takes the same cycles as one configured in code") {
    MachineSetup by_hand = one_triangle();
    by_hand.design.timing.transform.latency = 1;
    by_hand.design.timing.summed_height_table.ports = 2;
    by_hand.design.transform_pipelines = 3;
    MachineSetup presets = one_triangle();
    preset("device.mode", "\"timed\"");
    preset("device.timing.transform_latency", "1");
    preset("device.timing.summed_height_table_ports", "2");
    preset("device.hardware.transform_pipelines", "3");
    const DesignParameters parameters("device");
    presets.design = parameters.design();

    const MachineSetup defaults = one_triangle();
    const NamedMachine usual("usual", defaults), first("first", by_hand), second("second", presets);
    sc_core::sc_start();
    CHECK(second.finished());
    CHECK(second.cycles() == first.cycles());
    CHECK(second.cycles() < usual.cycles());
}
