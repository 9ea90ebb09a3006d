#include "testbench/machine/fingerprint.h"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <fstream>

#include "testbench/common/error.h"
#include "testbench/common/hash.h"

namespace tessera {

namespace {

namespace fs = std::filesystem;

std::string written(std::uint64_t hash) {
    return fmt::format("{:016x}", hash);
}

/// The mesh file that the job reads; for a run's folder, its mesh. Empty: the job reads none.
fs::path mesh_file(const Job& job) {
    return job.mesh.source == MeshSource::run ? job.mesh.path / "mesh.ply" : job.mesh.path;
}

void check(const std::string& table, const fs::path& file, const std::string& wanted) {
    if (wanted.empty() || file.empty())
        return;
    const std::string found = fingerprint_of(file);
    if (!found.empty() && found != wanted)
        throw InputError(fmt::format(
            "{0}.fingerprint = \"{1}\": {2} has {3}: the file was changed since this job was written, or is "
            "another file; to use it, set {0}.fingerprint = \"\" in the job and run again",
            table, wanted, file.string(), found));
}

}  // namespace

std::string fingerprint_of(const fs::path& file) {
    std::error_code error;
    if (!fs::is_regular_file(file, error))
        return {};  // opening a pipe would wait for its other end
    std::ifstream in(file, std::ios::binary);
    if (!in)
        return {};
    std::uint64_t hash = fnv1a_basis;
    std::array<char, 1 << 16> bytes;
    while (in) {
        in.read(bytes.data(), bytes.size());
        hash = fnv1a({bytes.data(), static_cast<std::size_t>(in.gcount())}, hash);
    }
    return in.bad() ? std::string{} : written(hash);
}

std::string fingerprint_of_bytes(std::string_view bytes) {
    return written(fnv1a(bytes));
}

void record_fingerprints(Job& job) {
    const auto record = [](const fs::path& file, std::string& fingerprint) {
        if (fingerprint.empty() && !file.empty())
            fingerprint = fingerprint_of(file);
    };
    record(mesh_file(job), job.mesh.fingerprint);
    record(job.map.path, job.map.fingerprint);
}

void check_mesh_fingerprint(const Job& job) {
    check("mesh", mesh_file(job), job.mesh.fingerprint);
}

void check_map_fingerprint(const Job& job) {
    check("map", job.map.path, job.map.fingerprint);
}

}  // namespace tessera
