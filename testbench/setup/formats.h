#pragma once
#include "modules/datapath/format.h"
#include "testbench/setup/scene_settings.h"

namespace tessera {

/// In: the bits of [formats]. Out: the datapath's formats; two of them are provisional: summed_height where its bits
/// are left to the mesh (summed_height_bits(), table_layout.h), and view_distance (view.h).
/// Throws InputError if an intermediate of the datapath would be wider than the model's integers.
datapath::Formats make_formats(const FormatSettings& settings, datapath::MapFilter filter);

}  // namespace tessera
