#include "testbench/commands/load_job.h"

#include "testbench/job/job_paths.h"
#include "testbench/job/read_job.h"
#include "testbench/job/validate_job.h"

namespace tessera {

Job load_job(const std::string& file, const std::vector<std::string>& settings,
             const std::filesystem::path& data_folder) {
    Job job = file.empty() ? Job{} : read_job(file);
    apply_settings(job, settings);
    validate(job);
    resolve_paths(job, data_folder);
    return job;
}

}  // namespace tessera
