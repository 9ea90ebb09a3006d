#pragma once
#include <string>

namespace tessera {

/// The reference of all job keys: one aligned Markdown table per table of a job file.
std::string document_keys();

}  // namespace tessera
