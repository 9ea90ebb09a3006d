#pragma once
#include <filesystem>
#include <string>

#include "testbench/job/job.h"

namespace tessera {

/// 64-bit FNV-1a hash of a file's bytes, 16 hexadecimal digits; empty if it cannot be read, which its reader will say.
std::string fingerprint_of(const std::filesystem::path& file);

/// Fills in mesh.fingerprint and map.fingerprint where a job reads a file and does not say which: what it is run with,
/// so that its results are never set beside another file's.
void record_fingerprints(Job& job);

/// Throws InputError if a file of the job is not the one its fingerprint stands for.
void check_mesh_fingerprint(const Job& job);
void check_map_fingerprint(const Job& job);

}  // namespace tessera
