#pragma once
#include "modules/datapath/format.h"
#include "testbench/setup/scene_settings.h"

namespace tessera {

/// Input: the bits of [formats]. Output: the datapath's formats; two of them are provisional: summed_height if its bits
/// depend on the mesh (summed_height_bits(), table_layout.h), and view_distance (view.h). Throws InputError if an
/// intermediate of the datapath would be wider than the model's integers.
datapath::Formats make_formats(const FormatSettings& settings, datapath::MapFilter filter);

}  // namespace tessera
