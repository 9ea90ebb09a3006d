#pragma once
#include <string>

namespace tessera {

/// The reference of all job keys: one Markdown table per table of a job file.
std::string document_keys();

}  // namespace tessera
