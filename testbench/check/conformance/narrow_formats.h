#pragma once
#include <string>

#include "testbench/check/conformance/end_to_end.h"
#include "testbench/job/job.h"

namespace tessera {

/// A warning for a run whose mesh or decisions differ too much from golden's, whose positions and normals are not
/// rounded: the formats that are narrower than their defaults, and the defaults; if none is, and more edges flip than
/// are allowed, or golden's own mesh differs more than is allowed, what to set. Else empty.
std::string narrow_formats_warning(const Job& job, double flips_percent, const EndToEndResult* golden_run);

}  // namespace tessera
