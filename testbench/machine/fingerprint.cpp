#include "testbench/machine/fingerprint.h"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <fstream>

#include "testbench/common/error.h"
#include "testbench/common/hash.h"
#include "testbench/job/job_paths.h"

namespace tessera {

namespace {

namespace fs = std::filesystem;

/// What is read: of a run's folder its mesh. Empty: the job reads none.
fs::path mesh_file(const Job& job, const fs::path& data_folder) {
    if (!reads_file(job.mesh.source))
        return {};
    const fs::path path = resolve_path(job.mesh.file, job.folder, data_folder);
    return job.mesh.source == MeshSource::run ? path / "mesh.ply" : path;
}

fs::path map_file(const Job& job, const fs::path& data_folder) {
    return job.map.source == MapSource::file ? resolve_path(job.map.file, job.folder, data_folder)
                                             : fs::path{};
}

void check(const std::string& table, const fs::path& file, const std::string& wanted) {
    if (wanted.empty() || file.empty())
        return;
    const std::string found = fingerprint_of(file);
    if (!found.empty() && found != wanted)
        throw InputError(fmt::format(
            "{0}.fingerprint = \"{1}\": {2} has {3}: it was changed since this job was written, or is "
            "another file; run anew, with {0}.fingerprint = \"\" where the job has it",
            table, wanted, file.string(), found));
}

}  // namespace

std::string fingerprint_of(const fs::path& file) {
    std::error_code error;
    if (!fs::is_regular_file(file, error))
        return {};  // to open a pipe would wait for its other end
    std::ifstream in(file, std::ios::binary);
    if (!in)
        return {};
    std::uint64_t hash = fnv1a_basis;
    std::array<char, 1 << 16> bytes;
    while (in) {
        in.read(bytes.data(), bytes.size());
        hash = fnv1a({bytes.data(), static_cast<std::size_t>(in.gcount())}, hash);
    }
    return in.bad() ? std::string{} : fmt::format("{:016x}", hash);
}

void record_fingerprints(Job& job, const fs::path& data_folder) {
    if (const fs::path file = mesh_file(job, data_folder); job.mesh.fingerprint.empty() && !file.empty())
        job.mesh.fingerprint = fingerprint_of(file);
    if (const fs::path file = map_file(job, data_folder); job.map.fingerprint.empty() && !file.empty())
        job.map.fingerprint = fingerprint_of(file);
}

void check_mesh_fingerprint(const Job& job, const fs::path& data_folder) {
    check("mesh", mesh_file(job, data_folder), job.mesh.fingerprint);
}

void check_map_fingerprint(const Job& job, const fs::path& data_folder) {
    check("map", map_file(job, data_folder), job.map.fingerprint);
}

}  // namespace tessera
