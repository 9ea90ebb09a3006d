#include <string>

#include "testbench/common/error.h"
#include "testbench/job/dump_job.h"
#include "testbench/job/job_keys.h"
#include "testbench/job/read_job.h"
#include "testbench/job/toml_text.h"
#include "testbench/job/validate_job.h"
#include "testbench/prove/fuzz/fuzz_target.h"

namespace tessera::fuzz {

namespace {

/// Checks the first line as an argument of --set.
void check_setting(std::string_view setting) {
    Job job;
    try {
        apply_setting(job, setting);
    } catch (const InputError& error) {
        promise_message(error.what(), "--set " + printable(setting));
        promise(same_settings(job, Job{}), "a refused setting changed the job");
    }
}

}  // namespace

void check_toml(std::string_view bytes) {
    check_setting(bytes.substr(0, bytes.find('\n')));
    const std::string name = "fuzzed.toml";
    try {
        const Job job = parse_job(bytes, name);
        // At this point each key is in its own range.
        for (const KeyTable& table : job_tables())
            for (const Key& key : table.keys)
                promise(complaint(key, key.get(job)).empty(), key.name + " is out of its range");
        const std::string dump = dump_job(job);
        const Job again = parse_job(dump, "dumped.toml");
        promise(same_settings(again, job), "a dumped job differs when read again");
        promise(dump_job(again) == dump, "a dumped job differs when dumped again");
        try {
            validate(job);
        } catch (const InputError& error) {
            promise(*error.what() != '\0', "a job is refused without a message");
        }
    } catch (const InputError& error) {
        promise_message(error.what(), name);
    }
}

}  // namespace tessera::fuzz
