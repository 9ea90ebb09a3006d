#pragma once
#include <filesystem>
#include <string>
#include <string_view>

#include "testbench/job/job.h"

namespace tessera {

/// 64-bit FNV-1a hash of a file's bytes, 16 hexadecimal digits; empty if it cannot be read, which its reader reports.
std::string fingerprint_of(const std::filesystem::path& file);

/// The fingerprint of a file with these bytes.
std::string fingerprint_of_bytes(std::string_view bytes);

/// Fills in mesh.fingerprint and map.fingerprint of files that a job reads, if absent, so that its results are never
/// compared with those of another file.
void record_fingerprints(Job& job);

/// Throws InputError if a file of the job does not match its fingerprint.
void check_mesh_fingerprint(const Job& job);
void check_map_fingerprint(const Job& job);

}  // namespace tessera
