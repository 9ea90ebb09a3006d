#include "testbench/commands/load_job.h"

#include "testbench/job/read_job.h"
#include "testbench/job/validate_job.h"

namespace tessera {

Job load_job(const std::string& file, const std::vector<std::string>& settings) {
    Job job = file.empty() ? Job{} : read_job(file);
    for (const std::string& setting : settings)
        apply_setting(job, setting);
    validate(job);
    return job;
}

}  // namespace tessera
